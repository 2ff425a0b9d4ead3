#pragma once
#include <cstdint>

#include "mpm/math/tensor.hpp"
#include "mpm/math/unrolled.hpp"
#include "mpm/step/transfer/flip.hpp"

namespace mpm {

/// APIC: particles take the velocity of the grid as PIC does, and beside it its affine part, C_p,
/// so that turning and shearing are kept: angular momentum is, to rounding. For a basis whose
/// second moment D is the same everywhere.
struct Apic : Flip {
  static constexpr std::string_view name = "apic";
  static constexpr std::string_view doc =
      "they take the velocity of the grid and its affine part, which keeps angular momentum";
  static constexpr std::string_view source = "Jiang et al. 2015";
  static constexpr bool takes_grid_velocity = true, affine = true, has_share = false;
  using Gives = Apic;

  /// From particle p to node i: m_i += m_p N_ip, eq. (2); p_i += N_ip m_p (v_p + C_p (x_i - x_p)),
  /// with the first moment M_ip = N_ip (x_i - x_p).
  template <class P, class N, class M, class Node>
  MPM_HD MPM_INLINE static void give(const P& p, const N& N_ip, const M& M_ip, Node& node) {
    node.m += p.m * N_ip;
    node.p += p.mv * N_ip + p.mC * M_ip;
  }

  /// A component of v_p after the step: v_p = sum v_i N_ip, of which `of_grid` is the sum.
  template <class T>
  MPM_HD MPM_INLINE T take(T, T, T of_grid) const {
    return of_grid;
  }
};

/// dt^2 C:C / D up to which a C_p that closes is carried along whole; from twice that on all of
/// `closing_part` is left out. Below, it would take hundreds of steps to close, and its velocities
/// are a hundredth of that of waves.
inline constexpr double closing_from = 1e-5;

/// What `carried_along` leaves out where S, the symmetric part of C_p, closes (S : S S < 0): the
/// part of S S along S, S (S : S S) / (S : S). Of S S that part alone changes C : C. It would make
/// energy, as the inertia of C_p does not lessen with the axis that closes: with its volume kept
/// debris that is flattened, (-2, 1, 1) a, would be infinitely fast at the time 1/a.
template <class T, int D>
MPM_HD MPM_INLINE inline Sym<T, D> closing_part(const Mat<T, D>& C, T x2) {
  const Sym<T, D> S = symmetric_part(C);
  T cube(0.0);
  unrolled<D * D>([&](auto k) MPM_INLINE {
    constexpr int a = k / D, b = k % D;
    if constexpr (a <= b) {
      T both(0.0);
      unrolled<D>([&](auto c) MPM_INLINE { both = fma(S(a, c), S(c, b), both); });
      cube = fma(a == b ? S(a, b) : T(2.0) * S(a, b), both, cube);
    }
  });
  const T share = min(max(fma(T(1.0 / closing_from), x2, T(-1.0)), T(0.0)), T(1.0));
  return share * (min(cube, T(0.0)) / max(inner(S, S), T(1e-200))) * S;
}

/// May what closes close faster, as it would by itself?
enum class Closing : std::uint8_t { no_faster, as_it_would };

/// C_p when the particle has moved: C' = C - dt/2 (C C + (C C)^T). The field of velocities that C_p
/// describes goes with its matter: with F = 1 + dt C its gradient becomes C F^-1 = C - dt C C, of
/// which the symmetric part is taken, so that the angular momentum m_p D ax C_p stays. Without it
/// what turns or expands keeps a C_p of the place where it was.
/// The series is good only for small dt |C|: a factor (1 - x^4)_+, x^2 = dt^2 C:C / D, takes the
/// correction away before that, and beyond x = 1 C_p stays.
/// What closes does not close faster (`closing_part`), but for a gas: with its heat it pays for
/// what C_p gains (step/flowing_matter.hpp).
template <class T, int D>
MPM_HD MPM_INLINE inline Mat<T, D> carried_along(const Mat<T, D>& C, T dt, Closing closes) {
  Mat<T, D> now = C;
  T square(0.0);
  unrolled<D * D>([&](auto k)
                      MPM_INLINE { square = fma(C[k / D][k % D], C[k / D][k % D], square); });
  const T x2 = T(1.0 / D) * dt * dt * square;
  const T part = dt * max(fma(-x2, x2, T(1.0)), T(0.0)), half = T(-0.5) * part;
  unrolled<D>([&](auto a) MPM_INLINE {
    unrolled<D>([&](auto b) MPM_INLINE {
      if constexpr (a <= b) {
        T both(0.0);
        unrolled<D>([&](auto c)
                        MPM_INLINE { both = fma(C[a][c], C[c][b], fma(C[b][c], C[c][a], both)); });
        now[a][b] = fma(half, both, C[a][b]);
        if constexpr (a != b) now[b][a] = fma(half, both, C[b][a]);
      }
    });
  });
  if (closes == Closing::no_faster && any(x2 > T(closing_from))) [[unlikely]] {
    const Sym<T, D> closing = closing_part<T, D>(C, x2);
    unrolled<D * D>([&](auto k) MPM_INLINE {
      constexpr int a = k / D, b = k % D;
      now[a][b] = fma(part, closing(a, b), now[a][b]);
    });
  }
  return now;
}

/// C : C - C' : C'; m_p D / 2 times that is the kinetic energy which C_p loses as it becomes C'.
template <class T, int D>
MPM_HD MPM_INLINE inline T square_difference(const Mat<T, D>& before, const Mat<T, D>& after) {
  T difference(0.0);
  unrolled<D * D>([&](auto k) MPM_INLINE {
    const T b = before[k / D][k % D], a = after[k / D][k % D];
    difference = fma(b - a, b + a, difference);
  });
  return difference;
}

}  // namespace mpm
