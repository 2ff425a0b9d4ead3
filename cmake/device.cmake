# Steps on an NVIDIA card: a shared object of its own, which the core loads when a device is asked for.
# Its code and the core's must not be linked together: both have functions of the same names, made by
# different compilers (docs/decisions/0057-a-device-of-its-own.md).
if(MPM_CUDA STREQUAL "AUTO")
  include(CheckLanguage)
  check_language(CUDA)
  if(NOT CMAKE_CUDA_COMPILER)
    return()
  endif()
endif()
if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)   # before the language, which has a default of its own
  set(CMAKE_CUDA_ARCHITECTURES 90)
endif()
enable_language(CUDA)

set(device_flags --expt-relaxed-constexpr -fmad=false -Werror=cross-execution-space-call
                 -Xcompiler=-ffp-contract=off -diag-suppress=177)
if(MPM_WERROR)
  list(APPEND device_flags -Werror=all-warnings)
endif()
function(mpm_device_objects name)
  add_library(${name} OBJECT ${ARGN})
  target_include_directories(${name} PRIVATE cpp)
  target_compile_options(${name} PRIVATE ${device_flags})
  set_target_properties(${name} PROPERTIES CUDA_STANDARD 20 CUDA_VISIBILITY_PRESET hidden
                                           POSITION_INDEPENDENT_CODE ON UNITY_BUILD OFF)
  target_sources(mpm_device PRIVATE $<TARGET_OBJECTS:${name}>)
endfunction()

add_library(mpm_device SHARED)
set_target_properties(mpm_device PROPERTIES CUDA_RUNTIME_LIBRARY Static LINKER_LANGUAGE CUDA)
target_link_options(mpm_device PRIVATE LINKER:--exclude-libs,ALL LINKER:-Bsymbolic)
set(device cpp/mpm/device/cuda)
mpm_device_objects(mpm_device_run ${device}/run.cu ${device}/make_step.cu ${device}/lists.cu ${device}/interface.cu)
# A strength model each: its place in StrengthModels, but for the last, which does not deform.
foreach(strength RANGE 10)
  mpm_device_objects(mpm_device_strength_${strength} ${device}/stress.cu)
  target_compile_definitions(mpm_device_strength_${strength} PRIVATE MPM_STRENGTH=${strength})
  if(strength EQUAL 4)   # Johnson and Cook's law is faster with more registers, as it spills less
    target_compile_definitions(mpm_device_strength_${strength} PRIVATE MPM_STRESS_BLOCKS=3)
  endif()
endforeach()
install(TARGETS mpm_device LIBRARY DESTINATION mpm3dpp)
if(NOT SKBUILD)
  set_target_properties(mpm_device PROPERTIES LIBRARY_OUTPUT_DIRECTORY
                                              "${CMAKE_BINARY_DIR}/python/mpm3dpp")
  # Compares and times without Python.
  add_executable(mpm_device_check tests/device/check.cpp)
  target_link_libraries(mpm_device_check PRIVATE mpm_core_${tested_level})
  set_target_properties(mpm_device_check PROPERTIES RUNTIME_OUTPUT_DIRECTORY
                                                    "${CMAKE_BINARY_DIR}/python/mpm3dpp")
endif()
