#include <numeric>

#include "mpm/particles/lists.hpp"

namespace mpm {

template <int D>
void sort_columns(Body<D>& body, Threads& threads) {
  body.moved = 0;
  constexpr std::size_t chunk = 4096;
  const std::size_t n = body.count();
  const std::uint32_t* order = body.order.data();
  auto in_chunks = [&](auto&& f) {
    threads.for_each((n + chunk - 1) / chunk,
                     [&](std::size_t c) { f(c * chunk, std::min(n, (c + 1) * chunk)); });
  };
  for (int c = 0; c < body.columns.component_count(); ++c) {
    const double* from = body.columns.component(c);
    double* to = body.columns.spare();
    in_chunks([&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) to[k] = from[order[k]];
    });
    body.columns.swap_with_spare(c);
  }
  in_chunks([&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) body.next_order[k] = body.id[order[k]];
  });
  std::swap(body.id, body.next_order);
  std::iota(body.order.begin(), body.order.end(), 0u);
}

template <int D>
void sort_disordered(std::vector<Body<D>>& bodies, Threads& threads) {
  // Sorting moves every column once; reading particles out of order costs about that once a quarter
  // of them is.
  for (auto& body : bodies)
    if (4 * body.moved >= body.count()) sort_columns(body, threads);
}

template void sort_columns<2>(Body<2>&, Threads&);
template void sort_columns<3>(Body<3>&, Threads&);
template void sort_disordered<2>(std::vector<Body<2>>&, Threads&);
template void sort_disordered<3>(std::vector<Body<3>>&, Threads&);

}  // namespace mpm
