#pragma once
// The seam between the run and the kernels of each strength model, which are compiled one by one.
#include "mpm/device/cuda/stress.cuh"

namespace mpm {

template <int D>
struct StressLaunch {
  const Material* material;
  ListView<D> lists;
  NodeTileView<D> nodes;
  StressStep<D> step;
  std::size_t patches;
};

/// Of the strength model at a place of StrengthModels.
template <int D, int strength>
void launch_stress(const StressLaunch<D>& launch);

}  // namespace mpm
