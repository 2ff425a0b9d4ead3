#pragma once
// What a particle gives to one node, by a thread that has the node: the formulas of the mappings
// (step/transfer) with the arithmetic of the host's schedules, to the same bits.
#include "mpm/basis/axis_weights.hpp"
#include "mpm/device/cuda/views.cuh"
#include "mpm/schedule/record_arithmetic.hpp"
#include "mpm/schedule/weights.hpp"
#include "mpm/step/transfer/mapping.hpp"

namespace mpm {

/// What is scattered (schedule/payload.hpp).
enum DeviceGives : unsigned { gives_mass = 1, gives_momentum = 2, gives_forces = 4 };

/// -V_p (sigma_p - q_p 1 + s_p) / h of eq. (9), as ParticleReader makes it.
template <int D>
__device__ Sym<double, D> traction_of(const ParticleView<D>& of, std::uint32_t row,
                                      double minus_per_cell_size) {
  const double scale = minus_per_cell_size * of.volume[row];
  Sym<double, D> t;
  for (int c = 0; c < Sym<double, D>::size; ++c) t.c[c] = of.stress[c][row];
  if (of.q != nullptr)
    for (int c = 0; c < D; ++c) t.c[c] = t.c[c] - of.q[row];
  if (of.damping[0] != nullptr)
    for (int c = 0; c < Sym<double, D>::size; ++c) t.c[c] = t.c[c] + of.damping[c][row];
  for (int c = 0; c < Sym<double, D>::size; ++c) t.c[c] = scale * t.c[c];
  return t;
}

/// For a basis of two nodes along an axis (schedule/nodes_in_lanes.hpp).
template <class Transfer, unsigned what, int D>
class TwoNodes {
 public:
  static constexpr int staged = 0;  // its functions are made at once

  template <class B>
  __device__ void add(const B&, const Vec<double, D>& xi, const Index<D>& at,
                      const ParticleView<D>& of, std::uint32_t row, double minus_per_cell_size) {
    double N[D], slope[D];
    for (int a = 0; a < D; ++a) {
      slope[a] = at[a] != 0 ? 1.0 : -1.0;
      N[a] = fma(slope[a], xi[a], at[a] != 0 ? 0.0 : 1.0);
    }
    if constexpr ((what & gives_momentum) != 0) {
      double all = N[0];
      for (int a = 1; a < D; ++a) all = all * N[a];
      Particle p{of.mass[row], {}, {}};
      for (int a = 0; a < D; ++a) p.v.c[a] = of.v[a][row];
      Mapping<Transfer>::give_momentum(p, all, *this);
    }
    if constexpr ((what & gives_forces) != 0) {
      Particle p{0.0, {}, {traction_of(of, row, minus_per_cell_size)}};
      Gradient gradient;
      for (int a = 0; a < D; ++a) {
        gradient.along[a] = slope[a];
        for (int b = 0; b < D; ++b)
          if (b != a) gradient.along[a] = gradient.along[a] * N[b];
      }
      Mapping<Transfer>::give_force(p, gradient, *this);
    }
  }
  /// Mass and momentum, or momentum alone; the force.
  __device__ HalfRecord first() const {
    const double z = D == 3 ? p.c[D - 1] : 0.0;
    if constexpr ((what & gives_mass) != 0) return {m.sum, p.c[0], p.c[1], z};
    return {p.c[0], p.c[1], z, 0.0};
  }
  __device__ HalfRecord second() const { return {f.c[0], f.c[1], D == 3 ? f.c[D - 1] : 0.0, 0.0}; }

  // Products with vectors are noted, so that they are carried out with the sum, rounded once.
  struct Velocity {
    double c[D];
  };
  struct Momentum {
    double m;
    const Velocity& v;
  };
  struct Traction {
    Sym<double, D> t;
  };
  struct Gradient {
    double along[D];
  };
  struct Force {
    const Traction& traction;
    const Gradient& gradient;
  };
  struct Particle {
    double m;
    Velocity v;
    Traction traction;
  };
  friend __device__ Momentum operator*(double m, const Velocity& v) { return {m, v}; }
  friend __device__ Force operator*(const Traction& t, const Gradient& g) { return {t, g}; }
  struct MassSum {
    double sum = 0.0;
    __device__ void operator+=(double part) { sum = sum + part; }
  };
  struct VectorSum {
    double c[D] = {};
    __device__ void operator+=(const Momentum& p) {
      for (int a = 0; a < D; ++a) c[a] = fma(p.v.c[a], p.m, c[a]);
    }
    __device__ void operator+=(const Force& p) {
      for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) c[a] = fma(p.traction.t(a, b), p.gradient.along[b], c[a]);
    }
  };
  MassSum m;
  VectorSum p, f;
};

