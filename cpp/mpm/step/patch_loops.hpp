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

/// f(p) for the patches of bodies of these kinds. The range is always that of all patches, so that
/// a thread has the same ones in every stage, and in its cache (decision 0025).
template <int D, class F>
void for_each_patch(Domain<D>& domain, Kinds kinds, F&& f) {
  domain.threads.for_each(domain.grid.patches.size(), [&](std::size_t p) {
    if (kinds & kind_bit(domain.body_of(domain.grid.patches[p]).kind)) f(p);
  });
}

}  // namespace mpm
