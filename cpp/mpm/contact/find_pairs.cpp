// The pairs of bodies at a node: normals, gaps, eq. (5), and frictions.
#include <vector>

#include "mpm/contact/contact_grid.hpp"
#include "mpm/contact/normal.hpp"

namespace mpm {
namespace {

// Gaps along the line between the centres wider than this are left as they are (decision 0008).
constexpr double surely_open = 0.5;  // [cells]

/// D_rs = D_r + D_s of eq. (5) [m], each D the distance from the node to the body's surface along
/// the unit vector; infinite for a zero vector.
template <int D>
double gap_along(const Vec<double, D>& normal, const NormalSource<D>& r, const NormalSource<D>& s,
                 double cell_size) {
  if (!(dot(normal, normal) > 0.0)) return std::numeric_limits<double>::infinity();
  return -cell_size * (r.particles.extent_along(normal) + s.particles.extent_along(-1.0 * normal));
}

/// The unit vector from the centre of r's particles around the node to that of s's; zero if they
/// are one.
template <int D>
Vec<double, D> between_centres(const NearParticles<D>& r, const NearParticles<D>& s,
                               unsigned held) {
  Vec<double, D> n = s.centre() - r.centre();
  for (int a = 0; a < D; ++a)
    if (held >> a & 1u) n[a] = 0.0;
  return normalised(n, 1e-9);
}

}  // namespace

template <int D>
void ContactGrid<D>::find_pairs(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                                const std::vector<double>& stiffness,
                                const ContactSettings& settings, const ContactNode& node) {
  const Side<D>* sides = &sides_[node.first_side];
  const auto rigid = [&](std::uint32_t k) {
    return bodies[static_cast<std::size_t>(sides[k].body)].rigid;
  };
  // Scratch of one thread, not counted among the bytes of the contact.
  thread_local std::vector<NormalSource<D>> sources;
  if (sources.size() < node.sides) sources.resize(node.sides);
  for (std::uint32_t k = 0; k < node.sides; ++k) {
    const auto b = static_cast<std::size_t>(sides[k].body);
    NormalSource<D>& source = sources[k];
    source.body = sides[k].body;
    source.stiffness = stiffness[b];
    source.particles.clear(grid.shape.margin);
    Vec<double, D> gradient = Vec<double, D>::zero();
    for_each_copy(grid, node, sides[k], [&](std::size_t p, int at) {
      collect_near(grid, bodies[b], grid.patches[p], at, source.particles);
      if (settings.normal != NormalRule::plane)
        gradient += mass_gradient(grid, bodies[b], grid.patches[p], at);
    });
    // A wall mirrors the body, so its surface is normal to the wall there.
    for (int a = 0; a < D; ++a)
      if (node.held >> a & 1u) gradient[a] = 0.0;
    source.normal = weighted_normal(gradient, sides[k].mass, grid.cell_size);
  }
  std::uint32_t at = node.first_pair;
  for (std::uint16_t r = 0; r < node.sides; ++r)
    for (std::uint16_t s = static_cast<std::uint16_t>(r + 1); s < node.sides; ++s) {
      SidePair<D>& pair = pairs_[at++];
      pair = {};
      pair.r = r;
      pair.s = s;
      pair.friction = friction(settings, bodies[static_cast<std::size_t>(sides[r].body)].group,
                               bodies[static_cast<std::size_t>(sides[s].body)].group);
      // Bodies that are well apart along the line between their centres need no better normal.
      const bool by_gap = settings.detection == Detection::gap;
      if (by_gap && settings.normal == NormalRule::plane) {
        pair.normal = between_centres(sources[r].particles, sources[s].particles, node.held);
        pair.gap = gap_along(pair.normal, sources[r], sources[s], grid.cell_size);
        if (pair.gap > settings.gap_distance + surely_open * grid.cell_size) continue;
      }
      pair.normal = pair_normal(sources[r], sources[s], settings.normal, node.held);
      const bool opposed = dot(pair.normal, pair.normal) > 0.0;
      pair.gap = gap_along(pair.normal, sources[r], sources[s], grid.cell_size);
      pair.closed = opposed &&
                    !(rigid(r) && rigid(s)) &&  // they have no stress that could part them
                    (!by_gap || pair.gap < settings.gap_distance);
    }
}

template void ContactGrid<2>::find_pairs(const TileGrid<2>&, const std::vector<Body<2>>&,
                                         const std::vector<double>&, const ContactSettings&,
                                         const ContactNode&);
template void ContactGrid<3>::find_pairs(const TileGrid<3>&, const std::vector<Body<3>>&,
                                         const std::vector<double>&, const ContactSettings&,
                                         const ContactNode&);

}  // namespace mpm
