#include <algorithm>
#include <numeric>

#include "mpm/particles/cell_lists.hpp"

namespace mpm {
namespace {

/// Numbers of rows in another order, with room behind them.
template <class Number>
std::vector<Number> in_order(const std::vector<Number>& numbers,
                             const std::vector<std::uint32_t>& rows, std::size_t room) {
  std::vector<Number> moved;
  moved.reserve(room);
  for (const std::uint32_t row : rows) moved.push_back(numbers[row]);
  moved.resize(room);
  return moved;
}

}  // namespace

template <int D>
void repack(std::vector<Patch<D>>& patches, std::vector<Body<D>>& bodies,
            std::vector<ParticlePool<D>>& pools) {
  for (Body<D>& body : bodies) body.moved = 0;
  for (std::size_t m = 0; m < pools.size(); ++m) {
    ParticlePool<D>& pool = pools[m];
    std::vector<std::uint32_t> rows;  // that were there, in their new order
    rows.reserve(pool.count());
    for (Patch<D>& patch : patches) {
      if (patch.foreign || pool_number(bodies, patch.body) != m) continue;
      patch.first_row = static_cast<std::uint32_t>(rows.size());
      for (std::uint32_t k = 0; k < patch.count; ++k) {
        std::uint32_t& row = pool.order[patch.begin + k];
        rows.push_back(row);
        row = static_cast<std::uint32_t>(rows.size() - 1);
      }
    }
    for (RemovedRow& removed : pool.removed) {
      rows.push_back(removed.row);
      removed.row = static_cast<std::uint32_t>(rows.size() - 1);
    }
    const std::size_t room = rows.size() + spare_rows(rows.size());
    repack(pool.columns, rows, room);
    pool.id = in_order(pool.id, rows, room);
    if (!pool.pieces.empty()) pool.piece = in_order(pool.piece, rows, room);
    pool.guests.clear();
    pool.free_rows.resize(room - rows.size());
    std::iota(pool.free_rows.rbegin(), pool.free_rows.rend(),
              static_cast<std::uint32_t>(rows.size()));
  }
}

template void repack<2>(std::vector<Patch<2>>&, std::vector<Body<2>>&,
                        std::vector<ParticlePool<2>>&);
template void repack<3>(std::vector<Patch<3>>&, std::vector<Body<3>>&,
                        std::vector<ParticlePool<3>>&);

}  // namespace mpm
