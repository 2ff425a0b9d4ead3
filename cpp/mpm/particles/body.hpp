#pragma once
// A body: what is not of its particles, which lie in the pool of its material.
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mpm/comm/share.hpp"
#include "mpm/materials/material.hpp"
#include "mpm/rigid/prescribed_motion.hpp"

namespace mpm {

/// What moves the particles of a body.
enum class BodyKind : std::uint8_t {
  deformable,  // each its own forces
  rigid,       // as one, those of all (Newton, Euler)
  prescribed,  // as one, Body::motion, whatever acts on them
  material,    // as deformable, on nodes that lie in the body and keep their motion
};

/// The particles of a body as the user gives them, until they are in a pool: a rank's share, then
/// those in its tiles.
struct GivenParticles {
  Share share;
  std::vector<double> positions;                              // (n, D) [m]
  std::vector<double> velocities;                             // (n, D) or (1, D) [m/s]
  std::vector<double> volumes;                                // (n,) or (1,) [m^3]
  std::vector<std::pair<int, std::vector<double>>> states{};  // a component of the columns, (n,)
  std::vector<std::uint32_t> numbers{};                       // in the body, if they are no share

  std::size_t count() const { return numbers.empty() ? share.count() : numbers.size(); }
  template <int D>
  Vec<double, D> position(std::size_t k) const {
    Vec<double, D> x;
    for (int a = 0; a < D; ++a) x[a] = positions[k * D + static_cast<std::size_t>(a)];
    return x;
  }
  std::uint32_t number(std::size_t k) const {
    return numbers.empty() ? static_cast<std::uint32_t>(share.first + k) : numbers[k];
  }
};

template <int D>
struct Body {
  std::string name;
  int material = 0;  // number of the pool, too, that holds its particles
  int group = 0;     // number of the first of the bodies with which it shares frictions and reports
  std::size_t count = 0;         // of its particles, those of other ranks too
  std::size_t removed = 0;       // those that take no part any more: eroded, or left the region
  std::size_t removed_here = 0;  // the part of them that this rank had
  double initial_density = 0.0;  // [kg/m^3]
  double stiffness = 0.0;        // rho c^2 of the start [Pa]; infinite if it is rigid
  double mean_mass = 0.0;        // of a particle at the start [kg]
  double mean_edge = 0.0;        // edge of a square or cube of the mean initial particle volume [m]
  double total_mass = 0.0;       // [kg]
  BodyKind kind = BodyKind::deformable;
  Matter matter = Matter::solid;
  int rigid = -1;                            // place among Domain::rigid, if it is rigid and free
  int force = -1;                            // place among Domain::body_forces, if it has one
  int damping = -1;                          // and among Domain::dampings
  std::unique_ptr<PrescribedMotion> motion;  // none for the thousands of bodies that are free
  unsigned held_by = ~0u;  // faces of the box, bits 2 axis + side, if it has such nodes
  double pressure_impedance = 0.0, shear_impedance = 0.0;  // rho c of the start [kg/(m^2 s)]
  bool averages = false;         // its pressures on its own nodes (step/average_in_body.cpp)
  std::int64_t failed = 0;       // of its particles, with such nodes (run/look_for_failed.hpp)
  int renewals = 0;              // how often nodes have been laid anew into it ...
  bool nodes_are_final = false;  // ... and no more (WhyNodesStay)
  std::size_t moved = 0;         // changes of cell since its rows were last sorted
  bool leaves = false;           // a rigid body that leaves the region that is kept, as a whole
  std::unique_ptr<GivenParticles> given;  // none if others take all, nor once they are in the pool

  /// Of its particles, until they go to the ranks of their tiles.
  Share share() const { return given ? given->share : Share{}; }
  std::size_t active() const { return count - removed; }
  bool deforms() const { return kind == BodyKind::deformable || keeps_nodes(); }
  /// Do its nodes keep their displacements and velocities (step/kept_nodes.hpp)?
  bool keeps_nodes() const { return kind == BodyKind::material; }
  bool is_prescribed() const { return kind == BodyKind::prescribed; }
  bool is_free_rigid() const { return kind == BodyKind::rigid; }
};

}  // namespace mpm
