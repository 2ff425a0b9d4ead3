#include "mpm/particles/add_columns.hpp"

namespace mpm {

template <int D>
void add_force_column(ParticlePool<D>& pool) {
  if (pool.body_force < 0) pool.body_force = pool.columns.add("body_force", "m/s^2", D);
}

template <int D>
void add_start_positions(ParticlePool<D>& pool) {
  if (pool.start_position < 0) pool.start_position = pool.columns.add("start_position", "m", D);
}

template <int D>
void add_set_back(ParticlePool<D>& pool) {
  pool.set_back = pool.columns.add("set_back", "1", 1);
}

template <int D>
void add_pressing(ParticlePool<D>& pool) {
  PressingColumns& at = pool.pressing;
  at.force = pool.columns.add("surface_force", "N", D);
  at.arm = pool.columns.add("surface_arm", "m", D);
  at.slip = pool.columns.add("surface_slip", "m", D);
  at.stiffness = pool.columns.add("surface_stiffness", "N/m", 1);
  at.onset = pool.columns.add("surface_onset", "m", 1);
  at.opposite = pool.columns.add("surface_opposite", "1", 1);
  at.set_back = pool.columns.add("surface_set_back", "m", 1);
}

template void add_force_column<2>(ParticlePool<2>&);
template void add_force_column<3>(ParticlePool<3>&);
template void add_start_positions<2>(ParticlePool<2>&);
template void add_start_positions<3>(ParticlePool<3>&);
template void add_set_back<2>(ParticlePool<2>&);
template void add_set_back<3>(ParticlePool<3>&);
template void add_pressing<2>(ParticlePool<2>&);
template void add_pressing<3>(ParticlePool<3>&);

}  // namespace mpm
