#pragma once
// A body: its particles as columns, and the list that keeps the particles of one cell together.
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "mpm/fields/columns.hpp"
#include "mpm/materials/material_block.hpp"
#include "mpm/rigid/prescribed_motion.hpp"

namespace mpm {

/// What moves the particles of a body.
enum class BodyKind : std::uint8_t {
  deformable,  // each its own forces
  rigid,       // as one, those of all (Newton, Euler)
  prescribed,  // as one, Body::motion, whatever acts on them
};

template <int D>
struct Body {
  std::string name;
  int material = 0;
  int group = 0;  // number of the first of the bodies with which it shares frictions and reports
  Columns columns;
  int position = 0;               // first component of each column; position [m], D components
  MaterialColumns at{};           // velocity [m/s] D; mass [kg]; volume [m^3]; stress [Pa]; ...
  std::vector<std::uint32_t> id;  // place of each particle in the order in which the user gave them
  std::vector<std::uint32_t> order;  // particles by patch, then by cell, then by id; behind them
                                     // those that are gone, which no patch holds
  double initial_density = 0.0;      // [kg/m^3]
  double stiffness = 0.0;            // rho c^2 of the start [Pa]; infinite if it is rigid
  double mean_mass = 0.0;            // of a particle at the start [kg]
  double mean_edge = 0.0;   // edge of a square or cube of the mean initial particle volume [m]
  double total_mass = 0.0;  // [kg]
  BodyKind kind = BodyKind::deformable;
  std::unique_ptr<PrescribedMotion> motion;  // none for the thousands of bodies that are free
  double pressure_impedance = 0.0, shear_impedance = 0.0;  // rho c of the start [kg/(m^2 s)]
  std::size_t moved = 0;  // changes of cell since the columns were last sorted
  bool leaves = false;    // a rigid body that leaves the region that is kept, as a whole
  std::size_t gone = 0;   // particles that take no part any more: eroded, or left the region

  std::size_t count() const { return columns.rows(); }
  std::size_t active() const { return count() - gone; }
  bool deforms() const { return kind == BodyKind::deformable; }
  bool is_prescribed() const { return kind == BodyKind::prescribed; }
  bool is_free_rigid() const { return kind == BodyKind::rigid; }
  double* x(int a) { return columns.component(position + a); }
  Rounded* v(int a) { return columns.rounded(at.velocity + a); }
  const double* x(int a) const { return columns.component(position + a); }
  const Rounded* v(int a) const { return columns.rounded(at.velocity + a); }
  double* mass() { return columns.component(at.mass); }
  const double* mass() const { return columns.component(at.mass); }
  double* volume() { return columns.component(at.volume); }
  const double* volume() const { return columns.component(at.volume); }
  const Rounded* stress(int k) const { return columns.rounded(at.stress + k); }

  std::size_t bytes() const {
    return columns.bytes() + (id.capacity() + order.capacity()) * sizeof(std::uint32_t);
  }
};

}  // namespace mpm
