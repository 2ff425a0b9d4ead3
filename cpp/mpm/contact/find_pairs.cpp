// The pairs of bodies at a node: normals, gaps, eq. (5), and frictions.
#include "mpm/contact/find_pairs.hpp"

#include <limits>
#include <vector>

#include "mpm/contact/normal.hpp"

namespace mpm {
namespace {

// A pair with a wider gap along the line between the centres gets no plane, and must not close
// before it is looked at again: normal_refresh_distance is at most half of this (decision 0012).
constexpr double surely_open = 0.5;  // [cells]

/// D_rs = D_r + D_s of eq. (5) [m], each D the distance from the node to the body's surface along
/// the unit vector; infinite for a zero vector.
template <int D>
double gap_along(const Vec<double, D>& normal, const NormalSource<D>& r, const NormalSource<D>& s,
                 double cell_size) {
  // A pair without a normal is never closed by distance: infinity fails eq. (5).
  if (!(dot(normal, normal) > 0.0)) return std::numeric_limits<double>::infinity();
  // Eq. (5): D_r = -max[(x_p - x_i) . n + l_p], and the same for s with -n; extents are in cells.
  return -cell_size * (r.particles.extent_along(normal) + s.particles.extent_along(-1.0 * normal));
}

/// The unit vector from the centre of r's particles around the node to that of s's; zero if they
/// are one.
template <int D>
Vec<double, D> between_centres(const NearParticles<D>& r, const NearParticles<D>& s,
                               unsigned constrained) {
  Vec<double, D> n = s.centre() - r.centre();
  for (int a = 0; a < D; ++a)
    if (constrained >> a & 1u) n[a] = 0.0;
  return normalised(n, 1e-9);
}

bool uses_gradients(NormalRule rule) {
  bool uses = false;
  NormalRules::with(rule, [&]<class Rule>(const Rule&) { uses = Rule::uses_gradients; });
  return uses;
}

bool uses_gap(Detection detection) {
  bool uses = false;
  Detections::with(detection, [&]<class Rule>(const Rule&) { uses = Rule::uses_gap; });
  return uses;
}

/// What the normals at a node are made of, of each body there, until the thread comes here again.
template <int D>
std::span<const NormalSource<D>> sources_at(const TileGrid<D>& grid,
                                            const std::vector<Body<D>>& bodies,
                                            TileBodies<D>& around, const ContactNode& node,
                                            std::span<const BodyAtNode<D>> sides,
                                            bool by_gradients) {
  const Index<D> index = Tile<D>::cell_index(node.cell);
  // Not counted among the bytes of the contact.
  thread_local std::vector<NormalSource<D>> sources;
  if (sources.size() < sides.size()) sources.resize(sides.size());
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const auto b = static_cast<std::size_t>(sides[k].body);
    NormalSource<D>& source = sources[k];
    source.body = sides[k].body;
    source.stiffness = bodies[b].stiffness;
    Vec<double, D> gradient = Vec<double, D>::zero();
    TileBody<D>& at = around.with(sides[k].body);
    // The reach of GIMP grows with the particle's width at the start; that of the others ignores
    // it.
    const double edge = bodies[b].mean_edge / grid.cell_size;
    collect_near<D>(at.particles, index, support(grid.basis, edge), source.particles);
    if (by_gradients) gradient = mass_gradient<D>(at.particles, index, grid, edge);
    // A wall mirrors the body, so its surface is normal to the wall there.
    for (int a = 0; a < D; ++a)
      if (node.constrained_axes >> a & 1u) gradient[a] = 0.0;
    source.normal = weighted_normal(gradient, sides[k].mass, grid.cell_size);
  }
  return {sources.data(), sides.size()};
}

}  // namespace

