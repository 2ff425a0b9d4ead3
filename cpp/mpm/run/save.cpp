// What a step reads that neither the case nor the rest of the state tells.
#include "mpm/run/save.hpp"

#include "mpm/contact/candidates.hpp"
#include "mpm/followers/find_followers.hpp"
#include "mpm/grid/blocks.hpp"
#include "mpm/run/check_restored.hpp"
#include "mpm/run/held_bodies.hpp"
#include "mpm/run/save_kept_nodes.hpp"
#include "mpm/run/surfaces.hpp"
#include "mpm/run/time_step.hpp"
#include "mpm/surfaces/renew_points.hpp"

namespace mpm {
namespace {

constexpr const char* other_version = "it was made by another version of mpm3dpp";
constexpr const char* other_case = "it was made from another case";
constexpr std::int64_t format = 27;  // raised whenever exchange() or what a value means changes

template <int D>
void exchange_body(StateStream& stream, Body<D>& body) {
  stream.same(body.count, other_case);
  stream(body.leaves, body.removed, body.averages, body.failed, body.renewals,
         body.nodes_are_final);
  StateStream::check(body.renewals >= 0 && body.failed >= 0, other_case);
  if (body.is_prescribed()) stream(body.motion->before, body.motion->now);
}

/// Of all ranks; restored, the first has them.
void exchange_sums(StateStream& stream, std::span<ExactSum> sums) {
  std::vector<ExactSum> all(sums.begin(), sums.end());
  all_sum(stream.comm(), all);
  for (ExactSum& sum : all) {
    std::array<std::int64_t, ExactSum::words> words;
    sum.write(words);
    stream(words);
    sum = ExactSum::read(words);
  }
  if (!stream.restores()) return;
  const bool first = stream.comm().rank() == 0;
  for (std::size_t k = 0; k < sums.size(); ++k) sums[k] = first ? all[k] : ExactSum{};
}
void exchange_removed(StateStream& stream, Removed& removed) {
  std::int64_t count = all_sum(stream.comm(), static_cast<std::int64_t>(removed.count));
  stream(count);
  exchange_sums(stream, removed.sums);
  if (stream.restores())
    removed.count = stream.comm().rank() == 0 ? static_cast<std::size_t>(count) : 0;
}

/// The lists anew, from where particles are: none depends on those that there were.
template <int D>
void rebuild(Domain<D>& domain, std::vector<Patch<D>> bodies, const StateStream& stream) {
  std::vector<std::int64_t> removed;
  removed.reserve(domain.bodies.size());
  for (const Body<D>& body : domain.bodies)
    removed.push_back(static_cast<std::int64_t>(body.removed_here));
  stream.comm().all_sum(removed);
  for (std::size_t b = 0; b < removed.size(); ++b)
    StateStream::check(std::cmp_equal(removed[b], domain.bodies[b].removed),
                       "its particles are damaged");
  domain.grid.patches = std::move(bodies);
  release_nodes(domain.grid);
  // Nodes that lie in bodies, and their surfaces, stay with who has them.
  std::optional<Owners<D>> owners;
  if (has_kept_nodes(domain)) owners = domain.grid.partition.owners;
  build_cell_lists(domain.grid, domain.bodies, domain.pools, domain.threads, domain.list_scratch,
                   std::move(owners));
  // What has failed in the last step, or is in another cell, is seen to in the next.
  for (Patch<D>& patch : domain.grid.patches) patch.left_cell = !patch.foreign && !patch.keeps;
  if (domain.has_contact())
    connect_tiles(domain.contact, domain.grid, domain.bodies, domain.contact_settings.response);
  probe_speeds(domain);
}

template <int D>
void exchange(Simulation<D>& simulation, StateStream& stream) {
  Domain<D>& domain = simulation.domain;
  stream.same(format, other_version);
  for (const std::size_t size :
       {sizeof(Storage), sizeof(Ledger), sizeof(Removed), sizeof(RigidMotion),
        sizeof(SurfacePiece<D>), sizeof(StepWatch), sizeof(Note), sizeof(PairRecord),
        sizeof(CachedPair<D>), sizeof(KeptSpin), sizeof(ActingOnHost<D>), sizeof(ActingBetween<D>),
        sizeof(ActingOnBody), sizeof(Levelled<D>), sizeof(LaidPoint<D>)})
    stream.same(size, other_version);
  stream.same(D, other_case);
  stream.same(domain.bodies.size(), other_case);
  stream.same(domain.loads.size(), other_case);
  stream.same(domain.pools.size(), other_case);
  auto held = static_cast<std::int64_t>(simulation.held.size());
  stream(held);
  if (stream.restores() && held == 0) free_held_bodies(simulation);  // It has settled.
  StateStream::check(std::cmp_equal(held, simulation.held.size()), other_case);
  for (Body<D>& body : domain.bodies) exchange_body(stream, body);
  stream(domain.grid.cell_size, domain.grid.anchor, domain.grid.walls.cells);
  if (stream.restores()) check_grid(domain);
  std::vector<Patch<D>> bodies(stream.restores() ? domain.bodies.size() : 0);
  for (std::size_t m = 0; m < domain.pools.size(); ++m)
    exchange_particles(domain, m, stream, bodies);
  for (SurfaceLoad<D>& load : domain.loads) stream(load.mean, load.force, load.impulse);
  if (stream.restores()) rebuild(domain, std::move(bodies), stream);
  exchange_kept_nodes(domain, stream);
  if (stream.restores() && has_kept_nodes(domain))
    find_followers(domain, std::vector<bool>(domain.bodies.size(), false));
  exchange_kept_spins(domain, stream);
  exchange_surfaces(domain, stream);
  if (domain.surfaces.meet && !domain.has_contact()) {
    domain.contact.records.exchange(stream);
    if (stream.restores())
      domain.contact.records.check_restored(domain.bodies.size(), stream.comm().rank() == 0);
  }
  if (domain.has_contact())
    exchange_contact(domain.contact, stream, domain.bodies.size(), domain.grid.partition);
  stream(domain.time, domain.time_step, domain.step_before, domain.shift, domain.step,
         domain.renewals, domain.gravity);
  exchange_removed(stream, domain.eroded);
  exchange_removed(stream, domain.outflow);
  for (PartEnergies& part : domain.part_energies) exchange_sums(stream, part.sums);
  exchange_sums(stream, domain.faces_in_step);
  exchange_sums(stream, domain.faces);
  stream.same(domain.rigid.size(), other_case);
  stream.array(std::span(domain.rigid));
  stream(simulation.coarsenings, simulation.next_time_step, simulation.least_stable, domain.ledger);
  for (ParticlePool<D>& pool : domain.pools) stream(pool.fastest);
  simulation.history.exchange(stream);
  stream(simulation.watch.steps, simulation.watch.looked);
  stream.vector(simulation.watch.notes);
  simulation.timers.exchange(stream);
}

}  // namespace

template <int D>
void save(Simulation<D>& simulation, const StateStream::Transfer& to) {
  require(simulation, Phase::ready, "call prepare() before save()");
  if (simulation.failure)
    throw std::invalid_argument("a run that had to stop has no state to go on from");
  StateStream stream(StateStream::Way::save, to, *simulation.domain.grid.partition.comm);
  exchange(simulation, stream);
  stream.end();
}

template <int D>
void restore(Simulation<D>& simulation, const StateStream::Transfer& from, std::size_t size) {
  constexpr const char* when = "call restore() after prepare() and before any step";
  require(simulation, Phase::ready, when);
  if (simulation.domain.step > 0) throw std::invalid_argument(when);
  StateStream stream(StateStream::Way::restore, from, *simulation.domain.grid.partition.comm, size);
  simulation.phase = Phase::broken;  // what has been restored half must not step
  exchange(simulation, stream);
  stream.end();
  check_rest(simulation, stream);
  simulation.phase = Phase::ready;
}

template void save<2>(Simulation<2>&, const StateStream::Transfer&);
template void save<3>(Simulation<3>&, const StateStream::Transfer&);
template void restore<2>(Simulation<2>&, const StateStream::Transfer&, std::size_t);
template void restore<3>(Simulation<3>&, const StateStream::Transfer&, std::size_t);

}  // namespace mpm
