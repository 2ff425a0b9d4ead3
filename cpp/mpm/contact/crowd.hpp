#pragma once
#include "mpm/contact/contact.hpp"

namespace mpm {

/// The node at which most bodies meet.
struct Crowd {
  int bodies = 0;           // at the node
  int body = -1;            // one of them
  double position[3] = {};  // of the node [m]
};

/// Of the nodes of this step where bodies may act on each other.
template <int D>
Crowd largest_crowd(const Contact<D>& contact, const TileGrid<D>& grid);

}  // namespace mpm
