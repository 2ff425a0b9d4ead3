#pragma once
// Scatter with the nodes of a cell in the lanes, for a basis of two nodes along an axis: the sums
// of all particles of a cell stay in registers, eqs. (2), (3) and (9), and memory is touched once a
// cell. Particles follow each other in the order of their numbers, so every sum has that order for
// any width of registers.
#include "mpm/schedule/payload.hpp"
#include "mpm/schedule/weights.hpp"

namespace mpm {

namespace nodes_in_lanes {
/// Over the nodes of a cell: N along an axis is base + slope xi, where base = 1 - place and slope =
/// 2 place - 1 of the node's place 0 or 1: 1 - xi and xi. In tables, so that one multiply-add gives
/// it in all lanes and no lane is chosen by a condition.
template <int D>
constexpr auto pattern(bool slope) {
  std::array<std::array<double, 1 << D>, D> r{};
  for (std::size_t a = 0; a < D; ++a)
    for (std::size_t k = 0; k < 1 << D; ++k) {
      const double place = static_cast<double>((k >> a) & 1);
      r[a][k] = slope ? 2.0 * place - 1.0 : 1.0 - place;
    }
  return r;
}
template <int D>
inline constexpr auto base = pattern<D>(false);
template <int D>
inline constexpr auto slope = pattern<D>(true);
}  // namespace nodes_in_lanes

/// Arithmetic of a mapping's formulas (step/transfer): p.m, p.v and p.traction are a particle's
/// numbers, N_ip and its gradient have a lane for each node. A product with a vector is not carried
/// out but noted (Momentum, Force), so that `VectorSums` does it with the sum, rounded once
/// (decision 0033).
namespace nodes_in_lanes {
template <int D>
using Sums = NodeBatch<(1 << D)>;

template <int D>
struct Gradient {
  Sums<D> along[D];
};
template <int D>
struct Velocity {
  double c[D];
};
template <int D>
struct Traction {
  Sym<double, D> t;
};
template <int D>
struct Momentum {
  const Velocity<D>& v;
  const Sums<D>& m;
};
template <int D>
struct Force {
  const Traction<D>& traction;
  const Gradient<D>& gradient;
};
template <int D>
Momentum<D> operator*(const Sums<D>& m, const Velocity<D>& v) {
  return {v, m};
}
template <int D>
Force<D> operator*(const Traction<D>& traction, const Gradient<D>& gradient) {
  return {traction, gradient};
}
/// A sum over particles of vectors. In 2D the third stays 0, for the empty place of a half record.
template <int D>
struct VectorSums {
  Sums<D> c[3] = {Sums<D>::zero(), Sums<D>::zero(), Sums<D>::zero()};

  MPM_INLINE void operator+=(const Momentum<D>& p) {
    unrolled<D>([&](auto a) { c[a].add(p.v.c[a], p.m); });
  }
  // f_a += t_ab dN/dxi_b; the sign of eq. (9), the volume and 1 / h are in t (ParticleReader).
  MPM_INLINE void operator+=(const Force<D>& p) {
    unrolled<D>([&](auto a) {
      unrolled<D>([&](auto b) { c[a].add(p.traction.t(a, b), p.gradient.along[b]); });
    });
  }
};
/// What is not asked for: a formula adds to it, and nothing is computed.
struct Nothing {
  template <class T>
  void operator+=(const T&) {}
};

template <unsigned what, int D>
struct NodeSums {
  std::conditional_t<(what & gives_mass) != 0, Sums<D>, Nothing> m{};
  VectorSums<D> p, f;
};
template <int D>
struct Particle {
  double m;
  Velocity<D> v;
  Traction<D> traction;
};
}  // namespace nodes_in_lanes

template <int D>
class NodesInLanes {
 public:
  template <int room>
  using Payload = PayloadColumns<D, room>;
  /// What is to be known of a cell's particles: their position in the cell, D numbers in place of
  /// the factors, which are cheap to make from it in the lanes of the nodes.
  template <int room>
  struct Places {
    double xi[D][room];
  };
  template <unsigned /*what*/, int room, class T>
  static void put(Places<room>& places, int at, const Weights<T, D, 2>& w) {
    unrolled<D>([&](auto a) { store_lanes(places.xi[a] + at, w.xi[a]); });
  }

  explicit NodesInLanes(const NodeStrides<D>& stride) : stride_(stride) {}

  /// What the first `count` of these particles give to the nodes, whose records begin at the first
  /// in reach: mass and momentum to the first half, forces to the second; momentum alone to the
  /// first.
  template <class Mapping, unsigned what, int width, int room>
  void give(const Nodes<width>& nodes, const Places<room>& places, const Payload<room>& payload,
            int count) const {
    constexpr bool forces = (what & gives_forces) != 0, momentum = what != gives_forces;
    static_assert(!(forces && momentum) || (what & gives_mass), "mass comes before the momentum");
    // All sums at once where the machine's registers hold them and a quarter is left for the rest:
    // 1 + 2 D of them (mass, momentum, force), each in `parts` registers. In 3D that is 7 of 32
    // with AVX-512, but 14 of 16 with AVX2: there the particles are gone through twice, momentum
    // and then forces. The terms and their order are the same either way, and so are the bits.
    constexpr int all = native_lanes == 8 ? 32 : 16;
    if constexpr (!forces || !momentum || Sums::parts * (1 + 2 * D) <= all - all / 4) {
      give_sums<Mapping, what>(nodes, places, payload, count);
    } else {
      give_sums<Mapping, what & ~gives_forces>(nodes, places, payload, count);
      give_sums<Mapping, gives_forces>(nodes, places, payload, count);
    }
  }

