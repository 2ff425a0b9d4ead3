#include "mpm/run/measures.hpp"

#include "mpm/comm/all_sums.hpp"
#include "mpm/step/kept_nodes.hpp"

namespace mpm {

template <int D>
double total_mass(const Domain<D>& domain) {
  ExactSum total;
  domain.for_each_particle(
      [&](const ParticlePool<D>& of, std::uint32_t row) { total.add(of.mass()[row]); });
  for (const ParticlePool<D>& of : domain.pools)
    for (const RemovedRow& removed : of.removed) total.add(of.mass()[removed.row]);
  all_sum(*domain.grid.partition.comm, {&total, 1});
  return total.value();
}

template <int D>
double kinetic_energy(Domain<D>& domain) {
  ExactSum total;
  for (const Patch<D>& patch : domain.grid.patches) {
    if (patch.keeps) {
      const OfTurning less = of_turning(domain.kept_spins, patch.body);
      for_each_kept_node(domain.grid, patch, [&](double m, const Vector3&, const Vector3& v) {
        total.add(m * (0.5 * dot(v, v) - less.kinetic));
      });
      continue;
    }
    const ParticlePool<D>& of = domain.pool_of(patch);
    for (const std::uint32_t row : of.rows(patch))
      total.add(mpm::kinetic_energy(of, row, domain.grid.affine_moment()));
  }
  all_sum(*domain.grid.partition.comm, {&total, 1});
  return total.value();
}

template <int D>
std::array<double, 3> momentum(Domain<D>& domain) {
  std::array<ExactSum, D> total{};
  for (const Patch<D>& patch : domain.grid.patches) {
    const auto add = [&](double m, const auto&, const auto& v) {
      for (std::size_t a = 0; a < D; ++a) total[a].add(m * v[static_cast<int>(a)]);
    };
    if (patch.keeps) {
      for_each_kept_node(domain.grid, patch, add);
      continue;
    }
    const ParticlePool<D>& of = domain.pool_of(patch);
    for (const std::uint32_t row : of.rows(patch))
      add(of.mass()[row], 0, velocity_in_space(of, row));
  }
  all_sum(*domain.grid.partition.comm, total);
  std::array<double, 3> sums{};
  for (std::size_t a = 0; a < D; ++a) sums[a] = total[a].value();
  return sums;
}

template <int D>
double energy_at_start(const ParticlePool<D>& pool, const Body<D>& body, std::uint32_t row) {
  const double volume = pool.volume()[row];
  if (pool.at.energy >= 0) return pool.columns.component(pool.at.energy)[row] * volume;
  Sym<double, D> stress;
  for (int c = 0; c < Sym<double, D>::size; ++c) stress.c[c] = pool.stress(c)[row];
  const double equivalent = von_mises(stress), mean = trace(stress) / 3.0;
  if (equivalent == 0.0 && mean == 0.0) return 0.0;
  const double rho = body.initial_density, G = std::pow(body.shear_impedance, 2) / rho;
  const double K = std::pow(body.pressure_impedance, 2) / rho - 4.0 / 3.0 * G;
  return volume * (0.5 * mean * mean / K + equivalent * equivalent / (6.0 * G));
}

template <int D>
double initial_internal_energy(const Domain<D>& domain) {
  ExactSum total;
  for (const Patch<D>& patch : domain.grid.patches) {
    const ParticlePool<D>& pool = domain.pool_of(patch);
    for (const std::uint32_t row : pool.rows(patch))
      total.add(energy_at_start(pool, domain.body_of(patch), row));
  }
  all_sum(*domain.grid.partition.comm, {&total, 1});
  return total.value();
}

template <int D>
std::size_t particle_count(const Domain<D>& domain) {
  std::size_t count = 0;
  for (const Body<D>& body : domain.bodies) count += body.count;
  return count;
}

namespace {

template <int D>
std::size_t bytes_of_surfaces(const Surfaces<D>& surfaces) {
  std::size_t parts = bytes_of(surfaces.parts);
  for (const SurfacePart<D>& part : surfaces.parts)
    parts += bytes_of(part.touches) + bytes_of(part.kept) + bytes_of(part.kept_next) +
             bytes_of(part.near_of) + bytes_of(part.awake_of) + bytes_of(part.awake) +
             bytes_of(part.near) + bytes_of(part.felt) + bytes_of(part.levelled) +
             bytes_of(part.face_sums) + bytes_of(part.begun);
  return parts + bytes_of(surfaces.part_of) + bytes_of(surfaces.hosts) + bytes_of(surfaces.points) +
         bytes_of(surfaces.places) + bytes_of(surfaces.bonds) + bytes_of(surfaces.on_bodies) +
         bytes_of(surfaces.moving) + bytes_of(surfaces.between_parts) +
         bytes_of(surfaces.on_bodies_by_part) + bytes_of(surfaces.F_on_hosts) +
         bytes_of(surfaces.others.hosts) + bytes_of(surfaces.others.places_at_start) +
         bytes_of(surfaces.first_numbers) + bytes_of(surfaces.set_back) +
         bytes_of(surfaces.places_of_lists) + bytes_of(surfaces.in_touch) +
         bytes_of(surfaces.place_of_motion) + bytes_of(surfaces.between) +
         bytes_of(surfaces.on_hosts) + bytes_of(surfaces.place_on_hosts);
}

}  // namespace

template <int D>
Bytes bytes_of(const Simulation<D>& simulation) {
  const Domain<D>& domain = simulation.domain;
  Bytes r;
  for (const ParticlePool<D>& of : domain.pools) r.particles += of.bytes();
  r.particles += domain.list_scratch.bytes();
  r.grid = bytes_of(domain.grid) + domain.followers.bytes() + bytes_of(domain.followers.follow);
  if (domain.has_contact()) r.contact = bytes_of(domain.contact);
  r.contact += bytes_of_surfaces(domain.surfaces);
  r.other = bytes_of(domain.sums) + bytes_of(domain.work_of_nodes) + simulation.history.bytes() +
            bytes_of(domain.part_energies) + bytes_of(domain.face_parts);
  for (std::size_t* bytes : {&r.particles, &r.grid, &r.contact, &r.other})
    *bytes = static_cast<std::size_t>(
        all_sum(*domain.grid.partition.comm, static_cast<std::int64_t>(*bytes)));
  return r;
}

template <int D>
ContactSummary contact_summary(const Simulation<D>& simulation) {
  const Contact<D>& contact = simulation.domain.contact;
  Comm& comm = *simulation.domain.grid.partition.comm;
  const auto all = [&](std::size_t number) {
    return static_cast<std::size_t>(all_sum(comm, static_cast<std::int64_t>(number)));
  };
  ContactSummary told;
  told.overlapped = contact.counts.overlapped;
  told.touching = simulation.domain.surfaces.touching;
  told.touching_max = simulation.domain.surfaces.touching_max;
  std::size_t levelled = 0;
  for (const SurfacePart<D>& part : simulation.domain.surfaces.parts)
    if (!part.foreign) levelled += part.levelled.size();
  told.levelled = all(levelled);
  told.overlapped_max = contact.counts.overlapped_max;
  told.bodies_max = contact.counts.bodies_max;
  told.unconverged = all(contact.unconverged.load());
  told.set_back_particles = all(contact.set_back.particles);
  told.set_back_most = all_max(comm, contact.set_back.most);
  told.bytes = bytes_of(simulation).contact;
  return told;
}

template <int D>
RanksSummary ranks_summary(const Simulation<D>& simulation) {
  Comm& comm = *simulation.domain.grid.partition.comm;
  const StepTraffic& passed = simulation.passed;
  const Traffic& t = passed.traffic;
  const auto microseconds = [](double time) { return static_cast<std::int64_t>(1e6 * time); };
  const double at_work = passed.seconds - t.seconds;
  std::int64_t sums[] = {t.letters,
                         t.bytes,
                         t.exchanges,
                         t.reductions,
                         microseconds(t.seconds),
                         microseconds(passed.seconds),
                         microseconds(at_work)};
  comm.all_sum(sums);
  const double longest = all_max(comm, at_work);
  RanksSummary told;
  told.ranks = comm.size();
  if (comm.alone() || passed.steps == 0) return told;
  const auto mean = [&](std::size_t k) {
    return static_cast<double>(sums[k]) / static_cast<double>(passed.steps * comm.size());
  };
  told.letters = mean(0);
  told.bytes = mean(1);
  told.exchanges = mean(2);
  told.reductions = mean(3);
  told.share =
      static_cast<double>(sums[4]) / static_cast<double>(std::max<std::int64_t>(1, sums[5]));
  told.imbalance =
      longest * comm.size() / (1e-6 * static_cast<double>(std::max<std::int64_t>(1, sums[6])));
  return told;
}

template <int D>
std::vector<FaceRecord> face_records(const Domain<D>& domain) {
  const Walls<D>& walls = domain.grid.walls;
  std::vector<FaceRecord> records;
  if (!walls.exist) return records;
  Comm& comm = *domain.grid.partition.comm;
  FaceSums<D> in_step = domain.faces_in_step, so_far = domain.faces;
  all_sum(comm, in_step);
  all_sum(comm, so_far);
  for (std::size_t face = 0; face < std::size_t{2} * D; ++face) {
    const std::size_t axis = face / 2, side = face % 2;
    if (walls.face[axis][side] == Wall::free) continue;
    FaceRecord& record = records.emplace_back();
    record.name = std::string(1, "xyz"[axis]) + (side == 0 ? "_min" : "_max");
    record.area = 1.0;
    for (std::size_t a = 0; a < D; ++a) {
      // What the bodies give the face is the opposite of what it gives them.
      record.impulse[a] = 0.0 - so_far[face * D + a].value();
      if (domain.time_step > 0.0)
        record.force[a] = 0.0 - in_step[face * D + a].value() / domain.time_step;
      if (a != axis) record.area *= walls.cells[a] * domain.grid.cell_size;
    }
  }
  return records;
}

template std::vector<FaceRecord> face_records<2>(const Domain<2>&);
template std::vector<FaceRecord> face_records<3>(const Domain<3>&);
template RanksSummary ranks_summary<2>(const Simulation<2>&);
template RanksSummary ranks_summary<3>(const Simulation<3>&);
template ContactSummary contact_summary<2>(const Simulation<2>&);
template ContactSummary contact_summary<3>(const Simulation<3>&);
template double total_mass<2>(const Domain<2>&);
template double total_mass<3>(const Domain<3>&);
template double kinetic_energy<2>(Domain<2>&);
template double kinetic_energy<3>(Domain<3>&);
template std::array<double, 3> momentum<2>(Domain<2>&);
template std::array<double, 3> momentum<3>(Domain<3>&);
template double energy_at_start<2>(const ParticlePool<2>&, const Body<2>&, std::uint32_t);
template double energy_at_start<3>(const ParticlePool<3>&, const Body<3>&, std::uint32_t);
template double initial_internal_energy<2>(const Domain<2>&);
template double initial_internal_energy<3>(const Domain<3>&);
template std::size_t particle_count<2>(const Domain<2>&);
template std::size_t particle_count<3>(const Domain<3>&);
template Bytes bytes_of<2>(const Simulation<2>&);
template Bytes bytes_of<3>(const Simulation<3>&);

}  // namespace mpm
