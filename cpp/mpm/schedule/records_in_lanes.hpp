#pragma once
// Scatter with the four numbers of half a node's record in the lanes, for any basis: particles
// follow each other, and the sums of a layer of nodes stay in registers.
#include "mpm/schedule/payload.hpp"
#include "mpm/schedule/weights.hpp"

namespace mpm {

template <int D, int count>
class RecordsInLanes {
 public:
  template <int room>
  using Payload = PayloadRecords<D, room>;
  /// What is to be known of a cell's particles: their weights; derivatives for forces only.
  template <int room>
  struct Places {
    double N[D][count][room], dN[D][count][room];
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

  explicit RecordsInLanes(const NodeStrides<D>& stride) : stride_(stride) {}

  /// What the first `n` of these particles give to the nodes, whose records begin at the first in
  /// reach: mass and momentum to the first half, forces to the second; momentum alone to the first.
  template <unsigned what, int width, int room>
  void give(const Nodes<width>& nodes, const Places<room>& places, const Payload<room>& payload,
            int n) const {
    if constexpr (what != gives_forces)
      give_sums(nodes, n, [&](int p, auto z, auto&& to) MPM_INLINE {
        give_momentum(places, payload, p, z, to);
      });
    if constexpr ((what & gives_forces) != 0)
      give_sums(nodes.at(force_at), n, [&](int p, auto z, auto&& to) MPM_INLINE {
        give_forces(places, payload, p, z, to);
      });
  }

 private:
  using Half = Batch<half_record>;

  /// Layer by layer: give(p, z, to) calls to(y, f(sum, x)), which adds to the sum of node x of row
  /// y what particle p gives.
  template <int width, class F>
  [[gnu::always_inline]] void give_sums(const Nodes<width>& nodes, int n, F&& give) const {
    unrolled<D == 3 ? count : 1>([&](auto z) MPM_INLINE {
      Half sums[count][count];
      for (auto& row_sums : sums)
        for (auto& sum : row_sums) sum = Half(0.0);
      for (int p = 0; p < n; ++p)
        give(p, z, [&](auto y, auto&& add_part) MPM_INLINE {
          unrolled<count>([&](auto x) MPM_INLINE { add_part(sums[y][x], x); });
        });
      unrolled<count>([&](auto y) MPM_INLINE {
        unrolled<count>([&](auto x) MPM_INLINE { add(nodes[stride_.to(x, y, z)], sums[y][x]); });
      });
    });
  }
  /// m_i += m_p N_ip, eq. (2); p_i += m_p N_ip v_p, eq. (3).
  template <int room, class F>
  [[gnu::always_inline]] static void give_momentum(const Places<room>& of,
                                                   const Payload<room>& payload, int p, auto z,
                                                   F&& to) {
    const double m = D == 3 ? payload.mass[p] * of.N[D - 1][z][p] : payload.mass[p];
    const Half given = m * Half::load(payload.velocity[p]);
    unrolled<count>([&](auto y) MPM_INLINE {
      const Half part = given * of.N[1][y][p];
      to(y, [&](Half& sum, auto x) MPM_INLINE { sum = fma(part, Half(of.N[0][x][p]), sum); });
    });
  }
  /// f_i -= V_p (sigma_p - q_p 1) . grad N_ip, eq. (9), with the artificial viscosity's pressure q.
  template <int room, class F>
  [[gnu::always_inline]] static void give_forces(const Places<room>& of,
                                                 const Payload<room>& payload, int p, auto z,
                                                 F&& to) {
    Half traction[D];
    unrolled<D>([&](auto b) MPM_INLINE {
      traction[b] = Half::load(payload.traction[b][p]);
      if constexpr (D == 3) traction[b] *= b == 2 ? of.dN[2][z][p] : of.N[2][z][p];
    });
    unrolled<count>([&](auto y) MPM_INLINE {
      const Half N(of.N[1][y][p]), along_x = traction[0] * N;
      Half across = traction[1] * of.dN[1][y][p];
      if constexpr (D == 3) across = fma(traction[2], N, across);
      to(y, [&](Half& sum, auto x) MPM_INLINE {
        sum = fma(along_x, Half(of.dN[0][x][p]), sum);
        sum = fma(across, Half(of.N[0][x][p]), sum);
      });
    });
  }
  static void add(double* to, Half part) { (Half::load(to) + part).store(to); }

  NodeStrides<D> stride_;
};

}  // namespace mpm
