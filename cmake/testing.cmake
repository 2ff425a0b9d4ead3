# The C++ unit tests: compiled once, run from pytest (module _testing) or without Python (unit_tests).
file(GLOB_RECURSE unit_sources CONFIGURE_DEPENDS tests/unit/*.cpp)
list(REMOVE_ITEM unit_sources "${CMAKE_CURRENT_SOURCE_DIR}/tests/unit/module.cpp"
     "${CMAKE_CURRENT_SOURCE_DIR}/tests/unit/main.cpp")
add_library(mpm_unit OBJECT ${unit_sources})
target_include_directories(mpm_unit PUBLIC tests/unit)
set_target_properties(mpm_unit PROPERTIES UNITY_BUILD_BATCH_SIZE 40)
target_link_libraries(mpm_unit PUBLIC mpm_core_${tested_level})
target_compile_options(mpm_unit PRIVATE $<$<CONFIG:Release>:-O1>)
# (half the time; what is not inlined of the headers may then be their copy, in the tests' binaries)

# Allocations are counted (tests/unit/run/count_allocations.cpp): our calls of an allocating function
# go through a wrapper.
foreach(name IN ITEMS malloc calloc realloc aligned_alloc posix_memalign _Znwm _ZnwmSt11align_val_t)
  target_link_options(mpm_unit INTERFACE LINKER:--wrap=${name})
endforeach()

mpm_add_module(_testing ${tested_level} tests/unit/module.cpp)
target_link_libraries(_testing PRIVATE mpm_unit)

if(NOT SKBUILD)
  enable_testing()
  add_executable(unit_tests tests/unit/main.cpp)
  target_link_libraries(unit_tests PRIVATE mpm_unit)
  if(NOT MPM_SANITIZE)   # then allocations from inside the C++ library are counted too
    target_link_options(unit_tests PRIVATE -static-libstdc++)
  endif()
  add_test(NAME unit COMMAND unit_tests)
  if(NOT MPM_SANITIZE)   # Python itself is not built with a sanitizer
    add_test(NAME pytest COMMAND "${Python_EXECUTABLE}" -m pytest
             WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
    set_tests_properties(pytest PROPERTIES ENVIRONMENT "PYTHONPATH=${CMAKE_BINARY_DIR}/python")
  endif()
endif()

# The code for a device, compiled for the processor, so that tests of it need no card
# (tests/device/emulated). The core loads it where MPM3DPP_DEVICE_LIBRARY names it.
if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")   # its fibers are switched by hand
  return()
endif()
set(MPM_EMULATED "0;4" CACHE STRING "Strength models that the emulated device knows, by their places in StrengthModels, or ALL")
set(strengths ${MPM_EMULATED})
if(strengths STREQUAL "ALL")
  set(strengths 0 1 2 3 4 5 6 7 8 9 10)
endif()
set(emulated tests/device/emulated)
add_library(mpm_emulated_flags INTERFACE)
target_compile_definitions(mpm_emulated_flags INTERFACE __CUDACC__ __CUDA_ARCH__=900 MPM_EMULATED)
target_compile_options(mpm_emulated_flags INTERFACE -O1 -w)
target_compile_options(mpm_emulated_flags INTERFACE "SHELL:-include cuda_runtime.h")
target_include_directories(mpm_emulated_flags INTERFACE ${emulated} cpp)
target_link_libraries(mpm_emulated_flags INTERFACE mpm_flags_${tested_level})
add_library(mpm_device_emulated SHARED ${emulated}/emulated.cpp ${emulated}/book.cpp
                                       ${emulated}/steps.cpp)
target_link_options(mpm_device_emulated PRIVATE LINKER:--exclude-libs,ALL LINKER:-Bsymbolic)
set_target_properties(mpm_device_emulated PROPERTIES UNITY_BUILD OFF)
target_link_libraries(mpm_device_emulated PRIVATE mpm_emulated_flags)
set(left_out "")
foreach(k RANGE 10)
  if(k IN_LIST strengths)
    add_library(mpm_emulated_${k} OBJECT ${emulated}/stress.cpp)
    target_compile_definitions(mpm_emulated_${k} PRIVATE MPM_STRENGTH=${k})
    target_link_libraries(mpm_emulated_${k} PRIVATE mpm_emulated_flags)
    target_sources(mpm_device_emulated PRIVATE $<TARGET_OBJECTS:mpm_emulated_${k}>)
  else()
    string(APPEND left_out "MPM_LEAVE_OUT(${k}) ")
  endif()
endforeach()
if(left_out)
  add_library(mpm_emulated_others OBJECT ${emulated}/others.cpp)
  target_compile_definitions(mpm_emulated_others PRIVATE "MPM_OTHERS=${left_out}")
  target_link_libraries(mpm_emulated_others PRIVATE mpm_emulated_flags)
  target_sources(mpm_device_emulated PRIVATE $<TARGET_OBJECTS:mpm_emulated_others>)
endif()
install(TARGETS mpm_device_emulated LIBRARY DESTINATION mpm3dpp)
if(NOT SKBUILD)
  set_target_properties(mpm_device_emulated PROPERTIES LIBRARY_OUTPUT_DIRECTORY
                                                       "${CMAKE_BINARY_DIR}/python/mpm3dpp")
endif()
