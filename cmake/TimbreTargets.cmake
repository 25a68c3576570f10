# One spelling of every include, here and once installed: "timbre/analysis/...".
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/include)
file(CREATE_LINK ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/include/timbre SYMBOLIC)

find_program(TIMBRE_CCACHE ccache)
if(TIMBRE_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
    CCACHE_SLOPPINESS=pch_defines,time_macros ${TIMBRE_CCACHE})
endif()

# Warnings, sanitizers and coverage of everything this project compiles.
function(timbre_compile_options target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wshadow)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # g++ 12 warns of overlapping copies inside std::string (its bug 105329).
    target_compile_options(${target} PRIVATE -Wno-restrict)
  endif()
  if(TIMBRE_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(TIMBRE_SANITIZE)
    target_compile_options(${target} PRIVATE
      -fsanitize=${TIMBRE_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(${target} PRIVATE -fsanitize=${TIMBRE_SANITIZE})
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      # With sanitizers g++ 12 sees uninitialised reads inside Eigen that are none.
      target_compile_options(${target} PRIVATE -Wno-maybe-uninitialized)
    endif()
  endif()
  if(TIMBRE_COVERAGE)
    target_compile_options(${target} PRIVATE --coverage)
    target_link_options(${target} PRIVATE --coverage)
  endif()
endfunction()

# Half of the time to compile a source is reading the same headers. Targets with the same options
# share those of the first: timbre_precompile(TARGET GROUP HEADERS...).
function(timbre_precompile target group)
  if(NOT TIMBRE_PRECOMPILE)
    return()
  endif()
  get_property(first GLOBAL PROPERTY TIMBRE_PRECOMPILED_${group})
  if(first)
    target_precompile_headers(${target} REUSE_FROM ${first})
  else()
    target_precompile_headers(${target} PRIVATE ${ARGN})
    set_property(GLOBAL PROPERTY TIMBRE_PRECOMPILED_${group} ${target})
  endif()
  if(TIMBRE_CCACHE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE -fpch-preprocess)  # else nothing is cached
  endif()
endfunction()

# Sources that read each header for themselves: of precompiled strings, g++ 12 warns in some that
# their lengths may be negative.
function(timbre_precompile_not)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# A library per top-level folder: alias, include path, warnings, export.
function(timbre_library name)
  add_library(timbre_${name} STATIC ${ARGN})
  add_library(timbre::${name} ALIAS timbre_${name})
  target_include_directories(timbre_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(timbre_${name} PUBLIC cxx_std_20)
  timbre_compile_options(timbre_${name})
  timbre_precompile(timbre_${name} libraries
    <Eigen/Core> <Eigen/SparseCore> <algorithm> <functional> <map> <memory> <optional> <string> <vector>)
  set_target_properties(timbre_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  install(TARGETS timbre_${name} EXPORT timbreTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
endfunction()

# Links static libraries of this project before the objects of a target that is compiled with less
# optimisation: of a template that both instantiate, the linker keeps the one it sees first.
function(timbre_link_first target)
  target_link_libraries(${target} PRIVATE ${ARGN})
  foreach(library ${ARGN})
    target_link_options(${target} PRIVATE
      LINKER:--whole-archive,$<TARGET_FILE:${library}>,--no-whole-archive)
  endforeach()
endfunction()

# A package that brings no CMake file of its own: header and library by name,
# so that the exported targets name nothing of this machine.
function(timbre_require_library target library header)
  find_path(TIMBRE_${library}_INCLUDE ${header} PATH_SUFFIXES suitesparse)
  find_library(TIMBRE_${library}_LIBRARY ${library})
  if(NOT TIMBRE_${library}_INCLUDE OR NOT TIMBRE_${library}_LIBRARY)
    message(FATAL_ERROR "lib${library} with ${header} is missing; packages.txt lists the Debian package")
  endif()
  if(NOT TIMBRE_${library}_INCLUDE STREQUAL "/usr/include")
    target_include_directories(${target} SYSTEM PRIVATE ${TIMBRE_${library}_INCLUDE})
  endif()
  target_link_libraries(${target} PRIVATE ${library})
endfunction()
