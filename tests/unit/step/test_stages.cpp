// Every stage does what the reference step does, to rounding: nodes and particles are compared
// after each.
#include "step/comparison.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

template <int D>
void check_step(Report& report, const Choice<D>& choice, Scheme scheme,
                std::span<const Stage<D>> stages) {
  Twin<D> twin(choice);
  Comparison<D> comparison(report, twin);
  for (int step = 0; step < 3; ++step) {
    twin.begin_step();
    for (const Stage<D>& stage : stages) {
      stage.run(twin.domain);
      CHECK(comparison.after(stage.name, scheme), stage.name);
    }
    twin.end_step();
  }
}

/// As the scheme lists the stages, and fused.
template <int D>
void check_schemes(Report& report, const Choice<D>& choice) {
  for (const Scheme scheme : {Scheme::usf, Scheme::usl, Scheme::musl}) {
    check_step(report, choice, scheme, stages_of<D>(scheme, false));
    check_step(report, choice, scheme, stages_of<D>(scheme, true));
  }
}

template <int D>
void check_all(Report& report) {
  Bases::for_each([&](BasisId basis, const auto&) {
    Choice<D> choice;
    choice.basis = basis;
    choice.load = choice.body_force = true;
    check_schemes(report, choice);
    choice.transfer = Transfers::id_of<Pic>();
    check_schemes(report, choice);
    choice.transfer = Transfers::id_of<Flip>();
    choice.pic_damping = 1e3;
    for (const BodyKind kind : {BodyKind::rigid, BodyKind::prescribed})
      for (const bool contact : {false, true}) {
        choice.kind = kind;
        choice.contact = contact;
        check_schemes(report, choice);
      }
    choice.walls.fill(Wall::slip);
    choice.walls[0] = Wall::fixed;
    choice.walls[1] = Wall::absorbing;
    choice.walls[3] = Wall::free;
    check_schemes(report, choice);
    choice.kind = BodyKind::deformable;
    check_schemes(report, choice);
  });
}

}  // namespace

void test_stages(Report& report) {
  check_all<2>(report);
  check_all<3>(report);
}
