// Contact between surfaces: what the stages of surfaces/ do is what the reference does that tries
// every pair of points, to rounding; each of its parts in bodies on which it acts.
#include "step/surface_comparison.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

constexpr double step_of_waves = 0.4 * SurfaceTwin<2>::cell / 180.0;  // .4 h / c of the stiffest

/// A block that falls on a face of the box and leans on another that flies against it, both turned,
/// of two materials.
template <int D>
SurfacesGiven<D> two_blocks(BasisId basis) {
  SurfacesGiven<D> given;
  given.basis = basis;
  given.walls[2] = Wall::contact;
  TurnedBlock<D> lower, upper;
  lower.size = upper.size = Vec<double, D>::zero();
  for (int a = 0; a < D; ++a) {
    lower.size[a] = upper.size[a] = D == 2 ? 4.0 : 3.5;
    lower.centre[a] = upper.centre[a] = 10.07;
    lower.velocity[a] = upper.velocity[a] = 0.0;
  }
  lower.centre[1] = 0.5 * lower.size[1] + 0.03;
  lower.velocity[1] = -3.0;
  upper.size[0] = 3.0;
  upper.angle = 0.06;
  upper.centre[0] = 11.23;
  upper.centre[1] = lower.centre[1] + lower.size[1] + (D == 2 ? 0.02 : 0.1);
  upper.velocity[0] = 2.0;
  upper.velocity[1] = -4.0;
  given.bodies = {{{lower}}, {{upper}, 2e7, 0.2, 1500.0}};
  return given;
}

/// How many points touch a face, and how many another body.
template <int D>
std::array<int, 2> count_touches(const SurfaceTwin<D>& twin) {
  std::array<int, 2> count{};
  for (const reference::SurfaceTouch<D>& touch : twin.surfaces.touches)
    ++count[touch.whom < 0 ? 0 : 1];
  return count;
}

/// Springs alone: where they begin softly and deeper, and set back.
template <int D>
void check_springs(Report& report, BasisId basis) {
  SurfaceTwin<D> twin(two_blocks<D>(basis));
  SurfaceComparison<D> comparison(report, twin);
  std::array<int, 2> most{};
  std::array<int, 2> firm{};  // no, yes
  for (int k = 0; k < 20; ++k) {
    comparison.make_step(step_of_waves);
    const auto now = count_touches(twin);
    for (std::size_t i : {0, 1}) most[i] = std::max(most[i], now[i]);
    for (const auto& touch : twin.surfaces.touches)
      ++firm[twin.surfaces.overlap(touch) > 0.5 * touch.w ? 1 : 0];
  }
  CHECK(most[0] >= 8 && most[1] >= 8, most[0], most[1]);
  CHECK(firm[0] >= 8 && firm[1] >= 8, firm[0], firm[1]);
  CHECK(!twin.surfaces.set_back.empty());
}

/// Friction with a face and with a body, each of which has a coefficient of its own: some points
/// stick and some slide, and what sticks is stored.
template <int D>
void check_friction(Report& report, BasisId basis) {
  SurfacesGiven<D> given = two_blocks<D>(basis);
  given.friction = 0.1;
  given.wall_friction[2] = 0.25;
  given.pairs = {{0, 1, {.friction = 0.4}}};
  given.bodies[0].blocks[0].velocity[0] = 0.3;
  if (D == 3) given.bodies[0].blocks[0].velocity[D - 1] = -0.3;
  SurfaceTwin<D> twin(given);
  SurfaceComparison<D> comparison(report, twin);
  std::array<int, 4> count{};  // face, body; sticks, slides
  for (int k = 0; k < 24; ++k) {
    comparison.make_step(step_of_waves);
    for (const auto& touch : twin.surfaces.touches)
      ++count[(touch.whom < 0 ? 0u : 1u) + (touch.slides ? 2u : 0u)];
  }
  for (const int n : count) CHECK(n > 20, count[0], count[1], count[2], count[3]);
  CHECK(twin.surfaces.bodies[0].stored_rub > 0.0 && twin.surfaces.bodies[1].stored_rub > 0.0);
}

