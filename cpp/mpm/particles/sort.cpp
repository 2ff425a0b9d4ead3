#include <algorithm>
#include <numeric>

#include "mpm/particles/lists.hpp"

namespace mpm {

template <int D>
void sort_columns(TileGrid<D>& grid, Body<D>& body, Threads& threads, ListScratch<D>& scratch) {
  body.moved = 0;
  constexpr std::size_t chunk = 4096;
  const std::size_t n = body.count();
  const std::uint32_t* order = body.order.data();
  auto in_chunks = [&](auto&& f) {
    threads.for_each((n + chunk - 1) / chunk,
                     [&](std::size_t c) { f(c * chunk, std::min(n, (c + 1) * chunk)); });
  };
  const auto sort = [&](auto* values, auto* room) {
    in_chunks([&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) room[k] = values[order[k]];
    });
    in_chunks([&](std::size_t begin, std::size_t end) {
      std::copy(room + begin, room + end, values + begin);
    });
  };
  std::byte* const room = scratch.room(grid, n * sizeof(double), n * sizeof(double));
  for (int c = 0; c < body.columns.component_count(); ++c)
    body.columns.with_component(
        c, [&]<class Number>(Number* values) { sort(values, reinterpret_cast<Number*>(room)); });
  sort(body.id.data(), reinterpret_cast<std::uint32_t*>(room));
  std::iota(body.order.begin(), body.order.end(), 0u);
}

template <int D>
void sort_disordered(TileGrid<D>& grid, std::vector<Body<D>>& bodies, Threads& threads,
                     double share, ListScratch<D>& scratch) {
  for (auto& body : bodies)
    if (static_cast<double>(body.moved) >= share * static_cast<double>(body.count()))
      sort_columns(grid, body, threads, scratch);
}

template void sort_columns<2>(TileGrid<2>&, Body<2>&, Threads&, ListScratch<2>&);
template void sort_columns<3>(TileGrid<3>&, Body<3>&, Threads&, ListScratch<3>&);
template void sort_disordered<2>(TileGrid<2>&, std::vector<Body<2>>&, Threads&, double,
                                 ListScratch<2>&);
template void sort_disordered<3>(TileGrid<3>&, std::vector<Body<3>>&, Threads&, double,
                                 ListScratch<3>&);

}  // namespace mpm
