# Language level, build type, warnings, sanitizers, compiler cache and linker for every target.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

# Builds sooner than with CMake's own -O3.
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")

# Less garbage collection: a seventh of GCC's time for some hundred megabytes.
add_compile_options($<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=524288>)

find_program(PLUMB_CCACHE ccache)
if(PLUMB_CCACHE)
  # Without this it caches nothing that a precompiled header is included in.
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env CCACHE_SLOPPINESS=pch_defines,time_macros "${PLUMB_CCACHE}")
endif()
find_program(PLUMB_MOLD mold)
if(PLUMB_MOLD AND NOT PLUMB_SANITIZE)
  add_link_options(-fuse-ld=mold)
endif()

add_library(plumb_warnings INTERFACE)
target_compile_options(plumb_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
  -Woverloaded-virtual -Wcast-qual -Wextra-semi -Wundef
  # GCC 12 warns falsely inside std::string (GCC bugs 105651, 105329)
  "$<$<CXX_COMPILER_ID:GNU>:-Wno-restrict;-Wno-array-bounds;-Wno-stringop-overflow>" $<$<BOOL:${PLUMB_WERROR}>:-Werror>)

# Same input, same bytes on every machine: no fused multiply-add that one compiler makes and another does not.
add_compile_options(-ffp-contract=off)

if(PLUMB_SANITIZE)
  string(REPLACE ";" "," _sanitizers "${PLUMB_SANITIZE}")
  add_compile_options(-fsanitize=${_sanitizers} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${_sanitizers})
endif()

# Fuzzers see which branches an input takes only in code compiled for it.
if(PLUMB_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()

find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(tl-expected REQUIRED)
find_package(nlohmann_json REQUIRED)
