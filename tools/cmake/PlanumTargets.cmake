# Flags and rules that every target of the project shares.
add_library(planum_flags INTERFACE)
target_compile_features(planum_flags INTERFACE cxx_std_20)
target_compile_options(planum_flags INTERFACE
  $<BUILD_INTERFACE:-Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast
  # g++ 12 sees overlaps and overflows in "text" + std::string that are not there (GCC bug 105651);
  # real ones are found by the sanitizers.
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict -Wno-array-bounds -Wno-stringop-overflow
     -Wno-stringop-overread>
  $<$<BOOL:${PLANUM_WARNINGS_AS_ERRORS}>:-Werror>
  # g++ looks for memory to free over and over; with 0.8 GB to fill first it is done sooner.
  $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=400000>
  # g++ 12 takes its own AVX-512 intrinsics for uninitialized; portable builds keep the warning.
  $<$<BOOL:${PLANUM_NATIVE}>:-march=native -Wno-uninitialized -Wno-maybe-uninitialized>
  # The same sum in the same order everywhere: no contraction that depends on inlining.
  -ffp-contract=off>)
# Fixed alignment: an installed library built with -march=native and a user built without agree.
target_compile_definitions(planum_flags INTERFACE EIGEN_MAX_ALIGN_BYTES=16)
if(PLANUM_SANITIZE)
  target_compile_options(planum_flags INTERFACE
    # Checks of every pointer double the build and find what the address sanitizer finds too.
    $<BUILD_INTERFACE:-fsanitize=${PLANUM_SANITIZE} -fno-sanitize=null,alignment,object-size
      -fno-omit-frame-pointer -fno-sanitize-recover=all>)
  target_link_options(planum_flags INTERFACE $<BUILD_INTERFACE:-fsanitize=${PLANUM_SANITIZE}>)
endif()
install(TARGETS planum_flags EXPORT planum_targets)

include(PlanumPrecompiled)
if(PLANUM_PRECOMPILED_HEADERS)
  planum_headers_carrier(planum_library_headers)
  set_target_properties(planum_library_headers PROPERTIES POSITION_INDEPENDENT_CODE ON)
endif()

# planum_library(NAME [SUBFOLDERS folder...] [PUBLIC dep...] [PRIVATE dep...]): one library per
# folder, every .cpp in it and in these folders below it.
function(planum_library name)
  cmake_parse_arguments(arg "" "" "SUBFOLDERS;PUBLIC;PRIVATE" ${ARGN})
  set(sources)
  set(headers)
  file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  foreach(part . ${arg_SUBFOLDERS})
    cmake_path(SET place NORMALIZE ${CMAKE_CURRENT_SOURCE_DIR}/${part})
    cmake_path(SET installed NORMALIZE ${CMAKE_INSTALL_INCLUDEDIR}/planum/${folder}/${part})
    file(GLOB part_sources CONFIGURE_DEPENDS ${place}/*.cpp)
    file(GLOB part_headers CONFIGURE_DEPENDS ${place}/*.hpp)
    install(FILES ${part_headers} DESTINATION ${installed})
    list(APPEND sources ${part_sources})
    list(APPEND headers ${part_headers})
  endforeach()
  add_library(planum_${name} STATIC ${sources})
  add_library(planum::${name} ALIAS planum_${name})
  set_target_properties(planum_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(planum_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/planum>)
  target_link_libraries(planum_${name} PUBLIC planum_flags ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  planum_precompiled_headers(planum_${name} planum_library_headers)
  install(TARGETS planum_${name} EXPORT planum_targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  set_property(GLOBAL APPEND PROPERTY PLANUM_HEADERS ${headers})
  set_property(GLOBAL APPEND PROPERTY PLANUM_LIBRARIES planum_${name})
endfunction()
