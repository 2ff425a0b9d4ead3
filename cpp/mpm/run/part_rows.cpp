#include "mpm/run/part_rows.hpp"

#include "mpm/run/pair_groups.hpp"

namespace mpm {
namespace {

/// What particles that take no part any more had.
struct Gone {
  ExactSum recoverable;  // [J]
  ExactSum eroded_mass;  // [kg]
};

template <int D>
std::vector<Gone> gone_of_groups(const Domain<D>& domain) {
  std::vector<Gone> gone(domain.part_energies.size());
  for (const ParticlePool<D>& pool : domain.pools)
    for (const RemovedRow& removed : pool.removed) {
      const auto b = static_cast<std::size_t>(removed.body);
      Gone& of_group = gone[domain.group_of[b]];
      const double m = pool.mass()[removed.row];
      of_group.recoverable.add(recoverable_energy(domain.bodies[b], pool, removed.row));
      if (pool.columns.component(pool.at.failed)[removed.row] != left_region)
        of_group.eroded_mass.add(m);
    }
  std::vector<ExactSum> sums;
  sums.reserve(2 * gone.size());
  for (const Gone& of_group : gone) {
    sums.push_back(of_group.recoverable);
    sums.push_back(of_group.eroded_mass);
  }
  all_sum(*domain.grid.partition.comm, sums);
  for (std::size_t g = 0; g < gone.size(); ++g) gone[g] = {sums[2 * g], sums[2 * g + 1]};
  return gone;
}

/// Forces of the last step [N].
struct Forces {
  Vector3 contact = Vector3::zero(), load = Vector3::zero();
};

template <int D>
std::vector<Forces> forces_on_groups(const Domain<D>& domain) {
  std::vector<Forces> forces(domain.part_energies.size());
  const auto on = [&](int body) -> Forces& {
    return forces[domain.group_of[static_cast<std::size_t>(body)]];
  };
  if (domain.has_contact() || domain.surfaces.meet)
    for (const PairRecord& pair : group_pairs(domain)) {
      const Vector3 force{pair.force[0], pair.force[1], pair.force[2]};
      on(pair.a).contact += force;
      on(pair.b).contact -= force;
    }
  for (const SurfaceLoad<D>& load : domain.loads) on(load.body).load += in_space<D>(load.force);
  return forces;
}

}  // namespace

template <int D>
std::vector<double> part_rows(const Domain<D>& domain, const std::vector<PartSums>& parts) {
  const std::vector<PartWork> works = total_of(domain.part_energies, *domain.grid.partition.comm);
  const std::vector<Gone> gone = gone_of_groups(domain);
  const std::vector<Forces> forces = forces_on_groups(domain);
  std::vector<double> rows;
  rows.reserve(parts.size() * part_columns.size());
  const auto add = [&](const Vector3& vector) {
    for (int a = 0; a < 3; ++a) rows.push_back(vector[a]);
  };
  for (std::size_t g = 0; g < parts.size(); ++g) {
    const PartSums& part = parts[g];
    rows.push_back(part.mass);
    add(part.centre);
    add(velocity_of(part));
    add(part.momentum);
    rows.push_back(part.kinetic);
    add(part.angular_momentum);
    add(spin_of(part, D));
    rows.push_back(works[g].internal - gone[g].recoverable.value());
    rows.push_back(works[g].plastic);
    rows.push_back(works[g].viscous);
    rows.push_back(gone[g].eroded_mass.value());
    add(forces[g].contact);
    add(forces[g].load);
  }
  return rows;
}

template std::vector<double> part_rows<2>(const Domain<2>&, const std::vector<PartSums>&);
template std::vector<double> part_rows<3>(const Domain<3>&, const std::vector<PartSums>&);

}  // namespace mpm
