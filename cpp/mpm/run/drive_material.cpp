#include "mpm/run/drive_material.hpp"

#include "mpm/materials/material_block.hpp"

namespace mpm {
namespace {

constexpr double cell = 1.0;  // [m]; only a detonation front and a viscous fluid's speed know it

void write_row(DrivenPoint& point, const Material& material, const Columns& columns,
               const MaterialColumns& at, const StressSums& sums) {
  for (int c = 0; c < 6; ++c) point.values.push_back(columns.component(at.stress + c)[0]);
  point.values.push_back(columns.component(at.volume)[0]);
  point.values.push_back(sums.plastic);
  point.values.push_back(sums.internal + sums.plastic);
  point.values.push_back(sound_speed<3>(material, columns, at, 0, cell));
  for (int c = at.stress + 6; c < columns.component_count(); ++c)
    point.values.push_back(columns.component(c)[0]);
}

}  // namespace

DrivenPoint drive_material(const MaterialChoice& choice, std::span<const double> increments,
                           double time_step, bool lanes) {
  const Material material = make_material(choice);
  Columns columns;
  MaterialColumns at{};
  at.velocity = columns.add("velocity", "m/s", 3);
  at.mass = columns.add("mass", "kg", 1);
  at.volume = columns.add("volume", "m^3", 1);
  at.stress = columns.add("stress", "Pa", 6);
  add_material_columns<3>(material, columns, at);
  columns.allocate(1);
  for (int a = 0; a < 3; ++a) columns.component(at.velocity + a)[0] = 0.0;
  columns.component(at.mass)[0] = material.density;
  columns.component(at.volume)[0] = 1.0;
  start_material_columns<3>(material, columns, at);

  DrivenPoint point;
  point.names = {"stress_xx", "stress_yy", "stress_zz",  "stress_yz", "stress_xz",
                 "stress_xy", "volume",    "dissipated", "work",      "sound_speed"};
  for (const ColumnInfo& info : columns.infos()) {
    if (info.first <= at.stress) continue;
    if (info.components == 1) point.names.push_back(info.name);
    for (int c = 0; c < info.components && info.components > 1; ++c)
      point.names.push_back(info.name + "_" + std::to_string(c));
  }

  StressSums sums;
  write_row(point, material, columns, at, sums);
  MaterialBlock<3> block;
  for (std::size_t n = 0; n + 9 <= increments.size(); n += 9) {
    block.row[0] = 0;
    block.count = 1;
    for (std::size_t k = 0; k < 9; ++k) block.gradient[k / 3][k % 3][0] = increments[n + k];
    const double time = static_cast<double>(n / 9 + 1) * time_step;
    const StressSettings settings{time_step, time, cell, {}, false};
    if (lanes)
      update_block<Batch<native_lanes>, 3>(material, columns, at, block, settings, sums);
    else
      update_block<double, 3>(material, columns, at, block, settings, sums);
    write_row(point, material, columns, at, sums);
  }
  return point;
}

}  // namespace mpm
