// The class of simulations: what it takes in, its steps, and what it tells.

#include "any.hpp"
#include "callback_comm.hpp"
#include "interrupt.hpp"
#include "mpm/run/advance.hpp"
#include "mpm/run/bodies.hpp"
#include "mpm/run/loads.hpp"
#include "mpm/run/measures.hpp"
#include "mpm/run/pair_groups.hpp"
#include "mpm/run/prepare.hpp"
#include "mpm/run/save.hpp"
#include "mpm/run/surfaces.hpp"
#include "mpm/run/time_step.hpp"
#include "mpm/run/warnings.hpp"
#include "translate.hpp"

namespace mpm::bindings {
namespace {

nb::dict dict_of(const RemovedSum& removed) {
  nb::dict d;
  d["mass"] = removed.mass;
  d["count"] = removed.count;
  return d;
}

using Functions3 = std::array<TimeFunction, 3>;

/// What makes a simulation ready to step.
void def_building(SimulationClass& simulation) {
  simulation
      .def("add_material",
           of_any([](auto& s, double density, const std::string& strength,
                     const Parameters& parameters, const std::optional<Named>& eos,
                     const std::vector<NamedFailure>& failures, Viscosity viscosity, double damping,
                     std::optional<bool> volume_averaging, bool in_body) {
             return add_material(s, choice_of(density, strength, parameters, eos, failures,
                                              viscosity, damping, volume_averaging, in_body));
           }),
           nb::arg("density"), nb::arg("strength"), nb::arg("parameters"), nb::arg("eos").none(),
           nb::arg("failures"), nb::arg("viscosity"), nb::arg("damping"),
           nb::arg("volume_averaging").none(), nb::arg("in_body") = false)
      .def("add_body",
           of_any([](auto& s, const std::string& name, int material, const Input& positions,
                     const Input& velocities, const Input& volumes) {
             return add_body(s, name, material, span_of(positions), span_of(velocities),
                             span_of(volumes));
           }),
           nb::arg("name"), nb::arg("material"), nb::arg("positions"), nb::arg("velocities"),
           nb::arg("volumes"))
      .def("add_bodies",
           of_any([](auto& s, const std::vector<std::string>& names, int material,
                     const Counts& counts, const Input& volumes, std::size_t first,
                     const Input& positions, const Input& velocities) {
             return add_bodies(s, names, material, span_of(counts), span_of(volumes), first,
                               span_of(positions), span_of(velocities));
           }),
           nb::arg("names"), nb::arg("material"), nb::arg("counts"), nb::arg("volumes"),
           nb::arg("first"), nb::arg("positions"), nb::arg("velocities"))
      .def("add_slice",
           of_any([](auto& s, const std::string& name, int material, std::size_t count,
                     std::size_t first, const Input& positions, const Input& velocities,
                     double volume) {
             return add_slice(s, name, material, count, first, span_of(positions),
                              span_of(velocities), volume);
           }),
           nb::arg("name"), nb::arg("material"), nb::arg("count"), nb::arg("first"),
           nb::arg("positions"), nb::arg("velocities"), nb::arg("volume"))
      .def("set_state",
           of_any([](auto& s, int body, const std::string& column, const Input& values) {
             set_state(s, body, column, span_of(values));
           }),
           nb::arg("body"), nb::arg("column"), nb::arg("values"))
      .def("set_group", of_any([](auto& s, int body, int first) { set_group(s, body, first); }),
           nb::arg("body"), nb::arg("first"));
}

/// What acts on the bodies.
void def_acting(SimulationClass& simulation) {
  simulation.def("keep_start_positions", of_any([](auto& s) { keep_start_positions(s); }))
      .def("set_motion",
           of_any([](auto& s, int body, const Functions3& velocity, const Functions3& spin,
                     const std::array<double, 3>& centre) {
             set_motion(s, body, velocity, spin, centre);
           }),
           nb::arg("body"), nb::arg("velocity"), nb::arg("spin"), nb::arg("centre"))
      .def("add_load",
           of_any([](auto& s, const std::string& name, int body, const std::string& kind,
                     const Functions3& value, const std::vector<std::uint32_t>& particles,
                     const Input& areas, const Input& sizes, const Input& arms) {
             add_load(s, name, body, kind, value,
                      {particles, span_of(areas), span_of(sizes), span_of(arms)});
           }),
           nb::arg("name"), nb::arg("body"), nb::arg("kind"), nb::arg("value"),
           nb::arg("particles"), nb::arg("areas"), nb::arg("sizes"), nb::arg("arms"))
      .def("add_surface",
           of_any([](auto& s, int body, const std::vector<std::uint32_t>& particles,
                     const Input& away, const Input& normals, const Input& areas, const Input& felt,
                     const std::vector<std::int32_t>& faces, double e, unsigned held_by) {
             const auto of = [](const Input& x) { return span_of(x); };
             add_surface(
                 s, body,
                 {particles, of(away), of(normals), of(areas), of(felt), faces, e, held_by});
           }),
           nb::arg("body"), nb::arg("particles"), nb::arg("offsets"), nb::arg("normals"),
           nb::arg("areas"), nb::arg("felt_areas"), nb::arg("faces"), nb::arg("spacing"),
           nb::arg("held_by"))
      .def("add_body_force",
           of_any([](auto& s, const std::vector<int>& bodies,
                     const std::vector<Expression::Program>& value) {
             add_body_force(s, bodies, value);
           }),
           nb::arg("bodies"), nb::arg("value"))
      .def("set_body_force", changing_any([](auto& s, int body, const Input& values) {
             set_body_force(s, body, span_of(values));
           }),
           nb::arg("body"), nb::arg("values"))
      .def("add_damping",
           of_any([](auto& s, const std::vector<int>& bodies, const TimeFunction& mass,
                     const TimeFunction& local) { add_damping(s, bodies, mass, local); }),
           nb::arg("bodies"), nb::arg("mass"), nb::arg("local"))
      .def("set_friction", of_any([](auto& s, int a, int b, double mu, double restitution) {
             set_pair_law(s.domain, a, b, {mu, false, 0.0, restitution});
           }),
           nb::arg("body_a"), nb::arg("body_b"), nb::arg("mu"), nb::arg("restitution") = 1.0)
      .def("bond", of_any([](auto& s, int a, int b) {
             set_pair_law(s.domain, a, b, {0.0, true, 0.0, 1.0});
           }),
           nb::arg("body_a"), nb::arg("body_b"))
      .def("press", of_any([](auto& s, int a, int b, double depth) { press(s, a, b, depth); }),
           nb::arg("body_a"), nb::arg("body_b"), nb::arg("depth"))
      .def("set_velocity", changing_any([](auto& s, int body, const Input& velocities) {
             set_velocity(s, body, span_of(velocities));
           }),
           nb::arg("body"), nb::arg("velocities"))
      .def("set_gravity",
           of_any([](auto& s, const Functions3& gravity) { set_gravity(s.domain, gravity); }),
           nb::arg("gravity"));
}

/// Steps, and the state between two of them.
void def_stepping(SimulationClass& simulation) {
  simulation
      .def("prepare",
           [](AnySimulation& either) {
             const AtWork here(either);
             const nb::gil_scoped_release without_lock;
             either.visit([](auto& s) { prepare(s); });
           })
      .def(
          "advance",
          [](AnySimulation& either, std::int64_t max_steps, double end_time) {
            std::int64_t made = 0;
            {
              const AtWork here(either);
              const InterruptFlag interrupt;
              if (PyErr_CheckSignals() != 0) throw nb::python_error();
              const nb::gil_scoped_release without_lock;
              made = either.visit_as_is(
                  [&](auto& s) { return advance(s, max_steps, end_time, interrupt.get()); });
            }
            if (PyErr_CheckSignals() != 0) throw nb::python_error();
            return made;
          },
          nb::arg("max_steps"), nb::arg("end_time"))
      .def(
          "save",
          [](AnySimulation& either, const nb::callable& write) {
            const AtWork here(either);
            const auto transfer = transfer_by(write);
            either.visit([&](auto& s) { save(s, transfer); });
          },
          nb::arg("write"))
      .def(
          "restore",
          [](AnySimulation& either, const nb::callable& readinto, std::size_t size) {
            const AtWork here(either);
            const auto transfer = transfer_by(readinto);
            either.visit([&](auto& s) {
              s.device.reset();
              restore(s, transfer, size);
            });
          },
          nb::arg("readinto"), nb::arg("size"))
      .def("set_threads", of_any_as_is([](auto& s, int count) { s.domain.threads.resize(count); }),
           nb::arg("count"));
}

/// What it tells of itself.
void def_telling(SimulationClass& simulation) {
  simulation.def_prop_ro("time", of_any_as_is([](auto& s) { return s.domain.time; }))
      .def_prop_ro("dt", of_any_as_is([](auto& s) { return s.next_time_step; }))
      .def_prop_ro("step", of_any_as_is([](auto& s) { return s.domain.step; }))
      .def_prop_ro("body_count", of_any_as_is([](auto& s) { return s.domain.bodies.size(); }))
      .def("body_particle_count",
           of_any([](auto& s, int body) { return s.domain.body_at(body).count; }), nb::arg("body"))
      .def_prop_ro("particle_count", of_any_as_is([](auto& s) { return particle_count(s.domain); }))
      .def_prop_ro("total_mass", of_any_as_is([](auto& s) { return total_mass(s.domain); }))
      .def("eroded",
           of_any_to([](auto& s) { return sum_of(s.domain.eroded, comm_of(s)); }, dict_of))
      .def("left", of_any_to([](auto& s) { return sum_of(s.domain.outflow, comm_of(s)); }, dict_of))
      .def("loads", of_any([](auto& s) { return load_records(s.domain); }))
      .def_prop_ro("failure", of_any_as_is([](auto& s) { return s.failure; }))
      .def("limiter", of_any([](auto& s) { return find_limiter(s.domain); }))
      .def("warnings", of_any_as_is([](auto& s) { return warnings(s); }));
}

/// What it takes: times, what passes between ranks, memory.
void def_costs(SimulationClass& simulation) {
  simulation
      .def("timers", as_is_to([](auto& s) { return s.timers.seconds(); },
                              [](const auto& times) {
                                nb::dict d;
                                for (const auto& [name, seconds] : times)
                                  d[nb::str(name.data(), name.size())] = seconds;
                                return d;
                              }))
      .def("reset_timers", of_any_as_is([](auto& s) {
             s.timers.reset();
             s.passed = {};
           }))
      .def("ranks", as_is_to([](auto& s) { return ranks_summary(s); },
                             [](const RanksSummary& told) {
                               nb::dict d;
                               d["ranks"] = told.ranks;
                               d["letters"] = told.letters;
                               d["bytes"] = told.bytes;
                               d["exchanges"] = told.exchanges;
                               d["reductions"] = told.reductions;
                               d["share"] = told.share;
                               d["imbalance"] = told.imbalance;
                               return d;
                             }))
      .def("bytes", as_is_to([](auto& s) { return bytes_of(s); },
                             [](const Bytes& b) {
                               nb::dict d;
                               d["particles"] = b.particles;
                               d["grid"] = b.grid;
                               d["contact"] = b.contact;
                               d["other"] = b.other;
                               return d;
                             }));
}

/// What has happened: history, contacts.
void def_records(SimulationClass& simulation) {
  simulation
      .def("history", as_is_to([](auto& s) { return s.history.take(); },
                               [](std::vector<double> rows) {
                                 return to_numpy(std::move(rows), history_terms.size());
                               }))
      .def("contact_pairs",
           of_any([](auto& s) { return s.domain.contact.records.of_all_ranks(comm_of(s)); }))
      .def("contact_groups", of_any([](auto& s) { return group_pairs(s.domain); }))
      .def("contact_summary", as_is_to([](auto& s) { return contact_summary(s); },
                                       [](const ContactSummary& told) {
                                         nb::dict d;
                                         d["overlapped_nodes"] = told.overlapped;
                                         d["touching_points"] = told.touching;
                                         d["touching_points_max"] = told.touching_max;
                                         d["levelled_points"] = told.levelled;
                                         d["overlapped_nodes_max"] = told.overlapped_max;
                                         d["bodies_per_node_max"] = told.bodies_max;
                                         d["unconverged_nodes"] = told.unconverged;
                                         d["set_back_particles"] = told.set_back_particles;
                                         d["set_back_most"] = told.set_back_most;
                                         d["bytes"] = told.bytes;
                                         return d;
                                       }));
  simulation
      .def_prop_ro_static("history_columns",
                          [](nb::handle) {
                            std::vector<std::string> names;
                            names.reserve(history_terms.size());
                            for (const HistoryTerm& t : history_terms) names.emplace_back(t.name);
                            return names;
                          })
      .def_ro_static("history_capacity", &HistoryRows::capacity);
}

}  // namespace

void add_simulation(nb::module_& m) {
  SimulationClass simulation(m, "Simulation");
  simulation.nb::class_<AnySimulation>::def(
      "__init__",
      [](AnySimulation* made, const Settings& settings, const nb::object& comm) {
        new (made) AnySimulation(settings, comm_from(comm));
      },
      nb::arg("settings"), nb::arg("comm") = nb::none());
  def_building(simulation);
  def_acting(simulation);
  def_stepping(simulation);
  def_telling(simulation);
  def_columns(simulation);
  def_records(simulation);
  def_tables(simulation);
  def_probes(simulation);
  def_device(simulation);
  def_costs(simulation);
}

}  // namespace mpm::bindings