/// A block that a rigid one hits, which turns, and that lies on one that shakes and turns as it is
/// prescribed; the two that do not deform overlap, and do nothing to each other.
template <int D>
SurfacesGiven<D> rigid_blocks() {
  SurfacesGiven<D> given = two_blocks<D>(basis_id<QuadraticBSpline>);
  given.walls[2] = Wall::free;
  TurnedBlock<D> plate = given.bodies[0].blocks[0], flying = given.bodies[1].blocks[0],
                 block = plate;
  plate.velocity[1] = 0.0;
  block.centre[1] = plate.centre[1] + plate.size[1] + 0.07;
  block.angle = 0.03;
  flying.centre[0] = block.centre[0] + 0.5 * (block.size[0] + flying.size[0]) + 0.15;
  flying.centre[1] = block.centre[1] - 0.6;
  flying.velocity[0] = -5.0;
  flying.velocity[1] = 1.0;
  TimeFunction shakes(3.0);
  shakes.amplitude = 2.0;
  shakes.frequency = 3e3;
  given.bodies = {{{plate}, 1e7, 0.3, 3000.0, BodyKind::prescribed, {1.0, shakes, 0.0}, {}},
                  {{block}},
                  {{flying}, 1e7, 0.3, 2000.0, BodyKind::rigid}};
  given.bodies[0].spin[2] = TimeFunction(30.0);
  if (D == 3) given.bodies[0].spin[0] = TimeFunction(-20.0);
  return given;
}

template <int D>
void check_rigid(Report& report) {
  SurfacesGiven<D> given = rigid_blocks<D>();
  given.friction = 0.3;
  SurfaceTwin<D> twin(given);
  SurfaceComparison<D> comparison(report, twin);
  std::map<std::pair<std::size_t, int>, int> count;
  const double before = twin.step.bodies[1].motion.velocity[0];
  for (int k = 0; k < 24; ++k) {
    comparison.make_step(step_of_waves);
    for (const auto& touch : twin.surfaces.touches) ++count[{touch.body, touch.whom}];
  }
  for (const auto& [a, b] : {std::pair{0, 1}, {1, 0}, {1, 2}, {2, 1}}) {
    const int n = count[{static_cast<std::size_t>(a), b}];
    CHECK(n > 20, a, b, n);
  }
  CHECK_EQUAL(count.size(), 4u);
  const RigidMotion& motion = twin.step.bodies[1].motion;
  CHECK(motion.velocity[0] > 0.99 * before && norm(motion.spin) > 1.0, before, motion.velocity[0]);
}

/// Where bodies part what restitution leaves not is taken from their motions as wholes, along the
/// surface too; from one that does not deform as well.
template <int D>
void check_restitution(Report& report, bool rigid) {
  SurfacesGiven<D> given = rigid ? rigid_blocks<D>() : two_blocks<D>(basis_id<QuadraticBSpline>);
  given.friction = given.wall_friction[2] = 0.8;
  given.restitution = 0.4;
  // Of .9 the dashpot takes by its own law, of .4 as much as a step may.
  given.pairs = {{0, 1, {.friction = 0.8, .restitution = 0.9}}};
  given.bodies[0].density = 400.0;  // its waves are fast, so that it parts soon
  SurfaceTwin<D> twin(given);
  SurfaceComparison<D> comparison(report, twin);
  double taken = 0.0, largest = 0.0, kinetic = 0.0;
  for (const auto& body : twin.surfaces.bodies)
    for (const auto& p : body.body().particles) kinetic += 0.5 * p.m * dot(p.v, p.v);
  for (int k = 0; k < 44; ++k) {
    comparison.make_step(0.8 * step_of_waves);
    for (const auto& body : twin.surfaces.bodies) {
      const RigidMotion motion = body.motion();
      const double power = dot(body.force, motion.velocity) +
                           dot(body.moment - cross(motion.centre, body.force), motion.spin);
      if (body.deforms()) taken -= twin.step.dt * power;
      if (body.deforms()) largest = std::max(largest, norm(body.force));
    }
  }
  CHECK(taken > 0.01 * kinetic && largest > 0.0, taken, kinetic, largest);
}

/// Two blocks that are drawn touching slide on each other: points of faces that sink beside
/// edges are levelled at first, and ever less.
template <int D>
void check_levelled(Report& report) {
  SurfacesGiven<D> given = two_blocks<D>(basis_id<QuadraticBSpline>);
  given.walls[2] = Wall::free;
  TurnedBlock<D>&lower = given.bodies[0].blocks[0], &upper = given.bodies[1].blocks[0];
  upper.angle = 0.0;
  upper.centre[1] = lower.centre[1] + lower.size[1];
  lower.velocity[1] = 0.0;
  upper.velocity[0] = 3.0;
  upper.velocity[1] = -2.0;
  SurfaceTwin<D> twin(given);
  SurfaceComparison<D> comparison(report, twin);
  const std::size_t before = twin.surfaces.levelled.size();
  std::size_t less = 0;
  for (int k = 0; k < 10; ++k) {
    comparison.make_step(step_of_waves);
    for (const auto& [of, level] : twin.surfaces.levelled) less += level.by < level.first;
  }
  CHECK(before > 4 && less > 4, before, less);
  CHECK(twin.surfaces.levelled.size() < before, before, twin.surfaces.levelled.size());
}

