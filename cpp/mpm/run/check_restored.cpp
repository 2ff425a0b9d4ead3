// Bytes from a file may be anything, and a step trusts its lists.
#include "mpm/run/check_restored.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>

#include "mpm/run/coarsen_cells.hpp"

namespace mpm {
namespace {

constexpr double farthest = 1 << 28;  // from the origin [cells]: beyond, a cell has no number

void check(bool holds, const char* sentence) { StateStream::check(holds, sentence); }

template <class... T>
bool finite(const T&... values) {
  return (std::isfinite(values) && ...);
}
template <int D>
bool finite(const Vec<double, D>& v) {
  bool all = true;
  for (int a = 0; a < D; ++a) all = all && std::isfinite(v[a]);
  return all;
}
bool finite(const RigidMotion& m) {
  bool all = finite(m.centre) && finite(m.velocity) && finite(m.spin) && m.free_axes <= 7u;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) all = all && std::isfinite(m.inertia[i][j]);
  return all;
}

/// The ranges of a patch's cells, and which of them hold particles.
template <int D>
void check_cells(const Patch<D>& patch) {
  check(patch.cell_begin.front() == 0 && patch.cell_begin.back() == patch.count &&
            std::ranges::is_sorted(patch.cell_begin),
        "its lists are damaged");
  std::uint64_t occupied = 0;
  for (std::size_t c = 0; c < Tile<D>::cell_count; ++c)
    if (patch.cell_begin[c + 1] > patch.cell_begin[c]) occupied |= std::uint64_t{1} << c;
  check(patch.occupied == occupied, "its lists are damaged");
}

/// Particles are in the cells of the lists, unless these are to be updated, and can be stepped.
template <int D>
void check_particles(const TileGrid<D>& grid, const ParticlePool<D>& pool, const Patch<D>& patch) {
  const Index<D> first = grid.first_cell(patch.tile);
  patch.for_each_cell([&](int c, std::uint32_t begin, std::uint32_t end) {
    Index<D> cell = Tile<D>::cell_index(c);
    for (std::size_t a = 0; a < D; ++a) cell[a] += first[a];
    for (std::uint32_t k = begin; k < end; ++k) {
      const std::uint32_t row = pool.order[k];
      const Vec<double, D> x = pool.position_of(row);
      bool fine = pool.mass()[row] > 0.0 && pool.volume()[row] > 0.0 &&
                  finite(pool.mass()[row], pool.volume()[row]);
      for (int a = 0; a < D; ++a)
        fine = fine && std::isfinite(double{pool.v(a)[row]}) &&
               std::abs(grid.in_cells(x[a], a)) < farthest;
      if (pool.set_back >= 0) {
        const double share = pool.columns.component(pool.set_back)[row];
        fine = fine && share >= 0.0 && std::isfinite(share);
      }
      check(fine, "its particles are damaged");
      check(patch.left_cell || grid.cell_of(x) == cell, "its lists are damaged");
    }
  });
}

/// Each row of a pool, and each number of a body, is that of one particle, in a list or removed.
template <int D>
void check_rows(const Domain<D>& domain) {
  std::vector<std::vector<bool>> rows, ids;
  for (const ParticlePool<D>& pool : domain.pools) rows.emplace_back(pool.count());
  for (const Body<D>& body : domain.bodies) ids.emplace_back(body.count);
  const auto see = [&](std::uint32_t row, int number) {
    const auto m = static_cast<std::size_t>(domain.body_at(number).material);
    check(row < rows[m].size() && !rows[m][row], "its lists are damaged");
    rows[m][row] = true;
    std::vector<bool>& seen = ids[static_cast<std::size_t>(number)];
    const std::uint32_t id = domain.pools[m].id[row];
    check(id < seen.size() && !seen[id], "its lists are damaged");
    seen[id] = true;
  };
  for (const Patch<D>& patch : domain.grid.patches)
    for (const std::uint32_t row : domain.pool_of(patch).rows(patch)) see(row, patch.body);
  std::vector<std::size_t> removed(domain.bodies.size(), 0);
  for (std::size_t m = 0; m < rows.size(); ++m)
    for (const RemovedRow& one : domain.pools[m].removed) {
      const auto b = static_cast<std::size_t>(one.body);
      check(one.body >= 0 && b < removed.size() &&
                std::cmp_equal(domain.body_at(one.body).material, m),
            "its lists are damaged");
      ++removed[b];
      see(one.row, one.body);
    }
  for (const std::vector<bool>& seen : rows)
    check(std::ranges::all_of(seen, std::identity()), "its lists are damaged");
  for (std::size_t b = 0; b < removed.size(); ++b)
    check(removed[b] == domain.bodies[b].removed_here, "its lists are damaged");
}

/// The ranges that patches own of their pools' lists: none of another's.
template <int D>
void check_ranges(const Domain<D>& domain) {
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> ranges(domain.pools.size());
  for (const Patch<D>& patch : domain.grid.patches) {
    check(patch.body >= 0 && std::cmp_less(patch.body, domain.bodies.size()) &&
              patch.count <= patch.room,
          "its lists are damaged");
    const auto m = static_cast<std::size_t>(domain.body_of(patch).material);
    ranges[m].emplace_back(patch.begin, patch.begin + std::size_t{patch.room});
  }
  for (std::size_t m = 0; m < ranges.size(); ++m) {
    std::size_t end = 0;
    std::ranges::sort(ranges[m]);
    for (const auto& [first, last] : ranges[m]) {
      check(first >= end, "its lists are damaged");
      end = last;
    }
    const ParticlePool<D>& pool = domain.pools[m];
    check(end <= pool.used && pool.used <= pool.order.size(), "its lists are damaged");
  }
}

/// The chains of pieces that particles carry: each piece once, by the particle that it is of.
template <int D>
void check_pieces(const Domain<D>& domain) {
  for (const ParticlePool<D>& pool : domain.pools) {
    std::vector<bool> seen(pool.pieces.size());
    for (const std::uint32_t first : pool.piece)
      for (std::uint32_t k = first; k != 0; k = pool.pieces[k - 1].next) {
        check(k <= seen.size() && !seen[k - 1], "its loads are damaged");
        seen[k - 1] = true;
      }
    for (const SurfacePiece<D>& piece : pool.pieces)
      check(piece.load >= 0 && std::cmp_less(piece.load, domain.loads.size()) &&
                finite(piece.area) && finite(piece.size) && finite(piece.arm),
            "its loads are damaged");
  }
}

}  // namespace

