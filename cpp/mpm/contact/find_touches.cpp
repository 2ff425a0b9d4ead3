// Which particles overlap another body, and by how much (decision 0054).
#include "mpm/contact/find_touches.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "mpm/contact/surface.hpp"
#include "mpm/contact/tile_particles.hpp"

namespace mpm {
namespace {

/// A body around a tile. Cells of the tile are a bit each.
template <int D>
struct BodyNear {
  std::int32_t body;
  bool deforms;
  Matter matter;
  int range;  // of its widest particle here, SurfaceSum::range()
  std::span<const TileHolder> holders;
  const Patch<D>* own;   // its patch of the tile itself, if any
  std::uint64_t near;    // cells so near to some of its particles that its surface is felt there
  std::uint64_t wanted;  // cells with particles of other bodies for which it is looked at
  TileParticles<D> particles;
};

/// Scratch of one thread: the bodies around a tile, the first `count`.
template <int D>
struct BodiesNear {
  std::vector<BodyNear<D>> bodies;
  std::size_t count = 0;
  std::span<BodyNear<D>> all() { return {bodies.data(), count}; }
};

Reach reach_to(int range) { return {range, range, 0.0}; }

/// May particles of r in the tile be pushed by s? Bodies that do not deform have no stress that
/// could part them.
template <int D>
bool may_push(const BodyNear<D>& r, const BodyNear<D>& s, Response response) {
  return r.own != nullptr && r.body != s.body && (r.deforms || s.deforms) &&
         !stops_approach(response, r.matter, s.matter);
}

template <int D>
void find_bodies(const Contact<D>& contact, const TileGrid<D>& grid,
                 const std::vector<Body<D>>& bodies, Response response, const ContactTile<D>& tile,
                 BodiesNear<D>& found) {
  found.count = 0;
  const std::uint32_t end = tile.first_holder + tile.holders;
  for (std::uint32_t h = tile.first_holder; h < end;) {
    if (found.count == found.bodies.size()) found.bodies.emplace_back();
    BodyNear<D>& at = found.bodies[found.count++];
    at.body = contact.holders[h].body;
    const Body<D>& body = bodies[static_cast<std::size_t>(at.body)];
    at.deforms = body.deforms();
    at.matter = body.matter;
    at.range = 1;
    const std::uint32_t first = h;
    for (std::uint32_t k = h; k < end && contact.holders[k].body == at.body; ++k)
      at.range = std::max(at.range, int{contact.surface_ranges[contact.holders[k].patch]});
    at.own = nullptr;
    at.near = at.wanted = 0;
    for (; h < end && contact.holders[h].body == at.body; ++h) {
      const TileHolder& holder = contact.holders[h];
      const Patch<D>& patch = grid.patches[static_cast<std::size_t>(holder.patch)];
      if (holder.neighbour == Tile<D>::self) at.own = &patch;
      at.near |=
          cells_in_reach<D>(patch.cells(), Tile<D>::offset(holder.neighbour), reach_to(at.range));
    }
    at.holders = {&contact.holders[first], h - first};
  }
  for (const BodyNear<D>& r : found.all())
    for (BodyNear<D>& s : found.all())
      if (may_push(r, s, response)) s.wanted |= r.own->occupied & s.near;
}

/// The surface of a body around a tile, as seen from a point x from the tile's first node.
template <int D>
SurfaceSum<D> surface_around(const TileGrid<D>& grid, const BodyNear<D>& body,
                             const Vec<double, D>& tile, const Vec<double, D>& x) {
  using T = typename SurfaceSum<D>::T;
  SurfaceSum<D> sum;
  for_each_image(grid.walls, tile + x, body.range,
                 [&](const Vec<double, D>& image, const Vec<double, D>& signs) {
                   const Vec<double, D> at = image - tile;
                   body.particles.within(at, body.range, [&](const auto& shift, const auto& q) {
                     Vec<T, D> d;
                     for (int a = 0; a < D; ++a)
                       d[a] = T(signs[a]) * (q.xi[a] + T(shift[a] - at[a]));
                     sum.add(d, q.half, q.mass);
                   });
                 });
  return sum;
}

/// A plane behind which all of a body's particles around a tile lie. What is well before it touches
/// none of them, and is passed by: whatever plane it is, what touches is the same.
template <int D>
class Front {
 public:
  using T = Batch<contact_lanes>;

