#pragma once
#include "mpm/contact/contact.hpp"

namespace mpm {

/// Find the overlapped nodes with their normals, pairs and gaps, eq. (5). Needs mass and velocity
/// at the nodes, and the length of the step that begins.
template <int D>
void find_nodes(Contact<D>& contact, TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                const std::vector<ParticlePool<D>>& pools, const ContactSettings& settings,
                double time_step, Threads& threads);

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
