#pragma once
// Four numbers at once where there are no vectors, on a device: the arithmetic of Batch<4>.
#include "mpm/math/scalar.hpp"

namespace mpm {

struct FourNumbers {
  double c[4];

  FourNumbers() = default;
  MPM_HD explicit FourNumbers(double x) : c{x, x, x, x} {}
  MPM_HD FourNumbers(double x, double y, double z, double w) : c{x, y, z, w} {}
  MPM_HD friend FourNumbers operator*(const FourNumbers& x, const FourNumbers& y) {
    return {x.c[0] * y.c[0], x.c[1] * y.c[1], x.c[2] * y.c[2], x.c[3] * y.c[3]};
  }
  MPM_HD friend FourNumbers operator*(double s, const FourNumbers& x) { return FourNumbers(s) * x; }
  MPM_HD friend FourNumbers operator*(const FourNumbers& x, double s) { return x * FourNumbers(s); }
};
MPM_HD inline FourNumbers fma(const FourNumbers& x, const FourNumbers& y, const FourNumbers& z) {
  return {fma(x.c[0], y.c[0], z.c[0]), fma(x.c[1], y.c[1], z.c[1]), fma(x.c[2], y.c[2], z.c[2]),
          fma(x.c[3], y.c[3], z.c[3])};
}

}  // namespace mpm
