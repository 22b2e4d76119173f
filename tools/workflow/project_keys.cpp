#include "tools/workflow/project_keys.hpp"

#include <utility>

#include "tools/workflow/keys/keys.hpp"

namespace planum {

const std::vector<Section>& project_sections() {
  static const std::vector<Section> sections = {
      {"scans", "what to read"},
      {"sensor", "replaces values in the headers of slices files"},
      {"registration", "each scan against the one before (ICP)"},
      {"loops", "scans that see the same place again"},
      {"relaxation", "all scans at once"},
      {"world", "the frame of all results"},
      {"cloud", "normals, and what is no surface"},
      {"mesh", "triangles from the cloud"},
      {"polygons", "plane parts of the mesh"},
      {"labels", "what a polygon is"},
      {"rooms", "rooms, doors and windows"},
      {"maps", "files for people and robots"},
      {"evaluation", "how good it is"},
      {"output", "where results go"},
  };
  return sections;
}

const std::vector<Key>& project_keys() {
  static const std::vector<Key> keys = [] {
    std::vector<Key> all;
    for (const auto& keys_of : {scan_keys, slam_keys, surface_keys, label_keys, map_keys})
      for (Key& key : keys_of()) all.push_back(std::move(key));
    return all;
  }();
  return keys;
}

}  // namespace planum
