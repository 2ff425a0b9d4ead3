#pragma once
// Scatter with the four numbers of half a node's record in the lanes, for any basis: particles
// follow each other in the order of their numbers, and the sums of a layer of nodes stay in
// registers. No lane is idle for want of particles (decision 0018).
#include "mpm/schedule/lattice_in_lanes.hpp"
#include "mpm/schedule/payload.hpp"
#include "mpm/schedule/record_arithmetic.hpp"
#include "mpm/schedule/weights.hpp"

namespace mpm {

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
    if constexpr (what == gives_forces && requires { Mapping::finds_lattices; })
      if (n == 1 << D && is_lattice<D>(places)) {
        const Nodes<width> forces = nodes.at(force_at);
        sum_lattice<D, count>(places, payload,
                              [&](int x, int y, int z, const Half& sum)
                                  MPM_INLINE { add(forces[stride_.to(x, y, z)], sum); });
        return;
      }
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
