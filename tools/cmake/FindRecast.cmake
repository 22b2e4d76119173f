# Recast & Detour, as the targets Recast::Recast (makes navigation meshes) and Recast::Detour (uses
# them).
find_path(RECAST_INCLUDE_DIR Recast.h PATH_SUFFIXES recastnavigation)
find_library(RECAST_LIBRARY Recast)
find_library(DETOUR_LIBRARY Detour)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Recast
  REQUIRED_VARS RECAST_LIBRARY DETOUR_LIBRARY RECAST_INCLUDE_DIR)
if(Recast_FOUND AND NOT TARGET Recast::Recast)
  foreach(part Recast Detour)
    string(TOUPPER ${part} name)
    add_library(Recast::${part} UNKNOWN IMPORTED)
    set_target_properties(Recast::${part} PROPERTIES IMPORTED_LOCATION ${${name}_LIBRARY}
      INTERFACE_INCLUDE_DIRECTORIES ${RECAST_INCLUDE_DIR})
  endforeach()
endif()
mark_as_advanced(RECAST_INCLUDE_DIR RECAST_LIBRARY DETOUR_LIBRARY)
