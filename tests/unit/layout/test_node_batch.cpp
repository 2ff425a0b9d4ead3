// Lanes over nodes: arithmetic value by value, and from four values of each node in a register each
// to the four values of a node beside each other.
#include "check.hpp"
#include "mpm/layout/node_batch.hpp"

namespace {

using namespace mpm;

template <int Count>
NodeBatch<Count> numbers(double first) {
  NodeBatch<Count> batch;
  for (int n = 0; n < Count; ++n) batch.part[n / batch.width].v[n % batch.width] = first + n;
  return batch;
}
template <int Count>
double value(const NodeBatch<Count>& batch, int n) {
  return batch.part[n / batch.width][n % batch.width];
}

template <int Count>
void check_arithmetic(mpm::testing::Report& report) {
  static_assert(NodeBatch<Count>::width * NodeBatch<Count>::parts == Count);
  NodeBatch<Count> sum = NodeBatch<Count>::zero();
  for (int n = 0; n < Count; ++n) CHECK_EQUAL(value(sum, n), 0.0);
  sum += 2.0 * numbers<Count>(1.0);
  sum.add(0.5, numbers<Count>(4.0));
  for (int n = 0; n < Count; ++n) CHECK_EQUAL(value(sum, n), 2.0 * (1.0 + n) + 0.5 * (4.0 + n));
}

template <int W>
void check_lanes(mpm::testing::Report& report) {
  Batch<W> of[4];
  for (int k = 0; k < 4; ++k)
    for (int n = 0; n < W; ++n) of[k].v[n] = 10.0 * n + k;
  int visited = 0;
  transpose_to_nodes<W>(of[0], of[1], of[2], of[3], [&](int node, const Batch<4>& half) {
    for (int k = 0; k < 4; ++k) CHECK_EQUAL(half[k], 10.0 * node + k);
    visited |= 1 << node;
  });
  CHECK_EQUAL(visited, (1 << W) - 1);
}

}  // namespace

void test_node_batch(mpm::testing::Report& report) {
  check_arithmetic<4>(report);
  check_arithmetic<8>(report);
  check_lanes<4>(report);
  if constexpr (native_lanes >= 8) check_lanes<8>(report);
}
