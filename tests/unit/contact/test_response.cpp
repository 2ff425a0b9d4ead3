// Which pairs of bodies have springs, and of which the approach is stopped at the nodes.
#include "check.hpp"
#include "mpm/contact/response.hpp"

void test_response(mpm::testing::Report& report) {
  using namespace mpm;
  constexpr auto solid = Matter::solid, liquid = Matter::liquid, gas = Matter::gas;
  constexpr Matter all[] = {solid, liquid, gas};
  // By matter: a row for each matter, against a solid, a liquid, a gas (decision 0062).
  constexpr bool stopped[3][3] = {{false, false, true}, {false, true, true}, {true, true, true}};
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      CHECK(stops_approach(Response::impulses, all[a], all[b]));
      CHECK(!stops_approach(Response::springs, all[a], all[b]));
      CHECK(stops_approach(Response::by_matter, all[a], all[b]) == stopped[a][b]);
    }
  CHECK(!may_spring(Response::impulses));
  CHECK(may_spring(Response::springs));
  CHECK(may_spring(Response::by_matter));
}
