#pragma once
#include "mpm/comm/comm.hpp"
#include "mpm/contact/contact.hpp"

namespace mpm {

/// What surfaces are set back beyond their overlap [cells]: positions are good to 1e-10 at 2^19
/// cells, and rounding must not choose what pushes at once.
inline constexpr double beyond_overlap = 1e-9;

/// Bodies that overlap at the start do not push each other: the surface of each particle that
/// overlaps another body is set back by that (decision 0053), unless the two are bonded. Needs
/// find_touches().
template <int D>
void set_back_surfaces(Contact<D>& contact, const std::vector<Body<D>>& bodies,
                       std::vector<ParticlePool<D>>& pools, const ContactSettings& settings,
                       double cell_size);

/// What springs have taken up as bodies that are pressed into each other (PairLaw::pressed) went
/// further by `more` of that before the touches were found [J; in 2D J/m]. Each rank calls it.
template <int D>
double work_of_pressing(const Contact<D>& contact, const std::vector<Body<D>>& bodies,
                        const ContactSettings& whole, double more, double cell_size, Comm& comm);

}  // namespace mpm
