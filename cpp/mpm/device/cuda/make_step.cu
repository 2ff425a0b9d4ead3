// The kernels of a step, in the order of step/scheme.hpp.
#include "mpm/device/cuda/run.cuh"
#include "mpm/device/cuda/stress_launch.cuh"

namespace mpm {
namespace {

constexpr int deforming_models = 11;  // of StrengthModels, before the rigid one

/// What the host does with the nodes in the midst of a step, if anything.
void host_does(HostStages* host, KernelTimer& timer, NodeMoment moment) {
  if (host != nullptr && host->wants(moment))
    timer.time("stages of the host", [&] { host->with_nodes(moment); });
}

}  // namespace

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
                     flags_.data(),
                     flags_.data() + 2};
    const StressLaunch<D> launch{&material, lists_.view(), lists_.nodes(records_.data()), of,
                                 lists_.patches()};
    [&]<int... k>(std::integer_sequence<int, k...>) {
      ((material.strength.index() == k ? launch_stress<D, k>(launch) : void()), ...);
    }(std::make_integer_sequence<int, deforming_models>{});
  }
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
NodeStep<D> RunOnDevice<D>::node_step(const DeviceStep<D>& step) {
  return {grid_,
          step.time_step,
          step.gravity,
          dot(step.gravity, step.gravity) > 0.0,
          grid_.has_ghosts(),
          step.takes_of_grid,
          step.transfer == DeviceTransfer::aflip,
          grid_shares_.data(),
          step.damping.empty() ? nullptr : damping_.data(),
          weighed_.data(),
          node_sums_.data(),
          lists_.node_tiles()};
}

template <int D>
template <class B, bool momentum, Forces forces, bool remapped>
void RunOnDevice<D>::sum_all(const NodeStep<D>& of_nodes) {
  launch(sum_nodes<B, D, momentum, forces, remapped>, static_cast<unsigned>(lists_.node_tiles()),
         NodeTileView<D>::nodes, lists_.nodes(records_.data()), partial(), of_nodes);
}

template <int D>
template <bool first, bool second, bool advanced, bool mapped>
void RunOnDevice<D>::reflect(const NodeStep<D>& of_nodes) {
  if (of_nodes.ghosts)
    launch(reflect_nodes<D, first, second, advanced, mapped>,
           static_cast<unsigned>(lists_.node_tiles()), NodeTileView<D>::nodes,
           lists_.nodes(records_.data()), of_nodes);
}

template <int D>
template <class B, DeviceAlso also>
void RunOnDevice<D>::advance(const DeviceStep<D>& step, const ParticleStep<D>& particles) {
  with_transfer<B>(step, [&]<class Transfer>() {
    launch(advance_patches<Transfer, also, B, D>, static_cast<unsigned>(lists_.patches()),
           advance_threads<also>, lists_.view(), lists_.nodes(records_.data()), partial(),
           particles);
  });
}

/// f<Gives>(): the transfer by which particles give their momentum.
template <class B, class F>
void with_gives(bool affine, F&& f) {
  if constexpr (B::second_moment > 0.0)
    if (affine) return f.template operator()<Apic>();
  f.template operator()<Flip>();
}

template <int D>
template <class B>
void RunOnDevice<D>::make_usf_step(const DeviceStep<D>& step, HostStages* host,
                                   const ParticleStep<D>& particles, const NodeStep<D>& of_nodes) {
  timer_.time("map momentum", [&] {
    with_gives<B>(of_nodes.other_at_fixed,
                  [&]<class Gives>() { map<B, Gives, gives_mass | gives_momentum>(particles); });
  });
  timer_.time("nodes", [&] {
    sum_all<B, true, Forces::none, false>(of_nodes);
    reflect<true, false, false, true>(of_nodes);
  });
  host_does(host, timer_, NodeMoment::velocities);
  timer_.time("stress", [&] { stress(step, particles); });
  timer_.time("map forces", [&] { map<B, Flip, gives_forces>(particles); });
  host_does(host, timer_, NodeMoment::mapped);
  if (host == nullptr) {
    timer_.time("nodes", [&] {
      sum_all<B, false, Forces::advanced, false>(of_nodes);
      reflect<true, true, true, false>(of_nodes);
    });
  } else {
    timer_.time("nodes", [&] { sum_all<B, false, Forces::summed, false>(of_nodes); });
    host_does(host, timer_, NodeMoment::forces);
    timer_.time("nodes", [&] { advance_all(of_nodes); });
  }
  host_does(host, timer_, NodeMoment::advanced);
  const bool released = host != nullptr && host->wants(NodeMoment::released);
  if (!released) {
    timer_.time("advance and move", [&] { advance<B, DeviceAlso::move>(step, particles); });
    return;
  }
  host_does(host, timer_, NodeMoment::released);
  timer_.time("advance", [&] { advance<B, DeviceAlso::nothing>(step, particles); });
  host_does(host, timer_, NodeMoment::restored);
  timer_.time("move", [&] {
    launch(move_patches<B, D>, static_cast<unsigned>(lists_.patches()), move_threads, lists_.view(),
           lists_.nodes(records_.data()), particles);
  });
}

