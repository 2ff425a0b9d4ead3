#pragma once
// What becomes of a mapping's formulas where the four numbers of half a node's record are taken at
// once: by the schedule of the host (records_in_lanes.hpp) and by a device's threads.
#include "mpm/layout/node_records.hpp"
#include "mpm/math/four_numbers.hpp"
#include "mpm/math/unrolled.hpp"

namespace mpm {

/// Arithmetic of a mapping's formulas: p.v and the columns of p.traction are halves of records,
/// N_ip and its gradient are factors along the axes. What does not change along a row of nodes, or
/// in a layer of them, is one expression there, which the compiler evaluates once. So a vector
/// takes 3 products for layers, 9 for rows and 27 multiply-adds in 3D (decision 0018). Axes are
/// multiplied in from z to x, as the loops nest.
namespace records_in_lanes {
#if defined(__CUDACC__)
using Half = FourNumbers;
#else
using Half = Batch<half_record>;
#endif

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
MPM_HD MPM_INLINE inline Function<D> operator*(double m, const Function<D>& N) {
  return {D == 3 ? m * N.z : m, N.y, N.x};
}
template <int D>
MPM_HD MPM_INLINE inline Scaled operator*(const Function<D>& scale, const Half& v) {
  // In this order, so that the first product is one for the layer and the second one for the row.
  return {(scale.z * v) * scale.y, scale.x};
}
template <int D>
MPM_HD MPM_INLINE inline Force operator*(const Tensor<D>& t, const Gradient<D>& N) {
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
MPM_HD MPM_INLINE inline Product<D> operator*(const Half& v, const Function<D>& N) {
  return {v, N};
}
template <int D>
MPM_HD MPM_INLINE inline Force operator+(const Product<D>& p, const Force& f) {
  const Half in_layer = D == 3 ? p.v * Half(p.N.z) : p.v;
  return {f.along, fma(in_layer, Half(p.N.y), f.across), f.x, f.dx};
}
/// The half record of a node, while particles are summed.
struct HalfSum {
  Half& sum;
  MPM_HD MPM_INLINE void operator+=(const Scaled& p) { sum = fma(p.part, Half(p.x), sum); }
  // Two multiply-adds a node whatever D is; the order of the two is part of the bits.
  MPM_HD MPM_INLINE void operator+=(const Force& p) {
    sum = fma(p.along, Half(p.dx), sum);
    sum = fma(p.across, Half(p.x), sum);
  }
};
/// The mass is a number of the half record beside the momentum: its own formula has nothing left to
/// do.
struct WithMomentum {
  template <class T>
  MPM_HD void operator+=(const T&) {}
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

}  // namespace mpm
