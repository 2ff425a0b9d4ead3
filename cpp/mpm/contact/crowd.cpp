#include "mpm/contact/crowd.hpp"

#include <vector>

#include "mpm/comm/all_sums.hpp"
#include "mpm/contact/pair_records.hpp"

namespace mpm {

template <int D>
Crowd largest_crowd(const Contact<D>& contact, const TileGrid<D>& grid) {
  Crowd most;
  for (const ContactPart<D>& part : contact.parts)
    for (const ContactNode& node : part.nodes) {
      if (static_cast<int>(node.sides) < most.bodies) continue;
      const Vec<double, D> x = grid.position_of(place_of(contact, grid, node));
      const Vector3 place = in_space<D>(x);
      // Of equal ones the lowest, in whatever order they come.
      if (static_cast<int>(node.sides) == most.bodies && !is_lower(place.c, most.position))
        continue;
      most.bodies = node.sides;
      most.body = part.sides[node.first_side].body;
      for (int a = 0; a < D; ++a) most.position[a] = x[a];
    }
  Comm& comm = *grid.partition.comm;
  std::vector<double> key{1.0 * most.bodies};
  for (int a = D; a-- > 0;) key.push_back(-most.position[a]);
  broadcast(comm, rank_of_largest(comm, key), most);
  return most;
}

template Crowd largest_crowd<2>(const Contact<2>&, const TileGrid<2>&);
template Crowd largest_crowd<3>(const Contact<3>&, const TileGrid<3>&);

}  // namespace mpm