template <int D>
ContactPair<D> new_pair(const std::vector<Body<D>>& bodies, const ContactSettings& settings,
                        std::span<const BodyAtNode<D>> sides, std::uint16_t r, std::uint16_t s) {
  ContactPair<D> pair{};
  pair.r = r;
  pair.s = s;
  const Body<D>& body_r = bodies[static_cast<std::size_t>(sides[r].body)];
  const Body<D>& body_s = bodies[static_cast<std::size_t>(sides[s].body)];
  const PairLaw law = law_of(settings, body_r.group, body_s.group);
  pair.friction = law.friction;
  pair.gap = std::numeric_limits<double>::infinity();
  pair.stopped = stops_approach(settings.response, body_r.matter, body_s.matter);
  // Two rigid bodies have no stress that could part them, nor hold them.
  if (law.bonded && (body_r.deforms() || body_s.deforms())) {
    pair.gap = 0.0;
    pair.bonded = pair.gap_closed = pair.active = pair.loaded = true;
  }
  return pair;
}

template <int D>
bool passes_gap_test(const ContactPair<D>& pair, const ContactSettings& settings,
                     double cell_size) {
  bool touches = false;
  Detections::with(settings.detection, [&]<class Rule>(const Rule&) {
    touches = Rule::touches(pair.gap, settings.gap_distance, cell_size);
  });
  // The rule "velocity" asks for no distance, so it would close pairs without a normal.
  return touches && dot(pair.normal, pair.normal) > 0.0;
}

template <int D>
void find_pairs(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                const ContactSettings& settings, TileBodies<D>& around, ContactPart<D>& part,
                const ContactNode& node) {
  const auto sides = part.sides_of(node);
  const auto rigid = [&](std::uint32_t k) {
    return !bodies[static_cast<std::size_t>(sides[k].body)].deforms();
  };
  const bool by_gradients = uses_gradients(settings.normal);
  const std::span<const NormalSource<D>> sources =
      sources_at<D>(grid, bodies, around, node, sides, by_gradients);
  for_each_new_pair<D>(bodies, settings, part, node, [&](ContactPair<D>& pair) {
    const std::uint16_t r = pair.r, s = pair.s;
    if (!pair.stopped || (rigid(r) && rigid(s))) return;
    // Bodies that are well apart along the line between their centres need no better normal. Only
    // where the gap decides and the normal costs a fit. Where the centres coincide the gap is
    // infinite, and the pair is left here too.
    if (uses_gap(settings.detection) && !by_gradients) {
      pair.normal =
          between_centres(sources[r].particles, sources[s].particles, node.constrained_axes);
      // One pass over the particles where a plane takes two to five (decision 0032): of the pairs
      // of a bed of spheres 44 % end here (decision 0027).
      pair.gap = gap_along(pair.normal, sources[r], sources[s], grid.cell_size);
      if (pair.gap > settings.gap_distance + surely_open * grid.cell_size) return;
    }
    NormalRules::with(settings.normal, [&]<class Rule>(const Rule&) {
      pair.normal = Rule::normal(sources[r], sources[s], node.constrained_axes);
    });
    // Also where the rule does not use it: the gap at the first contact is recorded.
    pair.gap = gap_along(pair.normal, sources[r], sources[s], grid.cell_size);
    pair.gap_closed = passes_gap_test(pair, settings, grid.cell_size);
  });
}

template ContactPair<2> new_pair<2>(const std::vector<Body<2>>&, const ContactSettings&,
                                    std::span<const BodyAtNode<2>>, std::uint16_t, std::uint16_t);
template ContactPair<3> new_pair<3>(const std::vector<Body<3>>&, const ContactSettings&,
                                    std::span<const BodyAtNode<3>>, std::uint16_t, std::uint16_t);
template bool passes_gap_test<2>(const ContactPair<2>&, const ContactSettings&, double);
template bool passes_gap_test<3>(const ContactPair<3>&, const ContactSettings&, double);
template void find_pairs<2>(const TileGrid<2>&, const std::vector<Body<2>>&, const ContactSettings&,
                            TileBodies<2>&, ContactPart<2>&, const ContactNode&);
template void find_pairs<3>(const TileGrid<3>&, const std::vector<Body<3>>&, const ContactSettings&,
                            TileBodies<3>&, ContactPart<3>&, const ContactNode&);

}  // namespace mpm