/// Two lumps of one body that fly against each other: more than four cells apart in it they are as
/// two bodies.
template <int D>
void check_folds(Report& report) {
  SurfacesGiven<D> given = two_blocks<D>(basis_id<Gimp>);  // whose short waves are not damped
  TurnedBlock<D> left = given.bodies[0].blocks[0], right = left;
  for (int a = 0; a < D; ++a) left.size[a] = right.size[a] = 3.5;
  left.centre[0] = 8.07;
  right.centre[0] = left.centre[0] + left.size[0] + 4.3;
  right.angle = 0.05;
  left.centre[1] = 8.03;
  right.centre[1] = 8.53;
  left.velocity[0] = 10.0;
  right.velocity[0] = -10.0;
  left.velocity[1] = right.velocity[1] = 0.0;
  given.bodies = {{{left, right}}};
  given.friction = 0.3;
  SurfaceTwin<D> twin(given);
  SurfaceComparison<D> comparison(report, twin);
  int folds = 0;
  double stored = 0.0;
  for (int k = 0; k < 75; ++k) {
    comparison.make_step(1.5 * step_of_waves);
    for (const auto& touch : twin.surfaces.touches) folds += touch.whom == 0;
    stored = std::max(stored, twin.surfaces.bodies[0].stored_push);
  }
  CHECK(folds > 100 && stored > 0.0, folds, stored);
}

/// Two blocks that are bonded where they touch, and swing on it, and a rigid one bonded to both,
/// that has come to touch more of them than it is bonded to.
template <int D>
SurfacesGiven<D> bonded_blocks() {
  SurfacesGiven<D> given = two_blocks<D>(basis_id<QuadraticBSpline>);
  given.walls[2] = Wall::free;
  TurnedBlock<D> lower = given.bodies[0].blocks[0], upper = lower, beside = lower;
  upper.centre[0] += 1.04;
  upper.centre[1] += lower.size[1];
  upper.velocity = Vec<double, D>::zero();
  upper.velocity[0] = 3.0;
  upper.velocity[1] = 1.0;
  lower.velocity[1] = 0.0;
  beside.centre[0] = upper.centre[0] + upper.size[0] + 0.15;
  beside.centre[1] = upper.centre[1] - 0.1;
  beside.velocity[0] = -8.0;
  beside.angle = 0.1;
  given.bodies = {
      {{lower}}, {{upper}, 2e7, 0.2, 1500.0}, {{beside}, 1e7, 0.3, 2000.0, BodyKind::rigid}};
  given.pairs = {{0, 1, {.friction = 0.2, .bonded = true}}, {1, 2, {.bonded = true}}};
  return given;
}

template <int D>
void check_bonds(Report& report) {
  SurfaceTwin<D> twin(bonded_blocks<D>());
  std::array<std::size_t, 2> count{};
  for (const reference::Bond<D>& bond : twin.bonds) ++count[bond.a + bond.b > 1 ? 1 : 0];
  CHECK(count[0] > 20 && count[1] > 4, count[0], count[1]);
  CHECK(count[0] < twin.points[0].size() / 2, count[0]);
  SurfaceComparison<D> comparison(report, twin);
  double most = 0.0;
  bool pushes = false;
  for (int k = 0; k < 26; ++k) {
    comparison.make_step(step_of_waves);
    for (const auto& bond : twin.bonds)
      most = std::max(most, norm(bond.d.x - twin.surfaces.bodies[bond.a].points[bond.c].x));
    pushes = pushes || !twin.surfaces.touches.empty();
  }
  CHECK(most > 0.01 * twin.e && pushes, most, pushes);
}

/// Two blocks that stand on one plane of symmetry or fixed wall, in 3D on two, and hit each other.
template <int D>
SurfacesGiven<D> blocks_on_wall(Wall wall) {
  SurfacesGiven<D> given = two_blocks<D>(basis_id<QuadraticBSpline>);
  given.walls = {};
  given.walls[0] = wall;
  if (D == 3) given.walls[4] = Wall::slip;
  given.gravity = 0.0;
  given.friction = 0.3;
  TurnedBlock<D>&lower = given.bodies[0].blocks[0], &upper = given.bodies[1].blocks[0];
  upper.angle = 0.0;
  lower.centre[1] = 6.03;
  upper.centre[1] = lower.centre[1] + lower.size[1] + 0.01;
  for (int a = 0; a < D; a += 2) {
    lower.centre[a] = 0.5 * lower.size[a];
    upper.centre[a] = 0.5 * upper.size[a];
  }
  upper.velocity[0] = 0.0;
  upper.velocity[1] = -9.0;
  return given;
}

