#pragma once
// Forces of a cell with a lattice of 2^D particles, axis by axis. Of such a lattice the weights
// along an axis are two sets for all particles, so that sums along z serve both columns of
// particles along y and x, and those along y both along x: 36 multiply-adds a particle in 3D in
// place of 54 and 36 products (decision 0073). Where nodes lie in the body a lattice is one for
// ever.
#include "mpm/layout/node_records.hpp"
#include "mpm/math/batch.hpp"
#include "mpm/math/unrolled.hpp"

namespace mpm {

/// From a particle of a lattice to the next along an axis: the last is fastest, as they are filled.
template <int D>
constexpr int along_lattice(int axis) {
  return 1 << (D - 1 - axis);
}

/// Weights of 2^D particles along an axis: are they two sets, one for particles low on it, one for
/// those high?
template <int D, int count, int room>
bool is_lattice_along(int axis, const double (&N)[count][room]) {
  bool same = true;
  // Two functions tell where a particle is, of GIMP as well.
  for (const int k : {0, count - 1})
    for (int p = 0; p < 1 << D; ++p) same &= N[k][p] == N[k][p & along_lattice<D>(axis)];
  return same;
}
template <int D, class Places>
bool is_lattice(const Places& places) {
  bool same = true;
  unrolled<D>([&](auto a) { same &= is_lattice_along<D>(a, places.N[a]); });
  return same;
}

/// give(x, y, z, sum) for the nodes in reach of a cell's lattice, of the tractions of its
/// particles.
template <int D, int count, class Places, class Payload, class F>
[[gnu::always_inline]] inline void sum_lattice(const Places& places, const Payload& payload,
                                               F&& give) {
  using Half = Batch<half_record>;
  const auto traction = [&](int b, int p) MPM_INLINE { return Half::load(payload.traction[b][p]); };
  const auto by = [](double factor, const Half& x) MPM_INLINE { return Half(factor) * x; };
  const auto more = [](double factor, const Half& x, const Half& sum)
                        MPM_INLINE { return fma(Half(factor), x, sum); };
  constexpr int dx = along_lattice<D>(0), dy = along_lattice<D>(1), dz = along_lattice<D>(D - 1);
  // t . grad N = along dN_x + across N_x, with along = t_x N_y N_z and
  // across = (t_y dN_y N_z + t_z N_y dN_z), of columns of particles low and high on x.
  unrolled<D == 3 ? count : 1>([&](auto z) MPM_INLINE {
    Half along[2][count], across[2][count];
    unrolled<2>([&](auto px) MPM_INLINE {
      Half t[3][2];
      unrolled<2>([&](auto py) MPM_INLINE {
        constexpr int low = px * dx + py * dy, high = low + dz;
        if constexpr (D == 3) {
          const auto &N = places.N[D - 1][z], &dN = places.dN[D - 1][z];
          unrolled<2>([&](auto b) MPM_INLINE {
            t[b][py] = more(N[dz], traction(b, high), by(N[0], traction(b, low)));
          });
          t[2][py] = more(dN[dz], traction(2, high), by(dN[0], traction(2, low)));
        } else {
          unrolled<2>([&](auto b) MPM_INLINE { t[b][py] = traction(b, low); });
        }
      });
      unrolled<count>([&](auto y) MPM_INLINE {
        const auto &N = places.N[1][y], &dN = places.dN[1][y];
        along[px][y] = more(N[dy], t[0][1], by(N[0], t[0][0]));
        across[px][y] = more(dN[dy], t[1][1], by(dN[0], t[1][0]));
        if constexpr (D == 3)
          across[px][y] = more(N[dy], t[2][1], more(N[0], t[2][0], across[px][y]));
      });
    });
    unrolled<count>([&](auto y) MPM_INLINE {
      unrolled<count>([&](auto x) MPM_INLINE {
        const auto &N = places.N[0][x], &dN = places.dN[0][x];
        const Half of_low = more(N[0], across[0][y], by(dN[0], along[0][y]));
        give(x, y, z, more(N[dx], across[1][y], more(dN[dx], along[1][y], of_low)));
      });
    });
  });
}

}  // namespace mpm
