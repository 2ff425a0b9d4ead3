#pragma once
// A body of one particle, at rest at the start.
#include "mpm/materials/material_block.hpp"

namespace mpm::testing {

template <int D, int most = 128>
struct OnePoint {
  Material material;
  Columns columns;
  MaterialColumns at{};
  MaterialBlock<D, most> block;
  StressSums sums;

  explicit OnePoint(const MaterialChoice& choice) : material(make_material(choice)) {
    at.velocity = columns.add("velocity", "m/s", D, Precision::rounded);
    at.mass = columns.add("mass", "kg", 1);
    at.volume = columns.add("volume", "m^3", 1);
    at.stress = columns.add("stress", "Pa", Sym<double, D>::size, Precision::rounded);
    add_material_columns<D>(material, columns, at);
    columns.allocate(1);
    for (int a = 0; a < D; ++a) columns.rounded(at.velocity + a)[0] = 0.0;
    columns.component(at.mass)[0] = material.density;
    columns.component(at.volume)[0] = 1.0;
    start_material_columns<D>(material, columns, at);
    if (choice.strength.name == "high_explosive")
      columns.component(columns.info("lighting_time").first)[0] = 0.0;
    block.row[0] = 0;
    block.count = 1;
  }
  double value(const ColumnInfo& info, int component) const {
    return columns.value(info.first + component, 0);
  }
};

}  // namespace mpm::testing
