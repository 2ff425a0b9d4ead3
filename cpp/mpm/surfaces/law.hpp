#pragma once
// The law of contact between surfaces. A point overlaps an opposite by o; a spring pushes it back
// with k o, and the stiffness k is that of a layer H of both bodies, a quarter of a cell, which is
// about the stiffest that steps bear (decision 0071):
//   k = (A / 2) / (H_a / M_a + H_b / M_b),   H = h / 4,   M = rho c^2,                        (S1)
// half of it as the other body's points do the same; against a face of the box, that stands for a
// mirrored body of which no points push, k = A M / H. So two like bodies have 2 M / h for each
// area.
//
// A step passes the kink at which a spring begins somewhere within it, and a flat hit, of all
// points of a face at once, would gain or lose a few per cent of its energy by where. So it begins
// softly over w, what the two surfaces approach each other while the slower waves of the two bodies
// pass a cell, as they begin to overlap there or have anywhere before, h / 5 and 4 e / 5 at most
// with e the spacing of points, and no more than has begun since the step before:
//   f = k (o + w / 2)^2 / (2 w) from o = -w / 2 to w / 2, then k o.                         (S4)
//
// Friction (Cundall & Strack 1979) is a spring too, with a memory s for each point and opposite: it
// turns with the normal and grows by what the surfaces slip on one another, up to where it slides,
//   s += u_t dt,   |s| <= mu f / k_t,   t = - k_t s,                                        (S2)
// k_t = 0.8 k being that of Mindlin (1949), 2 (1 - nu) / (2 - nu), for nu about 1/3.
//
// Elastic bodies without any loss that slide flutter: constant friction drives waves along their
// surfaces (Adams 1995). So a point that slides has a dashpot along the normal besides, a part of
// what would let no wave back, Z = rho c of the start (after Oden & Martins 1985):
//   f = k o + beta eta do/dt, .01 k o at least,   eta = 0.2 A / (1 / Z_a + 1 / Z_b),           (S6)
// at a face 0.4 A Z, with beta = 3 / 2 - 5 |u_n / u_t| between 0 and 1: not in a hit, of which the
// dashpot would take up to a fifth of the energy.
#include <algorithm>
#include <cmath>

#include "mpm/math/vec.hpp"

namespace mpm {

inline constexpr double layer = 0.25;       // H over the cells' size
inline constexpr double tangential = 0.8;   // k_t / k
inline constexpr double of_waves = 0.2;     // eta over A Z of both
inline constexpr double least_push = 0.01;  // f over k o

/// The longest step that springs bear, of the time in which the fastest wave passes a cell: with H
/// of (S1) blocks whose faces lie anywhere between nodes keep their energy in hits at .6, and at .7
/// some make up to .6 of it again.
inline constexpr double most_cfl_of_springs = 0.6;

/// The longest w [m].
inline double most_onset(double cell_size, double spacing) {
  return std::min(0.2 * cell_size, 0.8 * spacing);
}

/// Of a point of that area against another body, (S1) [N/m]; 1 / M of a rigid body is 0.
inline double stiffness_of_point(double area, double cell_size, double compliance,
                                 double compliance_of_other) {
  return 0.5 * area / (layer * cell_size * (compliance + compliance_of_other));
}
/// Against a face of the box.
inline double stiffness_at_wall(double area, double cell_size, double compliance) {
  return area / (layer * cell_size * compliance);
}

/// Of a point that slides, (S6) [N s/m]; 1 / Z of a rigid body is 0.
inline double damping_of_point(double area, double admittance, double admittance_of_other) {
  return of_waves * area / (admittance + admittance_of_other);
}
/// On a face of the box.
inline double damping_at_wall(double area, double admittance) {
  return 2.0 * of_waves * area / admittance;
}

/// beta of (S6), of how fast a point goes along the normal and along the surface.
inline double slides_by(double along_normal, double along_surface) {
  return along_surface > 0.0
             ? std::clamp(1.5 - 5.0 * std::abs(along_normal) / along_surface, 0.0, 1.0)
             : 0.0;
}

/// The force of a spring over k, (S4), of an overlap > -w / 2.
inline double pressed_in_by(double overlap, double w) {
  const double begun = overlap + 0.5 * w;
  return overlap < 0.5 * w ? begun * begun / (2.0 * w) : overlap;
}
/// What is stored in it over k.
inline double stored_by(double overlap, double w) {
  const double begun = overlap + 0.5 * w;
  return overlap < 0.5 * w ? begun * begun * begun / (6.0 * w)
                           : 0.5 * overlap * overlap + w * w / 24.0;
}

/// Friction of a point, (S2).
template <int D>
struct Friction {
  Vec<double, D> slip;   // of the spring [m]
  Vec<double, D> force;  // [N]
  double stored, taken;  // in the spring, by sliding in the step [J]
  bool slides;
};

/// That of a point with the spring's slip so far, the unit normal, and by how much the surfaces
/// have gone on one another in the step, along the normal too [m]; `push` is the normal force [N].
template <int D>
Friction<D> rub(const Vec<double, D>& before, const Vec<double, D>& normal,
                const Vec<double, D>& way, double stiffness, double coefficient, double push) {
  const double k = tangential * stiffness, most = coefficient * push / k;
  Vec<double, D> slip = before - dot(before, normal) * normal;
  const double length = norm(slip);
  if (length > 0.0) slip = (norm(before) / length) * slip;  // as long as it was
  const Vec<double, D> old = slip;
  slip += way - dot(way, normal) * normal;
  const double now = norm(slip);
  double taken = 0.0;
  if (now > most) {
    // By the mean of the forces before and after, as work is counted.
    taken = 0.5 * k * (now - most) * (most + dot(old, slip) / now);
    slip = (most / now) * slip;
  }
  return {slip, (-k) * slip, 0.5 * k * dot(slip, slip), taken, now > most};
}

}  // namespace mpm
