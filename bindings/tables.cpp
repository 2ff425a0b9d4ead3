// Tables of bodies, grains, contacts and walls.
#include "any.hpp"
#include "mpm/run/contact_rows.hpp"
#include "mpm/run/grain_rows.hpp"
#include "mpm/run/measures.hpp"
#include "mpm/run/part_rows.hpp"
#include "mpm/surfaces/bonds.hpp"

namespace mpm::bindings {

void def_tables(SimulationClass& simulation) {
  simulation
      .def("part_sums",
           of_any_to(
               [](auto& s) {
                 require(s, Phase::ready, "call prepare() before part_sums()");
                 const auto parts = part_sums(s.domain);
                 return std::pair(balance_row(s.domain.ledger.angular, angular_totals(parts)),
                                  part_rows(s.domain, parts));
               },
               [](auto sums) {
                 return nb::make_tuple(sums.first,
                                       to_numpy(std::move(sums.second), part_columns.size()));
               }))
      .def("grains_and_contacts",
           of_any_to(
               [](auto& s) {
                 require(s, Phase::ready, "call prepare() before grains_and_contacts()");
                 std::vector<double> contacts = contact_rows(s.domain);
                 std::vector<double> grains = grain_rows(s.domain, contacts);
                 return std::pair(std::move(grains), std::move(contacts));
               },
               [](auto rows) {
                 return nb::make_tuple(to_numpy(std::move(rows.first), grain_columns.size()),
                                       to_numpy(std::move(rows.second), contact_columns.size()));
               }))
      .def("bonded_groups", of_any([](auto& s) { return bonded_groups(s.domain); }))
      .def("walls", of_any([](auto& s) {
             require(s, Phase::ready, "call prepare() before walls()");
             return face_records(s.domain);
           }));
}

}  // namespace mpm::bindings
