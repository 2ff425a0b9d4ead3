// Which axes walls hold at a node, and where nodes beyond them are mirrored to.
#include "check.hpp"
#include "mpm/walls/face_impulses.hpp"
#include "mpm/walls/walls.hpp"

namespace {

using namespace mpm;

Walls<2> box(Wall x_min, Wall y_max, bool odd) {
  Walls<2> walls;
  walls.exist = true;
  walls.cells = {10, 6};
  walls.face[0][0] = x_min;
  walls.face[1][1] = y_max;
  walls.odd_at_fixed = odd;
  return walls;
}

/// Far away if there is none.
WallImage<2> image_of(const Walls<2>& walls, const Index<2>& node) {
  return walls.image(node).value_or(WallImage<2>{{99, 99}, 0});
}

}  // namespace

void test_walls(mpm::testing::Report& report) {
  const Walls<2> slip = box(Wall::slip, Wall::fixed, false);
  CHECK_EQUAL(slip.constrained_axes({0, 3}), 1u);   // on the face: not across it
  CHECK_EQUAL(slip.constrained_axes({1, 3}), 0u);   // inside
  CHECK_EQUAL(slip.constrained_axes({-1, 3}), 0u);  // beyond: it has an image
  CHECK_EQUAL(slip.constrained_axes({4, 6}), 3u);   // on the fixed face
  CHECK_EQUAL(slip.constrained_axes({4, 7}), 3u);   // and beyond, as that has no images
  CHECK_EQUAL(slip.constrained_axes({10, 3}), 0u);  // a free face
  CHECK(!slip.image({3, 3}) && !slip.image({0, 3}) && !slip.image({4, 7}));
  const WallImage<2> image = image_of(slip, {-2, 3});
  CHECK(image.node == (Index<2>{2, 3}) && image.turned == 1u);
  CHECK_EQUAL(image.component(5.0, 0), -5.0);
  CHECK_EQUAL(image.component(5.0, 1), 5.0);

  // Odd at a fixed wall: both components turn there; at a slip wall too, the first turns back.
  const Walls<2> odd = box(Wall::slip, Wall::fixed, true);
  CHECK_EQUAL(odd.constrained_axes({4, 7}), 0u);
  CHECK_EQUAL(odd.constrained_axes({4, 6}), 3u);
  const WallImage<2> above = image_of(odd, {4, 7});
  CHECK(above.node == (Index<2>{4, 5}) && above.turned == 3u);
  const WallImage<2> corner = image_of(odd, {-1, 7});
  CHECK(corner.node == (Index<2>{1, 5}) && corner.turned == 2u);

  // Which faces do it, as bits 2 axis + side: x_min is the first, y_max the fourth.
  CHECK_EQUAL(slip.faces_holding({0, 6}, 0), 1u | 8u);  // at the edge both hold x
  CHECK_EQUAL(slip.faces_holding({0, 6}, 1), 8u);
  CHECK_EQUAL(slip.faces_turning({-2, 3}, 0), 1u);
  CHECK_EQUAL(slip.faces_turning({-2, 3}, 1), 0u);
  CHECK_EQUAL(odd.faces_turning({-1, 7}, 0), 1u | 8u);
  CHECK_EQUAL(odd.faces_holding({4, 7}, 0), 0u);
  CHECK_EQUAL(box(Wall::absorbing, Wall::free, false).faces_absorbing({0, 3}), 1u);
  FaceImpulses<2> faces;
  faces.add(1u | 8u, 0, 3.0);
  CHECK(faces.of[0][0][0] == 1.5 && faces.of[1][1][0] == 1.5 && faces.of[0][1][0] == 0.0);

  Walls<2> none = odd;
  none.exist = false;
  CHECK(!none.image({-1, 7}) && none.constrained_axes({0, 6}) == 0u && !none.absorb());
  CHECK(!odd.absorb() && box(Wall::absorbing, Wall::free, false).absorb());
}
