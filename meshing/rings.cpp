#include "meshing/rings.hpp"

#include <algorithm>
#include <unordered_map>

namespace planum {

std::vector<Ring> simple_rings(const Ring& ring) {
  std::vector<Ring> simple;
  Ring path;
  std::unordered_map<std::uint32_t, std::size_t> place;  // of the vertices in path
  for (const std::uint32_t v : ring) {
    const auto before = place.find(v);
    if (before == place.end()) {
      place.emplace(v, path.size());
      path.push_back(v);
      continue;
    }
    // What lies between the two visits is a ring of its own (or a repeated vertex, or a spike).
    const auto cut = path.begin() + static_cast<std::ptrdiff_t>(before->second);
    Ring loop(cut, path.end());
    for (auto i = cut + 1; i != path.end(); ++i) place.erase(*i);
    path.erase(cut + 1, path.end());
    if (loop.size() >= 3) simple.push_back(std::move(loop));
  }
  if (path.size() >= 3) simple.push_back(std::move(path));
  return simple;
}

}  // namespace planum
