#include "mpm/run/watch.hpp"

#include <bit>
#include <cmath>
#include <sstream>

#include "mpm/run/find_failure.hpp"
#include "mpm/run/time_step.hpp"
#include "mpm/run/use_device.hpp"
#include "mpm/run/warnings.hpp"
#include "mpm/run/watch_contact.hpp"

namespace mpm {
namespace {

constexpr double small_volume = 0.01, large_volume = 100.0;  // over that at the start
constexpr double small_of_gas = 1e-3;  // the same of a gas, which fills any volume
// Less than that may be a gas that is alone, ten cells at most (step/flowing_matter.hpp), or what
// has evaporated, which bears hardly anything (`opened`, materials/model.hpp).
constexpr double large_in_cells = 100.0;
// A gas that has filled an empty box presses on its walls with .995, .98, .90 and .78 of its
// pressure where its particles are 1.2, 1.4, 1.7 and 1.9 cells apart.
constexpr double far_apart = 1.5;   // cells
constexpr double many_gaps = 0.01;  // of a body's cells, more than at the start
constexpr double beyond = 0.1;  // of a cell, behind a wall: GIMP may push a centre a little past it

std::size_t number(int k) { return static_cast<std::size_t>(k); }

/// Note something about a particle.
template <int D>
void note_at(Simulation<D>& simulation, Note found, const ParticleAt& at) {
  found.body = at.body;
  found.particle = at.particle;
  found.position = at.position;
  note(simulation, found);
}

/// What is wrong with the volumes that a kind of note is about.
const char* volumes_of(NoteKind kind) {
  return kind == NoteKind::volume
             ? " have less than 0.01 or more than 100 times their initial volume"
             : " have less than 0.001 of their initial volume, or stand for more than 100 cells";
}

/// Tell what was seen, and stop if it is too much.
template <int D>
void judge(Simulation<D>& simulation) {
  const Domain<D>& domain = simulation.domain;
  const std::vector<Sight<D>>& sights = simulation.watch.sights;
  for (std::size_t g = 0; g < sights.size(); ++g) {
    const Sight<D>& sight = sights[g];
    const auto tell = [&](NoteKind kind, const Seen& seen, int face, double limit) {
      if (seen.count == 0) return;
      const double share = static_cast<double>(seen.count) / static_cast<double>(sight.particles);
      note_at(simulation,
              {.kind = kind, .value = seen.value, .against = limit, .face = face, .share = share},
              seen.at);
      if (!(share > limit) || simulation.failure) return;
      std::ostringstream text;
      text.precision(4);
      text << 100.0 * share << " % of the particles of " << group_name(domain, static_cast<int>(g))
           << (kind == NoteKind::outside ? " lie beyond closed walls of the box" : volumes_of(kind))
           << ", and run." << (kind == NoteKind::outside ? "outside_limit" : "volume_limit")
           << " allows " << 100.0 * limit
           << " %; give smaller steps or cells, or a stiffer material";
      simulation.failure =
          failure_at(domain, note_names[number(static_cast<int>(kind))], seen.at, text.str());
    };
    tell(NoteKind::outside, sight.outside, -1, simulation.settings.run.outside_limit);
    tell(NoteKind::volume, sight.odd, -1, simulation.settings.run.volume_limit);
    tell(NoteKind::gas_volume, sight.swollen, -1, simulation.settings.run.volume_limit);
    // Of half of its particles: few that fly ahead of it do not matter.
    if (2 * sight.thin.count > sight.particles) tell(NoteKind::sparse_gas, sight.thin, -1, 1.0);
    const double gaps = sight.gap_share();
    if (gaps > simulation.watch.gaps_at_start[g] + many_gaps)
      note_at(simulation, {.kind = NoteKind::sparse, .share = gaps}, sight.gaps.at);
    for (int face = 0; face < 2 * D; ++face)
      tell(NoteKind::left_box, sight.left[number(face)], face, 1.0);
  }
}

/// Count the cells of a patch, and those beside an empty one behind which there are particles
/// again, each axis by itself, within the tile.
template <int D>
void look_for_gaps(const ParticlePool<D>& pool, const Patch<D>& patch, Sight<D>& sight) {
  sight.cells += std::popcount(patch.occupied);
  for (std::size_t a = 0; a < D; ++a) {
    Index<D> one{};
    one[a] = 1;
    const int step = Tile<D>::cell(one);
    for (std::uint64_t left = patch.occupied; left != 0; left &= left - 1) {
      const int cell = std::countr_zero(left);
      // One or two empty cells: what is farther off may be another part of it.
      const int behind = Tile<D>::cells - 1 - Tile<D>::cell_index(cell)[a];
      const auto holds = [&](int k) {
        return k <= behind && (patch.occupied >> (cell + k * step) & 1u) != 0;
      };
      if (holds(1) || !(holds(2) || holds(3))) continue;
      const std::uint32_t row =
          pool.order[patch.begin + patch.cell_begin[static_cast<std::size_t>(cell)]];
      sight.gaps.add(pool, patch.body, row, 1.0, 0.0);
    }
  }
}

/// What other ranks have seen.
template <int D>
void add_others(Simulation<D>& simulation) {
  Comm& comm = *simulation.domain.grid.partition.comm;
  if (comm.alone()) return;
  // Most have seen nothing: all counts at once, and the rest where there is any.
  constexpr std::size_t kinds = 5 + 2 * D;
  std::vector<Sight<D>>& sights = simulation.watch.sights;
  const auto seen = [](Sight<D>& sight, std::size_t kind) -> Seen& {
    Seen* const others[] = {&sight.outside, &sight.odd, &sight.swollen, &sight.gaps, &sight.thin};
    return kind < 5 ? *others[kind] : sight.left[kind - 5];
  };
  std::vector<std::int64_t> counts;
  for (Sight<D>& sight : sights) {
    counts.push_back(sight.particles);
    counts.push_back(sight.cells);
    for (std::size_t kind = 0; kind < kinds; ++kind) counts.push_back(seen(sight, kind).count);
  }
  comm.all_sum(counts);
  for (std::size_t g = 0, k = 0; g < sights.size(); ++g) {
    sights[g].particles = counts[k++];
    sights[g].cells = counts[k++];
    for (std::size_t kind = 0; kind < kinds; ++kind)
      if (counts[k++] > 0) seen(sights[g], kind).add_others(comm);
  }
}

}  // namespace

template <int D>
void watch_step(Simulation<D>& simulation) {
  const Domain<D>& domain = simulation.domain;
  StepWatch& watch = simulation.watch.steps;
  watch_contact(simulation);
  const double median = watch.median_fallen_below(simulation.next_time_step);
  const double made = watch.energy_made(domain.ledger.made(), domain.ledger.largest);
  const double work =
      domain.has_loads() ? watch.load_energy(domain.ledger.load_work, domain.ledger.largest) : 0.0;
  if (median == 0.0 && made == 0.0 && work == 0.0) return;
  bring_home(simulation);
  const Limiter fastest =
      find_limiter(domain);  // an unstable particle is the fastest, or soon will be
  if (fastest.body < 0) return;
  if (median > 0.0)
    note_at(simulation,
            {.kind = NoteKind::time_step, .value = simulation.next_time_step, .against = median},
            fastest);
  if (made > 0.0)
    note_at(simulation,
            {.kind = NoteKind::energy_made, .value = made, .against = domain.ledger.largest},
            fastest);
  // A load may be meant to be sudden; but what it moves faster than waves run is torn off.
  if (work > 0.0 && fastest.speed > fastest.sound_speed)
    note_at(simulation,
            {.kind = NoteKind::load_energy, .value = work, .against = domain.ledger.largest},
            fastest);
}

namespace {

/// What there is to see, of all ranks.
template <int D>
void see(Simulation<D>& simulation) {
  const Domain<D>& domain = simulation.domain;
  const TileGrid<D>& grid = domain.grid;
  Vec<double, D> lower, upper;
  for (int a = 0; a < D; ++a) {
    lower[a] = grid.origin[a] - beyond * grid.cell_size;
    upper[a] = grid.origin[a] + (grid.walls.cells[a] + beyond) * grid.cell_size;
  }
  const double cell_volume = std::pow(grid.cell_size, D);
  std::vector<Sight<D>>& seen = simulation.watch.sights;
  seen.assign(domain.bodies.size(), {});
  for (const Patch<D>& patch : grid.patches) {
    const std::size_t number_of = number(patch.body);
    const Body<D>& b = domain.bodies[number_of];
    const ParticlePool<D>& of = domain.pool_of(b);
    Sight<D>& sight = seen[number(b.group)];
    sight.particles += patch.count;
    const Material& material = domain.material_of(patch);
    const bool solid = b.deforms() && b.matter != Matter::gas;
    const bool may_evaporate = std::isfinite(material.bounds.lowest_energy);
    // On nodes of their own bodies hold together, however far their particles are apart.
    if (solid && !material.breaks_up() && !b.keeps_nodes()) look_for_gaps(of, patch, sight);
    const double* failed = of.at.failed >= 0 ? of.columns.component(of.at.failed) : nullptr;
    const bool placed = grid.walls.exist && !b.is_prescribed();
    const bool gas = b.deforms() && !solid;
    if (!solid && !gas && !placed) continue;
    for (const std::uint32_t i : of.rows(patch)) {
      const double J = of.volume()[i] * b.initial_density / of.mass()[i];
      const double cells = of.volume()[i] / cell_volume;
      if (solid && !(failed && failed[i] > 0.0)) {
        const bool large = J > large_volume && (!may_evaporate || cells > large_in_cells);
        if (J < small_volume || large) sight.odd.add(of, patch.body, i, std::abs(std::log(J)), J);
      }
      if (gas) {
        if (J < small_of_gas || (J > large_volume && cells > large_in_cells))
          sight.swollen.add(of, patch.body, i, std::abs(std::log(J)), J);
        const double apart = std::pow(cells, 1.0 / D);
        if (apart > far_apart) sight.thin.add(of, patch.body, i, apart, apart);
      }
      if (!placed) continue;
      bool outside = false;
      for (int a = 0; a < D; ++a) {
        const double x = of.x(a)[i];
        const double depth = std::max(lower[a] - x, x - upper[a]);
        if (!(depth > 0.0)) continue;
        const int side = x > upper[a] ? 1 : 0;
        const Wall wall = grid.walls.face[a][side];
        if (wall == Wall::fixed || wall == Wall::slip || wall == Wall::contact) {
          if (!outside)
            sight.outside.add(of, patch.body, i, depth, depth / grid.cell_size + beyond);
          outside = true;
        } else {
          sight.left[number(2 * a + side)].add(of, patch.body, i, depth, 0.0);
        }
      }
    }
  }
  add_others(simulation);
}

}  // namespace

template <int D>
void look(Simulation<D>& simulation) {
  simulation.watch.looked = simulation.domain.step;
  see(simulation);
  judge(simulation);
}

template <int D>
void look_at_start(Simulation<D>& simulation) {
  see(simulation);
  std::vector<double>& gaps = simulation.watch.gaps_at_start;
  for (const Sight<D>& sight : simulation.watch.sights) gaps.push_back(sight.gap_share());
}

template void watch_step<2>(Simulation<2>&);
template void watch_step<3>(Simulation<3>&);
template void look_at_start<2>(Simulation<2>&);
template void look_at_start<3>(Simulation<3>&);
template void look<2>(Simulation<2>&);
template void look<3>(Simulation<3>&);

}  // namespace mpm
