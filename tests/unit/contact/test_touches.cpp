// Two blocks of particles that overlap by a tenth of an edge: what touches, where it is pushed,
// what reaches the nodes of a tile, and how far surfaces are set back.
#include <algorithm>

#include "check.hpp"
#include "mpm/contact/candidates.hpp"
#include "mpm/contact/find_touches.hpp"
#include "mpm/contact/set_back.hpp"
#include "mpm/contact/tile_touches.hpp"
#include "mpm/domain.hpp"
#include "mpm/particles/add_columns.hpp"
#include "mpm/particles/cell_lists.hpp"
#include "mpm/particles/make_body.hpp"

namespace {

using namespace mpm;
constexpr double h = 0.1;             // of a cell [m]
constexpr double edge = 0.5 * h;      // of a particle
constexpr double overlap = 0.1;       // of an edge
constexpr int rows = 6, across = 12;  // of a block, along the last axis and the others

template <int D>
struct Blocks {
  Domain<D> domain;

  Blocks() {
    domain.grid.cell_size = h;
    domain.grid.basis = basis_id<QuadraticBSpline>;
    domain.threads.resize(2);
    MaterialChoice choice;
    choice.density = 1000.0;
    choice.strength = {"elastic", {{"E", 1e9}, {"nu", 0.3}}};
    domain.materials.push_back(make_material(choice));
    domain.pools.push_back(make_pool(domain.materials[0], domain.grid));
    add_set_back(domain.pools[0]);
    for (const int block : {0, 1}) {
      std::vector<double> x;
      Index<D> low{}, high;
      high.fill(across - 1);
      high[D - 1] = rows - 1;
      for_each_index<D>(low, high, [&](const Index<D>& k) {
        for (std::size_t a = 0; a < D; ++a)
          x.push_back(edge * (k[a] + 0.5 + (a == D - 1 ? block * (rows - overlap) : 0.0)));
      });
      const std::vector<double> v(D, 0.0);
      domain.bodies.push_back(make_body<D>("block", domain.materials[0], domain.pools[0], x, v,
                                           std::array{std::pow(edge, D)}));
    }
    fill_pools(domain.pools, domain.materials, domain.bodies, domain.grid.patches);
    place_anchor(domain.grid, domain.bodies, domain.pools);
    build_cell_lists(domain.grid, domain.bodies, domain.pools, domain.threads, domain.list_scratch);
    connect_tiles(domain.contact, domain.grid, domain.bodies, Response::springs);
  }
  void find() {
    domain.contact_settings.response = Response::springs;
    find_touches(domain.contact, domain.grid, domain.bodies, domain.pools, domain.contact_settings,
                 domain.threads);
  }
  std::vector<Touch<D>> all() const {
    std::vector<Touch<D>> touches;
    for (const auto& some : domain.contact.touches)
      touches.insert(touches.end(), some.begin(), some.end());
    return touches;
  }
};

/// In the middle of the blocks, where the other's surface is flat, a particle of the row next to it
/// touches, with the normal of the face and all of the overlap; no other row touches.
template <int D>
void check_touches(mpm::testing::Report& report, const Blocks<D>& blocks) {
  const ParticlePool<D>& pool = blocks.domain.pools[0];
  std::size_t flat = 0;
  for (const Touch<D>& touch : blocks.all()) {
    const std::uint32_t row = pool.order[touch.entry];
    const double depth = pool.x(D - 1)[row] / edge - rows + 0.5 * overlap;
    const double inwards = touch.body == 0 ? 1.0 : -1.0;
    CHECK_EQUAL(touch.other, 1 - touch.body);
    // Of sums of a dozen edges.
    CHECK_CLOSE(-inwards * depth, 0.5 - 0.5 * overlap, 1e-9);
    bool at_rim = false;
    for (int a = 0; a + 1 < D; ++a) {
      const double along = pool.x(a)[row] / edge;
      at_rim = at_rim || along < 4.0 || along > across - 4.0;
    }
    if (at_rim) continue;
    ++flat;
    // The dents of a flat layer: 3e-6 of an edge in 2D, 5e-4 in 3D, and a twentieth of the overlap.
    const double dents = 0.05 * overlap + (D == 2 ? 1e-5 : 6e-4);
    CHECK_CLOSE(touch.overlap * h / edge, overlap, dents);
    // Dents tilt the normal by less than 0.04, of which this is the cosine.
    CHECK_CLOSE(inwards * touch.normal[D - 1], 1.0, 1e-3);
    CHECK_CLOSE(touch.to_middle * h / edge, 0.5 - 0.5 * overlap, dents);
  }
  CHECK_EQUAL(flat, 2 * std::size_t(std::pow(across - 8, D - 1)));
}

/// A tile has each touch that reaches one of its nodes, and no other, whatever tile it lies in.
template <int D>
void check_tiles(mpm::testing::Report& report, const Blocks<D>& blocks) {
  const Contact<D>& contact = blocks.domain.contact;
  const TileGrid<D>& grid = blocks.domain.grid;
  constexpr double support = 1.5;
  for (std::size_t t = 0; t < contact.tiles.size(); ++t) {
    TileTouches<D> touches;
    touches.gather(contact, t, support);
    std::size_t expected = 0;
    for (const ContactTile<D>& other : contact.tiles)
      for (std::uint32_t k = 0; k < other.touches.count; ++k) {
        const Touch<D>& touch = contact.touches[other.touches.share][other.touches.first + k];
        bool reaches = true;
        for (std::size_t a = 0; a < D; ++a) {
          const double at = touch.place()[static_cast<int>(a)] + grid.first_cell(other.tile)[a] -
                            grid.first_cell(contact.tiles[t].tile)[a];
          reaches = reaches && at > -support && at < Tile<D>::cells - 1 + support;
        }
        expected += reaches;
      }
    CHECK_EQUAL(touches.between(1, 0).size(), expected);
    CHECK(touches.between(0, 2).empty());
    CHECK_EQUAL(touches.nodes() != 0, expected > 0);
  }
}

/// Then nothing overlaps, and it is said how much did; bonded bodies stay as they are.
template <int D>
void check_set_back(mpm::testing::Report& report, Blocks<D>& blocks) {
  double most = 0.0;
  for (const Touch<D>& touch : blocks.all()) most = std::max(most, touch.overlap * h);
  const std::size_t touched = blocks.all().size();
  Domain<D>& domain = blocks.domain;
  ContactSettings bonds_all = domain.contact_settings;
  for (const Body<D>& a : domain.bodies)
    for (const Body<D>& b : domain.bodies) set_law(bonds_all, a.group, b.group, {0.0, true});
  set_back_surfaces(domain.contact, domain.bodies, domain.pools, bonds_all, h);
  CHECK_EQUAL(domain.contact.set_back.particles, std::size_t{0});
  set_back_surfaces(domain.contact, domain.bodies, domain.pools, domain.contact_settings, h);
  CHECK_EQUAL(domain.contact.set_back.particles, touched);
  CHECK_EQUAL(domain.contact.set_back.most, most);
  blocks.find();
  CHECK(blocks.all().empty());
}

template <int D>
void check_blocks(mpm::testing::Report& report) {
  Blocks<D> blocks;
  blocks.find();
  check_touches(report, blocks);
  check_tiles(report, blocks);
  check_set_back(report, blocks);
}

}  // namespace

void test_touches(mpm::testing::Report& report) {
  check_blocks<2>(report);
  check_blocks<3>(report);
}
