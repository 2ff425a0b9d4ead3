// The Python module mpm3dpp._core: translates between Python and the core, and nothing else.
#include <nanobind/stl/array.h>
#include <nanobind/stl/unique_ptr.h>

#include "interrupt.hpp"
#include "mpm/ledger/history.hpp"
#include "mpm/run/allocator.hpp"
#include "mpm/run/machine_limits.hpp"
#include "mpm/run/simulation.hpp"
#include "one_thread.hpp"
#include "translate.hpp"

#if defined(__clang__)
#define MPM_COMPILER "clang++ " __clang_version__
#else
#define MPM_COMPILER "g++ " __VERSION__
#endif

using namespace mpm;
using namespace mpm::bindings;

namespace {

nb::dict dict_of(const GoneSum& gone) {
  nb::dict d;
  d["mass"] = gone.mass;
  d["count"] = gone.count;
  return d;
}

std::size_t particle_count(const Simulation& s) {
  std::size_t n = 0;
  for (int b = 0; b < s.body_count(); ++b) n += s.particle_count(b);
  return n;
}

/// What makes a simulation ready to step.
void def_building(SimulationClass& simulation) {
  simulation
      .def(
          "add_material",
          [](Simulation& s, double density, const std::string& strength,
             const Parameters& parameters, const std::optional<Named>& eos,
             const std::vector<NamedFailure>& failures, Viscosity viscosity) {
            return s.add_material(
                choice_of(density, strength, parameters, eos, failures, viscosity));
          },
          nb::arg("density"), nb::arg("strength"), nb::arg("parameters"), nb::arg("eos").none(),
          nb::arg("failures"), nb::arg("viscosity"))
      .def(
          "add_body",
          [](Simulation& s, const std::string& name, int material, const Input& positions,
             const Input& velocities, const Input& volumes) {
            return s.add_body(name, material, span_of(positions), span_of(velocities),
                              span_of(volumes));
          },
          nb::arg("name"), nb::arg("material"), nb::arg("positions"), nb::arg("velocities"),
          nb::arg("volumes"))
      .def(
          "set_state",
          [](Simulation& s, int body, const std::string& column, const Input& values) {
            s.set_state(body, column, span_of(values));
          },
          nb::arg("body"), nb::arg("column"), nb::arg("values"))
      .def("set_motion", &Simulation::set_motion, nb::arg("body"), nb::arg("velocity"),
           nb::arg("spin"), nb::arg("centre"))
      .def(
          "add_load",
          [](Simulation& s, const std::string& name, int body, const std::string& kind,
             const std::array<TimeFunction, 3>& value, const std::vector<std::uint32_t>& particles,
             const Input& areas, const Input& sizes, const Input& arms) {
            s.add_load(name, body, kind, value,
                       {particles, span_of(areas), span_of(sizes), span_of(arms)});
          },
          nb::arg("name"), nb::arg("body"), nb::arg("kind"), nb::arg("value"), nb::arg("particles"),
          nb::arg("areas"), nb::arg("sizes"), nb::arg("arms"))
      .def("set_group", &Simulation::set_group, nb::arg("body"), nb::arg("first"))
      .def("set_friction", &Simulation::set_pair_friction, nb::arg("body_a"), nb::arg("body_b"),
           nb::arg("mu"));
}

/// Steps, and the state between two of them.
void def_stepping(SimulationClass& simulation) {
  simulation
      .def("prepare",
           [](Simulation& s) {
             const AtWork here(s);
             const nb::gil_scoped_release without_lock;
             s.prepare();
           })
      .def(
          "advance",
          [](Simulation& s, std::int64_t max_steps, double end_time) {
            std::int64_t made = 0;
            {
              const AtWork here(s);
              const InterruptFlag interrupt;
              if (PyErr_CheckSignals() != 0) throw nb::python_error();
              const nb::gil_scoped_release without_lock;
              made = s.advance(max_steps, end_time, interrupt.get());
            }
            if (PyErr_CheckSignals() != 0) throw nb::python_error();
            return made;
          },
          nb::arg("max_steps"), nb::arg("end_time"))
      .def(
          "save",
          [](Simulation& s, const nb::callable& write) {
            const AtWork here(s);
            s.save(transfer_by(write));
          },
          nb::arg("write"))
      .def(
          "restore",
          [](Simulation& s, const nb::callable& readinto, std::size_t size) {
            const AtWork here(s);
            s.restore(transfer_by(readinto), size);
          },
          nb::arg("readinto"), nb::arg("size"));
}

/// What it tells of itself.
void def_telling(SimulationClass& simulation) {
  simulation.def_prop_ro("time", &Simulation::time)
      .def_prop_ro("dt", &Simulation::next_time_step)
      .def_prop_ro("step", &Simulation::step)
      .def_prop_ro("body_count", &Simulation::body_count)
      .def("body_particle_count", &Simulation::particle_count, nb::arg("body"))
      .def_prop_ro("particle_count", particle_count)
      .def_prop_ro("total_mass", &Simulation::total_mass)
      .def("eroded", [](const Simulation& s) { return dict_of(s.eroded()); })
      .def("left", [](const Simulation& s) { return dict_of(s.left()); })
      .def("loads", &Simulation::loads)
      .def_prop_ro("failure", &Simulation::failure)
      .def("limiter", &Simulation::limiter)
      .def("warnings", &Simulation::warnings)
      .def("set_threads", &Simulation::set_threads, nb::arg("count"));
}

/// The particles' numbers.
void def_columns(SimulationClass& simulation) {
  simulation.def("columns", &Simulation::columns, nb::arg("body"))
      .def(
          "column",
          [](const Simulation& s, int body, const std::string& name) {
            const auto width = static_cast<std::size_t>(s.column_components(body, name));
            std::vector<double> values(s.particle_count(body) * width);
            s.copy_column(body, name, values);
            return to_numpy(std::move(values), width);
          },
          nb::arg("body"), nb::arg("name"))
      .def(
          "rounded_column",
          [](const Simulation& s, const std::string& name, const std::vector<int>& places,
             std::size_t width, float elsewhere) {
            Floats values = floats(particle_count(s), width, elsewhere);
            s.round_column(name, places, width, {values.data(), values.size()});
            return values;
          },
          nb::arg("name"), nb::arg("places"), nb::arg("width"), nb::arg("elsewhere"))
      .def(
          "rounded_derived",
          [](const Simulation& s, const std::string& name) {
            Floats values = floats(particle_count(s), 1, 0.0F);
            s.round_derived(name, {values.data(), values.size()});
            return values;
          },
          nb::arg("name"))
      .def(
          "set_velocity",
          [](Simulation& s, int body, const Input& velocities) {
            s.set_velocity(body, span_of(velocities));
          },
          nb::arg("body"), nb::arg("velocities"))
      .def("set_gravity", &Simulation::set_gravity, nb::arg("gravity"));
}

/// What has happened: history, contacts, times, memory.
void def_records(SimulationClass& simulation) {
  simulation
      .def("history",
           [](Simulation& s) { return to_numpy(s.take_history(), history_terms.size()); })
      .def("contact_pairs", &Simulation::pairs)
      .def("contact_groups", &Simulation::group_pairs)
      .def("contact_summary",
           [](const Simulation& s) {
             nb::dict d;
             d["overlapped_nodes"] = s.overlapped_nodes();
             d["overlapped_nodes_max"] = s.overlapped_nodes_max();
             d["bodies_per_node_max"] = s.bodies_per_node_max();
             d["unconverged_nodes"] = s.unconverged_nodes();
             d["bytes"] = s.bytes().contact;
             return d;
           })
      .def("timers",
           [](const Simulation& s) {
             nb::dict d;
             for (const auto& [name, seconds] : s.stage_seconds())
               d[nb::str(name.data(), name.size())] = seconds;
             return d;
           })
      .def("reset_timers", &Simulation::reset_timers)
      .def("bytes", [](const Simulation& s) {
        const Bytes b = s.bytes();
        nb::dict d;
        d["particles"] = b.particles;
        d["grid"] = b.grid;
        d["contact"] = b.contact;
        d["other"] = b.other;
        return d;
      });
  simulation
      .def_prop_ro_static("history_columns",
                          [](nb::handle) {
                            std::vector<std::string> names;
                            names.reserve(history_terms.size());
                            for (const HistoryTerm& t : history_terms) names.emplace_back(t.name);
                            return names;
                          })
      .def_ro_static("history_capacity", &Simulation::history_capacity);
}

}  // namespace

