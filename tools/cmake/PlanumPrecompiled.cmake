# Eigen, fmt and the standard library are parsed once for all libraries and once for all tests:
# most of the time of a build goes there. Off in the debug preset, where a source that forgets an
# include is found.
option(PLANUM_PRECOMPILED_HEADERS "Parse the most used headers only once" ON)

set(planum_precompiled_headers
  <Eigen/Cholesky> <Eigen/Core> <Eigen/Eigenvalues> <Eigen/Geometry>
  <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <map> <memory> <optional>
  <random> <span> <string> <string_view> <vector>
  <fmt/format.h>)

# planum_headers_carrier(NAME header...): the target that others of the same flags take them from.
function(planum_headers_carrier name)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "")
  add_library(${name} STATIC ${source})
  target_link_libraries(${name} PRIVATE planum_flags Eigen3::Eigen fmt::fmt)
  target_precompile_headers(${name} PRIVATE ${planum_precompiled_headers} ${ARGN})
endfunction()

# planum_precompiled_headers(TARGET CARRIER)
function(planum_precompiled_headers target carrier)
  if(PLANUM_PRECOMPILED_HEADERS)
    target_precompile_headers(${target} REUSE_FROM ${carrier})
  endif()
endfunction()
