#pragma once
// The unit tests. A new one is a file that defines `void test_name(mpm::testing::Report& report)`
// and one line here: its name, in front of the backslash.
#include <array>
#include <string_view>

#include "check.hpp"

// clang-format off
#define MPM_UNIT_TESTS(X) \
  X(check) \
  X(catalogue) \
  X(exact_sum) \
  X(batch) \
  X(log) \
  X(exp_and_pow) \
  X(tensor) \
  X(hilbert) \
  X(cholesky) \
  X(time_function) \
  X(expression) \
  X(eigen) \
  X(threads) \
  X(threads_comm) \
  X(memory) \
  X(state_stream) \
  X(columns) \
  X(basis) \
  X(jaumann) \
  X(models) \
  X(material) \
  X(plane_strain) \
  X(take_through) \
  X(mohr_coulomb) \
  X(walls) \
  X(rigid_motion) \
  X(load_kinds) \
  X(surface_load) \
  X(tile) \
  X(block_shape) \
  X(node_bits) \
  X(node_batch) \
  X(connect) \
  X(patch) \
  X(outflow_box) \
  X(blocks) \
  X(shared_nodes) \
  X(make_body) \
  X(give_to_owners) \
  X(pool) \
  X(build_cell_lists) \
  X(update_cell_lists) \
  X(classify) \
  X(migrants) \
  X(sort_columns) \
  X(transfer) \
  X(move) \
  X(nodes_around) \
  X(loops) \
  X(fuse) \
  X(kept_nodes) \
  X(copies_of_nodes) \
  X(surfaces) \
  X(stages) \
  X(rows) \
  X(rows_in_space) \
  X(stages_in_space) \
  X(two_bodies) \
  X(many_bodies) \
  X(response) \
  X(separation) \
  X(springs) \
  X(touches) \
  X(tile_holder) \
  X(contact_part) \
  X(derived_fields) \
  X(slices) \
  X(ranks) \
  X(two_and_eight_ranks) \
  X(step_watch) \
  X(timers) \
  X(no_allocation) \
  /* end */
// clang-format on

namespace mpm::testing {

struct UnitTest {
  std::string_view name;
  void (*run)(Report&);
};

}  // namespace mpm::testing

#define MPM_DECLARE(name) void test_##name(mpm::testing::Report& report);
#define MPM_ENTRY(name) mpm::testing::UnitTest{#name, &test_##name},

MPM_UNIT_TESTS(MPM_DECLARE)

namespace mpm::testing {
inline constexpr auto unit_tests = std::array{MPM_UNIT_TESTS(MPM_ENTRY)};
}  // namespace mpm::testing

#undef MPM_DECLARE
#undef MPM_ENTRY