/// Their points feel mirrored ones, in the edge between the walls those of three images.
template <int D>
void check_images(Report& report, Wall wall) {
  SurfaceTwin<D> twin(blocks_on_wall<D>(wall));
  SurfaceComparison<D> comparison(report, twin);
  std::array<int, D> images{};
  double across = 0.0;
  for (int k = 0; k < 24; ++k) {
    comparison.make_step(step_of_waves);
    for (const auto& touch : twin.surfaces.touches)
      for (const auto& felt : touch.felt) {
        std::size_t mirrors = 0;
        for (int a = 0; a < D; ++a) mirrors += felt.mirror.sign[a] < 0.0;
        if (felt.share > 1e-3) ++images[mirrors];
        if (mirrors > 0) across = std::max(across, felt.share * norm(touch.rub));
      }
  }
  for (const int n : images) CHECK(n > 20, n);
  CHECK(across > 0.0);
}

/// The upper one does not lie on the wall, which pushes it back as it comes there: it has no image,
/// its nodes are free, and it slides there, if at all, as the wall is.
template <int D>
void check_not_held(Report& report, Wall wall) {
  SurfacesGiven<D> given = blocks_on_wall<D>(wall);
  TurnedBlock<D>& upper = given.bodies[1].blocks[0];
  upper.centre[0] += 0.04;
  upper.velocity[0] = -6.0;
  given.bodies[1].held_by = ~1u;
  SurfaceTwin<D> twin(given);
  SurfaceComparison<D> comparison(report, twin);
  int at_wall = 0, rubs = 0, images = 0;
  for (int k = 0; k < 24; ++k) {
    comparison.make_step(step_of_waves);
    for (const auto& touch : twin.surfaces.touches) {
      if (touch.whom == -1) {
        CHECK(touch.body == 1u, touch.body);
        ++at_wall;
        rubs += norm(touch.rub) > 0.0;
      }
      for (const auto& felt : touch.felt) {
        if (touch.whom == 1) CHECK(felt.mirror.sign[0] > 0.0);
        images += touch.whom == 0 && felt.mirror.sign[0] < 0.0 && felt.share > 1e-3;
      }
    }
  }
  CHECK(at_wall > 20 && images > 20, at_wall, images);
  CHECK(wall == Wall::slip ? rubs == 0 : rubs > 20, rubs);
}

/// What falls on a block and against a rigid one has its nodes in space: its particles press them
/// there, begin softly, stick and slide, and what overlapped at the start slides out.
template <int D>
void check_pressing(Report& report, BasisId basis) {
  SurfacesGiven<D> given = two_blocks<D>(basis);
  given.friction = 0.15;
  given.shaking = 0.5;
  BlocksGiven<D> sand = given.bodies[1];
  sand.in_space = true;
  TurnedBlock<D> beside = sand.blocks[0];
  sand.blocks[0].centre[1] -= 0.05;
  beside.centre[0] = sand.blocks[0].centre[0] + 0.5 * (sand.blocks[0].size[0] + beside.size[0]);
  beside.angle = 0.0;
  beside.centre[0] += 0.03;
  beside.velocity[0] = -4.0;
  given.bodies[1] = {{beside}, 1e7, 0.3, 3000.0, BodyKind::rigid};
  given.bodies.push_back(sand);
  SurfaceTwin<D> twin(given);
  SurfaceComparison<D> comparison(report, twin);
  std::array<int, 3> count{};  // sticks, slides, set back
  std::array<int, 2> of{};     // the bodies pressed
  for (int k = 0; k < 24; ++k) {
    comparison.make_step(step_of_waves);
    for (const reference::PressingParticle<D>& p : twin.pressing.particles) {
      const double most = given.friction * norm(p.push);
      if (most > 0.0) ++count[norm(p.rub) < 0.999 * most ? 0 : 1];
      count[2] += p.set_back > 0.0;
      if (p.pressed) ++of[static_cast<std::size_t>(p.whom)];
    }
  }
  for (const int n : count) CHECK(n > 10, count[0], count[1], count[2]);
  CHECK(of[0] > 10 && of[1] > 10, of[0], of[1]);
}

}  // namespace

void test_surfaces(Report& report) {
  for (const BasisId basis : {basis_id<QuadraticBSpline>, basis_id<Gimp>}) {
    check_springs<2>(report, basis);
    check_springs<3>(report, basis);
    check_friction<2>(report, basis);
    check_friction<3>(report, basis);
    check_pressing<2>(report, basis);
    check_pressing<3>(report, basis);
  }
  check_levelled<2>(report);
  check_levelled<3>(report);
  check_rigid<2>(report);
  check_rigid<3>(report);
  check_folds<2>(report);
  check_folds<3>(report);
  check_bonds<2>(report);
  check_bonds<3>(report);
  for (const Wall wall : {Wall::slip, Wall::fixed}) {
    check_not_held<2>(report, wall);
    check_not_held<3>(report, wall);
    check_images<2>(report, wall);
    check_images<3>(report, wall);
  }
  for (const bool rigid : {false, true}) {
    check_restitution<2>(report, rigid);
    check_restitution<3>(report, rigid);
  }
}
