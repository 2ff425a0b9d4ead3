// Bytes from a file may be anything, and a step trusts what it works on.
#include "mpm/run/check_restored.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "mpm/run/coarsen_cells.hpp"

namespace mpm {
namespace {

constexpr double widest = (1 << 20) - 8;  // from the anchor [cells]: beyond, lists have no keys
constexpr double farthest = 1 << 28;      // from the origin [cells]: beyond, a cell has no number

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

/// Has a particle of a body on nodes of its own a deformation that does not turn it inside out?
template <int D>
bool is_deformed(const ParticlePool<D>& pool, std::uint32_t row) {
  if (pool.reference < 0) return true;
  Mat<double, D> F;
  for (int k = 0; k < D * D; ++k) F[k / D][k % D] = pool.deformation_part(k)[row];
  return determinant(F) > 0.0 && std::isfinite(determinant(F));
}

/// Can a particle be stepped?
template <int D>
bool is_fine(const TileGrid<D>& grid, const ParticlePool<D>& pool, std::uint32_t row,
             std::size_t bodies) {
  const Vec<double, D> x = listed_place(pool, row);
  bool fine = finite(pool.position_of(row)) && is_deformed(pool, row) && pool.mass()[row] > 0.0 &&
              pool.volume()[row] > 0.0 && finite(pool.mass()[row], pool.volume()[row]);
  for (int a = 0; a < D; ++a)
    fine = fine && std::isfinite(double{pool.v(a)[row]}) &&
           std::abs(grid.in_cells(x[a], a)) < farthest &&
           std::abs(grid.in_cells(x[a], a) - grid.anchor[static_cast<std::size_t>(a)]) < widest;
  if (pool.set_back >= 0) {
    const double share = pool.columns.component(pool.set_back)[row];
    fine = fine && share >= 0.0 && std::isfinite(share);
  }
  if (pool.pressing.force < 0) return fine;
  for (int k = pool.pressing.force; k <= pool.pressing.set_back; ++k)
    fine = fine && std::isfinite(pool.columns.component(k)[row]);
  const double opposite = pool.columns.component(pool.pressing.opposite)[row];
  return fine && opposite >= 0.0 && opposite <= static_cast<double>(bodies);
}

/// The chains of pieces that particles carry: each piece once, by the particle that it is of.
template <int D>
bool are_fine(const Domain<D>& domain, const ParticlePool<D>& pool,
              std::span<const PlacedRow> rows) {
  if (pool.pieces.empty()) return true;
  std::vector<bool> seen(pool.pieces.size());
  for (const auto [place, row] : rows)
    for (std::uint32_t k = pool.piece[row]; k != 0; k = pool.pieces[k - 1].next) {
      if (k > seen.size() || seen[k - 1]) return false;
      seen[k - 1] = true;
      const SurfacePiece<D>& piece = pool.pieces[k - 1];
      if (piece.load < 0 || !std::cmp_less(piece.load, domain.loads.size()) ||
          !finite(piece.area) || !finite(piece.size) || !finite(piece.arm))
        return false;
    }
  return true;
}

}  // namespace

template <int D>
void check_particles(const Domain<D>& domain, std::size_t m, std::span<const PlacedRow> rows,
                     const StateStream& stream) {
  const ParticlePool<D>& pool = domain.pools[m];
  stream.check_all(std::ranges::all_of(rows,
                                       [&](const PlacedRow& one) {
                                         return is_fine(domain.grid, pool, one.row,
                                                        domain.bodies.size());
                                       }),
                   "its particles are damaged");
  stream.check_all(are_fine(domain, pool, rows), "its loads are damaged");
}

template <int D>
void check_grid(const Domain<D>& domain) {
  const TileGrid<D>& grid = domain.grid;
  check(finite(grid.cell_size) && grid.cell_size > 0.0, "its grid is damaged");
  for (const std::int32_t cell : grid.anchor)
    check(std::abs(static_cast<double>(cell)) < farthest, "its grid is damaged");
  for (const Body<D>& body : domain.bodies)
    if (body.is_prescribed())
      check(finite(body.motion->before) && finite(body.motion->now), "its motions are damaged");
}

template <int D>
void check_rest(const Simulation<D>& simulation, const StateStream& stream) {
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
            domain.time >= earliest && finite(domain.time_step, domain.step_before, domain.shift) &&
            domain.step_before >= 0.0 && simulation.next_time_step > 0.0 &&
            finite(simulation.least_stable) && finite(domain.gravity),
        "its time is damaged");
  for (const ParticlePool<D>& pool : domain.pools)
    check(finite(pool.fastest) && pool.fastest >= 0.0, "its time is damaged");
  bool slow = true;
  const auto check_speed = [&](double v) {  // The next step is infinite where none moves.
    slow =
        slow && (v == 0.0 || std::abs(v) * simulation.next_time_step < farthest * grid.cell_size);
  };
  domain.for_each_particle([&](const ParticlePool<D>& of, std::uint32_t row) {
    for (int a = 0; a < D; ++a) check_speed(of.v(a)[row]);
    // What it gives to a node a cell away.
    for (int k = 0; of.affine >= 0 && k < D * D; ++k)
      check_speed(of.affine_part(k)[row] * grid.cell_size);
  });
  stream.check_all(slow, "its particles are damaged");
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

template void check_particles<2>(const Domain<2>&, std::size_t, std::span<const PlacedRow>,
                                 const StateStream&);
template void check_particles<3>(const Domain<3>&, std::size_t, std::span<const PlacedRow>,
                                 const StateStream&);
template void check_grid<2>(const Domain<2>&);
template void check_grid<3>(const Domain<3>&);
template void check_rest<2>(const Simulation<2>&, const StateStream&);
template void check_rest<3>(const Simulation<3>&, const StateStream&);

}  // namespace mpm
