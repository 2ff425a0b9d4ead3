#include "mpm/run/watch.hpp"

#include <sstream>

#include "mpm/contact/find_nodes.hpp"
#include "mpm/run/find_failure.hpp"
#include "mpm/run/time_step.hpp"
#include "mpm/run/use_device.hpp"
#include "mpm/run/warnings.hpp"

namespace mpm {
namespace {

constexpr double small_volume = 0.01, large_volume = 100.0;  // over that at the start
constexpr double beyond = 0.1;  // of a cell, behind a wall: GIMP may push a centre a little past it
// At a node: each meets each, 435 pairs. Equal spheres have twelve neighbours, grains of two cells
// ten.
constexpr int many_bodies = 30;

std::size_t number(int k) { return static_cast<std::size_t>(k); }

/// Count something that is so about a body, and note it if that is new.
template <int D>
void note(Simulation<D>& simulation, Note found) {
  const Domain<D>& domain = simulation.domain;
  std::vector<Note>& notes = simulation.watch.notes;
  found.group = domain.body_at(found.body).group;
  found.step = domain.step;
  found.time = domain.time;
  for (Note& known : notes)
    if (known.kind == found.kind && known.group == found.group && known.face == found.face) {
      ++known.count;
      known.share = std::max(known.share, found.share);
      return;
    }
  notes.push_back(found);
  notes.back().count = 1;
}

/// The same about a particle.
template <int D>
void note_at(Simulation<D>& simulation, Note found, const ParticleAt& at) {
  found.body = at.body;
  found.particle = at.particle;
  found.position = at.position;
  note(simulation, found);
}

/// Note the first node at which so many bodies meet that steps take long, and count such steps.
template <int D>
void watch_crowd(Simulation<D>& simulation) {
  const Domain<D>& domain = simulation.domain;
  if (domain.contact.counts.bodies_max <= many_bodies) return;
  const Crowd most = largest_crowd(domain.contact, domain.grid);
  if (most.bodies <= many_bodies) return;
  for (Note& known : simulation.watch.notes)
    if (known.kind == NoteKind::crowd) {
      ++known.count;
      return;
    }
  Note found{.kind = NoteKind::crowd, .body = most.body, .value = static_cast<double>(most.bodies)};
  std::copy(std::begin(most.position), std::end(most.position), found.position.begin());
  note(simulation, found);
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
           << (kind == NoteKind::volume
                   ? " have less than 0.01 or more than 100 times their initial volume"
                   : " lie beyond closed walls of the box")
           << ", and run." << (kind == NoteKind::volume ? "volume_limit" : "outside_limit")
           << " allows " << 100.0 * limit
           << " %; give smaller steps or cells, or a stiffer material";
      simulation.failure =
          failure_at(domain, note_names[number(static_cast<int>(kind))], seen.at, text.str());
    };
    tell(NoteKind::outside, sight.outside, -1, simulation.settings.run.outside_limit);
    tell(NoteKind::volume, sight.odd, -1, simulation.settings.run.volume_limit);
    for (int face = 0; face < 2 * D; ++face)
      tell(NoteKind::left_box, sight.left[number(face)], face, 1.0);
  }
}

/// What other ranks have seen.
template <int D>
void add_others(Simulation<D>& simulation) {
  Comm& comm = *simulation.domain.grid.partition.comm;
  if (comm.alone()) return;
  // Most have seen nothing: all counts at once, and the rest where there is any.
  constexpr std::size_t kinds = 2 + 2 * D;
  std::vector<Sight<D>>& sights = simulation.watch.sights;
  const auto seen = [](Sight<D>& sight, std::size_t kind) -> Seen& {
    return kind == 0 ? sight.outside : kind == 1 ? sight.odd : sight.left[kind - 2];
  };
  std::vector<std::int64_t> counts;
  for (Sight<D>& sight : sights) {
    counts.push_back(sight.particles);
    for (std::size_t kind = 0; kind < kinds; ++kind) counts.push_back(seen(sight, kind).count);
  }
  comm.all_sum(counts);
  for (std::size_t g = 0, k = 0; g < sights.size(); ++g) {
    sights[g].particles = counts[k++];
    for (std::size_t kind = 0; kind < kinds; ++kind)
      if (counts[k++] > 0) seen(sights[g], kind).add_others(comm);
  }
}

}  // namespace

template <int D>
void watch_step(Simulation<D>& simulation) {
  const Domain<D>& domain = simulation.domain;
  StepWatch& watch = simulation.watch.steps;
  watch_crowd(simulation);
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

template <int D>
void look(Simulation<D>& simulation) {
  const Domain<D>& domain = simulation.domain;
  simulation.watch.looked = domain.step;
  const TileGrid<D>& grid = domain.grid;
  Vec<double, D> lower, upper;
  for (int a = 0; a < D; ++a) {
    lower[a] = grid.origin[a] - beyond * grid.cell_size;
    upper[a] = grid.origin[a] + (grid.walls.cells[a] + beyond) * grid.cell_size;
  }
  std::vector<Sight<D>>& seen = simulation.watch.sights;
  seen.assign(domain.bodies.size(), {});
  for (const Patch<D>& patch : grid.patches) {
    const std::size_t number_of = number(patch.body);
    const Body<D>& b = domain.bodies[number_of];
    const ParticlePool<D>& of = domain.pool_of(b);
    Sight<D>& sight = seen[number(b.group)];
    sight.particles += patch.count;
    const bool solid = b.deforms() && !domain.material_of(patch).is_gas();
    const double* failed = of.at.failed >= 0 ? of.columns.component(of.at.failed) : nullptr;
    const bool placed = grid.walls.exist && !b.is_prescribed();
    if (!solid && !placed) continue;
    for (const std::uint32_t i : of.rows(patch)) {
      if (solid && !(failed && failed[i] > 0.0)) {
        const double J = of.volume()[i] * b.initial_density / of.mass()[i];
        if (J < small_volume || J > large_volume)
          sight.odd.add(of, patch.body, i, std::abs(std::log(J)), J);
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
  judge(simulation);
}

template void watch_step<2>(Simulation<2>&);
template void watch_step<3>(Simulation<3>&);
template void look<2>(Simulation<2>&);
template void look<3>(Simulation<3>&);

}  // namespace mpm