template <int D>
template <class B>
void RunOnDevice<D>::make_musl_step(const DeviceStep<D>& step, HostStages* host,
                                    const ParticleStep<D>& particles, const NodeStep<D>& of_nodes) {
  timer_.time("map momentum and forces", [&] {
    with_gives<B>(of_nodes.other_at_fixed, [&]<class Gives>() {
      map<B, Gives, gives_mass | gives_momentum | gives_forces>(particles);
    });
  });
  host_does(host, timer_, NodeMoment::mapped);
  if (host == nullptr) {
    timer_.time("nodes", [&] {
      sum_all<B, true, Forces::advanced, false>(of_nodes);
      reflect<true, true, true, true>(of_nodes);
    });
  } else {
    timer_.time("nodes", [&] {
      sum_all<B, true, Forces::summed, false>(of_nodes);
      reflect<true, false, false, true>(of_nodes);
    });
    host_does(host, timer_, NodeMoment::velocities_and_forces);
    timer_.time("nodes", [&] { advance_all(of_nodes); });
  }
  host_does(host, timer_, NodeMoment::advanced);
  host_does(host, timer_, NodeMoment::released);
  timer_.time("advance and remap", [&] { advance<B, DeviceAlso::remap>(step, particles); });
  host_does(host, timer_, NodeMoment::restored);
  timer_.time("nodes", [&] {
    sum_all<B, false, Forces::none, true>(of_nodes);
    reflect<false, true, false, false>(of_nodes);
  });
  host_does(host, timer_, NodeMoment::remapped);
  timer_.time("stress and move", [&] { stress(step, particles); });
}

template <int D>
template <class B>
void RunOnDevice<D>::make_step(const DeviceStep<D>& step, HostStages* host) {
  const MoveView moves = lists_.begin_moves(spare_column_.data());
  const ParticleStep<D> particles = particle_step(step, moves);
  const NodeStep<D> of_nodes = node_step(step);
  if (first_)
    make_usf_step<B>(step, host, particles, of_nodes);
  else
    make_musl_step<B>(step, host, particles, of_nodes);
  check_cuda(cudaGetLastError(), "starting kernels");
}

template <int D>
void RunOnDevice<D>::make_step(const DeviceStep<D>& step, HostStages* host) {
  Bases::with(grid_.basis, 0.5, [&]<class B>(const B&) { make_step<B>(step, host); });
}

template <int D>
void RunOnDevice<D>::choose_mapped(const std::vector<NodeBlockPlace<D>>& blocks) {
  mapped_.choose(blocks, [&](auto... of) { lists_.find_patches(of...); });
  bool changed = false;
  for (const NodeBlockPlace<D>& block : blocks)
    changed = std::exchange(of_weighed_[static_cast<std::size_t>(block.body)], 1) == 0 || changed;
  if (changed) weighed_.take(of_weighed_.data(), body_count_);
}

template <int D>
const double* RunOnDevice<D>::read_mapped() {
  // As on the host the weights come before what is added there: sums are rounded.
  if (grid_.has_ghosts() && mapped_.blocks() > 0)
    Bases::with(grid_.basis, 0.5, [&]<class B>(const B&) {
      launch(weigh_mapped<B, D>, static_cast<unsigned>(mapped_.blocks()), 128, lists_.view(),
             mapped_.tiles(), partial(), grid_, gravity_);
    });
  return mapped_.read(mapped(), 0);
}

template void RunOnDevice<2>::choose_mapped(const std::vector<NodeBlockPlace<2>>&);
template void RunOnDevice<3>::choose_mapped(const std::vector<NodeBlockPlace<3>>&);
template const double* RunOnDevice<2>::read_mapped();
template const double* RunOnDevice<3>::read_mapped();
template void RunOnDevice<2>::make_step(const DeviceStep<2>&, HostStages*);
template void RunOnDevice<3>::make_step(const DeviceStep<3>&, HostStages*);

}  // namespace mpm
