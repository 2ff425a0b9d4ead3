#pragma once
// Sums over the nodes around a host, with the components of vectors in the lanes: hosts share no
// nodes as the particles of a cell do. For W_i = N_i + d . grad_X N_i + sum_k b_k d2N_i/dX_k^2 of
// any places (PlaceAtHost) three sums are needed: with N_i, its gradient, and its second
// differences along each axis.
#include "mpm/schedule/record_arithmetic.hpp"
#include "mpm/schedule/weights.hpp"
#include "mpm/surfaces/hosts.hpp"

namespace mpm {

/// The functions of the three nodes in reach along an axis, with derivatives in space.
struct HostAxis {
  double N[3], dN[3], d2N[3];  // [1; 1/m; 1/m^2]

  HostAxis(const AxisWeights<double, 3>& of, double cell_size) {
    for (int k = 0; k < 3; ++k) {
      N[k] = of.N[k];
      dN[k] = of.dN[k] / cell_size;
      d2N[k] = (k == 1 ? -2.0 : 1.0) / (cell_size * cell_size);
    }
  }
};

template <int D>
class AroundHost {
  using Half = records_in_lanes::Half;

 public:
  AroundHost(const Weights<double, D, 3>& weights, double cell_size, const NodeStrides<D>& stride)
      : x_(weights.axis[0], cell_size),
        y_(weights.axis[1], cell_size),
        z_(weights.axis[D - 1], cell_size),
        stride_(stride) {}

  /// The motion by vectors that begin at `first`, of the first node in reach.
  template <int width>
  HostMotion<D> motion(const Nodes<width>& first) const {
    Half mean(0.0), gradient[D], second[D];
    for (int a = 0; a < D; ++a) gradient[a] = second[a] = Half(0.0);
    for_each_row(first, [&](auto y, auto z, const Nodes<width>& row) {
      const Half N = along(row, x_.N);
      mean = fma(Half(yz(y_.N, z_.N, y, z)), N, mean);
      gradient[0] = fma(Half(yz(y_.N, z_.N, y, z)), along(row, x_.dN), gradient[0]);
      gradient[1] = fma(Half(yz(y_.dN, z_.N, y, z)), N, gradient[1]);
      if constexpr (D == 3) gradient[2] = fma(Half(yz(y_.N, z_.dN, y, z)), N, gradient[2]);
      add_second(y, z, row, N, second);
    });
    HostMotion<D> motion;
    for (int a = 0; a < D; ++a) motion.mean[a] = mean[a];
    motion.gradient = from_columns(gradient);
    motion.second = from_columns(second);
    return motion;
  }
  /// Its second derivatives alone.
  template <int width>
  Mat<double, D> second_derivatives(const Nodes<width>& first) const {
    Half second[D];
    for (int a = 0; a < D; ++a) second[a] = Half(0.0);
    for_each_row(first, [&](auto y, auto z, const Nodes<width>& row) {
      add_second(y, z, row, along(row, x_.N), second);
    });
    return from_columns(second);
  }
  /// sum of t W_i to the numbers from `first` on.
  template <int width>
  void give(const Nodes<width>& first, const ForceAtHost<D>& forces) const {
    Half force(0.0), moment[D], second[D];
    for (int b = 0; b < D; ++b) moment[b] = second[b] = Half(0.0);
    for (int a = 0; a < D; ++a) {
      force.v[a] = forces.force[a];
      for (int b = 0; b < D; ++b) {
        moment[b].v[a] = forces.moment[a][b];
        second[b].v[a] = forces.second[a][b];
      }
    }
    for_each_row(first, [&](auto y, auto z, const Nodes<width>& row) {
      const Half across(yz(y_.N, z_.N, y, z));
      Half with_N = fma(Half(yz(y_.dN, z_.N, y, z)), moment[1], across * force);
      with_N = fma(Half(yz(y_.d2N, z_.N, y, z)), second[1], with_N);
      if constexpr (D == 3) {
        with_N = fma(Half(yz(y_.N, z_.dN, y, z)), moment[2], with_N);
        with_N = fma(Half(yz(y_.N, z_.d2N, y, z)), second[2], with_N);
      }
      const Half with_dN = across * moment[0], with_d2N = across * second[0];
      for (int x = 0; x < 3; ++x) {
        Half sum = fma(Half(x_.N[x]), with_N, Half::load(row[x]));
        sum = fma(Half(x_.dN[x]), with_dN, sum);
        fma(Half(x_.d2N[x]), with_d2N, sum).store(row[x]);
      }
    });
  }

 private:
  template <int width, class F>
  void for_each_row(const Nodes<width>& first, F&& f) const {
    for (int z = 0; z < (D == 3 ? 3 : 1); ++z)
      for (int y = 0; y < 3; ++y) f(y, z, first.from(stride_.to(0, y, z)));
  }
  static double yz(const double* along_y, const double* along_z, int y, int z) {
    return D == 3 ? along_y[y] * along_z[z] : along_y[y];
  }
  template <int width>
  static Half along(const Nodes<width>& row, const double* x) {
    const Half sum = fma(Half(x[1]), Half::load(row[1]), Half(x[0]) * Half::load(row[0]));
    return fma(Half(x[2]), Half::load(row[2]), sum);
  }
  template <int width>
  void add_second(int y, int z, const Nodes<width>& row, const Half& N, Half* second) const {
    second[0] = fma(Half(yz(y_.N, z_.N, y, z)), along(row, x_.d2N), second[0]);
    second[1] = fma(Half(yz(y_.d2N, z_.N, y, z)), N, second[1]);
    if constexpr (D == 3) second[2] = fma(Half(yz(y_.N, z_.d2N, y, z)), N, second[2]);
  }
  static Mat<double, D> from_columns(const Half* columns) {
    Mat<double, D> m;
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b) m[a][b] = columns[b][a];
    return m;
  }

  HostAxis x_, y_, z_;  // in 2D z is not looked at
  NodeStrides<D> stride_;
};

}  // namespace mpm
