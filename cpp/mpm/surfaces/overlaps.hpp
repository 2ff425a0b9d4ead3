#pragma once
#include <functional>

#include "mpm/domain.hpp"

namespace mpm {

/// The faces of the box and the bodies that the points of a part overlap or may begin to: how deep,
/// how stiff, along what. Needs find_near_points() and bound_onsets().
template <int D>
void find_overlaps(const Domain<D>& domain, SurfacePart<D>& part);

/// f(near points, how high above their surface, in spacings) for what the points of a part feel.
template <int D>
void for_each_near_surface(const Domain<D>& domain, const SurfacePart<D>& part,
                           const std::function<void(const NearPoints&, double)>& f);

/// Before the first step: the surfaces of points that overlap faces or bodies are set back by that,
/// so that nothing is pushed.
template <int D>
void set_back_overlaps(Domain<D>& domain);

/// The surfaces of points that overlap more of a body or a face of the box than before, as they
/// have been uncovered there, are set back by that: no spring begins pressed. `before`: overlaps by
/// the first numbers of points, sorted, of all ranks.
template <int D>
void set_back_more(Domain<D>& domain, const std::vector<KeptOfContact<double>>& before);

}  // namespace mpm
