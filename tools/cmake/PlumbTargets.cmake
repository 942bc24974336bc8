# What most files include, parsed once: a third of the time that a build takes. Off shows which files do not include what they use.
option(PLUMB_PRECOMPILED_HEADERS "Precompile the headers that most files include" ON)
set(PLUMB_COMMON_HEADERS <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <limits> <map> <memory> <numbers> <optional>
  <set> <span> <string> <string_view> <unordered_map> <utility> <vector> <Eigen/Dense>)

# A target that others take the precompiled headers from; it must be compiled as they are.
function(plumb_headers name)
  cmake_parse_arguments(ARG "" "" "HEADERS;DEPS" ${ARGN})
  if(NOT PLUMB_PRECOMPILED_HEADERS)
    return()
  endif()
  add_library(${name} OBJECT ${PROJECT_SOURCE_DIR}/tools/cmake/precompiled.cc)
  target_link_libraries(${name} PRIVATE ${ARG_DEPS} Eigen3::Eigen plumb_warnings)
  target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)  # lets ccache see into it
  target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
endfunction()

function(plumb_use_headers target name)
  if(TARGET ${name})
    target_precompile_headers(${target} REUSE_FROM ${name})
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
  endif()
endfunction()

plumb_headers(plumb_library_headers HEADERS ${PLUMB_COMMON_HEADERS})

# plumb_library(NAME SOURCES a.cc b.cc DEPS plumb_schema ... PRIVATE_DEPS ceres ...)
# One static library per folder. Headers are included by their path from the repository's root.
function(plumb_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS;PRIVATE_DEPS" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PUBLIC ${ARG_DEPS} PRIVATE plumb_warnings ${ARG_PRIVATE_DEPS})
  plumb_use_headers(${name} plumb_library_headers)
endfunction()

# How tests are compiled: sooner rather than faster, as what takes time in them is in the libraries.
function(plumb_test_options name)
  target_compile_definitions(${name} PRIVATE PLUMB_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# plumb_test(NAME LABEL unit SOURCES a_test.cc DEPS plumb_schema ...): one GoogleTest program, its tests known to ctest
# one by one, or with WHOLE as one (tests that share an expensive set-up).
function(plumb_test name)
  cmake_parse_arguments(ARG "WHOLE" "LABEL;TIMEOUT" "SOURCES;DEPS" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_DEPS} plumb_warnings GTest::gtest_main GTest::gmock)
  plumb_test_options(${name})
  plumb_use_headers(${name} plumb_test_headers)
  if(ARG_WHOLE)
    add_test(NAME ${name} COMMAND ${name})
    set_tests_properties(${name} PROPERTIES LABELS ${ARG_LABEL} TIMEOUT ${ARG_TIMEOUT})
  else()
    gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 PROPERTIES LABELS ${ARG_LABEL} TIMEOUT ${ARG_TIMEOUT})
  endif()
endfunction()
