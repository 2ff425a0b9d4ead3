// Given particles come to the rank that has their tile, each once and with all that was given.
#include <mutex>
#include <random>

#include "check.hpp"
#include "mpm/particles/give_to_owners.hpp"
#include "on_ranks.hpp"

namespace {

using namespace mpm;

constexpr std::size_t count = 500;  // of each of two bodies

/// The second body has velocities of its own, volumes and a state.
Body<3> given_body(int b, const Comm& comm, std::span<const double> places) {
  Body<3> body;
  body.count = count;
  const Share share(count, comm);
  GivenParticles given{share, share.of(places, 3), {1.0, 2.0, 3.0}, {0.5}};
  for (std::size_t k = share.first; b == 1 && k < share.last; ++k) {
    const auto number = static_cast<double>(k);
    if (k == share.first) given.velocities.clear(), given.volumes.clear();
    for (const double factor : {2.0, 3.0, 4.0}) given.velocities.push_back(factor * number);
    given.volumes.push_back(5.0 * number);
    if (given.states.empty()) given.states = {{7, {}}};
    given.states[0].second.push_back(6.0 * number);
  }
  if (share.count() > 0) body.given = std::make_unique<GivenParticles>(std::move(given));
  return body;
}

bool is_as_given(int b, const GivenParticles& given, std::size_t k,
                 std::span<const double> places) {
  const std::size_t n = given.numbers[k];
  const auto number = static_cast<double>(n);
  bool same = true;
  for (std::size_t a = 0; a < 3; ++a) {
    const double speed = b == 1 ? static_cast<double>(2 + a) * number : static_cast<double>(1 + a);
    same &= given.positions[3 * k + a] == places[3 * n + a];
    same &= given.velocities[3 * k + a] == speed;
  }
  same &= given.volumes[k] == (b == 1 ? 5.0 * number : 0.5);
  if (b == 0) return same && given.states.empty();
  return same && given.states[0].first == 7 && given.states[0].second[k] == 6.0 * number;
}

}  // namespace

void test_give_to_owners(mpm::testing::Report& report) {
  std::mt19937_64 random(3);
  std::vector<double> places[2];
  for (int b = 0; b < 2; ++b)
    for (std::size_t k = 0; k < 3 * count; ++k)
      places[b].push_back(std::uniform_real_distribution<double>(0.0, 40.0)(random));
  std::mutex mutex;
  std::vector<int> seen[2];
  for (std::vector<int>& of : seen) of.resize(count, 0);
  std::size_t most = 0;
  mpm::testing::on_ranks(5, [&](Comm& comm) {
    TileGrid<3> grid;
    grid.partition.comm = &comm;
    grid.cell_size = 1.0;
    std::vector<Body<3>> bodies(2);
    for (int b = 0; b < 2; ++b)
      bodies[static_cast<std::size_t>(b)] = given_body(b, comm, places[b]);
    place_anchor(grid, bodies);
    const auto owners = give_to_owners(grid, bodies);
    const std::scoped_lock lock(mutex);
    CHECK(owners.has_value());
    if (!owners) return;
    std::size_t here = 0;
    for (int b = 0; b < 2; ++b) {
      const auto& given = bodies[static_cast<std::size_t>(b)].given;
      for (std::size_t k = 0; given && k < given->count(); ++k, ++here) {
        const Index<3> tile = grid.tile_and_cell(given->position<3>(k)).first;
        CHECK_EQUAL(owners->rank_of(tile), comm.rank());
        CHECK(is_as_given(b, *given, k, places[b]), b, k);
        ++seen[b][given->numbers[k]];
      }
    }
    most = std::max(most, here);
  });
  for (const std::vector<int>& of : seen)
    for (const int times : of) CHECK_EQUAL(times, 1);
  CHECK(most < 300, most);  // A fifth of them are 200.
  TileGrid<3> alone;
  std::vector<Body<3>> bodies;
  CHECK(!give_to_owners(alone, bodies));
}
