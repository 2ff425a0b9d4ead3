# The Python module _core, or one for each level, _core_LEVEL, and where they go.
find_package(Python 3.10 REQUIRED COMPONENTS Interpreter Development.Module)
if(NOT SKBUILD)   # a build by preset: nanobind is asked for its folder
  execute_process(COMMAND "${Python_EXECUTABLE}" -m nanobind --cmake_dir
                  OUTPUT_STRIP_TRAILING_WHITESPACE OUTPUT_VARIABLE nanobind_ROOT)
endif()
find_package(nanobind CONFIG REQUIRED)

# Add the module `name` of the package, with the core of a level; `ARGN` are its sources.
function(mpm_add_module name level)
  nanobind_add_module(${name} NB_STATIC NOMINSIZE ${ARGN})
  target_link_libraries(${name} PRIVATE mpm_core_${level})
  install(TARGETS ${name} LIBRARY DESTINATION mpm3dpp)
  if(NOT SKBUILD)
    set_target_properties(${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY
                                             "${CMAKE_BINARY_DIR}/python/mpm3dpp")
  endif()
endfunction()

file(GLOB_RECURSE binding_sources CONFIGURE_DEPENDS bindings/*.cpp)
list(LENGTH MPM_LEVELS level_count)
foreach(level IN LISTS MPM_LEVELS)
  if(level_count EQUAL 1)
    mpm_add_module(_core ${level} ${binding_sources})
  else()
    # Python would take one of before first, in a folder that was built for one level.
    file(GLOB one_core "${CMAKE_BINARY_DIR}/python/mpm3dpp/_core.*")
    if(one_core)
      file(REMOVE ${one_core})
    endif()
    string(MAKE_C_IDENTIFIER "${level}" level_name)
    mpm_add_module(_core_${level_name} ${level} ${binding_sources})
  endif()
endforeach()

# A build by preset makes an importable package: links to the Python files, modules beside them.
if(NOT SKBUILD)
  file(MAKE_DIRECTORY "${CMAKE_BINARY_DIR}/python/mpm3dpp")
  file(GLOB package_entries CONFIGURE_DEPENDS python/mpm3dpp/*)
  foreach(entry IN LISTS package_entries)
    cmake_path(GET entry FILENAME entry_name)
    file(CREATE_LINK "${entry}" "${CMAKE_BINARY_DIR}/python/mpm3dpp/${entry_name}" SYMBOLIC)
  endforeach()
endif()

# The cases of the examples and the pages go with an installed package, for `mpm3dpp examples | docs`.
install(DIRECTORY examples/ DESTINATION mpm3dpp/examples FILES_MATCHING PATTERN "*.toml" PATTERN "*.csv")
install(DIRECTORY docs/ DESTINATION mpm3dpp/docs FILES_MATCHING PATTERN "*.md"
        PATTERN "_*" EXCLUDE PATTERN "images" EXCLUDE)

# Ranks by MPI, in a module of their own: the core does not know of it.
if(NOT MPM_MPI STREQUAL "OFF")
  set(MPI_CXX_SKIP_MPICXX ON)   # the C interface is enough
  if(MPM_MPI STREQUAL "ON")
    find_package(MPI REQUIRED COMPONENTS CXX)
  else()
    find_package(MPI QUIET COMPONENTS CXX)
  endif()
  if(MPI_CXX_FOUND)
    mpm_add_module(_comm_mpi ${tested_level} mpi/mpi_comm.cpp mpi/module.cpp)
    target_link_libraries(_comm_mpi PRIVATE MPI::MPI_CXX)
  endif()
  message(STATUS "MPM3Dpp: ranks by MPI: ${MPI_CXX_FOUND} ${MPI_CXX_LIBRARIES}")
endif()
