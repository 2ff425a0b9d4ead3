#include "mpm/run/drive_material.hpp"

#include <cmath>
#include <stdexcept>

namespace mpm {
namespace {

/// A number that a driven point shows: a component of its columns, or a sum.
struct Shown {
  std::string name, unit;
  int component = -1;
  const double* sum = nullptr;
};

/// The point with all its columns, at rest. Its initial volume is 1 m^3.
struct Point {
  Material material;
  Columns columns;
  MaterialColumns at{};
  double dissipated = 0.0, work = 0.0, sound_speed = 0.0, viscous = 0.0;

  explicit Point(const MaterialChoice& choice) : material(make_material(choice)) {
    material.averages_volume = false;  // A point is its own mean.
    at.velocity = columns.add("velocity", "m/s", 3, Precision::rounded);
    at.mass = columns.add("mass", "kg", 1);
    at.volume = columns.add("volume", "m^3", 1);
    at.stress = columns.add("stress", "Pa", 6, Precision::rounded);
    add_material_columns<3>(material, columns, at);
    columns.allocate(1);
    for (int a = 0; a < 3; ++a) columns.rounded(at.velocity + a)[0] = 0.0;
    columns.component(at.mass)[0] = material.density;
    columns.component(at.volume)[0] = 1.0;
    start_material_columns<3>(material, columns, at);
  }

  /// What may be given at the start: stress, volume and the material's columns.
  std::vector<Shown> state() const {
    std::vector<Shown> found;
    for (const char* c : {"xx", "yy", "zz", "yz", "xz", "xy"})
      found.push_back(
          {std::string("stress_") + c, "Pa", at.stress + static_cast<int>(found.size())});
    found.push_back({"volume", "1", at.volume});
    for (const ColumnInfo& info : columns.infos())
      for (int c = 0; c < info.components && info.first > at.stress; ++c)
        found.push_back({info.components == 1 ? info.name : info.name + "_" + std::to_string(c),
                         info.unit, info.first + c});
    return found;
  }
  /// What is counted since the start, or follows from the state.
  std::vector<Shown> sums() const {
    std::vector<Shown> found{{"dissipated", "J/m^3", -1, &dissipated},
                             {"work", "J/m^3", -1, &work},
                             {"sound_speed", "m/s", -1, &sound_speed}};
    if (material.viscosity.active()) found.push_back({"viscous", "J/m^3", -1, &viscous});
    return found;
  }
  double value(const Shown& shown) const {
    return shown.sum ? *shown.sum : columns.value(shown.component, 0);
  }
};

void set_state(Point& point, const std::map<std::string, double>& given) {
  const std::vector<Shown> state = point.state();
  for (const auto& [name, value] : given) {
    if (!std::isfinite(value))
      throw std::invalid_argument("state." + name + " must be a finite number");
    if (name == "volume" && !(value > 0.0)) throw std::invalid_argument("state.volume must be > 0");
    bool known = false;
    std::string names;
    for (const Shown& column : state) {
      names += (names.empty() ? "" : ", ") + column.name;
      if (column.name != name) continue;
      point.columns.with_component(
          column.component, [&]<class Number>(Number* to) { to[0] = static_cast<Number>(value); });
      known = true;
    }
    if (!known)
      throw std::invalid_argument("state." + name + " is not a column here; there are " + names);
  }
}

void check(const char* name, double value, Rule rule) {
  if (!rule.allows(value))
    throw std::invalid_argument(std::string(name) + " = " + std::to_string(value) + ' ' +
                                rule.text());
}

}  // namespace

DrivenPoint drive_material(const MaterialChoice& choice, const Drive& drive) {
  if (drive.increments.size() % 9 != 0)
    throw std::invalid_argument("increments must have the shape (n, 3, 3)");
  check("time_step", drive.time_step, Rule::positive);
  check("cell_size", drive.cell_size, Rule::positive);

  Point point(choice);
  std::vector<Shown> shown = point.state();
  set_state(point, drive.state);
  for (const Shown& sum : point.sums()) shown.push_back(sum);

  DrivenPoint driven;
  for (const Shown& column : shown) {
    driven.names.push_back(column.name);
    driven.units.push_back(column.unit);
  }
  StressSums sums;
  const auto write_row = [&] {
    point.dissipated = sums.plastic;
    point.work = sums.internal + sums.plastic;
    point.viscous = sums.viscous;
    point.sound_speed = sound_speed<3>(point.material, point.columns, point.at, 0, drive.cell_size);
    for (const Shown& column : shown) driven.values.push_back(point.value(column));
  };
  write_row();
  MaterialBlock<3> block;
  block.row[0] = 0;
  block.count = 1;
  for (std::size_t n = 0; n < drive.increments.size(); n += 9) {
    for (std::size_t k = 0; k < 9; ++k) block.gradient[k / 3][k % 3][0] = drive.increments[n + k];
    const std::size_t step = n / 9 + 1;
    const double time = static_cast<double>(step) * drive.time_step;
    const StressSettings settings{drive.time_step, time, drive.cell_size, point.material.viscosity,
                                  false};
    if (drive.lanes)
      update_block<Batch<native_lanes>, 3>(point.material, point.columns, point.at, block, settings,
                                           sums);
    else
      update_block<double, 3>(point.material, point.columns, point.at, block, settings, sums);
    write_row();
  }
  return driven;
}

}  // namespace mpm
