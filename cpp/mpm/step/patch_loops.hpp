#pragma once
// Loops over the patches of a domain, shared out among the threads.
#include "mpm/domain.hpp"

namespace mpm {

/// Kinds of bodies, a bit each.
using Kinds = unsigned;
constexpr Kinds kind_bit(BodyKind kind) { return 1u << static_cast<unsigned>(kind); }
inline constexpr Kinds deformable = kind_bit(BodyKind::deformable);
inline constexpr Kinds free_rigid = kind_bit(BodyKind::rigid);
inline constexpr Kinds prescribed = kind_bit(BodyKind::prescribed);
inline constexpr Kinds in_body = kind_bit(BodyKind::material);

/// f(p) for all patches, or for those of the part that is done now. The range is always that of all
/// patches, so that a thread has the same ones in every stage, and in its cache (decision 0025).
template <int D, class F>
void for_each_patch(Domain<D>& domain, F&& f) {
  const Partition<D>& partition = domain.grid.partition;
  const bool all = partition.part == PatchPart::all;
  const auto& some = partition.part == PatchPart::edge ? partition.edge : partition.inside;
  // One body for both, so that the compiler makes one of it.
  domain.threads.for_each(all ? domain.grid.patches.size() : some.size(),
                          [&](std::size_t k) { f(all ? k : std::size_t{some[k]}); });
}

/// The same for the patches of bodies of these kinds.
template <int D, class F>
void for_each_patch(Domain<D>& domain, Kinds kinds, F&& f) {
  for_each_patch(domain, [&](std::size_t p) {
    if (kinds & kind_bit(domain.body_of(domain.grid.patches[p]).kind)) f(p);
  });
}

/// f(patch, block) for those of matter that flows and has a limit to its growth.
template <int D, class F>
void for_each_flowing_patch(Domain<D>& domain, F&& f) {
  for_each_patch(domain, deformable, [&](std::size_t p) {
    const Patch<D>& patch = domain.grid.patches[p];
    if (domain.pool_of(patch).at.growth_limit >= 0) f(patch, domain.grid.block(p));
  });
}

}  // namespace mpm
