#pragma once
// Particles that carry contact points: how they move, and what acts on them; plain data.
#include <cstdint>

#include "mpm/layout/tile.hpp"
#include "mpm/math/inverse.hpp"

namespace mpm {

/// A particle that carries contact points. What acts on these acts on its nodes.
template <int D>
struct Host {
  std::uint32_t part = 0, row = 0;
  std::int32_t first_node = 0;  // its cell's own, in the patch's block
  Vec<double, D> xi;            // its place in its cell
};

/// A place of a body by the functions of a host, W_i = N_i + d . grad_X N_i + sum_k b_k
/// d2N_i/dX_k^2 (decision 0071).
template <int D>
struct PlaceAtHost {
  Vec<double, D> away;    // d, from the host to the place, in the body at the start [m]
  Vec<double, D> second;  // b [m^2]
};

/// The fibre of a body that was normal to its surface.
template <int D>
struct Fibre {
  Vec<double, D> normal;     // N
  Vec<double, D> direction;  // F N / |F N|
  double stretch;            // |F N|
  double behind;             // how far the point lies behind the surface [m]

  Fibre(const Mat<double, D>& F, const Vec<double, D>& N, double how_far)
      : normal(N), direction(product(F, N)), stretch(norm(direction)), behind(how_far) {
    direction = (1.0 / stretch) * direction;
  }
};

/// The sums of forces t at places of a body: t, t (x) d and t (x) b. They act on the nodes of the
/// host by W_i, so that force, moment and power are those of the forces at these places.
template <int D>
struct ForceAtHost {
  Vec<double, D> force = Vec<double, D>::zero();  // [N]
  Mat<double, D> moment{}, second{};              // [N m; N m^2]

  void add(const Vec<double, D>& t, const PlaceAtHost<D>& place) {
    force += t;
    add_product(moment, t, place.away);
    add_product(second, t, place.second);
  }
  /// Of t that acts `behind` the place, along the fibre: what it has across the fibre turns that,
  /// whose length does not matter.
  void add_moment(const Vec<double, D>& t, const Fibre<D>& fibre) {
    const Vec<double, D> aside = t - dot(t, fibre.direction) * fibre.direction;
    add_product(moment, (-fibre.behind / fibre.stretch) * aside, fibre.normal);
  }
  void add(const ForceAtHost& other) {
    force += other.force;
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b) {
        moment[a][b] += other.moment[a][b];
        second[a][b] += other.second[a][b];
      }
  }
  static void add_product(Mat<double, D>& sum, const Vec<double, D>& t, const Vec<double, D>& d) {
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b) sum[a][b] += t[a] * d[b];
  }
};

/// How a host moves: the mean of its nodes' velocities, its gradient in the body at the start, and
/// its second derivatives along each axis.
template <int D>
struct HostMotion {
  Vec<double, D> mean;      // [m/s]
  Mat<double, D> gradient;  // [1/s]
  Mat<double, D> second;    // [1/m s]

  Vec<double, D> at(const PlaceAtHost<D>& place) const {
    Vec<double, D> v = mean;
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b)
        v[a] += gradient[a][b] * place.away[b] + second[a][b] * place.second[b];
    return v;
  }
  /// With forces that act there [W].
  double power(const ForceAtHost<D>& forces) const {
    double sum = dot(forces.force, mean);
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b)
        sum += forces.moment[a][b] * gradient[a][b] + forces.second[a][b] * second[a][b];
    return sum;
  }
};

/// F of a host, and its inverse.
template <int D>
struct HostDeformation {
  Mat<double, D> F, inverse;

  HostDeformation() = default;
  explicit HostDeformation(const Mat<double, D>& deformation)
      : F(deformation), inverse(inverse_of(deformation)) {}
};

/// A host in touch.
template <int D>
struct HostInTouch {
  HostMotion<D> motion;
  HostDeformation<D> deformation;
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
