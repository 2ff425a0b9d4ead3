#pragma once
// The operations of a number on one double; those of lanes are in batch.hpp.
#include <cmath>

#include "mpm/math/host_device.hpp"

namespace mpm {

MPM_HD inline double select(bool condition, double yes, double no) { return condition ? yes : no; }
MPM_HD inline double fma(double a, double b, double c) {
#if defined(MPM_FUSES)
  return __builtin_fma(a, b, c);
#else
  return a * b + c;
#endif
}
MPM_HD inline double min(double a, double b) { return a < b ? a : b; }
MPM_HD inline double max(double a, double b) { return a > b ? a : b; }
MPM_HD inline double sqrt(double a) { return std::sqrt(a); }

}  // namespace mpm