  /// `from` are some of the tile's cells, where the other body is.
  Front(const TileParticles<D>& body, std::uint64_t from, double distance) {
    Vec<T, D> moment = Vec<T, D>::zero();
    T count(0.0), half(0.0);
    body.for_each([&](const Vec<double, D>& shift, const auto& q) {
      const T one = select(q.mass > T(0.0), T(1.0), T(0.0));
      count += one;
      half = max(half, q.half);
      for (int a = 0; a < D; ++a) moment[a] = fma(one, q.xi[a] + T(shift[a]), moment[a]);
    });
    Vec<double, D> cells = Vec<double, D>::zero();
    for (std::uint64_t left = from; left != 0; left &= left - 1)
      for (int a = 0; a < D; ++a)
        cells[a] += Tile<D>::cell_index(std::countr_zero(left))[static_cast<std::size_t>(a)];
    for (int a = 0; a < D; ++a)
      normal_[a] = sum(moment[a]) / sum(count) - cells[a] / std::popcount(from);
    normal_ = normalised(normal_);
    T first(std::numeric_limits<double>::infinity());
    body.for_each([&](const Vec<double, D>& shift, const auto& q) {
      T along(0.0);
      for (int a = 0; a < D; ++a) along = fma(T(normal_[a]), q.xi[a] + T(shift[a]), along);
      first = min(first, along);
    });
    first_ = -largest(-first);
    margin_ = distance + beyond * largest(half);
  }
  /// Of particles at places from the tile's first node, those that may touch it, a bit each.
  std::uint64_t near(const Vec<T, D>& x, T half) const {
    T along(0.0);
    for (int a = 0; a < D; ++a) along = fma(T(normal_[a]), x[a], along);
    return lane_bits(along > T(first_ - margin_) - T(beyond) * half);
  }

