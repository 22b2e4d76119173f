#include "tools/workflow/settings.hpp"

#include <map>

#include "slam/core/error.hpp"

namespace planum {
namespace {

template <class Value>
Value named(const std::map<std::string, Value>& values, const std::string& name, const char* key) {
  const auto found = values.find(name);
  if (found == values.end()) throw Error(std::string(key) + ": there is no '" + name + "'");
  return found->second;
}

}  // namespace

Pairing pairing_of(const Settings& settings) {
  return named<Pairing>({{"point-to-point", Pairing::point_to_point},
                         {"point-to-plane", Pairing::point_to_plane},
                         {"plane-to-plane", Pairing::plane_to_plane},
                         {"symmetric", Pairing::symmetric}},
                        settings.pairing, "registration.pairing");
}

Minimizer minimizer_of(const Settings& settings) {
  return named<Minimizer>({{"svd", Minimizer::svd},
                           {"quaternion", Minimizer::quaternion},
                           {"dual-quaternion", Minimizer::dual_quaternion},
                           {"orthonormal", Minimizer::orthonormal},
                           {"helix", Minimizer::helix},
                           {"small-angle", Minimizer::small_angle},
                           {"lu-milios", Minimizer::lu_milios}},
                          settings.minimizer, "registration.minimizer");
}

}  // namespace planum
