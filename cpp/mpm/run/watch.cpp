// The part of a simulation that looks whether what it computes can be so.
#include "mpm/run/watch.hpp"

#include <sstream>

#include "mpm/contact/find_nodes.hpp"
#include "mpm/run/simulation_of.hpp"

namespace mpm {
namespace {

constexpr double small_volume = 0.01, large_volume = 100.0;  // over that at the start
constexpr double beyond = 0.1;  // of a cell, behind a wall: GIMP may push a centre a little past it
// At a node: each meets each, 435 pairs. Equal spheres have twelve neighbours, grains of two cells
// ten.
constexpr int many_bodies = 30;

std::size_t number(int k) { return static_cast<std::size_t>(k); }

}  // namespace

/// Count something that is so about a body, and note it if that is new.
template <int D>
void SimulationOf<D>::note(Note found) {
  found.group = body(found.body).group;
  found.step = domain_.step;
  found.time = domain_.time;
  for (Note& known : notes_)
    if (known.kind == found.kind && known.group == found.group && known.face == found.face) {
      ++known.count;
      known.share = std::max(known.share, found.share);
      return;
    }
  notes_.push_back(found);
  notes_.back().count = 1;
}

/// The same about a particle.
template <int D>
void SimulationOf<D>::note_at(Note found, int b, std::size_t row) {
  const Body<D>& at = body(b);
  found.body = b;
  found.particle = pool(at).id[row];
  for (int a = 0; a < D; ++a) found.position[number(a)] = pool(at).x(a)[row];
  note(found);
}

/// Note the first node at which so many bodies meet that steps take long, and count such steps.
template <int D>
void SimulationOf<D>::watch_crowd() {
  if (domain_.contact.counts.bodies_max <= many_bodies) return;
  const Crowd most = largest_crowd(domain_.contact, domain_.grid);
  if (most.bodies <= many_bodies) return;
  for (Note& known : notes_)
    if (known.kind == NoteKind::crowd) {
      ++known.count;
      return;
    }
  Note found{.kind = NoteKind::crowd, .body = most.body, .value = static_cast<double>(most.bodies)};
  std::copy(std::begin(most.position), std::end(most.position), found.position.begin());
  note(found);
}

/// Judge the step that has been made, by the ledger and the next time step.
template <int D>
void SimulationOf<D>::watch_step() {
  watch_crowd();
  const double median = watch_.median_fallen_below(next_time_step_);
  const double made = watch_.energy_made(domain_.ledger.made(), domain_.ledger.largest);
  const double work = domain_.has_loads()
                          ? watch_.load_energy(domain_.ledger.load_work, domain_.ledger.largest)
                          : 0.0;
  if (median == 0.0 && made == 0.0 && work == 0.0) return;
  const Limiter fastest = limiter();  // an unstable particle is the fastest, or soon will be
  if (fastest.body < 0) return;
  const std::size_t row = row_of(fastest.body, fastest.particle);
  if (median > 0.0)
    note_at({.kind = NoteKind::time_step, .value = next_time_step_, .against = median},
            fastest.body, row);
  if (made > 0.0)
    note_at({.kind = NoteKind::energy_made, .value = made, .against = domain_.ledger.largest},
            fastest.body, row);
  // A load may be meant to be sudden; but what it moves faster than waves run is torn off.
  if (work > 0.0 && fastest.speed > fastest.sound_speed)
    note_at({.kind = NoteKind::load_energy, .value = work, .against = domain_.ledger.largest},
            fastest.body, row);
}

template <int D>
std::size_t SimulationOf<D>::row_of(int b, std::int64_t particle) const {
  const ParticlePool<D>& of = pool(body(b));
  std::size_t found = 0;
  for_each_row(domain_.grid.patches, of, b, body(b).removed, [&](std::uint32_t row) {
    if (static_cast<std::int64_t>(of.id[row]) == particle) found = row;
  });
  return found;
}

/// The body, and that it stands for all of its entry.
template <int D>
std::string SimulationOf<D>::group_name(int first) const {
  const bool several = std::ranges::any_of(
      domain_.bodies, [&](const Body<D>& b) { return b.group == first && &b != &body(first); });
  return "body \"" + body(first).name + '"' + (several ? " and those grouped with it" : "");
}

/// Look at the places and volumes of all particles, in the order of the bodies' lists, which no
/// number of threads changes; some ten operations for each.
template <int D>
void SimulationOf<D>::look() {
  looked_ = domain_.step;
  const TileGrid<D>& grid = domain_.grid;
  Vec<double, D> lower, upper;
  for (int a = 0; a < D; ++a) {
    lower[a] = grid.origin[a] - beyond * grid.cell_size;
    upper[a] = grid.origin[a] + (grid.walls.cells[a] + beyond) * grid.cell_size;
  }
  std::vector<Sight>& seen = sights_;
  seen.assign(domain_.bodies.size(), {});
  for (const Patch<D>& patch : grid.patches) {
    const std::size_t number_of = number(patch.body);
    const Body<D>& b = domain_.bodies[number_of];
    const ParticlePool<D>& of = pool(b);
    Sight& sight = seen[number(b.group)];
    sight.particles += patch.count;
    const bool solid = b.deforms() && !domain_.material_of(patch).is_gas();
    const double* failed = of.at.failed >= 0 ? of.columns.component(of.at.failed) : nullptr;
    const bool placed = grid.walls.exist && !b.is_prescribed();
    if (!solid && !placed) continue;
    for (const std::uint32_t i : of.rows(patch)) {
      if (solid && !(failed && failed[i] > 0.0)) {
        const double J = of.volume()[i] * b.initial_density / of.mass()[i];
        if (J < small_volume || J > large_volume)
          sight.odd.add(number_of, i, std::abs(std::log(J)), J);
      }
      if (!placed) continue;
      bool outside = false;
      for (int a = 0; a < D; ++a) {
        const double x = of.x(a)[i];
        const double depth = std::max(lower[a] - x, x - upper[a]);
        if (!(depth > 0.0)) continue;
        const int side = x > upper[a] ? 1 : 0;
        const Wall wall = grid.walls.face[a][side];
        if (wall == Wall::fixed || wall == Wall::slip) {
          if (!outside) sight.outside.add(number_of, i, depth, depth / grid.cell_size + beyond);
          outside = true;
        } else {
          sight.left[number(2 * a + side)].add(number_of, i, depth, 0.0);
        }
      }
    }
  }
  judge();
}

/// Tell what was seen, and stop if it is too much.
template <int D>
void SimulationOf<D>::judge() {
  for (std::size_t g = 0; g < sights_.size(); ++g) {
    const Sight& sight = sights_[g];
    const auto tell = [&](NoteKind kind, const Seen& seen, int face, double limit) {
      if (seen.count == 0) return;
      const double share = static_cast<double>(seen.count) / static_cast<double>(sight.particles);
      note_at({.kind = kind, .value = seen.value, .against = limit, .face = face, .share = share},
              static_cast<int>(seen.body), seen.row);
      if (!(share > limit) || failure_) return;
      std::ostringstream text;
      text.precision(4);
      text << 100.0 * share << " % of the particles of " << group_name(static_cast<int>(g))
           << (kind == NoteKind::volume
                   ? " have less than 0.01 or more than 100 times their initial volume"
                   : " lie beyond closed walls of the box")
           << ", and run." << (kind == NoteKind::volume ? "volume_limit" : "outside_limit")
           << " allows " << 100.0 * limit
           << " %; give smaller steps or cells, or a stiffer material";
      failure_ =
          failure_at(note_names[number(static_cast<int>(kind))], seen.body, seen.row, text.str());
    };
    tell(NoteKind::outside, sight.outside, -1, settings_.run.outside_limit);
    tell(NoteKind::volume, sight.odd, -1, settings_.run.volume_limit);
    for (int face = 0; face < 2 * D; ++face)
      tell(NoteKind::left_box, sight.left[number(face)], face, 1.0);
  }
}

template class SimulationOf<2>;
template class SimulationOf<3>;

}  // namespace mpm
