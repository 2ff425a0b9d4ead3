// The state of a run between two steps: what a step reads that neither the case nor the rest of the
// state tells. It is restored into a simulation of the same case that has made no step.
#include "mpm/contact/candidates.hpp"
#include "mpm/grid/blocks.hpp"
#include "mpm/grid/connect.hpp"
#include "mpm/run/simulation_of.hpp"

namespace mpm {
namespace {

constexpr const char* other_version = "it was made by another version of mpm3dpp";
constexpr const char* other_case = "it was made from another case";
constexpr std::int64_t format = 4;  // raised whenever exchange() or what a value means changes

template <int D>
void exchange_body(StateStream& stream, Body<D>& body) {
  stream.same(body.count, other_case);
  stream(body.moved, body.leaves, body.removed);
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
  stream.vector(pool.order);
  stream(pool.used);
  stream.vector(pool.removed);
}

}  // namespace

template <int D>
void SimulationOf<D>::exchange(StateStream& stream) {
  stream.same(format, other_version);
  for (const std::size_t size :
       {sizeof(Storage), sizeof(Ledger), sizeof(PatchSums<D>), sizeof(Removed<D>),
        sizeof(RigidMotion), sizeof(SurfacePiece<D>), sizeof(StepWatch), sizeof(Note),
        sizeof(PairRecord), sizeof(CachedNode), sizeof(CachedPair<D>)})
    stream.same(size, other_version);
  stream.same(D, other_case);
  stream.same(domain_.bodies.size(), other_case);
  stream.same(domain_.loads.size(), other_case);
  stream.same(domain_.pools.size(), other_case);
  stream.same(domain_.pieces.size(), other_case);
  for (Body<D>& body : domain_.bodies) exchange_body(stream, body);
  for (ParticlePool<D>& pool : domain_.pools) exchange_pool(stream, pool);
  for (SurfaceLoad<D>& load : domain_.loads) stream(load.stress, load.force, load.impulse);
  stream.array(std::span(domain_.pieces));
  exchange_grid(domain_.grid, stream);
  if (stream.restores()) {
    check_lists();
    release_nodes(domain_.grid);
    connect(domain_.grid);
    cut_blocks(domain_.grid, domain_.threads);
    if (domain_.has_contact()) connect_tiles(domain_.contact, domain_.grid, domain_.bodies);
  }
  if (domain_.has_contact()) exchange_contact(domain_.contact, stream, domain_.bodies.size());
  stream(domain_.time, domain_.time_step, domain_.step, domain_.gravity);
  stream(domain_.eroded, domain_.outflow);
  stream.vector(domain_.sums);
  stream.same(domain_.rigid.size(), other_case);
  stream.array(std::span(domain_.rigid));
  stream(settings_.grid.cell_size, coarsenings_, next_time_step_, domain_.ledger);
  stream.vector(history_);
  stream(watch_, looked_);
  stream.vector(notes_);
  timers_.exchange(stream);
}

template <int D>
void SimulationOf<D>::save(const StateStream::Transfer& to) {
  if (!prepared_) throw std::invalid_argument("call prepare() before save()");
  if (failure_) throw std::invalid_argument("a run that had to stop has no state to go on from");
  StateStream stream(StateStream::Way::save, to);
  exchange(stream);
}

template <int D>
void SimulationOf<D>::restore(const StateStream::Transfer& from, std::size_t size) {
  if (!prepared_ || domain_.step > 0)
    throw std::invalid_argument("call restore() after prepare() and before any step");
  const double cell_size = settings_.grid.cell_size;
  const auto walls = domain_.grid.walls.cells;
  StateStream stream(StateStream::Way::restore, from, size);
  prepared_ = false;  // what has been restored half must not step
  exchange(stream);
  stream.end();
  check_rest(cell_size, walls);
  prepared_ = true;
}

template class SimulationOf<2>;
template class SimulationOf<3>;

}  // namespace mpm
