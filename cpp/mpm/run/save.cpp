// What a step reads that neither the case nor the rest of the state tells.
#include "mpm/run/save.hpp"

#include "mpm/contact/candidates.hpp"
#include "mpm/grid/blocks.hpp"
#include "mpm/grid/connect.hpp"
#include "mpm/run/check_restored.hpp"

namespace mpm {
namespace {

constexpr const char* other_version = "it was made by another version of mpm3dpp";
constexpr const char* other_case = "it was made from another case";
constexpr std::int64_t format = 12;  // raised whenever exchange() or what a value means changes

template <int D>
void exchange_body(StateStream& stream, Body<D>& body) {
  stream.same(body.count, other_case);
  stream(body.moved, body.leaves, body.removed, body.removed_here);
  if (body.is_prescribed()) stream(body.motion->before, body.motion->now);
}

template <int D>
void exchange_pool(StateStream& stream, ParticlePool<D>& pool) {
  stream.same(pool.count(), other_case);
  stream.same(pool.columns.component_count(), other_case);
  for (int c = 0; c < pool.columns.component_count(); ++c)
    pool.columns.with_component(
        c, [&](auto* values) { stream.array(std::span(values, pool.count())); });
  stream.array(std::span(pool.id));
  stream.same(pool.piece.size(), other_case);
  stream.array(std::span(pool.piece));
  stream.same(pool.pieces.size(), other_case);
  stream.array(std::span(pool.pieces));
  stream.vector(pool.order);
  stream(pool.used);
  stream.vector(pool.removed);
}

template <int D>
void exchange(Simulation<D>& simulation, StateStream& stream) {
  Domain<D>& domain = simulation.domain;
  stream.same(format, other_version);
  for (const std::size_t size :
       {sizeof(Storage), sizeof(Ledger), sizeof(PatchSums<D>), sizeof(Removed), sizeof(RigidMotion),
        sizeof(SurfacePiece<D>), sizeof(StepWatch), sizeof(Note), sizeof(PairRecord),
        sizeof(CachedNode), sizeof(CachedPair<D>)})
    stream.same(size, other_version);
  stream.same(D, other_case);
  stream.same(domain.bodies.size(), other_case);
  stream.same(domain.loads.size(), other_case);
  stream.same(domain.pools.size(), other_case);
  for (Body<D>& body : domain.bodies) exchange_body(stream, body);
  for (ParticlePool<D>& pool : domain.pools) exchange_pool(stream, pool);
  for (SurfaceLoad<D>& load : domain.loads) stream(load.stress, load.force, load.impulse);
  exchange_grid(domain.grid, stream);
  if (stream.restores()) {
    check_lists(domain);
    release_nodes(domain.grid);
    connect(domain.grid);
    cut_blocks(domain.grid, domain.threads);
    if (domain.has_contact())
      connect_tiles(domain.contact, domain.grid, domain.bodies, domain.contact_settings.response);
  }
  if (domain.has_contact()) exchange_contact(domain.contact, stream, domain.bodies.size());
  stream(domain.time, domain.time_step, domain.step, domain.gravity);
  stream(domain.eroded, domain.outflow);
  stream.vector(domain.sums);
  stream.same(domain.rigid.size(), other_case);
  stream.array(std::span(domain.rigid));
  stream(simulation.coarsenings, simulation.next_time_step, domain.ledger);
  for (ParticlePool<D>& pool : domain.pools) stream(pool.fastest);
  simulation.history.exchange(stream);
  stream(simulation.watch.steps, simulation.watch.looked);
  stream.vector(simulation.watch.notes);
  simulation.timers.exchange(stream);
}

template <int D>
void refuse_ranks(const Simulation<D>& simulation) {
  if (!simulation.domain.grid.partition.alone())
    throw std::invalid_argument("a run of several ranks has no checkpoints: give one rank");
}

}  // namespace

template <int D>
void save(Simulation<D>& simulation, const StateStream::Transfer& to) {
  require(simulation, Phase::ready, "call prepare() before save()");
  if (simulation.failure)
    throw std::invalid_argument("a run that had to stop has no state to go on from");
  refuse_ranks(simulation);
  StateStream stream(StateStream::Way::save, to);
  exchange(simulation, stream);
}

template <int D>
void restore(Simulation<D>& simulation, const StateStream::Transfer& from, std::size_t size) {
  constexpr const char* when = "call restore() after prepare() and before any step";
  require(simulation, Phase::ready, when);
  if (simulation.domain.step > 0) throw std::invalid_argument(when);
  refuse_ranks(simulation);
  StateStream stream(StateStream::Way::restore, from, size);
  simulation.phase = Phase::broken;  // what has been restored half must not step
  exchange(simulation, stream);
  stream.end();
  check_rest(simulation);
  simulation.phase = Phase::ready;
}

template void save<2>(Simulation<2>&, const StateStream::Transfer&);
template void save<3>(Simulation<3>&, const StateStream::Transfer&);
template void restore<2>(Simulation<2>&, const StateStream::Transfer&, std::size_t);
template void restore<3>(Simulation<3>&, const StateStream::Transfer&, std::size_t);

}  // namespace mpm
