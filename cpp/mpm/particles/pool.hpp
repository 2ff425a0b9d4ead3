#pragma once
// The particles of all bodies of one material: a pool of rows, and the lists that keep those of one
// cell together. A particle is known by the number of its body and its number in it; where its row
// lies, and where its entry of a list, says nothing.
#include <cstdint>
#include <span>
#include <vector>

#include "mpm/fields/columns.hpp"
#include "mpm/fields/lists.hpp"
#include "mpm/grid/patch.hpp"
#include "mpm/loads/surface_load.hpp"
#include "mpm/materials/material_block.hpp"
#include "mpm/particles/body.hpp"

namespace mpm {

/// A particle that takes no part any more: no patch holds it.
struct RemovedRow {
  std::uint32_t row;
  int body;
};

/// What a transfer keeps of particles beside their velocity; or what bodies that keep their nodes
/// do in its place.
struct TransferColumns {
  bool affine = false, unseen = false;  // the affine part; what a filter takes of the velocity
  bool reference = false;               // places in the body, and its deformation
};

/// Of particles whose nodes lie in space and that press surfaces (surfaces/pressing.hpp): the first
/// component of each column; -1: there are none.
struct PressingColumns {
  int force = -1;      // of the springs [N], D components
  int arm = -1;        // the way to where friction acts [m], D components
  int slip = -1;       // of the spring of friction [m], D components
  int stiffness = -1;  // of the springs, 0 where none is pressed [N/m]
  int onset = -1;      // over which the spring begins [m]
  int opposite = -1;   // 1 + number of the body that is remembered, or 0
  int set_back = -1;   // by which they overlapped at the start [m]
};

template <int D>
struct ParticlePool {
  Columns columns;
  int position = 0;         // first component of each column; position [m], D components
  MaterialColumns at{};     // velocity [m/s] D; mass [kg]; volume [m^3]; stress [Pa]; ...
  int affine = -1;          // affine part of the velocity [1/s], D x D; -1: none
  int unseen = -1;          // what a filter takes of the velocity [m/s], D; -1: none
  int body_force = -1;      // force per mass [m/s^2], D components; -1: none
  int start_position = -1;  // [m], D components; -1: none
  // Of bodies that keep their nodes: the place X among these [m], D, and F = dx/dX, D x D; -1: of
  // others, whose nodes lie in space.
  int reference = -1, deformation = -1;
  // Of such bodies that flow plastically: their plastic strain; what it was, and by how much
  // particles were farther apart than at the start, when nodes were laid into them the last time.
  int flowed = -1, flowed_before = -1, stretched_before = -1;
  // And that may fail: 1 where neighbours of one that has failed have their contact points.
  int opened = -1;
  int set_back = -1;  // share of half its edge that the surface is set back in contact; -1: none
  PressingColumns pressing;
  Matter matter = Matter::solid;     // of its material
  double sound_speed = 0.0;          // of its material at the start [m/s]
  double fastest = 0.0;              // wave and particle together, before the step [m/s]
  std::vector<std::uint32_t> id;     // number of each particle in its body, as the user gave them
  std::vector<std::uint32_t> piece;  // 1 + number of its first of `pieces`, or 0; empty: no loads
  std::vector<SurfacePiece<D>> pieces;  // of all loads; of other ranks' particles they mean nothing
  std::vector<std::uint32_t> order;  // rows by cell, then by id, in the range that each patch owns
  std::size_t used = 0;  // of `order`, by the ranges of patches, now or before; behind it is room
  std::vector<RemovedRow> removed;
  std::vector<std::uint32_t> free_rows;  // of no particle: some have gone to other ranks
  std::vector<std::uint32_t> guests;     // rows of particles of other ranks that contact looks at

