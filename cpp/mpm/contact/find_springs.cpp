// The pairs of bodies at a node, by the springs of those that overlap (decision 0054).
#include "mpm/contact/find_springs.hpp"

#include "mpm/contact/find_pairs.hpp"
#include "mpm/contact/springs.hpp"

namespace mpm {
namespace {

template <int D>
SpringSide<D> side_of(const TileGrid<D>& grid, const Body<D>& body, std::int32_t number,
                      const Index<D>& node) {
  // No compliance if it is rigid. One that is held for a while keeps its own.
  return {number, 1.0 / body.stiffness,
          NodeShares<D>(grid.basis, body.mean_edge / grid.cell_size, grid.walls, node)};
}

}  // namespace

template <int D>
void find_springs(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                  const ContactSettings& settings, const TileTouches<D>& touches,
                  ContactPart<D>& part, const ContactNode& node, const Index<D>& place, bool made) {
  const auto sides = part.sides_of(node);
  Vec<double, D> at;  // from the tile's first node
  for (int a = 0; a < D; ++a) at[a] = Tile<D>::cell_index(node.cell)[static_cast<std::size_t>(a)];
  const double distance = settings.gap_distance / grid.cell_size;
  const auto body = [&](std::int32_t b) -> const Body<D>& {
    return bodies[static_cast<std::size_t>(b)];
  };
  const auto spring = [&](ContactPair<D>& pair) {
    const std::int32_t body_r = sides[pair.r].body, body_s = sides[pair.s].body;
    const auto between = touches.between(body_r, body_s);
    if (between.empty()) return;
    const SpringSide<D> of_r = side_of<D>(grid, body(body_r), body_r, place),
                        of_s = side_of<D>(grid, body(body_s), body_s, place);
    Springs<D> springs;
    for (const NearTouch<D>& touch : between)
      if (touch.nodes >> node.cell & 1u) springs.add(touch, at, of_r, of_s);
    pair.normal = springs.normal(node.constrained_axes);
    pair.spring = springs.along(pair.normal, grid.cell_size);
    pair.gap = springs.gap(distance, grid.cell_size);
    pair.gap_closed = pair.active = pair.loaded = pair.spring.force > 0.0;
  };
  if (made) {
    for (ContactPair<D>& pair : part.pairs_of(node))
      if (!pair.bonded && !pair.stopped) spring(pair);
    return;
  }
  for_each_new_pair<D>(bodies, settings, part, node, spring);
}

template void find_springs<2>(const TileGrid<2>&, const std::vector<Body<2>>&,
                              const ContactSettings&, const TileTouches<2>&, ContactPart<2>&,
                              const ContactNode&, const Index<2>&, bool);
template void find_springs<3>(const TileGrid<3>&, const std::vector<Body<3>>&,
                              const ContactSettings&, const TileTouches<3>&, ContactPart<3>&,
                              const ContactNode&, const Index<3>&, bool);

}  // namespace mpm
