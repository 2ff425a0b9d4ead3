#pragma once
// A run on a device: its memory, and a step as a list of kernels (make_step.cu).
#include <limits>

#include "mpm/device/cuda/advance.cuh"
#include "mpm/device/cuda/exchange.cuh"
#include "mpm/device/cuda/lists.cuh"
#include "mpm/device/cuda/nodes.cuh"
#include "mpm/device/cuda/pool.cuh"
#include "mpm/device/cuda/timing.cuh"

namespace mpm {

inline constexpr std::size_t of_particles = DeviceSum::count - DeviceSum::of_nodes;

template <int D>
class RunOnDevice : public DeviceRun<D> {
 public:
  explicit RunOnDevice(const DeviceProblem<D>& problem)
      : grid_(problem.grid),
        first_(problem.stress_first),
        disorder_(problem.disorder),
        outflow_box_(problem.outflow_box),
        lists_(problem.grid.reach().before > 0) {
    for (const DevicePool& pool : problem.pools) pools_.push_back(take_pool<D>(pool));
    body_count_ = problem.bodies.size();
    bodies_.take(problem.bodies.data(), body_count_);
    host_bodies_ = problem.bodies;
    std::vector<double> densities;
    for (const DevicePool& pool : problem.pools) densities.push_back(pool.material->density);
    densities_.take(densities.data(), densities.size());
    views_.allocate(pools_.size());
    for (PoolOnDevice<D>& pool : pools_)
      pool.share = pool.grid_share =
          std::numeric_limits<double>::quiet_NaN();  // until the first step
    send_views();
    start(problem);
    report_sums_.allocate(body_count_ * DeviceSum::count);
    report_fastest_.allocate(body_count_);
    sums_.allocate(body_count_ * DeviceSum::count);
    fastest_.allocate(body_count_);
    grid_shares_.allocate(body_count_);
    of_weighed_.assign(body_count_, 0);
    weighed_.take(of_weighed_.data(), body_count_);
    flags_.allocate(flag_count);
    host_counters_.allocate(8);
    make_room();
  }

  void step(const DeviceStep<D>& step, HostStages* host, DeviceReport& report) override;
  const double* read_column(std::size_t pool, int component) override;
  void choose_nodes(const std::vector<NodeBlockPlace<D>>& blocks) override {
    summed_.choose(blocks, [&](auto... of) { lists_.find_node_tiles(of...); });
  }
  const double* read_nodes(int half) override { return summed_.read(summed(half), half); }
  double* nodes_of_host(int half) override { return summed_.of_host(half); }
  void write_nodes(int half) override { summed_.write(summed(half), half); }
  void choose_mapped(const std::vector<NodeBlockPlace<D>>& blocks) override;
  const double* read_mapped() override;
  double* mapped_of_host() override { return mapped_.of_host(0); }
  void write_mapped() override { mapped_.write(mapped(), 0); }
  void wait() override { check_cuda(cudaDeviceSynchronize(), "making a step"); }
  std::size_t bytes() const override { return device_bytes(); }
  std::vector<DeviceTime> times() override { return timer_.take(); }

 private:
  void start(const DeviceProblem<D>& problem);
  void send_views();
  PartialView partial() {
    return {partial_first_.data(),
            partial_second_.size() > 0 ? partial_second_.data() : partial_first_.data()};
  }
  SummedNodes<D> summed(int half) {
    return {summed_.tiles(), reinterpret_cast<HalfRecord*>(records_.data()), half};
  }
  MappedNodes<D> mapped() {
    MappedNodes<D> nodes{mapped_.tiles(), partial().second, 0, 0};
    Bases::with(grid_.basis, 0.5, [&]<class B>(const B&) {
      nodes.edge = Block<B, D>::edge;
      nodes.low = Block<B, D>::low;
    });
    return nodes;
  }
  void make_room();
  void sort_columns();
  ParticleStep<D> particle_step(const DeviceStep<D>& step, const MoveView& moves);
  void make_step(const DeviceStep<D>& step, HostStages* host);
  NodeStep<D> node_step(const DeviceStep<D>& step);
  template <class B>
  void make_step(const DeviceStep<D>& step, HostStages* host);
  template <class B>
  void make_usf_step(const DeviceStep<D>& step, HostStages* host, const ParticleStep<D>& particles,
                     const NodeStep<D>& of_nodes);
  template <class B>
  void make_musl_step(const DeviceStep<D>& step, HostStages* host, const ParticleStep<D>& particles,
                      const NodeStep<D>& of_nodes);
  template <class B, bool momentum, Forces forces, bool remapped>
  void sum_all(const NodeStep<D>& of_nodes);
  template <bool first, bool second, bool advanced, bool mapped>
  void reflect(const NodeStep<D>& of_nodes);
  void advance_all(const NodeStep<D>& of_nodes) {
    launch(advance_nodes<D>, static_cast<unsigned>(lists_.node_tiles()), NodeTileView<D>::nodes,
           lists_.nodes(records_.data()), of_nodes);
    reflect<true, true, true, false>(of_nodes);
  }
  template <class B, DeviceAlso also>
  void advance(const DeviceStep<D>& step, const ParticleStep<D>& particles);
  template <class B, class F>
  void with_transfer(const DeviceStep<D>& step, F&& f);
  template <class B, class Gives, unsigned what>
  void map(const ParticleStep<D>& particles);
  void stress(const DeviceStep<D>& step, const ParticleStep<D>& particles);
  void read(DeviceReport& report);

  GridGeometry<D> grid_;
  bool first_;
  double disorder_;
  OutflowBox<D> outflow_box_;
  DeviceLists<D> lists_;
  std::vector<PoolOnDevice<D>> pools_;
  std::vector<DeviceBody> host_bodies_;
  std::size_t body_count_ = 0;
  std::int64_t steps_ = 0;
  DeviceArray<DeviceBody> bodies_;
  DeviceArray<ParticleView<D>> views_;
  DeviceArray<HalfRecord> partial_first_, partial_second_;
  DeviceArray<double> records_, node_sums_, patch_sums_, patch_fastest_, sums_, fastest_,
      grid_shares_, densities_, spare_column_;
  DeviceArray<StepDamping> damping_;
  DeviceArray<std::uint8_t> weighed_;  // of each body, as of_weighed_
  std::vector<std::uint8_t> of_weighed_;
  Vec<double, D> gravity_ = Vec<double, D>::zero();  // of the step
  NodeExchange<D, 2> summed_;
  NodeExchange<D, 1> mapped_;
  DeviceArray<std::uint32_t> flags_;  // negative volume, odd, gone
  static constexpr int flag_count = 3;
  PinnedArray<double> host_column_;
  PinnedArray<double> report_sums_, report_fastest_;
  PinnedArray<std::uint32_t> host_counters_;
  KernelTimer timer_;
};

}  // namespace mpm
