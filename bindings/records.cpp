// What a simulation tells: records of loads, failures, warnings and contacts.
#include "mpm/run/records.hpp"

#include <nanobind/stl/array.h>

#include "mpm/contact/pair_records.hpp"
#include "mpm/fields/columns.hpp"
#include "translate.hpp"

namespace mpm::bindings {

void add_records(nb::module_& m) {
  nb::class_<FaceRecord>(m, "Face")
      .def_ro("name", &FaceRecord::name)
      .def_ro("force", &FaceRecord::force)
      .def_ro("impulse", &FaceRecord::impulse)
      .def_ro("area", &FaceRecord::area);
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
