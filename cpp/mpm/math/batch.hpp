#pragma once
// SIMD lanes: W doubles in one register, written like a scalar. The width follows the instruction
// set the file is compiled for.
#include <bit>
#include <cstdint>
#include <utility>
#if defined(__SSE2__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

#include "mpm/math/unrolled.hpp"

namespace mpm {

#if defined(__AVX512F__)
inline constexpr int native_lanes = 8;
#elif defined(__AVX__)
inline constexpr int native_lanes = 4;
#else
inline constexpr int native_lanes = 2;
#endif

/// The compiler's vector types of W numbers. Numbers in memory are read and written as `Unaligned`,
/// floats as `Floats`, and not by memcpy, after which the compiler must take all it knows from
/// memory anew.
template <int W>
struct Vectors;
template <>
struct Vectors<2> {
  typedef double Real __attribute__((vector_size(16)));
  typedef double Unaligned __attribute__((vector_size(16), aligned(8)));
  typedef float Floats __attribute__((vector_size(8), aligned(4)));
  typedef std::int64_t Bits __attribute__((vector_size(16)));
};
template <>
struct Vectors<4> {
  typedef double Real __attribute__((vector_size(32)));
  typedef double Unaligned __attribute__((vector_size(32), aligned(8)));
  typedef float Floats __attribute__((vector_size(16), aligned(4)));
  typedef std::int64_t Bits __attribute__((vector_size(32)));
};
template <>
struct Vectors<8> {
  typedef double Real __attribute__((vector_size(64)));
  typedef double Unaligned __attribute__((vector_size(64), aligned(8)));
  typedef float Floats __attribute__((vector_size(32), aligned(4)));
  typedef std::int64_t Bits __attribute__((vector_size(64)));
};

/// True or false in each of W lanes (all bits set or none).
template <int W>
struct Mask {
  using Vector = typename Vectors<W>::Bits;
  Vector v;
  friend Mask operator&(Mask a, Mask b) { return {a.v & b.v}; }
  friend Mask operator|(Mask a, Mask b) { return {a.v | b.v}; }
  friend Mask operator!(Mask a) { return {~a.v}; }
};

/// W doubles, with the arithmetic of one.
template <int W>
struct Batch {
  static constexpr int lanes = W;
  using Vector = typename Vectors<W>::Real;
  Vector v;

  Batch() = default;
  // Not left to the compiler: g++ copies what it takes for a plain struct in halves, which then
  // have to wait for each other where they are read whole.
  Batch(const Batch& other) : v(other.v) {}
  Batch& operator=(const Batch& other) {
    v = other.v;
    return *this;
  }
  Batch(double s)  // NOLINT: a number stands for itself in every lane
      : v(repeated(s, std::make_integer_sequence<int, W>{})) {}
  explicit Batch(Vector value) : v(value) {}

  static Batch load(const double* from) {
    return Batch(Vector(*reinterpret_cast<const typename Vectors<W>::Unaligned*>(from)));
  }
  void store(double* to) const { *reinterpret_cast<typename Vectors<W>::Unaligned*>(to) = v; }
  /// Floats become doubles, and doubles the nearest floats.
  static Batch load(const float* from) {
    return Batch(__builtin_convertvector(
        *reinterpret_cast<const typename Vectors<W>::Floats*>(from), Vector));
  }
  void store(float* to) const {
    using Floats = typename Vectors<W>::Floats;
    *reinterpret_cast<Floats*>(to) = __builtin_convertvector(v, Floats);
  }
  double operator[](int lane) const { return v[lane]; }

