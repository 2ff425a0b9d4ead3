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
  for (int step = 0; step < 2; ++step) {
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
    Extra extra = filters(choice.transfer) ? Extra::filter : Extra::none;
    const bool takes = takes_grid_velocity(choice.transfer) || choice.pic_rate > 0.0;
    if (choice.contact && (takes || choice.flip_share < 1.0)) extra = Extra::release;
    check_step(report, choice, scheme, stages_of<D>(scheme, false, extra));
    check_step(report, choice, scheme, stages_of<D>(scheme, true, extra));
  }
}

/// With volumes averaged over cells: in contact, with loads and walls.
template <int D>
void check_averages(Report& report, Choice<D> choice) {
  choice.averages = true;
  for (const bool contact : {false, true}) {
    choice.contact = contact;
    check_schemes(report, choice);
  }
}

/// One of each kind.
template <int D>
void put_walls(Choice<D>& choice) {
  choice.walls.fill(Wall::slip);
  choice.walls[0] = Wall::fixed;
  choice.walls[1] = Wall::absorbing;
  choice.walls[3] = Wall::free;
}

/// Every transfer that goes with the basis: alone, in contact, with other kinds of bodies and
/// walls.
template <int D>
void check_transfers(Report& report, BasisId basis) {
  Transfers::for_each([&]<class Transfer>(TransferId transfer, const Transfer&) {
    if (Transfer::affine && second_moment(basis) == 0.0) return;
    Choice<D> choice;
    choice.basis = basis;
    choice.transfer = transfer;
    choice.load = true;
    check_averages(report, choice);
    if (Transfer::has_share) choice.flip_share = 0.9, choice.pic_rate = 1e3;
    check_schemes(report, choice);
    if (Transfer::filters) choice.filter_order = 3, choice.filter_every = 2;
    choice.contact = true;
    for (const BodyKind kind : {BodyKind::rigid, BodyKind::prescribed, BodyKind::deformable}) {
      choice.kind = kind;
      check_schemes(report, choice);
    }
    choice.springs = true;
    check_schemes(report, choice);
    choice.springs = false;
    put_walls(choice);
    choice.filter_every = 1;
    check_schemes(report, choice);
    choice.damping = true;
    check_schemes(report, choice);
    choice.damping = false;
    choice.kind = BodyKind::prescribed;
    check_schemes(report, choice);
  });
}

/// Springs of particles so narrow and so wide that surfaces are felt one and two cells away: the
/// default, without walls that mirror and with them. (What is felt further than two cells is cut
/// off, which the reference does not do: test_springs.)
template <int D>
void check_widths(Report& report) {
  Choice<D> choice;
  choice.basis = basis_id<QuadraticBSpline>;
  choice.transfer = Transfers::id_of<Aflip>();
  choice.flip_share = 0.97;
  choice.contact = choice.springs = true;
  for (const bool walls : {false, true}) {
    if (walls) put_walls(choice);
    for (const double edge : {0.45, 0.9}) {
      choice.edge = edge;
      check_schemes(report, choice);
    }
  }
}

/// Walls that touch, which meet in a corner beside others, of bodies alone and in contact.
template <int D>
void check_touching_walls(Report& report, BasisId basis) {
  Choice<D> choice;
  choice.basis = basis;
  choice.walls.fill(Wall::contact);
  choice.walls[1] = Wall::fixed;
  choice.walls[3] = Wall::slip;
  choice.load = choice.body_force = true;
  for (const TransferId transfer :
       {Transfers::id_of<Flip>(), Transfers::id_of<Pic>(), Transfers::id_of<Apic>()}) {
    if (is_affine(transfer) && second_moment(basis) == 0.0) continue;
    choice.transfer = transfer;
    for (const bool contact : {false, true})
      for (const bool springs : {false, true}) {
        choice.contact = contact;
        choice.springs = springs;
        check_schemes(report, choice);
      }
  }
  choice.transfer = Transfers::id_of<Flip>();
  choice.damping = true;
  check_schemes(report, choice);
}

template <int D>
void check_stages(Report& report) {
  check_widths<D>(report);
  Bases::for_each([&](BasisId basis, const auto&) {
    check_transfers<D>(report, basis);
    check_touching_walls<D>(report, basis);
    Choice<D> choice;
    choice.basis = basis;
    choice.load = choice.body_force = true;
    check_schemes(report, choice);
    choice.pic_rate = 1e3;
    for (const BodyKind kind : {BodyKind::rigid, BodyKind::prescribed})
      for (const bool contact : {false, true}) {
        choice.kind = kind;
        choice.contact = contact;
        check_schemes(report, choice);
      }
    choice.damping = true;
    check_schemes(report, choice);
    put_walls(choice);
    for (const bool springs : {false, true})
      for (const BodyKind kind : {BodyKind::prescribed, BodyKind::deformable}) {
        choice.springs = springs;
        choice.kind = kind;
        check_schemes(report, choice);
      }
    choice.springs = choice.damping = false;
    check_averages(report, choice);
  });
}

}  // namespace

void test_stages(Report& report) {
  check_stages<2>(report);
  check_widths<3>(report);
  check_transfers<3>(report, basis_id<Gimp>);
  check_touching_walls<3>(report, basis_id<QuadraticBSpline>);
}

void test_stages_in_space(Report& report) { check_stages<3>(report); }
