// What goes into a simulation and what it tells, but for materials: settings and records.
#include <nanobind/stl/array.h>

#include "mpm/run/simulation.hpp"
#include "translate.hpp"

namespace mpm::bindings {

void add_records(nb::module_& m) {
  nb::enum_<Scheme>(m, "Scheme")
      .value("usf", Scheme::usf)
      .value("usl", Scheme::usl)
      .value("musl", Scheme::musl);
  nb::enum_<BasisId> basis_ids(m, "Basis");
  nb::dict bases;  // name -> what is to be known of it
  Bases::for_each([&]<BasisModel B>(BasisId id, const B&) {
    const nb::str name(B::name.data(), B::name.size());
    basis_ids.value(name.c_str(), id);
    nb::dict known;
    known["doc"] = nb::str(B::doc.data(), B::doc.size());
    known["source"] = nb::str(B::source.data(), B::source.size());
    known["nodes"] = B::nodes;
    known["before"] = B::before;
    known["own_node"] = B::own_node;
    bases[name] = known;
  });
  m.attr("bases") = bases;
  m.def(
      "stages",
      [](Scheme scheme, bool fused) {
        const auto names = [](std::uint32_t data) {
          nb::list said;
          for (std::size_t k = 0; k < data_names.size(); ++k)
            if (data >> k & 1u) said.append(nb::str(data_names[k].data(), data_names[k].size()));
          return said;
        };
        nb::list rows;
        for (const Stage<3>& stage : stages_of<3>(scheme, fused))
          rows.append(nb::make_tuple(nb::str(stage.name.data(), stage.name.size()),
                                     names(stage.reads), names(stage.writes), stage.all_particles));
        return rows;
      },
      nb::arg("scheme"), nb::arg("fused"),
      "Of each stage: its name, what it reads and writes, and whether it goes through all "
      "particles");
  nb::enum_<Wall>(m, "Wall")
      .value("free", Wall::free)
      .value("slip", Wall::slip)
      .value("fixed", Wall::fixed)
      .value("absorbing", Wall::absorbing);
  nb::enum_<Detection>(m, "Detection")
      .value("gap", Detection::gap)
      .value("velocity", Detection::velocity);
  nb::enum_<NormalRule>(m, "NormalRule")
      .value("plane", NormalRule::plane)
      .value("pair", NormalRule::pair)
      .value("first", NormalRule::first)
      .value("second", NormalRule::second)
      .value("stiffer", NormalRule::stiffer);

  nb::class_<TimeFunction>(m, "TimeFunction")
      .def(nb::init_implicit<double>())
      .def(
          "__init__",
          [](TimeFunction* self, double constant, double amplitude, double frequency, double phase,
             const std::vector<double>& times, const std::vector<double>& values) {
            new (self) TimeFunction(constant);
            self->amplitude = amplitude;
            self->frequency = frequency;
            self->phase = phase;
            self->times = times;
            self->values = values;
          },
          nb::arg("constant"), nb::arg("amplitude"), nb::arg("frequency"), nb::arg("phase"),
          nb::arg("times"), nb::arg("values"))
      .def("at", &TimeFunction::at, nb::arg("time"))
      .def("mean", &TimeFunction::mean, nb::arg("start"), nb::arg("end"));

  nb::class_<Settings>(m, "Settings")
      .def(nb::init<>())
      .def_rw("dimension", &Settings::dimension)
      .def_rw("cell_size", &Settings::cell_size)
      .def_rw("origin", &Settings::origin)
      .def_rw("box_cells", &Settings::box_cells)
      .def_rw("doubling_tiles", &Settings::doubling_tiles)
      .def_rw("doubling_bytes", &Settings::doubling_bytes)
      .def_rw("doubling_times", &Settings::doubling_times)
      .def_rw("keep", &Settings::keep)
      .def_rw("keep_lower", &Settings::keep_lower)
      .def_rw("keep_upper", &Settings::keep_upper)
      .def_rw("walls", &Settings::walls)
      .def_rw("basis", &Settings::basis)
      .def_rw("scheme", &Settings::scheme)
      .def_rw("time_step_factor", &Settings::time_step_factor)
      .def_rw("gravity", &Settings::gravity)
      .def_rw("contact", &Settings::contact)
      .def_rw("bonded", &Settings::bonded)
      .def_rw("pic_damping", &Settings::pic_damping)
      .def_rw("fused", &Settings::fused)
      .def_rw("disorder", &Settings::disorder)
      .def_rw("detection", &Settings::detection)
      .def_rw("normal_rule", &Settings::normal_rule)
      .def_rw("gap_distance", &Settings::gap_distance)
      .def_rw("normal_travel", &Settings::normal_travel)
      .def_rw("friction", &Settings::friction)
      .def_rw("threads", &Settings::threads)
      .def_rw("energy_growth_limit", &Settings::energy_growth_limit)
      .def_rw("outside_limit", &Settings::outside_limit)
      .def_rw("volume_limit", &Settings::volume_limit);

  nb::class_<LoadRecord>(m, "Load")
      .def_ro("name", &LoadRecord::name)
      .def_ro("force", &LoadRecord::force)
      .def_ro("impulse", &LoadRecord::impulse)
      .def_ro("area", &LoadRecord::area);
  nb::class_<Failure>(m, "Failure")
      .def_ro("kind", &Failure::kind)
      .def_ro("body", &Failure::body)
      .def_ro("particle", &Failure::particle)
      .def_ro("step", &Failure::step)
      .def_ro("time", &Failure::time)
      .def_ro("position", &Failure::position)
      .def_ro("message", &Failure::message);
  nb::class_<Warning>(m, "Warning")
      .def_ro("kind", &Warning::kind)
      .def_ro("body", &Warning::body)
      .def_ro("particle", &Warning::particle)
      .def_ro("step", &Warning::step)
      .def_ro("time", &Warning::time)
      .def_ro("position", &Warning::position)
      .def_ro("share", &Warning::share)
      .def_ro("count", &Warning::count)
      .def_ro("is_error", &Warning::is_error)
      .def_ro("message", &Warning::message);
  nb::class_<Limiter>(m, "Limiter")
      .def_ro("body", &Limiter::body)
      .def_ro("particle", &Limiter::particle)
      .def_ro("sound_speed", &Limiter::sound_speed)
      .def_ro("speed", &Limiter::speed);
  nb::class_<ColumnInfo>(m, "Column")
      .def_ro("name", &ColumnInfo::name)
      .def_ro("components", &ColumnInfo::components)
      .def_ro("unit", &ColumnInfo::unit);
  nb::class_<PairRecord>(m, "ContactPair")
      .def_prop_ro("bodies", [](const PairRecord& p) { return std::pair(p.a, p.b); })
      .def_ro("first_time", &PairRecord::first_time)
      .def_ro("first_gap", &PairRecord::first_gap)
      .def_prop_ro("first_normal",
                   [](const PairRecord& p) { return std::to_array(p.first_normal); })
      .def_prop_ro("first_node", [](const PairRecord& p) { return std::to_array(p.first_node); })
      .def_ro("first_step", &PairRecord::first_step)
      .def_prop_ro("force", [](const PairRecord& p) { return std::to_array(p.force); })
      .def_prop_ro("impulse", [](const PairRecord& p) { return std::to_array(p.impulse); })
      .def_ro("friction_work", &PairRecord::friction_work)
      .def_ro("pairs", &PairRecord::pairs);
}

}  // namespace mpm::bindings
