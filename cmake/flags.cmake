# Compiler flags of our own code, as an interface target for each level of instructions: mpm_flags_LEVEL.
include(CheckCXXCompilerFlag)

set(flags -Wall -Wextra -Wconversion -Wno-psabi)
if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
  list(APPEND flags -Wno-sign-conversion)   # which is part of -Wconversion here, not of g++'s
endif()
# No -ffast-math: NaN and infinity are tested for, and the order of sums is fixed. These two change
# no result; they let sqrt and select become plain vector instructions. What is one multiplication and
# addition says so (fma in math/batch.hpp): were it left to the compiler, two loops of one source
# could give different bits.
list(APPEND flags -ffp-contract=off -fno-math-errno -fno-trapping-math)
# A unity build (pip install) parses each header once for many files: a fifth less time. Names in
# anonymous namespaces must differ within it, and g++ warns of them as if they were a header's.
check_cxx_compiler_flag(-Wsubobject-linkage MPM_HAS_SUBOBJECT_LINKAGE)
if(CMAKE_UNITY_BUILD AND MPM_HAS_SUBOBJECT_LINKAGE)
  list(APPEND flags -Wno-subobject-linkage)
endif()
if(MPM_WERROR)
  list(APPEND flags -Werror)
endif()
# g++ 12.2 makes wrong code where it may move more than 16 bytes at once, which -march=native allows it
# on processors with AVX-512: a symmetric tensor that starts as the unit tensor gets a one in its
# fourth component (docs/decisions/0015-fused-stages.md).
check_cxx_compiler_flag("-mmove-max=128 -mstore-max=128" MPM_HAS_MOVE_MAX)
if(MPM_HAS_MOVE_MAX)
  list(APPEND flags -mmove-max=128 -mstore-max=128)
endif()
# The loops over particles are marked to be flattened, but g++ stops at limits of its own, and which
# calls it then leaves changes with every edit: up to twice the time of a stage.
set(inline_limits --param=inline-unit-growth=1000 --param=large-stack-frame=65536
                  --param=large-stack-frame-growth=100000)
list(JOIN inline_limits " " text)
check_cxx_compiler_flag("-Werror ${text}" MPM_HAS_INLINE_LIMITS)   # clang++ only warns of them
if(MPM_HAS_INLINE_LIMITS)
  list(APPEND flags ${inline_limits})
endif()
if(MPM_SAME_BITS)
  list(APPEND flags -DMPM_SAME_BITS)
endif()
if(MPM_FLOAT32)
  list(APPEND flags -DMPM_FLOAT32)
endif()
if(MPM_SANITIZE)
  # Lines and no variables, which g++ gives up to follow in the checked kernels, after a first try.
  # Not optimized: of one file of kernels g++ takes half an hour with -O1, three minutes with -O0.
  list(APPEND flags -fsanitize=${MPM_SANITIZE} -fno-omit-frame-pointer -g1 -O0)
endif()

# Levels of instructions that the core is built for; with more than one the package chooses when it is
# imported (python/mpm3dpp/base/processor.py).
if(MPM_NATIVE)
  set(MPM_LEVELS native)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
  set(MPM_LEVELS x86-64 x86-64-v3 x86-64-v4)   # SSE2; AVX2 and FMA; AVX-512
else()
  set(MPM_LEVELS default)   # on ARM with NEON
endif()

foreach(level IN LISTS MPM_LEVELS)
  set(level_flags ${flags})
  if(NOT level STREQUAL default)
    string(MAKE_C_IDENTIFIER "MPM_HAS_MARCH_${level}" has_march)
    check_cxx_compiler_flag(-march=${level} ${has_march})
    if(${has_march})
      list(APPEND level_flags -march=${level})
    elseif(level STREQUAL native)
      message(WARNING "this compiler has no -march=native: building for its default processor")
    else()
      message(FATAL_ERROR "this compiler has no -march=${level}, which MPM_NATIVE=OFF needs: "
                          "set CXX to g++ >= 12 or clang++ >= 16")
    endif()
  endif()
  string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
  string(JOIN " " build_flags ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}} ${level_flags})
  string(REGEX REPLACE " +" " " build_flags "${build_flags}")
  message(STATUS "MPM3Dpp ${MPM_VERSION}: ${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION} "
                 "${build_flags}")

  add_library(mpm_flags_${level} INTERFACE)
  target_compile_features(mpm_flags_${level} INTERFACE cxx_std_20)
  target_compile_options(mpm_flags_${level} INTERFACE ${level_flags})
  # For build_info(): a result names what made it.
  target_compile_definitions(mpm_flags_${level} INTERFACE MPM_BUILD_FLAGS="${build_flags}"
                                                          MPM_VERSION="${MPM_VERSION}")
  if(MPM_SANITIZE)
    target_link_options(mpm_flags_${level} INTERFACE -fsanitize=${MPM_SANITIZE})
  endif()
endforeach()