 private:
  // Bodies touch at the height of a half edge of both over the outermost particles. At a quarter
  // more these would have to lie three times as densely as in a lattice.
  static constexpr double beyond = 1.25;
  Vec<double, D> normal_;
  double first_ = 0.0, margin_ = 0.0;
};

/// Is any cell of a tile nearer to a face that mirrors than that, or beyond it?
template <int D>
bool near_walls(const Walls<D>& walls, const Index<D>& first, int range) {
  bool near = false;
  for (std::size_t a = 0; a < D; ++a)
    near = near || (Walls<D>::goes_on(walls.face[a][0]) && first[a] <= range) ||
           (Walls<D>::goes_on(walls.face[a][1]) &&
            first[a] + Tile<D>::cells + range >= walls.cells[a]);
  return walls.exist && near;
}

/// How wide the surfaces of the bodies in contact are felt, patch by patch.
template <int D>
void find_ranges(Contact<D>& contact, const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                 const std::vector<ParticlePool<D>>& pools, Threads& threads) {
  contact.surface_ranges.resize(grid.patches.size());
  threads.for_each(grid.patches.size(), [&](std::size_t p) {
    const Patch<D>& patch = grid.patches[p];
    if (!patch.in_contact) return;
    contact.surface_ranges[p] =
        patch.foreign ? patch.surface_range
                      : surface_range(grid, pools[pool_number(bodies, patch.body)], patch);
  });
}

/// The particles of a tile's patch that overlap another body.
template <int D>
void add_touches(const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                 const ParticlePool<D>& pool, const BodyNear<D>& own, const BodyNear<D>& other,
                 double distance, std::vector<Touch<D>>& touches) {
  const Patch<D>& patch = *own.own;
  const Index<D> first = grid.first_cell(patch.tile);
  Vec<double, D> tile;
  for (int a = 0; a < D; ++a) tile[a] = first[static_cast<std::size_t>(a)];
  const double mean_edge = bodies[static_cast<std::size_t>(own.body)].mean_edge;
  const double own_node = reach_of(grid.basis).own_node;
  std::uint64_t cells = patch.occupied & other.near;
  if (cells == 0) return;
  const Front<D> front(other.particles, cells, distance);
  // What walls mirror is not among the particles.
  const bool all = near_walls<D>(grid.walls, first, other.range);
  for (; cells != 0; cells &= cells - 1) {
    const auto c = static_cast<std::size_t>(std::countr_zero(cells));
    const Index<D> cell = Tile<D>::cell_index(static_cast<int>(c));
    Index<D> in_grid = first;
    for (std::size_t a = 0; a < D; ++a) in_grid[a] += cell[a];
    const std::uint32_t end = patch.begin + patch.cell_begin[c + 1];
    for (std::uint32_t i = patch.begin + patch.cell_begin[c]; i < end; i += contact_lanes) {
      const auto lanes = TileParticles<D>::lanes_of(grid, mean_edge, pool, in_grid, i, end);
      Vec<Batch<contact_lanes>, D> places;
      for (int a = 0; a < D; ++a)
        places[a] =
            lanes.xi[a] + Batch<contact_lanes>(cell[static_cast<std::size_t>(a)] - own_node);
      std::uint64_t left = lane_bits(lanes.mass > Batch<contact_lanes>(0.0));
      if (!all) left &= front.near(places, lanes.half);
      for (; left != 0; left &= left - 1) {
        const int k = std::countr_zero(left);
        Vec<double, D> x;
        for (int a = 0; a < D; ++a) x[a] = places[a][k];
        const SurfaceSum<D> sum = surface_around(grid, other, tile, x);
        const Vec<double, D> normal = sum.normal();
        if (!(dot(normal, normal) > 0.0)) continue;  // out of reach, or in the very middle
        const double half = lanes.half[k], surface = half - lanes.set_back[k],
                     other_half = sum.mean_half();
        const double overlap = surface + other_half + distance - sum.height(other_half);
        if (overlap > 0.0)
          touches.push_back({own.body, other.body, i + static_cast<std::uint32_t>(k), x, normal,
                             half, surface, other_half, overlap,
                             0.5 * (distance - overlap) + surface});
      }
    }
  }
}

}  // namespace

template <int D>
std::uint8_t surface_range(const TileGrid<D>& grid, const ParticlePool<D>& pool,
                           const Patch<D>& patch) {
  double widest = 0.0;
  for (const std::uint32_t row : pool.rows(patch))
    widest = std::max(widest, double{pool.volume()[row]});
  const double edge = (D == 2 ? std::sqrt(widest) : std::cbrt(widest)) / grid.cell_size;
  return static_cast<std::uint8_t>(SurfaceSum<D>::range(edge));
}

template <int D>
void find_touches(Contact<D>& contact, const TileGrid<D>& grid, const std::vector<Body<D>>& bodies,
                  const std::vector<ParticlePool<D>>& pools, const ContactSettings& settings,
                  Threads& threads, bool presses) {
  const double distance = settings.gap_distance / grid.cell_size;
  const bool pressed = presses && std::ranges::any_of(settings.pair_laws, [](const auto& x) {
                         return x.second.pressed > 0.0;
                       });
  const auto further = [&](std::int32_t r, std::int32_t s) {
    if (!pressed) return 0.0;
    const auto group = [&](std::int32_t b) { return bodies[static_cast<std::size_t>(b)].group; };
    return law_of(settings, group(r), group(s)).pressed / grid.cell_size;
  };
  find_ranges(contact, grid, bodies, pools, threads);
  const TileShares shares(contact.tiles.size(), threads.count());
  // None goes: their memory is used again.
  if (shares.count > contact.touches.size()) contact.touches.resize(shares.count);
  for (auto& touches : contact.touches) touches.clear();
  threads.for_each(shares.count, [&](std::size_t share) {
    thread_local BodiesNear<D> around;
    std::vector<Touch<D>>& touches = contact.touches[share];
    for (std::size_t t = shares.first(share); t < shares.first(share + 1); ++t) {
      ContactTile<D>& tile = contact.tiles[t];
      tile.touches = {static_cast<std::uint32_t>(share), static_cast<std::uint32_t>(touches.size()),
                      0};
      find_bodies(contact, grid, bodies, settings.response, tile, around);
      for (BodyNear<D>& s : around.all())
        if (s.wanted != 0)
          s.particles.gather(grid, bodies[static_cast<std::size_t>(s.body)],
                             pools[pool_number(bodies, s.body)], tile.tile, s.holders, s.wanted,
                             reach_to(s.range));
      for (const BodyNear<D>& r : around.all())
        for (const BodyNear<D>& s : around.all())
          if (may_push(r, s, settings.response))
            add_touches(grid, bodies, pools[pool_number(bodies, r.body)], r, s,
                        distance + further(r.body, s.body), touches);
      tile.touches.count = static_cast<std::uint32_t>(touches.size()) - tile.touches.first;
    }
  });
}

template std::uint8_t surface_range<2>(const TileGrid<2>&, const ParticlePool<2>&, const Patch<2>&);
template std::uint8_t surface_range<3>(const TileGrid<3>&, const ParticlePool<3>&, const Patch<3>&);
template void find_touches<2>(Contact<2>&, const TileGrid<2>&, const std::vector<Body<2>>&,
                              const std::vector<ParticlePool<2>>&, const ContactSettings&, Threads&,
                              bool);
template void find_touches<3>(Contact<3>&, const TileGrid<3>&, const std::vector<Body<3>>&,
                              const std::vector<ParticlePool<3>>&, const ContactSettings&, Threads&,
                              bool);

}  // namespace mpm