  std::size_t count() const { return columns.rows(); }
  double* x(int a) { return columns.component(position + a); }
  Storage* v(int a) { return columns.rounded(at.velocity + a); }
  const double* x(int a) const { return columns.component(position + a); }
  const Storage* v(int a) const { return columns.rounded(at.velocity + a); }
  double* mass() { return columns.component(at.mass); }
  const double* mass() const { return columns.component(at.mass); }
  double* volume() { return columns.component(at.volume); }
  const double* volume() const { return columns.component(at.volume); }
  /// Component C_ij of the affine part of the velocity, k = D i + j [1/s].
  Storage* affine_part(int k) { return columns.rounded(affine + k); }
  const Storage* affine_part(int k) const { return columns.rounded(affine + k); }
  /// What a filter takes of component a of the velocity [m/s].
  Storage* unseen_velocity(int a) { return columns.rounded(unseen + a); }
  const Storage* unseen_velocity(int a) const { return columns.rounded(unseen + a); }
  const Storage* stress(int k) const { return columns.rounded(at.stress + k); }
  Vec<double, D> position_of(std::size_t row) const {
    Vec<double, D> place;
    for (int a = 0; a < D; ++a) place[a] = x(a)[row];
    return place;
  }

  /// The place by which particles have their cell and weights: in space, or in the body.
  const double* listed(int a) const {
    return columns.component((reference < 0 ? position : reference) + a);
  }
  /// Component F_ij of the deformation gradient, k = D i + j.
  double* deformation_part(int k) { return columns.component(deformation + k); }
  const double* deformation_part(int k) const { return columns.component(deformation + k); }

