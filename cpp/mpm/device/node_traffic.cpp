#include "mpm/device/node_traffic.hpp"

#include <cstring>

namespace mpm {

template <int D>
bool is_loaded(const Domain<D>& domain, const Patch<D>& patch) {
  if (domain.body_of(patch).force >= 0) return true;
  for (const SurfaceLoad<D>& load : domain.loads)
    if (load.body == patch.body) return true;
  return false;
}

template <int D>
void NodeTraffic<D>::choose() {
  for (Nodes* const nodes : {&wanted_, &loaded_}) {
    nodes->patches.clear();
    nodes->places.clear();
    nodes->count = 0;
  }
  const bool absorbs = domain_.grid.walls.absorb();
  for (std::uint32_t p = 0; p < domain_.grid.patches.size(); ++p) {
    const Patch<D>& patch = domain_.grid.patches[p];
    if (!is_on_device(domain_.body_of(patch)) || patch.shape.node_count == 0) continue;
    const bool loaded = is_loaded(domain_, patch);
    if (loaded) add(loaded_, p);
    if (loaded || patch.in_contact || (absorbs && patch.at_wall)) add(wanted_, p);
  }
  run_.choose_nodes(wanted_.places);
  run_.choose_mapped(loaded_.places);
}

template <int D>
void NodeTraffic<D>::add(Nodes& nodes, std::uint32_t p) {
  const Patch<D>& patch = domain_.grid.patches[p];
  nodes.patches.push_back(p);
  nodes.places.push_back({patch.body, patch.tile, patch.shape.low, patch.shape.nodes, nodes.count});
  nodes.count += static_cast<std::uint32_t>(patch.shape.node_count);
}

template <int D>
template <class F>
void NodeTraffic<D>::for_each(const Nodes& nodes, int half, F&& f) {
  domain_.threads.for_each(nodes.patches.size(), [&](std::size_t k) {
    const NodeBlock<D> block = domain_.grid.block(nodes.patches[k]);
    std::size_t place = std::size_t{half_record} * nodes.places[k].first;
    for (int n = 0; n < block.count; ++n, place += half_record)
      f(block.records[n] + half * half_record, place);
  });
}

template <int D>
void NodeTraffic<D>::take(const Nodes& nodes, const double* from, int half) {
  for_each(nodes, half, [&](double* of_node, std::size_t place) {
    std::memcpy(of_node, from + place, half_record * sizeof(double));
  });
}

template <int D>
void NodeTraffic<D>::give(const Nodes& nodes, double* to, int half) {
  for_each(nodes, half, [&](const double* of_node, std::size_t place) {
    std::memcpy(to + place, of_node, half_record * sizeof(double));
  });
}

template bool is_loaded<2>(const Domain<2>&, const Patch<2>&);
template bool is_loaded<3>(const Domain<3>&, const Patch<3>&);
template class NodeTraffic<2>;
template class NodeTraffic<3>;

}  // namespace mpm