  friend Batch operator+(Batch a, Batch b) { return Batch(a.v + b.v); }
  friend Batch operator-(Batch a, Batch b) { return Batch(a.v - b.v); }
  friend Batch operator*(Batch a, Batch b) { return Batch(a.v * b.v); }
  friend Batch operator/(Batch a, Batch b) { return Batch(a.v / b.v); }
  friend Batch operator-(Batch a) { return Batch(-a.v); }
  /// a b + c
  friend Batch fma(Batch a, Batch b, Batch c) {
#if defined(MPM_FUSES)
#if defined(__AVX512F__)
    if constexpr (W == 8) return Batch(_mm512_fmadd_pd(a.v, b.v, c.v));
#endif
#if defined(__FMA__)
    if constexpr (W == 4) return Batch(_mm256_fmadd_pd(a.v, b.v, c.v));
    if constexpr (W == 2) return Batch(_mm_fmadd_pd(a.v, b.v, c.v));
#elif defined(__aarch64__)
    if constexpr (W == 2) return Batch(vfmaq_f64(c.v, a.v, b.v));
    Batch r;
    for (int k = 0; k < W; ++k) r.v[k] = __builtin_fma(a.v[k], b.v[k], c.v[k]);
    return r;
#endif
#endif
    return Batch(a.v * b.v + c.v);
  }
  Batch& operator+=(Batch b) { return *this = *this + b; }
  Batch& operator-=(Batch b) { return *this = *this - b; }
  Batch& operator*=(Batch b) { return *this = *this * b; }
  friend Mask<W> operator<(Batch a, Batch b) { return {a.v < b.v}; }
  friend Mask<W> operator>(Batch a, Batch b) { return {a.v > b.v}; }
  friend Mask<W> operator<=(Batch a, Batch b) { return {a.v <= b.v}; }
  friend Mask<W> operator>=(Batch a, Batch b) { return {a.v >= b.v}; }