/// For a basis of three nodes along an axis (schedule/records_in_lanes.hpp). What a particle has is
/// found once and staged, number by number, for all the nodes that it reaches.
template <class Transfer, unsigned what, int D>
class ThreeNodes {
  static constexpr bool momentum = (what & gives_momentum) != 0,
                        forces = (what & gives_forces) != 0;
  static constexpr bool affine = momentum && Transfer::affine;
  // Places of what is staged: functions, first moments, m (1, v), m C h or m and v; derivatives,
  // traction.
  static constexpr int count = 3, functions = 0, moments = functions + D * count,
                       mass = moments + (affine ? D * count : 0),
                       velocity = mass + (momentum ? 1 : 0),
                       columns = velocity + (momentum ? D : 0),
                       derivatives = columns + (affine ? D * D : 0),
                       traction = derivatives + (forces ? D * count : 0);

 public:
  static constexpr int staged = traction + (forces ? Sym<double, D>::size : 0);
  /// From one number of the staged particles to the next: threads that read three of them at once
  /// shall find them in different banks.
  static constexpr int at_once = 8, stride = at_once + 1;

  template <class B>
  static __device__ void stage(double* to, const B& basis, const Vec<double, D>& xi,
                               const ParticleView<D>& of, std::uint32_t row,
                               double minus_per_cell_size) {
    static_assert(B::nodes == count);
    const Weights<double, D, count> w = weights_at(basis, xi);
    const auto put_axes = [&](int place, auto&& number) {
      unrolled<D>([&](auto a) {
        unrolled<count>([&](auto k) { to[(place + count * a + k) * stride] = number(a, k); });
      });
    };
    put_axes(functions, [&](auto a, auto k) { return w.axis[a].N[k]; });
    if constexpr (momentum) {
      const double m = of.mass[row];
      to[mass * stride] = m;
      for (int a = 0; a < D; ++a)
        to[(velocity + a) * stride] = affine ? m * of.v[a][row] : of.v[a][row];
      if constexpr (affine) {
        const Moments<double, D, count> M = moments_at<B>(xi, w);
        put_axes(moments, [&](auto a, auto k) { return M.axis[a][k]; });
        for (int k = 0; k < D * D; ++k)
          to[(columns + k) * stride] = m * (of.cell_size * of.affine[k][row]);
      }
    }
    if constexpr (forces) {
      put_axes(derivatives, [&](auto a, auto k) { return w.axis[a].dN[k]; });
      const Sym<double, D> t = traction_of(of, row, minus_per_cell_size);
      for (int c = 0; c < Sym<double, D>::size; ++c) to[(traction + c) * stride] = t.c[c];
    }
  }

  /// What a staged particle gives to the node that is `at` among those that it reaches.
  __device__ void add(const double* from, const Index<D>& at) {
    using namespace records_in_lanes;
    const auto get = [&](int place) { return from[place * stride]; };
    const auto along = [&](int place, int a) { return get(place + count * a + at[a]); };
    const Function<D> N{D == 3 ? along(functions, D - 1) : 1.0, along(functions, 1),
                        along(functions, 0)};
    NodeSum node{{}, {p_}, {f_}};
    if constexpr (momentum) {
      const double m = get(mass);
      double v[3] = {0.0, 0.0, 0.0};
      for (int a = 0; a < D; ++a) v[a] = get(velocity + a);
      if constexpr (affine) {
        AffineMomentum<D> p{m, half(m, v), {}};
        for (int b = 0; b < D; ++b) {
          double column[3] = {0.0, 0.0, 0.0};
          for (int a = 0; a < D; ++a) column[a] = get(columns + D * a + b);
          p.mC.column[b] = half(0.0, column);
        }
        const records_in_lanes::Gradient<D> M{N.z,
                                              N.y,
                                              N.x,
                                              D == 3 ? along(moments, D - 1) : 0.0,
                                              along(moments, 1),
                                              along(moments, 0)};
        Mapping<Transfer>::give_momentum(p, N, M, node);
      } else {
        const Momentum p{m, half(1.0, v)};
        Mapping<Transfer>::give_momentum(p, N, node);
      }
    }
    if constexpr (forces) {
      Sym<double, D> t;
      for (int c = 0; c < Sym<double, D>::size; ++c) t.c[c] = get(traction + c);
      Stress<D> p;
      for (int b = 0; b < D; ++b)
        p.traction.column[b] = Half(t(0, b), t(1, b), D == 3 ? t(D - 1, b) : 0.0, 0.0);
      const records_in_lanes::Gradient<D> gradient{N.z,
                                                   N.y,
                                                   N.x,
                                                   D == 3 ? along(derivatives, D - 1) : 0.0,
                                                   along(derivatives, 1),
                                                   along(derivatives, 0)};
      Mapping<Transfer>::give_force(p, gradient, node);
    }
  }
  __device__ HalfRecord first() const { return {p_.c[0], p_.c[1], p_.c[2], p_.c[3]}; }
  __device__ HalfRecord second() const { return {f_.c[0], f_.c[1], f_.c[2], f_.c[3]}; }

 private:
  /// As half a record has them: with the mass before the momentum, or momentum alone.
  static __device__ FourNumbers half(double first, const double* v) {
    if constexpr ((what & gives_mass) != 0) return {first, v[0], v[1], v[2]};
    return {v[0], v[1], v[2], 0.0};
  }

  FourNumbers p_{0.0}, f_{0.0};
};

}  // namespace mpm
