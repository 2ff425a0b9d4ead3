#pragma once
// Points near walls that are planes of symmetry, or fixed: of the mirrored bodies behind these a
// point feels what its own image would feel of the bodies here, as |x_q' - x_p| = |x_q - x_p'|.
// Energies are those of the half before the wall.
#include <array>

#include "mpm/domain.hpp"

namespace mpm {

/// A place, or one of its images behind walls: bit a is set if it is mirrored along axis a, by the
/// lower face, bit D + a by the upper one.
template <int D>
struct PlaceOrImage {
  std::uint8_t mirrors = 0;
  Vec<double, D> place;
};

constexpr bool is_mirrored(std::uint8_t mirrors, int axis, int dimension) {
  return ((mirrors | mirrors >> dimension) >> axis & 1u) != 0;
}

/// A vector as its image has it.
template <int D>
Vec<double, D> mirrored(std::uint8_t mirrors, Vec<double, D> vector) {
  for (int a = 0; a < D; ++a)
    if (is_mirrored(mirrors, a, D)) vector[a] = -vector[a];
  return vector;
}

/// A place as its image has it [m].
template <int D>
Vec<double, D> mirrored_place(const TileGrid<D>& grid, std::uint8_t mirrors, Vec<double, D> place) {
  for (int a = 0; a < D; ++a) {
    const double upper = grid.cell_size * grid.walls.cells[static_cast<std::size_t>(a)];
    if (mirrors >> a & 1u) place[a] = 2.0 * grid.origin[a] - place[a];
    if (mirrors >> (D + a) & 1u) place[a] = 2.0 * (grid.origin[a] + upper) - place[a];
  }
  return place;
}

/// f(place or image) for a place and its images behind walls that hold a body, no farther from
/// these than the place may be felt.
template <int D, class F>
void for_each_image(const TileGrid<D>& grid, int body, const Vec<double, D>& place, double reach,
                    F&& f) {
  f(PlaceOrImage<D>{0, place});
  const Walls<D>& walls = grid.walls_of(body);
  if (!walls.exist) return;
  std::array<PlaceOrImage<D>, D == 3 ? 27 : 9> found;  // beyond one wall at most along each axis
  found[0].place = place;
  std::size_t count = 1;
  for (int a = 0; a < D; ++a) {
    const std::size_t before = count;
    for (const int side : {0, 1}) {
      if (!Walls<D>::holds(walls.face[a][side])) continue;
      const auto mirror = static_cast<std::uint8_t>(1u << (side * D + a));
      const Vec<double, D> image = mirrored_place(grid, mirror, place);
      if (!(0.5 * std::abs(image[a] - place[a]) < reach)) continue;
      for (std::size_t k = 0; k < before; ++k)
        found[count++] = {static_cast<std::uint8_t>(found[k].mirrors | mirror),
                          mirrored_place(grid, mirror, found[k].place)};
    }
  }
  for (std::size_t k = 1; k < count; ++k) f(found[k]);
}

}  // namespace mpm
