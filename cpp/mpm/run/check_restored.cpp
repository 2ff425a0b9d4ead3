// Whether a state that was restored is one that a run can have: bytes from a file may be anything,
// and a step trusts its lists.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "mpm/ledger/history.hpp"
#include "mpm/run/simulation_of.hpp"

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

/// Whether each number from 0 on is there once.
bool counts_all(const std::vector<std::uint32_t>& numbers) {
  std::vector<bool> seen(numbers.size());
  for (const std::uint32_t n : numbers) {
    if (n >= seen.size() || seen[n]) return false;
    seen[n] = true;
  }
  return true;
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

/// Particles are in the cells of the lists, unless these are to be mended, and can be stepped.
template <int D>
void check_particles(const TileGrid<D>& grid, const Body<D>& body, const Patch<D>& patch) {
  const Index<D> first = grid.first_cell(patch.tile);
  patch.for_each_cell([&](int c, std::uint32_t begin, std::uint32_t end) {
    Index<D> cell = Tile<D>::cell_index(c);
    for (std::size_t a = 0; a < D; ++a) cell[a] += first[a];
    for (std::uint32_t k = begin; k < end; ++k) {
      const std::uint32_t row = body.order[k];
      Vec<double, D> x;
      bool fine = body.mass()[row] > 0.0 && body.volume()[row] > 0.0 &&
                  finite(body.mass()[row], body.volume()[row]);
      for (int a = 0; a < D; ++a) {
        x[a] = body.x(a)[row];
        fine = fine && std::isfinite(double{body.v(a)[row]}) &&
               std::abs(grid.in_cells(x[a], a)) < farthest;
      }
      check(fine, "its particles are damaged");
      check(patch.left_cell || grid.cell_of(x) == cell, "its lists are damaged");
    }
  });
}

}  // namespace

/// Bodies and patches: what numbers the particles and says where they are. Throws
/// std::invalid_argument if no step can have left them so.
template <int D>
void SimulationOf<D>::check_lists() const {
  const TileGrid<D>& grid = domain_.grid;
  check(finite(grid.cell_size) && grid.cell_size > 0.0, "its grid is damaged");
  for (const std::int32_t cell : grid.anchor)
    check(std::abs(static_cast<double>(cell)) < farthest, "its grid is damaged");
  for (const Body<D>& body : domain_.bodies) {
    check(counts_all(body.id) && counts_all(body.order) && body.gone <= body.count(),
          "its lists are damaged");
    if (body.is_prescribed())
      check(finite(body.motion->before) && finite(body.motion->now), "its motions are damaged");
  }
  std::vector<std::size_t> listed(domain_.bodies.size(), 0);
  const Patch<D>* last = nullptr;
  for (const Patch<D>& patch : grid.patches) {
    const auto b = static_cast<std::size_t>(patch.body);
    check(patch.body >= 0 && b < listed.size(), "its lists are damaged");
    const Body<D>& body = domain_.bodies[b];
    check(!last || patch_less<D>(last->body, last->tile, patch.body, patch.tile),
          "its lists are damaged");
    check(patch.begin == listed[b] && patch.count <= body.active() - listed[b],
          "its lists are damaged");
    for (const std::int32_t tile : patch.tile)
      check(std::abs(static_cast<double>(tile)) * Tile<D>::cells < farthest,
            "its lists are damaged");
    listed[b] += patch.count;
    last = &patch;
    check_cells<D>(patch);
    check_particles<D>(grid, body, patch);
  }
  for (std::size_t b = 0; b < listed.size(); ++b)
    check(listed[b] == domain_.bodies[b].active(), "its lists are damaged");
}

/// All else, when it has been restored. Throws std::invalid_argument likewise.
///
/// `cell_size`, `walls`: of the case, before cells have doubled.
template <int D>
void SimulationOf<D>::check_rest(double cell_size, const Index<D>& walls) const {
  const TileGrid<D>& grid = domain_.grid;
  check(doublings_ >= 0 && doublings_ <= most_doublings(), "its grid is damaged");
  bool same = settings_.grid.cell_size == std::ldexp(cell_size, doublings_);
  for (std::size_t a = 0; a < D; ++a)
    same = same && (grid.walls.cells[a] == walls[a] >> std::min(doublings_, 31));
  check(same && grid.cell_size == settings_.grid.cell_size, "its grid is damaged");
  check(domain_.step >= 0 && domain_.step < std::int64_t{1} << 62 && finite(domain_.time) &&
            domain_.time >= 0.0 && finite(domain_.time_step) && next_time_step_ > 0.0 &&
            finite(domain_.gravity),
        "its time is damaged");
  for (const Body<D>& body : domain_.bodies)
    for (std::size_t k = 0; k < body.active(); ++k)
      for (int a = 0; a < D; ++a) {
        const double v = body.v(a)[body.order[k]];  // The next step is infinite where none moves.
        check(v == 0.0 || std::abs(v) * next_time_step_ < farthest * grid.cell_size,
              "its particles are damaged");
      }
  check(domain_.sums.size() == grid.patches.size(), "its sums are damaged");
  for (const PatchSums<D>& s : domain_.sums) {
    StateStream::check_flag(s.stress.negative_volume);
    StateStream::check_flag(s.stress.eroded);
  }
  for (const RigidMotion& motion : domain_.rigid) check(finite(motion), "its motions are damaged");
  for (const SurfaceLoad<D>& load : domain_.loads)
    for (std::size_t k = 0; k < load.area.size(); ++k)
      check(finite(load.area[k]) && finite(load.size[k]) && finite(load.arm[k]),
            "its loads are damaged");
  const std::size_t columns = history_terms.size();
  check(history_.size() % columns == 0 && history_.size() <= (history_capacity + 1) * columns,
        "its history is damaged");
  check(finite(domain_.ledger.kinetic) && finite(domain_.ledger.residual()),
        "its energies are damaged");
  check(watch_.plausible() && looked_ <= domain_.step, "its warnings are damaged");
  const auto number_of = [&](int n) { return n >= 0 && n < body_count(); };
  for (const Note& note : notes_)
    check(static_cast<std::size_t>(note.kind) < note_names.size() && number_of(note.body) &&
              number_of(note.group) && note.face >= -1 && note.face < 2 * D,
          "its warnings are damaged");
}

template void SimulationOf<2>::check_lists() const;
template void SimulationOf<3>::check_lists() const;
template void SimulationOf<2>::check_rest(double, const Index<2>&) const;
template void SimulationOf<3>::check_rest(double, const Index<3>&) const;

}  // namespace mpm
