#pragma once
// Scatter with the four numbers of half a node's record in the lanes, for any basis: particles
// follow each other in the order of their numbers, and the sums of a layer of nodes stay in
// registers. No lane is idle for want of particles (decision 0018).
#include "mpm/schedule/payload.hpp"
#include "mpm/schedule/weights.hpp"

namespace mpm {

/// Arithmetic of a mapping's formulas: p.v and the columns of p.traction are halves of records,
/// N_ip and its gradient are factors along the axes. What does not change along a row of nodes, or
/// in a layer of them, is one expression there, which the compiler evaluates once. So a vector
/// takes 3 products for layers, 9 for rows and 27 multiply-adds in 3D (decision 0018). Axes are
/// multiplied in from z to x, as the loops nest.
namespace records_in_lanes {
using Half = Batch<half_record>;

template <int D>
struct Function {
  double z, y, x;  // in 2D z is what it is scaled with
};
template <int D>
struct Gradient {
  double z, y, x, dz, dy, dx;
};
template <int D>
struct Tensor {
  Half column[D];
};
/// Of one node: part x.
struct Scaled {
  Half part;
  double x;
};
/// along dx + across x, with the derivative and the function along x of the node: with t_b the
/// columns of the traction, t . grad N = (t_x N_y N_z) dN_x + (t_y dN_y N_z + t_z N_y dN_z) N_x,
/// and both brackets are one for a row.
struct Force {
  Half along, across;
  double x, dx;
};
template <int D>
MPM_INLINE inline Function<D> operator*(double m, const Function<D>& N) {
  return {D == 3 ? m * N.z : m, N.y, N.x};
}
template <int D>
MPM_INLINE inline Scaled operator*(const Function<D>& scale, const Half& v) {
  // In this order, so that the first product is one for the layer and the second one for the row.
  return {(scale.z * v) * scale.y, scale.x};
}
template <int D>
MPM_INLINE inline Force operator*(const Tensor<D>& t, const Gradient<D>& N) {
  // What a layer shares: N_z, but dN_z for the column along z.
  const auto in_layer = [&](int b) MPM_INLINE {
    return D == 3 ? t.column[b] * Half(b == 2 ? N.dz : N.z) : t.column[b];
  };
  const Half y(N.y);
  Half across = in_layer(1) * Half(N.dy);
  if constexpr (D == 3) across = fma(in_layer(2), y, across);
  return {in_layer(0) * y, across, N.x, N.dx};
}
/// A vector times N, and the sum with a tensor times first moments: N is one for a row but for N_x.
template <int D>
struct Product {
  Half v;
  const Function<D>& N;
};
template <int D>
MPM_INLINE inline Product<D> operator*(const Half& v, const Function<D>& N) {
  return {v, N};
}
template <int D>
MPM_INLINE inline Force operator+(const Product<D>& p, const Force& f) {
  const Half in_layer = D == 3 ? p.v * Half(p.N.z) : p.v;
  return {f.along, fma(in_layer, Half(p.N.y), f.across), f.x, f.dx};
}
/// The half record of a node, while particles are summed.
struct HalfSum {
  Half& sum;
  MPM_INLINE void operator+=(const Scaled& p) { sum = fma(p.part, Half(p.x), sum); }
  // Two multiply-adds a node whatever D is; the order of the two is part of the bits.
  MPM_INLINE void operator+=(const Force& p) {
    sum = fma(p.along, Half(p.dx), sum);
    sum = fma(p.across, Half(p.x), sum);
  }
};
/// The mass is a number of the half record beside the momentum: its own formula has nothing left to
/// do.
struct WithMomentum {
  template <class T>
  void operator+=(const T&) {}
};
struct NodeSum {
  WithMomentum m;
  HalfSum p, f;
};
struct Momentum {
  double m;
  Half v;
};
/// Momentum and its gradient; the mass is in both.
template <int D>
struct AffineMomentum {
  double m;
  Half mv;
  Tensor<D> mC;
};
template <int D>
struct Stress {
  Tensor<D> traction;
};
}  // namespace records_in_lanes

template <int D, int count>
class RecordsInLanes {
 public:
  template <int room>
  using Payload = PayloadRecords<D, room>;
  /// What is to be known of a cell's particles: their weights; derivatives for forces only. As many
  /// columns as factors along an axis, 3 D, not 3^D products: these are made as they are used.
  template <int room>
  struct Places {
    double N[D][count][room], dN[D][count][room];
    double M[D][count][room];  // first moments, for an affine part only
  };
  template <unsigned what, int room, class T>
  static void put(Places<room>& places, int at, const Weights<T, D, count>& w) {
    unrolled<D>([&](auto a) {
      unrolled<count>([&](auto k) {
        store_lanes(places.N[a][k] + at, w.axis[a].N[k]);
        if constexpr ((what & gives_forces) != 0)
          store_lanes(places.dN[a][k] + at, w.axis[a].dN[k]);
      });
    });
  }
  template <int room, class T>
  static void put_moments(Places<room>& places, int at, const Moments<T, D, count>& M) {
    unrolled<D>([&](auto a) {
      unrolled<count>([&](auto k) { store_lanes(places.M[a][k] + at, M.axis[a][k]); });
    });
  }

