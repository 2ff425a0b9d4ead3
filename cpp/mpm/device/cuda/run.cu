// A run on a device: its memory, and a step as a list of kernels (make_step).
#include <limits>

#include "mpm/device/cuda/advance.cuh"
#include "mpm/device/cuda/lists.cuh"
#include "mpm/device/cuda/nodes.cuh"
#include "mpm/device/cuda/pool.cuh"
#include "mpm/device/cuda/stress_launch.cuh"
#include "mpm/device/cuda/timing.cuh"

namespace mpm {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr int deforming_models = 11;       // of StrengthModels, before the rigid one
constexpr std::int64_t look_at_order = 4;  // steps from one count of jumps to the next
constexpr std::size_t of_particles = DeviceSum::count - DeviceSum::of_nodes;

template <int D>
class RunOnDevice : public DeviceRun<D> {
 public:
  explicit RunOnDevice(const DeviceProblem<D>& problem)
      : grid_(problem.grid),
        first_(problem.stress_first),
        disorder_(problem.disorder),
        lists_(problem.grid.reach().before > 0) {
    for (const DevicePool& pool : problem.pools) pools_.push_back(take_pool<D>(pool));
    body_count_ = problem.bodies.size();
    bodies_.take(problem.bodies.data(), body_count_);
    host_bodies_ = problem.bodies;
    views_.allocate(pools_.size());
    for (PoolOnDevice<D>& pool : pools_)
      pool.share = pool.grid_share = none;  // until the first step
    send_views();
    start(problem);
    report_sums_.allocate(body_count_ * DeviceSum::count);
    report_fastest_.allocate(body_count_);
    sums_.allocate(body_count_ * DeviceSum::count);
    fastest_.allocate(body_count_);
    grid_shares_.allocate(body_count_);
    flags_.allocate(2);
    host_counters_.allocate(8);
    make_room();
  }

  void step(const DeviceStep<D>& step, DeviceReport& report) override;
  void give_back(std::vector<DevicePool>& pools) override;
  std::size_t bytes() const override { return device_bytes(); }
  std::vector<DeviceTime> times() override { return timer_.take(); }

 private:
  void start(const DeviceProblem<D>& problem);
  void send_views();
  PartialView partial() {
    return {partial_first_.data(),
            partial_second_.size() > 0 ? partial_second_.data() : partial_first_.data()};
  }
  void make_room();
  void sort_columns();
  ParticleStep<D> particle_step(const DeviceStep<D>& step, const MoveView& moves);
  template <class B>
  void make_step(const DeviceStep<D>& step);
  template <class B, class F>
  void with_transfer(const DeviceStep<D>& step, F&& f);
  template <class B, class Gives, unsigned what>
  void map(const ParticleStep<D>& particles);
  void stress(const DeviceStep<D>& step, const ParticleStep<D>& particles);
  void read(DeviceReport& report);

