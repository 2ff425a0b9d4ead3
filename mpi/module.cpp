// The Python module mpm3dpp._comm_mpi: ranks by MPI for the core, which does not know of it.
#include <cstdint>
#include <string>

#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include "mpi_comm.hpp"

namespace nb = nanobind;

namespace {

std::string library_version() {
  std::string text(MPI_MAX_LIBRARY_VERSION_STRING, '\0');
  int length = 0;
  MPI_Get_library_version(text.data(), &length);
  text.resize(static_cast<std::size_t>(length));
  return text;
}

}  // namespace

NB_MODULE(_comm_mpi, m) {
  m.doc() = "Ranks that are processes, by the MPI that this module was built with.";
  m.def("library_version", &library_version,
        "What the MPI library that this process has says of itself.");
#ifdef OPEN_MPI
  m.attr("built_with") = "Open MPI";
#else
  m.attr("built_with") = "MPICH";
#endif
  m.def(
      "comm",
      [](std::uintptr_t users, std::size_t piece) {
        // NOLINTNEXTLINE(performance-no-int-to-ptr): mpi4py tells it as an integer.
        mpm::Comm* comm = new mpm::MpiComm(*reinterpret_cast<const MPI_Comm*>(users), piece);
        return nb::capsule(comm, "mpm::Comm",
                           [](void* p) noexcept { delete static_cast<mpm::Comm*>(p); });
      },
      nb::arg("users"), nb::arg("piece"),
      "A communicator for the core, by all ranks of a user's, of which `users` is the address; "
      "letters of any length go in pieces of so many bytes.");
}
