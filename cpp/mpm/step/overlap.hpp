#pragma once
// Ranks hide what passes between them behind work: the stages before an exchange go through the
// patches first of which others read nodes; what these have is sent, and the others' turn comes
// while it is on its way (decision 0056).
#include "mpm/step/stages.hpp"

namespace mpm {

/// Can a stage be done for some patches now and for the others later? One with nothing to do can.
template <int D>
bool in_parts(const Domain<D>& domain, const Stage<D>& stage) {
  using S = Stages<D>;
  return stage.by_patch || (stage.run == S::load_surfaces.run && !domain.has_loads()) ||
         (stage.run == S::hold_rigid.run && !domain.has_rigid());
}

/// The exchange to which the k-th stage and all between lead in parts; k if there is none.
template <int D>
std::size_t exchange_after(const Domain<D>& domain, std::span<const Stage<D>> stages,
                           std::size_t k) {
  std::size_t end = k;
  while (end < stages.size() && in_parts(domain, stages[end])) ++end;
  return end < stages.size() && stages[end].start != nullptr ? end : k;
}

/// All stages of a step by run(k), which runs the k-th.
template <int D, class Run>
void run_stages(Domain<D>& domain, std::span<const Stage<D>> stages, Run&& run) {
  Partition<D>& partition = domain.grid.partition;
  for (std::size_t k = 0; k < stages.size(); ++k) {
    const std::size_t end = partition.alone() ? k : exchange_after(domain, stages, k);
    if (end == k) {
      run(k);
      continue;
    }
    for (const PatchPart part : {PatchPart::edge, PatchPart::inside}) {
      partition.part = part;
      for (std::size_t j = k; j < end; ++j) run(j);
      if (part == PatchPart::edge) stages[end].start(domain);
    }
    partition.part = PatchPart::all;
    k = end - 1;
  }
}

}  // namespace mpm
