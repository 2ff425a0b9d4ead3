#pragma once
// Elementary functions of a number, free of branches: of lanes, and of a device's double, which so
// has their bits. Accuracy is stated beside each and tested.
#include <cstdint>
#include <cstring>

#include "mpm/math/double_math.hpp"

namespace mpm {

/// A number's bits as whole numbers, and back.
template <class T>
struct NumberBits;
template <>
struct NumberBits<double> {
  using Whole = std::int64_t;
  MPM_HD static Whole of(double x) {
    Whole bits;
    std::memcpy(&bits, &x, sizeof(bits));
    return bits;
  }
  MPM_HD static double number(Whole bits) {
    double x;
    std::memcpy(&x, &bits, sizeof(x));
    return x;
  }
};

/// The polynomial with these coefficients, the constant one first.
template <class T, class... Rest>
MPM_HD T horner(T x, double first, Rest... rest) {
  if constexpr (sizeof...(rest) == 0)
    return T(first);
  else
    return fma(x, horner(x, rest...), T(first));
}

/// Natural logarithm of a positive, finite, normal number, within 1 ulp: x = 2^k (1 + f), and the
/// minimax series of log(1 + f) in s = f / (2 + f) of Sun's fdlibm (e_log.c, 1993).
template <class T>
MPM_HD T log_by_series(T x) {
  using Bits = NumberBits<T>;
  using Whole = typename Bits::Whole;
  const Whole bits = Bits::of(x);
  // Shift the mantissa's range to sqrt(1/2) .. sqrt(2), so that f stays small on both sides of one.
  const Whole sqrt_half = Whole{} + 0x3fe6a09e667f3bcdLL;
  const Whole exponent = (bits - sqrt_half) >> 52;
  const T m = Bits::number(bits - (exponent << 52));
  // An integer k below 2^51 becomes a double through the bits of 1.5 x 2^52: no conversion
  // instruction is needed.
  const T k = Bits::number(exponent + 0x4338000000000000LL) - T(6755399441055744.0);

  const T f = m - T(1.0);
  const T s = f / (T(2.0) + f);
  const T z = s * s;
  const T w = z * z;
  const T even =
      w * horner(w, 3.999999999940941908e-01, 2.222219843214978396e-01, 1.531383769920937332e-01);
  const T odd = z * horner(w, 6.666666666666735130e-01, 2.857142874366239149e-01,
                           1.818357216161805012e-01, 1.479819860511658591e-01);
  // k ln 2 in two parts, as in fdlibm: k times the upper one is exact, as its last 21 bits are 0.
  const T half_square = T(0.5) * f * f;
  const T rest = half_square - fma(s, half_square + even + odd, k * T(1.90821492927058770002e-10));
  return fma(k, T(6.93147180369123816490e-01), f - rest);
}

/// Exponential of a number between -708 and 709 (beyond them, of these), within 2 ulp: x = k ln 2 +
/// r, Taylor's series of exp(r) to r^13 for |r| <= ln(2)/2 (remainder 4e-18), and 2^k by its bits.
template <class T>
MPM_HD T exp_by_series(T x) {
  using Bits = NumberBits<T>;
  using Whole = typename Bits::Whole;
  // So that 2^k is a normal number whose exponent fits: -1021 <= k <= 1023.
  const T bounded = min(max(x, T(-708.0)), T(709.0));
  // Adding 1.5 x 2^52 rounds to a whole number and leaves it in the low bits.
  const T magic(6755399441055744.0);
  const T shifted = fma(bounded, T(1.44269504088896338700), magic);
  const T k = shifted - magic;
  // ln 2 in the same two parts as in log.
  const T r =
      fma(k, T(-1.90821492927058770002e-10), fma(k, T(-6.93147180369123816490e-01), bounded));
  // Pairs and powers of r^2 (Estrin's scheme): a product need not wait for the one before.
  const T r2 = r * r, r4 = r2 * r2;
  const T a = horner(r, 1.0 / 2.0, 1.0 / 6.0);
  const T b = horner(r, 1.0 / 24.0, 1.0 / 120.0);
  const T c = horner(r, 1.0 / 720.0, 1.0 / 5040.0);
  const T d = horner(r, 1.0 / 40320.0, 1.0 / 362880.0);
  const T e = horner(r, 1.0 / 3628800.0, 1.0 / 39916800.0);
  const T f = horner(r, 1.0 / 479001600.0, 1.0 / 6227020800.0);
  const T high = fma(r4, fma(r2, f, e), fma(r2, d, c));
  const T series = fma(r2, fma(r4, high, fma(r2, b, a)), r);
  // 2^k; the shift drops the magic's bits.
  const Whole power = (Bits::of(shifted) << 52) + (Whole{} + 0x3ff0000000000000LL);
  const T scale = Bits::number(power);
  return fma(scale, series, scale);
}

/// x to the power y for positive, finite, normal x: exp(y log x), within 2 + 2 |y log x| ulp.
template <class T>
MPM_HD T pow_by_series(T x, T y) {
  return exp_by_series(y * log_by_series(x));
}

}  // namespace mpm
