#pragma once
// Particles that carry contact points: how they move, and what acts on them; plain data.
#include <cstdint>

#include "mpm/layout/tile.hpp"
#include "mpm/math/tensor.hpp"

namespace mpm {

/// A particle that carries contact points. What acts on these acts on its nodes.
template <int D>
struct Host {
  std::uint32_t part = 0, row = 0;
  std::int32_t first_node = 0;  // its cell's own, in the patch's block
  Vec<double, D> xi;            // its place in its cell
};

/// The sums of forces t at places X_p + d of a body, X_p that of the host: t, and t (x) d. They act
/// on its nodes with t N_ip + (t (x) d) grad_X N_ip, of which force, moment and power are those of
/// the forces at these places.
template <int D>
struct ForceAtHost {
  Vec<double, D> force = Vec<double, D>::zero();  // [N]
  Mat<double, D> moment{};                        // [N m]

  void add(const Vec<double, D>& t, const Vec<double, D>& d) {
    force += t;
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b) moment[a][b] += t[a] * d[b];
  }
  void add(const ForceAtHost& other) {
    force += other.force;
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b) moment[a][b] += other.moment[a][b];
  }
};

/// How a host moves: the mean of its nodes' velocities, and its gradient in the body at the start.
template <int D>
struct HostMotion {
  Vec<double, D> mean;      // [m/s]
  Mat<double, D> gradient;  // [1/s]

  /// At d from the host, in the body at the start.
  Vec<double, D> at(const Vec<double, D>& d) const {
    Vec<double, D> v = mean;
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b) v[a] += gradient[a][b] * d[b];
    return v;
  }
  /// With forces that act there [W].
  double power(const ForceAtHost<D>& forces) const {
    double sum = dot(forces.force, mean);
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b) sum += forces.moment[a][b] * gradient[a][b];
    return sum;
  }
};

/// What acts on a host in the coming step.
template <int D>
struct ActingOnHost {
  std::uint32_t host = 0;
  ForceAtHost<D> push, rub;  // by springs, by friction
};

/// A host of another rank, as that tells of it after the last step.
template <int D>
struct HostElsewhere {
  std::uint32_t host = 0;
  Mat<double, D> deformation;  // F
  HostMotion<D> motion;
};

}  // namespace mpm