  GridGeometry<D> grid_;
  bool first_;
  double disorder_;
  DeviceLists<D> lists_;
  std::vector<PoolOnDevice<D>> pools_;
  std::vector<DeviceBody> host_bodies_;
  std::size_t body_count_ = 0;
  std::int64_t steps_ = 0;
  DeviceArray<DeviceBody> bodies_;
  DeviceArray<ParticleView<D>> views_;
  DeviceArray<HalfRecord> partial_first_, partial_second_;
  DeviceArray<double> records_, node_sums_, patch_sums_, patch_fastest_, sums_, fastest_,
      grid_shares_, spare_column_;
  DeviceArray<std::uint32_t> flags_;  // negative volume; odd
  PinnedArray<double> report_sums_, report_fastest_;
  PinnedArray<std::uint32_t> host_counters_;
  KernelTimer timer_;
};

template <int D>
void RunOnDevice<D>::start(const DeviceProblem<D>& problem) {
  std::size_t rows = 0;
  for (const PoolOnDevice<D>& pool : pools_) rows += pool.rows;
  DeviceArray<std::uint64_t> keys;
  DeviceArray<std::uint32_t> of_entry, body, count;
  keys.allocate(rows);
  of_entry.allocate(rows);
  count.allocate(1);
  check_cuda(cudaMemset(count.data(), 0, sizeof(std::uint32_t)), "taking particles");
  for (std::size_t p = 0; p < pools_.size(); ++p) {
    body.take(problem.pools[p].body, pools_[p].rows);
    launch(first_keys<D>, blocks_of(pools_[p].rows), 256, grid_,
           mpm::view_of(pools_[p], grid_.cell_size), body.data(), pools_[p].rows, keys.data(),
           of_entry.data(), count.data());
    for (std::size_t row = 0; row < pools_[p].rows; ++row)
      pools_[p].in_lists += problem.pools[p].body[row] != DevicePool::no_body;
  }
  std::uint32_t found = 0;
  count.give(&found, 1);
  spare_column_.allocate(rows);
  if (found == 0) throw std::runtime_error("there is no particle for the device");
  lists_.start(grid_, bodies_.data(), views_.data(), keys, of_entry, found, body_count_,
               spare_column_.data());
  keys.release();
  of_entry.release();
  sort_columns();
}

template <int D>
void RunOnDevice<D>::send_views() {
  std::vector<ParticleView<D>> views;
  for (std::size_t p = 0; p < pools_.size(); ++p)
    views.push_back(mpm::view_of(pools_[p], grid_.cell_size));
  views_.take(views.data(), views.size());
}

template <int D>
void RunOnDevice<D>::make_room() {
  const std::size_t per_block = [&] {
    std::size_t n = 0;
    Bases::with(grid_.basis, 0.5, [&]<class B>(const B&) { n = Block<B, D>::nodes; });
    return n;
  }();
  const std::size_t patches = lists_.patches(), tiles = lists_.node_tiles();
  partial_first_.need(patches * per_block);
  // With USF forces are mapped when the momenta have been summed; walls with images ask for masses
  // then.
  if (!first_ || grid_.has_ghosts()) partial_second_.need(patches * per_block);
  records_.need(tiles * NodeTileView<D>::nodes * record);
  node_sums_.need(tiles * DeviceSum::of_nodes);
  patch_sums_.need(patches * of_particles);
  patch_fastest_.need(patches);
}

/// The rows of all columns in the order of the lists.
template <int D>
void RunOnDevice<D>::sort_columns() {
  timer_.time("sort columns", [&] {
    DeviceArray<std::uint32_t> entries;
    entries.allocate(body_count_ + 1);
    launch(first_entries, blocks_of(body_count_ + 1), 256, lists_.view().cell_begin,
           lists_.patch_of_body(), Tile<D>::cell_count, body_count_ + 1, entries.data());
    std::vector<std::uint32_t> first(body_count_ + 1);
    entries.give(first.data(), first.size());
    for (std::size_t p = 0; p < pools_.size(); ++p) {
      // Rows of particles that have been taken out would be lost.
      if (pools_[p].in_lists < pools_[p].rows) continue;
      std::vector<EntryRange> bodies;
      for (std::size_t b = 0; b < body_count_; ++b)
        if (host_bodies_[b].pool == static_cast<int>(p))
          bodies.push_back({first[b], first[b + 1] - first[b]});
      sort_pool(pools_[p], bodies, lists_.order(), lists_.spare(), spare_column_);
    }
  });
  send_views();
}

template <int D>
ParticleStep<D> RunOnDevice<D>::particle_step(const DeviceStep<D>& step, const MoveView& moves) {
  const double moment = grid_.affine_moment();
  return {grid_,           grid_.coordinates(),
          bodies_.data(),  views_.data(),
          step.time_step,  -1.0 / grid_.cell_size,
          moment,          moment > 0.0 ? grid_.cell_size / moment : 0.0,
          moves,           patch_sums_.data(),
          lists_.patches()};
}

template <int D>
template <class B, class F>
void RunOnDevice<D>::with_transfer(const DeviceStep<D>& step, F&& f) {
  switch (step.transfer) {
    case DeviceTransfer::flip:
      return f.template operator()<Flip>();
    case DeviceTransfer::flip_pic:
      return f.template operator()<FlipPic>();
    case DeviceTransfer::aflip:
      if constexpr (B::second_moment > 0.0) return f.template operator()<Aflip>();
      break;
  }
  throw std::runtime_error("an affine transfer needs the quadratic B-spline");
}

template <int D>
template <class B, class Gives, unsigned what>
void RunOnDevice<D>::map(const ParticleStep<D>& particles) {
  launch(map_patches<Gives, what, B, D>, static_cast<unsigned>(lists_.patches()), scatter_threads,
         lists_.view(), partial(), particles);
}

template <int D>
void RunOnDevice<D>::stress(const DeviceStep<D>& step, const ParticleStep<D>& particles) {
  for (std::size_t p = 0; p < pools_.size(); ++p) {
    PoolOnDevice<D>& pool = pools_[p];
    if (pool.in_lists == 0) continue;
    const double duration = first_ ? step.strain_time : step.time_step;
    const Material& material = *pool.material;
    StressStep<D> of{particles,
                     first_,
                     static_cast<int>(p),
                     mpm::view_of(material),
                     block_columns(pool),
                     {duration > 0.0 ? duration : step.time_step, step.time_after, grid_.cell_size,
                      material.viscosity, first_},
                     duration / grid_.cell_size,
                     first_ && duration > 0.0 ? step.time_step / duration : 1.0,
                     patch_fastest_.data(),
                     flags_.data()};
    const StressLaunch<D> launch{&material, lists_.view(), lists_.nodes(records_.data()), of,
                                 lists_.patches()};
    [&]<int... k>(std::integer_sequence<int, k...>) {
      ((material.strength.index() == k ? launch_stress<D, k>(launch) : void()), ...);
    }(std::make_integer_sequence<int, deforming_models>{});
  }
}

template <int D>
template <class B>
void RunOnDevice<D>::make_step(const DeviceStep<D>& step) {
  const auto patches = static_cast<unsigned>(lists_.patches());
  const auto tiles = static_cast<unsigned>(lists_.node_tiles());
  const NodeTileView<D> nodes = lists_.nodes(records_.data());
  const PartialView partial = this->partial();
  const MoveView moves = lists_.begin_moves(spare_column_.data());
  const ParticleStep<D> particles = particle_step(step, moves);
  const bool affine = step.transfer == DeviceTransfer::aflip;
  const NodeStep<D> of_nodes{grid_,
                             step.time_step,
                             step.gravity,
                             dot(step.gravity, step.gravity) > 0.0,
                             grid_.has_ghosts(),
                             step.takes_of_grid,
                             affine,
                             grid_shares_.data(),
                             node_sums_.data(),
                             lists_.node_tiles()};
  const auto with_gives = [&](auto&& f) {
    if constexpr (B::second_moment > 0.0)
      if (affine) return f.template operator()<Apic>();
    f.template operator()<Flip>();
  };
  const bool ghosts = grid_.has_ghosts();
  constexpr unsigned threads = NodeTileView<D>::nodes;
  if (first_) {
    timer_.time("map momentum", [&] {
      with_gives([&]<class Gives>() { map<B, Gives, gives_mass | gives_momentum>(particles); });
    });
    timer_.time("nodes", [&] {
      launch(sum_nodes<B, D, true, false, false>, tiles, threads, nodes, partial, of_nodes);
      if (ghosts)
        launch(reflect_nodes<D, true, false, false, true>, tiles, threads, nodes, of_nodes);
    });
    timer_.time("stress", [&] { stress(step, particles); });
    timer_.time("map forces", [&] { map<B, Flip, gives_forces>(particles); });
    timer_.time("nodes", [&] {
      launch(sum_nodes<B, D, false, true, false>, tiles, threads, nodes, partial, of_nodes);
      if (ghosts)
        launch(reflect_nodes<D, true, true, true, false>, tiles, threads, nodes, of_nodes);
    });
    timer_.time("advance and move", [&] {
      with_transfer<B>(step, [&]<class Transfer>() {
        launch(advance_patches<Transfer, DeviceAlso::move, B, D>, patches, move_threads,
               lists_.view(), nodes, partial, particles);
      });
    });
  } else {
    timer_.time("map momentum and forces", [&] {
      with_gives([&]<class Gives>() {
        map<B, Gives, gives_mass | gives_momentum | gives_forces>(particles);
      });
    });
    timer_.time("nodes", [&] {
      launch(sum_nodes<B, D, true, true, false>, tiles, threads, nodes, partial, of_nodes);
      if (ghosts) launch(reflect_nodes<D, true, true, true, true>, tiles, threads, nodes, of_nodes);
    });
    timer_.time("advance and remap", [&] {
      with_transfer<B>(step, [&]<class Transfer>() {
        launch(advance_patches<Transfer, DeviceAlso::remap, B, D>, patches, scatter_threads,
               lists_.view(), nodes, partial, particles);
      });
    });
    timer_.time("nodes", [&] {
      launch(sum_nodes<B, D, false, false, true>, tiles, threads, nodes, partial, of_nodes);
      if (ghosts)
        launch(reflect_nodes<D, false, true, false, false>, tiles, threads, nodes, of_nodes);
    });
    timer_.time("stress and move", [&] { stress(step, particles); });
  }
  check_cuda(cudaGetLastError(), "starting kernels");
}

template <int D>
void RunOnDevice<D>::read(DeviceReport& report) {
  const auto bodies = static_cast<unsigned>(body_count_);
  launch(sum_bodies, dim3(bodies, DeviceSum::of_nodes), 256, node_sums_.data(), lists_.node_tiles(),
         lists_.tile_of_body(), sums_.data(), 0);
  launch(sum_bodies, dim3(bodies, of_particles), 256, patch_sums_.data(), lists_.patches(),
         lists_.patch_of_body(), sums_.data(), DeviceSum::of_nodes);
  launch(find_fastest, bodies, 256, patch_fastest_.data(), lists_.patch_of_body(), fastest_.data());
  const auto get = [](auto* to, const auto* from, std::size_t count) {
    check_cuda(cudaMemcpyAsync(to, from, count * sizeof(*from), cudaMemcpyDeviceToHost),
               "reading sums");
  };
  get(report_sums_.data(), sums_.data(), body_count_ * DeviceSum::count);
  get(report_fastest_.data(), fastest_.data(), body_count_);
  get(host_counters_.data(), lists_.counters(), 3);
  get(host_counters_.data() + 4, flags_.data(), 2);
  check_cuda(cudaDeviceSynchronize(), "making a step");
  report.sums.assign(report_sums_.data(), report_sums_.data() + body_count_ * DeviceSum::count);
  report.fastest.assign(report_fastest_.data(), report_fastest_.data() + body_count_);
  report.negative_volume = host_counters_[4] != 0;
  report.odd = host_counters_[5];
}

template <int D>
void RunOnDevice<D>::step(const DeviceStep<D>& step, DeviceReport& report) {
  bool other_shares = false;
  for (std::size_t p = 0; p < pools_.size(); ++p) {
    PoolOnDevice<D>& pool = pools_[p];
    other_shares =
        other_shares || step.share[p] != pool.share || step.grid_share[p] != pool.grid_share;
    pool.share = step.share[p];
    pool.grid_share = step.grid_share[p];
  }
  if (other_shares) {
    send_views();
    std::vector<double> of_bodies;
    for (const DeviceBody& body : host_bodies_)
      of_bodies.push_back(pools_[static_cast<std::size_t>(body.pool)].grid_share);
    grid_shares_.take(of_bodies.data(), of_bodies.size());
  }
  check_cuda(cudaMemsetAsync(node_sums_.data(), 0,
                             lists_.node_tiles() * DeviceSum::of_nodes * sizeof(double)),
             "making a step");
  check_cuda(
      cudaMemsetAsync(patch_sums_.data(), 0, lists_.patches() * of_particles * sizeof(double)),
      "making a step");
  check_cuda(cudaMemsetAsync(flags_.data(), 0, 2 * sizeof(std::uint32_t)), "making a step");
  Bases::with(grid_.basis, 0.5, [&]<class B>(const B&) { make_step<B>(step); });
  ++steps_;
  if (step.look)
    for (PoolOnDevice<D>& pool : pools_)
      launch(count_odd<D>, blocks_of(pool.rows), 256, grid_, mpm::view_of(pool, grid_.cell_size),
             pool.rows, pool.material->density, flags_.data() + 1);
  read(report);
  report.patches = lists_.patches();
  report.node_tiles = lists_.node_tiles();
  timer_.time("lists", [&] {
    lists_.finish_moves(grid_, bodies_.data(), views_.data(), host_counters_[0] != 0,
                        host_counters_[1]);
  });
  make_room();
  if (steps_ % look_at_order != 0) return;
  check_cuda(cudaMemsetAsync(lists_.jumps(), 0, sizeof(std::uint32_t)), "sorting columns");
  launch(count_jumps, blocks_of(lists_.particles()), 256, lists_.order(), lists_.particles(),
         lists_.jumps());
  std::uint32_t jumps = 0;
  check_cuda(cudaMemcpy(&jumps, lists_.jumps(), sizeof(jumps), cudaMemcpyDeviceToHost),
             "sorting columns");
  if (jumps > disorder_ * static_cast<double>(lists_.particles())) sort_columns();
}

template <int D>
void RunOnDevice<D>::give_back(std::vector<DevicePool>& pools) {
  for (std::size_t p = 0; p < pools_.size(); ++p)
    mpm::give_back(pools_[p], *pools[p].columns, spare_column_);
}

}  // namespace

DeviceRun<2>* make_run(const DeviceProblem<2>& problem) { return new RunOnDevice<2>(problem); }
DeviceRun<3>* make_run(const DeviceProblem<3>& problem) { return new RunOnDevice<3>(problem); }

}  // namespace mpm