NB_MODULE(_core, m) {
  m.doc() =
      "The compiled core of MPM3Dpp. SI units throughout; see mpm3dpp.Case for defaults and units.";

  add_settings(m);
  add_records(m);
  SimulationClass simulation(m, "Simulation");
  simulation.nb::class_<Simulation>::def(
      nb::new_([](const Settings& settings) { return make_simulation(settings); }),
      nb::arg("settings"));
  def_building(simulation);
  def_stepping(simulation);
  def_telling(simulation);
  def_columns(simulation);
  def_records(simulation);
  add_materials(m);
  m.def("measure_bandwidth", &measure_bandwidth, nb::arg("threads"),
        nb::call_guard<nb::gil_scoped_release>());
  m.def("measure_arithmetic", &measure_arithmetic, nb::arg("threads"),
        nb::call_guard<nb::gil_scoped_release>());
  m.def("return_freed_memory", &return_freed_memory);
  m.def("build_info", [] {
    nb::dict d;
    d["compiler"] = MPM_COMPILER;
    d["flags"] = MPM_BUILD_FLAGS;
    d["isa"] = native_lanes == 8 ? "AVX-512" : native_lanes == 4 ? "AVX" : "SSE2 or NEON";
    d["lanes"] = native_lanes;
    d["velocity_and_stress"] = std::is_same_v<Storage, float> ? "float32" : "float64";
    return d;
  });
}
