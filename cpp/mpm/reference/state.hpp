#pragma once
// What the reference step works on: particles, nodes, bodies, and what acts on them.
#include <array>
#include <functional>
#include <map>
#include <vector>

#include "mpm/layout/tile.hpp"
#include "mpm/materials/strength/elastic.hpp"
#include "mpm/particles/body.hpp"

namespace mpm::reference {

template <int D>
struct Particle {
  Vec<double, D> x, v;                             // position [m], velocity [m/s]
  Vec<double, D> X;                                // position at the start [m]
  double m, V;                                     // mass [kg], volume [m^3]
  Sym<double, D> sigma;                            // stress [Pa]
  Mat<double, D> gradient{};                       // of a step's velocity x dt, at its start
  Sym<double, D> s = Sym<double, D>::zero();       // and that of the material's damping [Pa]
  Mat<double, D> C{};                              // affine part of the velocity [1/s]
  Vec<double, D> unseen = Vec<double, D>::zero();  // of v, to be taken away in this step [m/s]
};

template <int D>
struct Node {
  double m = 0.0;                                  // mass [kg]
  Vec<double, D> v = Vec<double, D>::zero();       // velocity [m/s]; a momentum while it is summed
  Vec<double, D> f = Vec<double, D>::zero();       // force [N]
  Vec<double, D> f_load = Vec<double, D>::zero();  // the part of it of loads on surfaces [N]
  Vec<double, D> f_body = Vec<double, D>::zero();  // and of the body force, a part of f_load [N]
  Vec<double, D> f_absorb = Vec<double, D>::zero();  // and that of absorbing walls [N]
  Vec<double, D> f_touch = Vec<double, D>::zero();   // and that of walls that touch [N]
  Vec<double, D> f_damp = Vec<double, D>::zero();    // that damping of the body's motion adds [N]
  Vec<double, D> dv = Vec<double, D>::zero();        // change of the velocity in this step [m/s]
  Vec<double, D> v_corrected = Vec<double, D>::zero();  // by how much eqs. (6)-(7) have changed v
  Vec<double, D> v_new = Vec<double, D>::zero();        // remapped velocity [m/s]
};

/// A body; every body has its own velocity field on the common grid.
template <int D>
struct Body {
  std::vector<Particle<D>> particles;
  Elastic material;
  double beta = 0.0;                     // damping of the material by its stiffness [s]
  BodyKind kind = BodyKind::deformable;  // others have no stress, and their particles move as one
  RigidMotion motion;                    // of this step
  // Of a body whose motion is prescribed: that of the step before, and what it is given as.
  RigidMotion last_motion;
  std::array<TimeFunction, 3> velocity{}, spin{};  // [m/s], [rad/s]
  // Force per mass [m/s^2], of the present place, that at the start [m] and the time [s]; or none.
  std::function<Vec<double, D>(const Vec<double, D>&, const Vec<double, D>&, double)> force;
  unsigned held_by = ~0u;           // faces of the box, bits 2 axis + side, on nodes of its own
  double alpha = 0.0, kappa = 0.0;  // damping of its motion: by the mass [1/s], local
  std::map<Index<D>, Node<D>> nodes;

  bool deforms() const { return kind == BodyKind::deformable; }
  bool prescribed() const { return kind == BodyKind::prescribed; }
};

/// Two bodies r and s at a node, and what eqs. (6)-(7) and (11)-(15) need there.
template <int D>
struct Contact {
  Index<D> node;
  Node<D>*r, *s;
  Vec<double, D> n;                           // unit normal from r to s
  double w_r, w_s;                            // 1/m of the masses that meet there [1/kg]
  bool touching = false;                      // the bodies approach, or rest against each other
  double push = 0.0, stiffness = 0.0;         // of springs: force at the start [N], and [N/m]
  Vec<double, D> f = Vec<double, D>::zero();  // contact force on s [N]
};

/// A piece of a body's surface, carried by a particle.
template <int D>
struct Piece {
  std::size_t particle;
  double size;               // area [m^2]: at an edge of the body more than |a|
  Vec<double, D> a, middle;  // outward area vector [m^2]; its middle from the particle [m]
};

/// A pressure or a traction on a part of a body's surface.
template <int D>
struct Load {
  std::size_t body;
  bool pressure;                      // else a traction
  std::array<TimeFunction, D> value;  // p, the first, or t [Pa]
  std::vector<Piece<D>> pieces;
  Vec<double, D> force = Vec<double, D>::zero();  // of this step [N]
};

/// What forces do in a step [J]. Of loads and walls the part of the step's energy balance
/// that the nodes exchange with the outside; of contact what it does on prescribed bodies.
struct Works {
  double gravity = 0.0, loads = 0.0, absorbed = 0.0, damped = 0.0, touched = 0.0,
         on_prescribed = 0.0;
};

}  // namespace mpm::reference
