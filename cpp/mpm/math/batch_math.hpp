#pragma once
// Elementary functions on lanes, as accurate as elementary.hpp says.
#include "mpm/math/batch.hpp"
#include "mpm/math/elementary.hpp"

namespace mpm {

template <int W>
struct NumberBits<Batch<W>> {
  using Whole = typename Mask<W>::Vector;
  static Whole of(Batch<W> x) {
    Whole bits;
    std::memcpy(&bits, &x.v, sizeof(bits));
    return bits;
  }
  static Batch<W> number(Whole bits) {
    Batch<W> x;
    std::memcpy(&x.v, &bits, sizeof(bits));
    return x;
  }
};

template <int W>
Batch<W> log(Batch<W> x) {
  return log_by_series(x);
}
template <int W>
Batch<W> exp(Batch<W> x) {
  return exp_by_series(x);
}
template <int W>
Batch<W> pow(Batch<W> x, Batch<W> y) {
  return pow_by_series(x, y);
}

}  // namespace mpm
