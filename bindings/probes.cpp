// What probes see.
#include "mpm/run/probes.hpp"

#include "any.hpp"
#include "translate.hpp"

namespace mpm::bindings {
namespace {

/// A place or corner, with zeros behind the dimension.
std::array<double, 3> place_of(const std::vector<double>& given) {
  std::array<double, 3> place{};
  std::copy_n(given.begin(), std::min(given.size(), place.size()), place.begin());
  return place;
}

}  // namespace

void def_probes(SimulationClass& simulation) {
  simulation
      .def("probe",
           of_any([](auto& s, const std::string& kind, const std::vector<int>& bodies,
                     const std::vector<double>& lower, const std::vector<double>& upper,
                     std::int64_t particle, const std::vector<std::string>& fields) {
             require(s, Phase::ready, "call prepare() before probe()");
             const Probe probe{choice_named<ProbeKind>("kind", kind),
                               bodies,
                               place_of(lower),
                               place_of(upper),
                               particle,
                               fields};
             return look(s.domain, probe);
           }),
           nb::arg("kind"), nb::arg("bodies"), nb::arg("lower"), nb::arg("upper"),
           nb::arg("particle"), nb::arg("fields"))
      .def("nearest_particle",
           of_any([](auto& s, const std::vector<int>& bodies, const std::vector<double>& place) {
             require(s, Phase::ready, "call prepare() before nearest_particle()");
             return nearest_particle(s.domain, bodies, place_of(place));
           }),
           nb::arg("bodies"), nb::arg("place"));
}

}  // namespace mpm::bindings