 private:
  using Sums = nodes_in_lanes::Sums<D>;
  using Part = typename Sums::Part;

  template <class Mapping, unsigned what, int width, int room>
  void give_sums(const Nodes<width>& nodes, const Places<room>& places,
                 const Payload<room>& payload, int count) const {
    nodes_in_lanes::NodeSums<what, D> sums;
    for (int k = 0; k < count; ++k) {
      const nodes_in_lanes::Particle<D> p = particle<what>(payload, k);
      if constexpr (what != gives_forces) Mapping::give_momentum(p, functions(places, k), sums);
      if constexpr ((what & gives_forces) != 0) Mapping::give_force(p, gradients(places, k), sums);
    }
    // As halves of records: mass and momentum, or momentum alone from the first place on (MUSL's
    // remap, whose mass is known), and the force.
    const auto& p = sums.p.c;
    const auto& f = sums.f.c;
    if constexpr ((what & gives_mass) != 0)
      add_to_nodes(nodes, sums.m, p[0], p[1], p[2]);
    else if constexpr (what != gives_forces)
      add_to_nodes(nodes, p[0], p[1], p[2], Sums::zero());
    if constexpr ((what & gives_forces) != 0)
      add_to_nodes(nodes.at(force_at), f[0], f[1], f[2], Sums::zero());
  }
  template <unsigned what, int room>
  static nodes_in_lanes::Particle<D> particle(const Payload<room>& payload, int k) {
    // What is not scattered has not been laid out either, and is not read.
    nodes_in_lanes::Particle<D> p;
    if constexpr (what != gives_forces) {
      p.m = payload.mass[k];
      unrolled<D>([&](auto a) { p.v.c[a] = payload.velocity[a][k]; });
    }
    if constexpr ((what & gives_forces) != 0)
      unrolled<Sym<double, D>::size>([&](auto c) { p.traction.t.c[c] = payload.traction[c][k]; });
    return p;
  }

  /// N_ip over the cell's nodes, for particle p of those: the product over the axes.
  template <int room>
  static Sums functions(const Places<room>& places, int p) {
    Part inner = lanes(0, places.xi[0][p]);
    for (int a = 1; a < inner_axes; ++a) inner = inner * lanes(a, places.xi[a][p]);
    // The axes in their order: the same bits for every width.
    Sums N;
    for (int k = 0; k < Sums::parts; ++k) {
      N.part[k] = inner;
      for (int a = inner_axes; a < D; ++a) N.part[k] = N.part[k] * along(a, k, places.xi[a][p]);
    }
    return N;
  }
  /// dN_ip / d xi over the cell's nodes, along each axis: its slope, -1 or 1, times N along the
  /// others. These are exact factors, so it matters for no bit where the sign is multiplied in.
  template <int room>
  static nodes_in_lanes::Gradient<D> gradients(const Places<room>& places, int p) {
    nodes_in_lanes::Gradient<D> G;
    Part N[D];
    for (int a = 0; a < inner_axes; ++a) N[a] = lanes(a, places.xi[a][p]);
    for (int a = 0; a < D; ++a)
      for (int k = 0; k < Sums::parts; ++k) {
        // Along axis a the slope, of the others N; inner axes first, as in `functions`.
        Part g = a < inner_axes ? Part::load(slopes(a)) : Part(place(a, k) ? 1.0 : -1.0);
        for (int b = 0; b < inner_axes; ++b)
          if (b != a) g = g * N[b];
        for (int b = inner_axes; b < D; ++b)
          if (b != a) g = g * along(b, k, places.xi[b][p]);
        G.along[a].part[k] = g;
      }
    return G;
  }
  /// To half the nodes' records: the values of four fields. Lanes hold nodes, memory holds fields,
  /// so registers are transposed and each node is read and written once, as one register.
  template <int width>
  void add_to_nodes(const Nodes<width>& nodes, const Sums& a, const Sums& b, const Sums& c,
                    const Sums& d) const {
    unrolled<Sums::parts>([&](auto part) {
      transpose_to_nodes(a.part[part], b.part[part], c.part[part], d.part[part],
                         [&](int k, Batch<4> q) {
                           // Number of the node in the cell, its bits being the places along x, y,
                           // z (base, slope).
                           k += part * Sums::width;
                           double* to = nodes[stride_.to(k & 1, k >> 1 & 1, k >> 2)];
                           (Batch<4>::load(to) + q).store(to);
                         });
    });
  }

  // The nodes of one register differ in the place along these axes; along the others they share it,
  // so that a whole register has one factor, xi or 1 - xi, and no table.
  static constexpr int inner_axes = Sums::width == 8 ? 3 : Sums::width == 4 ? 2 : 1;

  static const double* slopes(int a) {
    return nodes_in_lanes::slope<D>[static_cast<std::size_t>(a)].data();
  }
  /// Place along an outer axis of the nodes in register k.
  static constexpr int place(int a, int k) { return k * Sums::width >> a & 1; }
  /// One-axis factor of an inner axis, and of an outer one in register k. 1 - xi is rounded once in
  /// both, so it makes no difference to the bits which axes are inner ones.
  static Part lanes(int a, double xi) {
    return fma(Part(xi), Part::load(slopes(a)),
               Part::load(nodes_in_lanes::base<D>[static_cast<std::size_t>(a)].data()));
  }
  static Part along(int a, int k, double xi) {
    return place(a, k) ? Part(xi) : Part(1.0) - Part(xi);
  }

  NodeStrides<D> stride_;
};

}  // namespace mpm
