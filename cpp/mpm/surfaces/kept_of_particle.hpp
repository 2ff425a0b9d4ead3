#pragma once
#include "mpm/particles/pool.hpp"

namespace mpm {

/// The columns of a particle that presses.
template <int D>
class KeptOfParticle {
 public:
  KeptOfParticle(ParticlePool<D>& pool, std::uint32_t row) : pool_(pool), row_(row) {}
  double& number(int column) const { return pool_.columns.component(column)[row_]; }
  Vec<double, D> vector(int column) const {
    Vec<double, D> v;
    for (int a = 0; a < D; ++a) v[a] = pool_.columns.component(column + a)[row_];
    return v;
  }
  void set(int column, const Vec<double, D>& v) const {
    for (int a = 0; a < D; ++a) pool_.columns.component(column + a)[row_] = v[a];
  }

  /// All of it but the force that acts in the coming step.
  void forget() const {
    const PressingColumns& at = pool_.pressing;
    set(at.slip, Vec<double, D>::zero());
    for (const int column : {at.stiffness, at.onset, at.opposite, at.set_back})
      number(column) = 0.0;
  }

 private:
  ParticlePool<D>& pool_;
  std::uint32_t row_;
};

}  // namespace mpm
