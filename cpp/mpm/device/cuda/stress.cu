// The kernels of one strength model, MPM_STRENGTH in StrengthModels, with each equation of state.
#include <cstring>

#include "mpm/device/cuda/memory.cuh"
#include "mpm/device/cuda/stress_launch.cuh"

namespace mpm {
namespace {

using Strength = std::variant_alternative_t<MPM_STRENGTH, StrengthModels::Any>;

template <class Eos, int D>
void launch_with(const StressLaunch<D>& of, const Eos& eos) {
  const Strength& strength = std::get<Strength>(of.material->strength);
  const auto blocks = static_cast<unsigned>(of.patches);
  if (of.material->failures.empty())
    launch(stress_patches<Strength, Eos, NoFailures, D>, blocks, stress_threads, strength, eos,
           NoFailures{}, of.lists, of.nodes, of.step);
  else
    launch(stress_patches<Strength, Eos, FailureList, D>, blocks, stress_threads, strength, eos,
           list_of(of.material->failures), of.lists, of.nodes, of.step);
}

}  // namespace

template <int D, int strength>
void launch_stress(const StressLaunch<D>& of) {
  const Material& material = *of.material;
  if constexpr (Strength::eos != EosUse::must)
    if (!material.eos) launch_with(of, NoEos{});
  if constexpr (Strength::eos != EosUse::never)
    if (material.eos)
      std::visit(
          [&]<class Eos>(const Eos& eos) {
            if constexpr (LinearEos<Eos>) {
              AnyLinearEos any;
              any.index = static_cast<int>(material.eos->index());
              std::memcpy(any.bytes, &eos, sizeof(eos));
              launch_with(of, any);
            } else {
              launch_with(of, eos);
            }
          },
          *material.eos);
  check_cuda(cudaGetLastError(), "updating the stress");
}

template void launch_stress<2, MPM_STRENGTH>(const StressLaunch<2>&);
template void launch_stress<3, MPM_STRENGTH>(const StressLaunch<3>&);

}  // namespace mpm
