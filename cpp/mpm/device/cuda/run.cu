#include "mpm/device/cuda/run.cuh"

namespace mpm {

constexpr std::int64_t look_at_order = 4;  // steps from one count of jumps to the next

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
  lists_.start(grid_, bodies_.data(), views_.data(), keys, of_entry, found, rows, body_count_,
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
      if (pools_[p].rows == 0) continue;
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
  get(host_counters_.data() + 4, flags_.data(), flag_count);
  check_cuda(cudaDeviceSynchronize(), "making a step");
  report.sums.assign(report_sums_.data(), report_sums_.data() + body_count_ * DeviceSum::count);
  report.fastest.assign(report_fastest_.data(), report_fastest_.data() + body_count_);
  report.negative_volume = host_counters_[4] != 0;
  report.odd = host_counters_[5];
  report.gone = host_counters_[6] != 0;
}

template <int D>
void RunOnDevice<D>::step(const DeviceStep<D>& step, HostStages* host, DeviceReport& report) {
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
  check_cuda(cudaMemsetAsync(flags_.data(), 0, flag_count * sizeof(std::uint32_t)),
             "making a step");
  gravity_ = step.gravity;
  if (!step.damping.empty()) damping_.take(step.damping.data(), step.damping.size());
  make_step(step, host);
  ++steps_;
  if (outflow_box_.exist)
    launch(find_left<D>, static_cast<unsigned>(lists_.patches()), 128, outflow_box_, lists_.view(),
           bodies_.data(), views_.data(), flags_.data() + 2);
  if (step.look)
    launch(count_odd<D>, static_cast<unsigned>(lists_.patches()), 128, grid_, lists_.view(),
           bodies_.data(), views_.data(), densities_.data(), flags_.data() + 1);
  read(report);
  report.patches = lists_.patches();
  report.node_tiles = lists_.node_tiles();
  timer_.time("lists", [&] {
    lists_.finish_moves(grid_, outflow_box_, bodies_.data(), views_.data(), host_counters_[0] != 0,
                        host_counters_[1], report.gone);
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
const double* RunOnDevice<D>::read_column(std::size_t pool, int component) {
  PoolOnDevice<D>& of = pools_[pool];
  if (host_column_.size() < of.rows) host_column_.allocate(of.rows);
  launch(give_rows<double>, blocks_of(of.rows), 256, of.column(component), of.home.data(), of.rows,
         spare_column_.data());
  check_cuda(cudaMemcpy(host_column_.data(), spare_column_.data(), of.rows * sizeof(double),
                        cudaMemcpyDeviceToHost),
             "giving particles to the host");
  return host_column_.data();
}

DeviceRun<2>* make_run(const DeviceProblem<2>& problem) { return new RunOnDevice<2>(problem); }
DeviceRun<3>* make_run(const DeviceProblem<3>& problem) { return new RunOnDevice<3>(problem); }

}  // namespace mpm