 private:
  // Not 0 + s, which is an addition that the compiler must keep.
  template <int... k>
  static Vector repeated(double s, std::integer_sequence<int, k...>) {
    return Vector{(static_cast<void>(k), s)...};
  }
};

template <int W>
Batch<W> select(Mask<W> condition, Batch<W> yes, Batch<W> no) {
  return Batch<W>(condition.v ? yes.v : no.v);
}
// By their own instructions, which g++ 12 does not find; b if one of the two is NaN.
template <int W>
Batch<W> min(Batch<W> a, Batch<W> b) {
#if defined(__AVX512F__)
  if constexpr (W == 8) return Batch<W>(_mm512_mask_min_pd(a.v, __mmask8(0xff), a.v, b.v));
#endif
#if defined(__AVX__)
  if constexpr (W == 4) return Batch<W>(_mm256_min_pd(a.v, b.v));
#endif
#if defined(__SSE2__)
  if constexpr (W == 2) return Batch<W>(_mm_min_pd(a.v, b.v));
#endif
  return Batch<W>(a.v < b.v ? a.v : b.v);
}
template <int W>
Batch<W> max(Batch<W> a, Batch<W> b) {
#if defined(__AVX512F__)
  if constexpr (W == 8) return Batch<W>(_mm512_mask_max_pd(a.v, __mmask8(0xff), a.v, b.v));
#endif
#if defined(__AVX__)
  if constexpr (W == 4) return Batch<W>(_mm256_max_pd(a.v, b.v));
#endif
#if defined(__SSE2__)
  if constexpr (W == 2) return Batch<W>(_mm_max_pd(a.v, b.v));
#endif
  return Batch<W>(a.v > b.v ? a.v : b.v);
}

template <int W>
Batch<W> sqrt(Batch<W> a) {
#if defined(__AVX512F__)
  if constexpr (W == 8)  // all lanes by a mask: of the plain one g++ 12 warns wrongly
    return Batch<W>(_mm512_mask_sqrt_pd(a.v, __mmask8(0xff), a.v));
#endif
#if defined(__AVX__)
  if constexpr (W == 4) return Batch<W>(_mm256_sqrt_pd(a.v));
#endif
#if defined(__SSE2__)
  if constexpr (W == 2) return Batch<W>(_mm_sqrt_pd(a.v));
#endif
  Batch<W> r;
  for (int k = 0; k < W; ++k) r.v[k] = __builtin_sqrt(a.v[k]);
  return r;
}

template <int W>
Batch<W> absolute(Batch<W> a) {
  using Bits = typename Vectors<W>::Bits;
  constexpr std::int64_t all_but_sign = INT64_MAX;
  return Batch<W>(
      reinterpret_cast<typename Batch<W>::Vector>(reinterpret_cast<Bits>(a.v) & all_but_sign));
}

/// The largest whole number that is not above, for sizes below 2^51.
template <int W>
Batch<W> floor(Batch<W> a) {
  const Batch<W> magic(6755399441055744.0);  // 1.5 x 2^52: adding it rounds to a whole number
  const Batch<W> nearest = (a + magic) - magic;
  return nearest - select(nearest > a, Batch<W>(1.0), Batch<W>(0.0));
}

/// A bit for each lane, set where the condition holds.
template <int W>
std::uint64_t lane_bits(Mask<W> m) {
#if defined(__AVX512F__)
  if constexpr (W == 8) {
    const auto lanes = reinterpret_cast<__m512i>(m.v);
    return _mm512_test_epi64_mask(lanes, lanes);
  }
#endif
#if defined(__SSE2__)
  if constexpr (W == 2)
    return static_cast<std::uint64_t>(_mm_movemask_pd(reinterpret_cast<__m128d>(m.v)));
#endif
#if defined(__AVX__)
  if constexpr (W == 4)
    return static_cast<std::uint64_t>(_mm256_movemask_pd(reinterpret_cast<__m256d>(m.v)));
#endif
#if defined(__aarch64__)
  if constexpr (W == 2) {
    constexpr typename Mask<W>::Vector place = {1, 2};
    return vaddvq_u64(reinterpret_cast<uint64x2_t>(m.v & place));
  }
#endif
  std::uint64_t bits = 0;
  for (int k = 0; k < W; ++k) bits |= m.v[k] != 0 ? std::uint64_t{1} << k : 0;
  return bits;
}

/// True if the condition holds in any lane.
template <int W>
bool any(Mask<W> m) {
  return lane_bits(m) != 0;
}

/// The lanes before `count`.
template <int W>
Mask<W> first_lanes(int count) {
  using Bits = typename Mask<W>::Vector;
  Bits lane;
  for (int k = 0; k < W; ++k) lane[k] = k;
  return {lane < Bits{} + count};
}

/// The first `count` of W numbers in memory, at least one, and `rest` in the lanes behind. What is
/// behind is not read: another thread may be writing it.
template <int W>
Batch<W> load_first(const double* from, int count, double rest) {
#if defined(__AVX512VL__)
  const auto lanes = static_cast<__mmask8>((1u << count) - 1u);
  const auto behind = Batch<W>(rest).v;
  if constexpr (W == 8) return Batch<W>(_mm512_mask_loadu_pd(behind, lanes, from));
  if constexpr (W == 4) return Batch<W>(_mm256_mask_loadu_pd(behind, lanes, from));
  if constexpr (W == 2) return Batch<W>(_mm_mask_loadu_pd(behind, lanes, from));
#elif defined(__AVX__)
  if constexpr (W == 4) {
    const auto lanes = first_lanes<W>(count);
    const auto bits = reinterpret_cast<__m256i>(lanes.v);
    return select(lanes, Batch<W>(_mm256_maskload_pd(from, bits)), Batch<W>(rest));
  }
#endif
  Batch<W> b(rest);
  for (int k = 0; k < count; ++k) b.v[k] = from[k];
  return b;
}

/// The lanes brought together by f(x, y) until two are left, those half the lanes apart first,
/// whatever the instruction set.
template <int W, class F>
Batch<2> joined(Batch<W> a, F&& f) {
  if constexpr (W == 2)
    return a;
  else
    return [&]<int... k>(std::integer_sequence<int, k...>) {
      const Batch<W / 2> low(__builtin_shufflevector(a.v, a.v, k...));
      const Batch<W / 2> high(__builtin_shufflevector(a.v, a.v, (k + W / 2)...));
      return joined(f(low, high), f);
    }(std::make_integer_sequence<int, W / 2>{});
}

/// Sum over the lanes.
template <int W>
double sum(Batch<W> a) {
  const Batch<2> pair = joined(a, [](auto x, auto y) { return x + y; });
  return pair[0] + pair[1];
}

/// Largest lane.
template <int W>
double largest(Batch<W> a) {
  const Batch<2> pair = joined(a, [](auto x, auto y) { return max(x, y); });
  return pair[0] > pair[1] ? pair[0] : pair[1];
}

}  // namespace mpm
