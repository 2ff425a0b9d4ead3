#pragma once
// What a frame holds of the bodies: columns rounded to floats, without room for doubles between.
#include <span>
#include <string>

#include "mpm/domain.hpp"
#include "mpm/run/slices.hpp"

namespace mpm {

/// A column of all bodies, one after another, rounded to floats: component c of particle i goes to
/// to[(i - first of the slice) * width + places[c]]. By all at once, and those without a slice need
/// no room. What belongs to bodies without the column, or to no component, stays as it is.
template <int D>
void round_column(const Domain<D>& domain, const Slices& slices, const std::string& name,
                  std::span<const int> places, std::size_t width, std::span<float> to);
/// A field of `derived_fields` of all particles, rounded to floats.
template <int D>
void round_derived(const Domain<D>& domain, const Slices& slices, const std::string& name,
                   std::span<float> to);

}  // namespace mpm
