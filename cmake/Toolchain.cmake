# What every translation unit is compiled with, and why.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)

# [verification P5], same bytes: no contraction of a*b+c (it differs by processor), no fast-math, no -march=native.
add_compile_options(-ffp-contract=off -Wall -Wextra -Wshadow -Wnon-virtual-dtor)
# Eigen asks for such instructions by name where the processor is known to have them; ARM's compilers tell by this macro.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
  add_compile_options(-U__ARM_FEATURE_FMA)
endif()
# g++ 12 raises these two falsely inside Eigen and std::variant at -O3.
add_compile_options($<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized> $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds>)
option(PATCHMILL_WERROR "Warnings are errors" ON)
if(PATCHMILL_WERROR)
  add_compile_options(-Werror)
endif()
include_directories(${CMAKE_SOURCE_DIR})

set(PATCHMILL_SANITIZE "" CACHE STRING "Sanitizers, comma separated (address,undefined or thread)")
if(PATCHMILL_SANITIZE)
  add_compile_options(-fsanitize=${PATCHMILL_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${PATCHMILL_SANITIZE})
endif()

find_program(CCACHE ccache)
if(CCACHE)
  # What precompiled headers need (ccache(1), PRECOMPILED HEADERS).
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
endif()
