// Strength models that a small build leaves out: each takes seconds to compile.
#include "mpm/device/cuda/stress_launch.cuh"

namespace mpm {

template <int D, int strength>
void launch_stress(const StressLaunch<D>&) {
  throw std::runtime_error("the emulation has been built without this strength model");
}
#define MPM_LEAVE_OUT(k)                                     \
  template void launch_stress<2, k>(const StressLaunch<2>&); \
  template void launch_stress<3, k>(const StressLaunch<3>&);
MPM_OTHERS

}  // namespace mpm
