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

# What a program exposed to strangers is built with: addresses that nobody can guess (PIE), tables of addresses that are
# read-only before main() runs (RELRO, BIND_NOW), checked stacks and checked calls of libc, indirect jumps that land on
# marked instructions only. tests/operations/hardening.sh reads each of these from the finished programs.
include(CheckPIESupported)
check_pie_supported()
add_compile_options(-fstack-protector-strong)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  add_compile_options(-fcf-protection=full)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
  add_compile_options(-mbranch-protection=standard)
endif()
add_link_options(-Wl,-z,relro -Wl,-z,now -Wl,-z,noexecstack)

set(PATCHMILL_SANITIZE "" CACHE STRING "Sanitizers, comma separated (address,undefined or thread)")
if(PATCHMILL_SANITIZE)
  add_compile_options(-fsanitize=${PATCHMILL_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${PATCHMILL_SANITIZE})
elseif(NOT CMAKE_BUILD_TYPE STREQUAL "Debug")
  # The checked calls need an optimizing compiler, and the sanitizers have checks of their own.
  add_compile_options(-U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2)
endif()

find_program(CCACHE ccache)
if(CCACHE)
  # What precompiled headers need (ccache(1), PRECOMPILED HEADERS).
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
endif()
