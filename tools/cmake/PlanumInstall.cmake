# find_package(planum) for other projects: planum::core, planum::registration, planum::meshing ...
include(CMakePackageConfigHelpers)
configure_package_config_file(${PROJECT_SOURCE_DIR}/tools/cmake/planumConfig.cmake.in
  ${PROJECT_BINARY_DIR}/planumConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/planum)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/planumConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(EXPORT planum_targets NAMESPACE planum:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/planum
  FILE planumTargets.cmake)
install(FILES ${PROJECT_BINARY_DIR}/planumConfig.cmake ${PROJECT_BINARY_DIR}/planumConfigVersion.cmake
  tools/cmake/FindCHOLMOD.cmake tools/cmake/FindGEOS_C.cmake
  tools/cmake/FindRecast.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/planum)