  /// The rows of a patch's particles.
  std::span<const std::uint32_t> rows(const Patch<D>& patch) const {
    return {order.data() + patch.begin, patch.count};
  }
  std::size_t bytes() const {
    return columns.bytes() + bytes_of(id) + bytes_of(piece) + bytes_of(order) + bytes_of(removed) +
           bytes_of(free_rows);
  }
};

/// The place by which a particle has its cell.
template <int D>
Vec<double, D> listed_place(const ParticlePool<D>& pool, std::size_t row) {
  Vec<double, D> place;
  for (int a = 0; a < D; ++a) place[a] = pool.listed(a)[row];
  return place;
}

/// So many rows more, that few comings allocate.
constexpr std::size_t spare_rows(std::size_t rows) { return rows / 64 + 64; }

/// See to so many free rows.
template <int D>
void need_rows(ParticlePool<D>& pool, std::size_t number) {
  std::vector<std::uint32_t>& free = pool.free_rows;
  if (free.size() >= number) return;
  // Where some come more do: to move all that there are costs about a step.
  const std::size_t count = pool.count(), needed = count + number - free.size(),
                    more = needed + 2 * spare_rows(needed);
  grow(pool.columns, more);
  pool.id.resize(more);
  if (!pool.pieces.empty()) pool.piece.resize(more, 0);
  for (std::size_t row = more; row > count; --row)
    free.push_back(static_cast<std::uint32_t>(row - 1));
}

/// Rows for so many particles that come from other ranks.
template <int D>
void take_rows(ParticlePool<D>& pool, std::size_t number, std::vector<std::uint32_t>& rows) {
  std::vector<std::uint32_t>& free = pool.free_rows;
  need_rows(pool, number);
  rows.assign(free.rbegin(), free.rbegin() + static_cast<std::ptrdiff_t>(number));
  free.resize(free.size() - number);
}

/// f(piece) for the pieces of loads that a particle carries.
template <class Pool, class F>
void for_each_piece_of(Pool& pool, std::uint32_t row, F&& f) {
  for (std::uint32_t k = pool.piece.empty() ? 0 : pool.piece[row]; k != 0;
       k = pool.pieces[k - 1].next)
    f(pool.pieces[k - 1]);
}

/// By how much the mean stress that forces use is less than that of the material, where bodies on
/// nodes of their own average their pressures; in all that is shown [Pa].
template <int D>
double averaged_away(const ParticlePool<D>& pool, std::uint32_t row) {
  if (pool.deformation < 0 || pool.at.force_pressure < 0) return 0.0;
  const int q = pool.at.viscosity_pressure;
  return pool.columns.component(pool.at.force_pressure)[row] -
         (q >= 0 ? pool.columns.component(q)[row] : 0.0);
}

/// A piece of a load as it is in space by now.
template <int D>
SurfacePiece<D> piece_in_space(const ParticlePool<D>& pool, std::uint32_t row,
                               SurfacePiece<D> piece) {
  if (pool.deformation < 0) return piece;
  Mat<double, D> F;
  for (int k = 0; k < D * D; ++k) F[k / D][k % D] = pool.deformation_part(k)[row];
  piece.deform(F);
  return piece;
}

/// Kinetic energy of a particle [J]; with an affine part m D C:C / 2 of it, D = `affine_moment`
/// [m^2].
template <int D>
double kinetic_energy(const ParticlePool<D>& pool, std::uint32_t row, double affine_moment) {
  const double m = pool.mass()[row];
  double sum = 0.0;
  for (int a = 0; a < D; ++a) sum += 0.5 * m * pool.v(a)[row] * pool.v(a)[row];
  for (int k = 0; k < (pool.affine < 0 ? 0 : D * D); ++k)
    sum += 0.5 * m * affine_moment * pool.affine_part(k)[row] * pool.affine_part(k)[row];
  return sum;
}

/// The axial vector of the affine part of a particle's velocity, eps_kab C_ba [1/s].
template <int D>
Vector3 turning(const ParticlePool<D>& pool, std::uint32_t row) {
  Vector3 w = Vector3::zero();
  if (pool.affine < 0) return w;
  const auto C = [&](int i, int j) { return double{pool.affine_part(D * i + j)[row]}; };
  w[2] = C(1, 0) - C(0, 1);
  if constexpr (D == 3) {
    w[0] = C(2, 1) - C(1, 2);
    w[1] = C(0, 2) - C(2, 0);
  }
  return w;
}

template <int D>
Vector3 velocity_in_space(const ParticlePool<D>& pool, std::uint32_t row) {
  Vec<double, D> v;
  for (int a = 0; a < D; ++a) v[a] = pool.v(a)[row];
  return in_space<D>(v);
}

/// Angular momentum of a particle about a point [N m s], with that of the affine part.
template <int D>
Vector3 angular_momentum(const ParticlePool<D>& pool, std::uint32_t row, double affine_moment,
                         const Vector3& about) {
  const Vector3 arm = in_space<D>(pool.position_of(row)) - about;
  return pool.mass()[row] *
         (cross(arm, velocity_in_space(pool, row)) + affine_moment * turning(pool, row));
}

/// Recoverable energy of a particle, which is kept per initial volume m / rho_0 [J].
template <int D>
double recoverable_energy(const Body<D>& body, const ParticlePool<D>& pool, std::uint32_t row) {
  return pool.columns.component(pool.at.recoverable)[row] * pool.mass()[row] / body.initial_density;
}

/// How many entries of its pool's lists a patch with so many particles gets: some come and go.
constexpr std::uint32_t room_for(std::uint32_t count) { return count + count / 16 + 1; }
/// How many entries there are behind the ranges of all patches, for those that outgrow theirs.
constexpr std::size_t spare_room(std::size_t used) { return used / 16 + 64; }

/// The number of the pool, and of the material, of the body with a number.
template <int D>
std::size_t pool_number(const std::vector<Body<D>>& bodies, int body) {
  return static_cast<std::size_t>(bodies[static_cast<std::size_t>(body)].material);
}

/// The patches of a body.
template <int D, class Patches>
auto patches_of(Patches& patches, int body) {
  const auto found = std::ranges::equal_range(patches, body, {}, &Patch<D>::body);
  return std::span(found.begin(), found.end());
}

/// f(row) for the particles of a body that take part, in the order of its lists.
template <int D, class F>
void for_each_active_row(const std::vector<Patch<D>>& patches, const ParticlePool<D>& pool,
                         int body, F&& f) {
  for (const Patch<D>& patch : patches_of<D>(patches, body))
    for (const std::uint32_t row : pool.rows(patch)) f(row);
}

/// The same, and then for those that were removed, so many of them.
template <int D, class F>
void for_each_row(const std::vector<Patch<D>>& patches, const ParticlePool<D>& pool, int body,
                  std::size_t removed, F&& f) {
  for_each_active_row(patches, pool, body, f);
  for (auto at = pool.removed.begin(); removed > 0; ++at)
    if (at->body == body) {
      f(at->row);
      --removed;
    }
}

}  // namespace mpm
