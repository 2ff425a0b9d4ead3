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