template <int D>
void check_lists(const Domain<D>& domain) {
  const TileGrid<D>& grid = domain.grid;
  check(finite(grid.cell_size) && grid.cell_size > 0.0, "its grid is damaged");
  for (const std::int32_t cell : grid.anchor)
    check(std::abs(static_cast<double>(cell)) < farthest, "its grid is damaged");
  for (const Body<D>& body : domain.bodies)
    if (body.is_prescribed())
      check(finite(body.motion->before) && finite(body.motion->now), "its motions are damaged");
  check_ranges(domain);
  check_rows(domain);
  const Patch<D>* last = nullptr;
  for (const Patch<D>& patch : grid.patches) {
    check(!last || patch_less<D>(last->body, last->tile, patch.body, patch.tile),
          "its lists are damaged");
    for (const std::int32_t tile : patch.tile)
      check(std::abs(static_cast<double>(tile)) * Tile<D>::cells < farthest,
            "its lists are damaged");
    last = &patch;
    check_cells<D>(patch);
    check_particles<D>(grid, domain.pool_of(patch), patch);
  }
  check_pieces(domain);
}

template <int D>
void check_rest(const Simulation<D>& simulation) {
  const Domain<D>& domain = simulation.domain;
  const GridSettings& given = simulation.settings.grid;
  const int coarsenings = simulation.coarsenings;
  const TileGrid<D>& grid = domain.grid;
  check(coarsenings >= 0 && coarsenings <= most_coarsenings(given), "its grid is damaged");
  bool same = grid.cell_size == std::ldexp(given.cell_size, coarsenings);
  for (std::size_t a = 0; a < D; ++a)
    same = same && (grid.walls.cells[a] == given.box_cells[a] >> std::min(coarsenings, 31));
  check(same, "its grid is damaged");
  const auto& settle = simulation.settings.run.settle;
  const double earliest = settle ? -settle->longest : 0.0;
  check(domain.step >= 0 && domain.step < std::int64_t{1} << 62 && finite(domain.time) &&
            domain.time >= earliest && finite(domain.time_step) &&
            simulation.next_time_step > 0.0 && finite(domain.gravity),
        "its time is damaged");
  for (const ParticlePool<D>& pool : domain.pools)
    check(finite(pool.fastest) && pool.fastest >= 0.0, "its time is damaged");
  const auto check_speed = [&](double v) {  // The next step is infinite where none moves.
    check(v == 0.0 || std::abs(v) * simulation.next_time_step < farthest * grid.cell_size,
          "its particles are damaged");
  };
  const bool affine = is_affine(domain.transfer);
  domain.for_each_particle([&](const ParticlePool<D>& of, std::uint32_t row) {
    for (int a = 0; a < D; ++a) check_speed(of.v(a)[row]);
    // What it gives to a node a cell away.
    for (int k = 0; affine && k < D * D; ++k) check_speed(of.affine_part(k)[row] * grid.cell_size);
  });
  check(domain.sums.size() == grid.patches.size(), "its sums are damaged");
  for (const PatchSums<D>& s : domain.sums) {
    StateStream::check_flag(s.stress.negative_volume);
    StateStream::check_flag(s.stress.eroded);
  }
  for (const RigidMotion& motion : domain.rigid) check(finite(motion), "its motions are damaged");
  check(simulation.history.plausible(), "its history is damaged");
  check(finite(domain.ledger.kinetic) && finite(domain.ledger.residual()),
        "its energies are damaged");
  const AngularLedger& angular = domain.ledger.angular;
  const AngularBalance balance = balance_of(angular, angular.start, angular.prescribed_start);
  check(finite(balance.numerical) && finite(balance.motion), "its angular momentum is damaged");
  const Watch<D>& watch = simulation.watch;
  check(watch.steps.plausible() && watch.looked <= domain.step, "its warnings are damaged");
  const auto number_of = [&](int n) { return n >= 0 && std::cmp_less(n, domain.bodies.size()); };
  for (const Note& note : watch.notes)
    check(static_cast<std::size_t>(note.kind) < note_names.size() && number_of(note.body) &&
              number_of(note.group) && note.face >= -1 && note.face < 2 * D,
          "its warnings are damaged");
}

template void check_lists<2>(const Domain<2>&);
template void check_lists<3>(const Domain<3>&);
template void check_rest<2>(const Simulation<2>&);
template void check_rest<3>(const Simulation<3>&);

}  // namespace mpm
