#pragma once
// What has been noted, in sentences.
#include "mpm/run/simulation.hpp"

namespace mpm {

template <int D>
std::vector<Warning> warnings(const Simulation<D>& simulation);

/// The body that a group begins with, and that it stands for all of its entry.
template <int D>
std::string group_name(const Domain<D>& domain, int first);

}  // namespace mpm
