# The C interface of GEOS (the stable one), as the target GEOS::C.
find_path(GEOS_C_INCLUDE_DIR geos_c.h)
find_library(GEOS_C_LIBRARY geos_c)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(GEOS_C REQUIRED_VARS GEOS_C_LIBRARY GEOS_C_INCLUDE_DIR)
if(GEOS_C_FOUND AND NOT TARGET GEOS::C)
  add_library(GEOS::C UNKNOWN IMPORTED)
  set_target_properties(GEOS::C PROPERTIES IMPORTED_LOCATION ${GEOS_C_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${GEOS_C_INCLUDE_DIR})
endif()
mark_as_advanced(GEOS_C_INCLUDE_DIR GEOS_C_LIBRARY)