  explicit RecordsInLanes(const NodeStrides<D>& stride) : stride_(stride) {}

  /// What the first `n` of these particles give to the nodes, whose records begin at the first in
  /// reach: mass and momentum to the first half, forces to the second; momentum alone to the first.
  template <class Mapping, unsigned what, int width, int room>
  void give(const Nodes<width>& nodes, const Places<room>& places, const Payload<room>& payload,
            int n) const {
    // Momentum and forces one after another and not in one pass: each has the 9 sums of a layer,
    // and both would be more than the 16 registers of AVX2.
    if constexpr ((what & gives_affine) != 0)
      give_sums(nodes, n, [&](int k, auto x, auto y, auto z, Half& sum) MPM_INLINE {
        records_in_lanes::AffineMomentum<D> p{payload.mass[k], Half::load(payload.velocity[k]), {}};
        unrolled<D>([&](auto b) MPM_INLINE { p.mC.column[b] = Half::load(payload.affine[b][k]); });
        const records_in_lanes::Function<D> N = functions(places, k, x, y, z);
        const records_in_lanes::Gradient<D> M{N.z,
                                              N.y,
                                              N.x,
                                              D == 3 ? places.M[D - 1][z][k] : 0.0,
                                              places.M[1][y][k],
                                              places.M[0][x][k]};
        records_in_lanes::NodeSum node{{}, {sum}, {sum}};
        Mapping::give_momentum(p, N, M, node);
      });
    else if constexpr (what != gives_forces)
      give_sums(nodes, n, [&](int k, auto x, auto y, auto z, Half& sum) MPM_INLINE {
        const records_in_lanes::Momentum p{payload.mass[k], Half::load(payload.velocity[k])};
        records_in_lanes::NodeSum node{{}, {sum}, {sum}};
        Mapping::give_momentum(p, functions(places, k, x, y, z), node);
      });
    if constexpr ((what & gives_forces) != 0)
      give_sums(nodes.at(force_at), n, [&](int k, auto x, auto y, auto z, Half& sum) MPM_INLINE {
        records_in_lanes::Stress<D> p;
        unrolled<D>([&](auto b)
                        MPM_INLINE { p.traction.column[b] = Half::load(payload.traction[b][k]); });
        const records_in_lanes::Function<D> N = functions(places, k, x, y, z);
        const records_in_lanes::Gradient<D> dN{N.z,
                                               N.y,
                                               N.x,
                                               D == 3 ? places.dN[D - 1][z][k] : 0.0,
                                               places.dN[1][y][k],
                                               places.dN[0][x][k]};
        records_in_lanes::NodeSum node{{}, {sum}, {sum}};
        Mapping::give_force(p, dN, node);
      });
  }

 private:
  using Half = records_in_lanes::Half;

  /// Of particle k at a node. In 2D there is one layer, with N_z = 1 and no derivative along z.
  template <int room>
  [[gnu::always_inline]] static records_in_lanes::Function<D> functions(const Places<room>& places,
                                                                        int k, int x, int y,
                                                                        int z) {
    return {D == 3 ? places.N[D - 1][z][k] : 1.0, places.N[1][y][k], places.N[0][x][k]};
  }

  /// Layer by layer: give(k, x, y, z, sum) adds to the sum of a node what particle k gives. The 9
  /// sums of a layer fit into registers, the 27 of all do not (decision 0022), so the particles are
  /// read again for each layer; these are in the first cache.
  template <int width, class F>
  [[gnu::always_inline]] void give_sums(const Nodes<width>& nodes, int n, F&& give) const {
    unrolled<D == 3 ? count : 1>([&](auto z) MPM_INLINE {
      // From 0 and not from the nodes: one addition to memory for a cell, and the same sums
      // whatever other cells have given.
      Half sums[count][count];
      for (auto& row_sums : sums)
        for (auto& sum : row_sums) sum = Half(0.0);
      for (int k = 0; k < n; ++k)
        unrolled<count>([&](auto y) MPM_INLINE {
          unrolled<count>([&](auto x) MPM_INLINE { give(k, x, y, z, sums[y][x]); });
        });
      // Neighbouring cells share nodes: their sums are added in the order of the cells.
      unrolled<count>([&](auto y) MPM_INLINE {
        unrolled<count>([&](auto x) MPM_INLINE { add(nodes[stride_.to(x, y, z)], sums[y][x]); });
      });
    });
  }
  static void add(double* to, Half part) { (Half::load(to) + part).store(to); }

  NodeStrides<D> stride_;
};

}  // namespace mpm
