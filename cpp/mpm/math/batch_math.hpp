#pragma once
// Elementary functions on lanes, free of branches. Accuracy is stated beside each and tested.
#include <cstring>

#include "mpm/math/batch.hpp"

namespace mpm {

/// The polynomial with these coefficients, the constant one first.
template <int W, class... Rest>
Batch<W> horner(Batch<W> x, double first, Rest... rest) {
  if constexpr (sizeof...(rest) == 0)
    return Batch<W>(first);
  else
    return fma(x, horner(x, rest...), Batch<W>(first));
}

/// Natural logarithm of positive, finite, normal lanes, within 1 ulp: x = 2^k (1 + f), and the
/// minimax series of log(1 + f) in s = f / (2 + f) of Sun's fdlibm (e_log.c, 1993).
template <int W>
Batch<W> log(Batch<W> x) {
  using Bits = typename Mask<W>::Vector;
  Bits bits;
  std::memcpy(&bits, &x.v, sizeof(bits));
  // Shift the mantissa's range to sqrt(1/2) .. sqrt(2), so that f stays small on both sides of one.
  const Bits sqrt_half = Bits{} + 0x3fe6a09e667f3bcdLL;
  const Bits exponent = (bits - sqrt_half) >> 52;
  const Bits mantissa = bits - (exponent << 52);
  Batch<W> m;
  std::memcpy(&m.v, &mantissa, sizeof(mantissa));
  // An integer k below 2^51 becomes a double through the bits of 1.5 x 2^52: no conversion
  // instruction is needed.
  const Bits magic = exponent + 0x4338000000000000LL;
  Batch<W> k;
  std::memcpy(&k.v, &magic, sizeof(magic));
  k = k - Batch<W>(6755399441055744.0);

  const Batch<W> f = m - Batch<W>(1.0);
  const Batch<W> s = f / (Batch<W>(2.0) + f);
  const Batch<W> z = s * s;
  const Batch<W> w = z * z;
  const Batch<W> even =
      w * horner(w, 3.999999999940941908e-01, 2.222219843214978396e-01, 1.531383769920937332e-01);
  const Batch<W> odd = z * horner(w, 6.666666666666735130e-01, 2.857142874366239149e-01,
                                  1.818357216161805012e-01, 1.479819860511658591e-01);
  // k ln 2 in two parts, as in fdlibm: k times the upper one is exact, as its last 21 bits are 0.
  const Batch<W> half_square = Batch<W>(0.5) * f * f;
  const Batch<W> rest =
      half_square - fma(s, half_square + even + odd, k * Batch<W>(1.90821492927058770002e-10));
  return fma(k, Batch<W>(6.93147180369123816490e-01), f - rest);
}

/// Exponential of lanes between -708 and 709 (beyond them, of these), within 2 ulp: x = k ln 2 + r,
/// Taylor's series of exp(r) to r^13 for |r| <= ln(2)/2 (remainder 4e-18), and 2^k by its bits.
template <int W>
Batch<W> exp(Batch<W> x) {
  using Bits = typename Mask<W>::Vector;
  // So that 2^k is a normal number whose exponent fits: -1021 <= k <= 1023.
  const Batch<W> bounded = min(max(x, Batch<W>(-708.0)), Batch<W>(709.0));
  // Adding 1.5 x 2^52 rounds to a whole number and leaves it in the low bits.
  const Batch<W> magic(6755399441055744.0);
  const Batch<W> shifted = fma(bounded, Batch<W>(1.44269504088896338700), magic);
  const Batch<W> k = shifted - magic;
  // ln 2 in the same two parts as in log.
  const Batch<W> r = fma(k, Batch<W>(-1.90821492927058770002e-10),
                         fma(k, Batch<W>(-6.93147180369123816490e-01), bounded));
  // Pairs and powers of r^2 (Estrin's scheme): a product need not wait for the one before.
  const Batch<W> r2 = r * r, r4 = r2 * r2;
  const Batch<W> a = horner(r, 1.0 / 2.0, 1.0 / 6.0);
  const Batch<W> b = horner(r, 1.0 / 24.0, 1.0 / 120.0);
  const Batch<W> c = horner(r, 1.0 / 720.0, 1.0 / 5040.0);
  const Batch<W> d = horner(r, 1.0 / 40320.0, 1.0 / 362880.0);
  const Batch<W> e = horner(r, 1.0 / 3628800.0, 1.0 / 39916800.0);
  const Batch<W> f = horner(r, 1.0 / 479001600.0, 1.0 / 6227020800.0);
  const Batch<W> high = fma(r4, fma(r2, f, e), fma(r2, d, c));
  const Batch<W> series = fma(r2, fma(r4, high, fma(r2, b, a)), r);
  Bits bits;
  std::memcpy(&bits, &shifted.v, sizeof(bits));
  bits = (bits << 52) + (Bits{} + 0x3ff0000000000000LL);  // 2^k; the shift drops the magic's bits
  Batch<W> scale;
  std::memcpy(&scale.v, &bits, sizeof(bits));
  return fma(scale, series, scale);
}

/// x to the power y for positive, finite, normal x: exp(y log x), within 2 + 2 |y log x| ulp.
template <int W>
Batch<W> pow(Batch<W> x, Batch<W> y) {
  return exp(y * log(x));
}

}  // namespace mpm
