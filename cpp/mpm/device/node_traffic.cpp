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
  wanted_ = {};
  loaded_ = {};
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
void NodeTraffic<D>::take(const Nodes& nodes, const double* from, int half) {
  domain_.threads.for_each(nodes.patches.size(), [&](std::size_t k) {
    const NodeBlock<D> block = domain_.grid.block(nodes.patches[k]);
    const double* of_block = from + std::size_t{half_record} * nodes.places[k].first;
    for (int n = 0; n < block.count; ++n, of_block += half_record)
      std::memcpy(block.records[n] + half * half_record, of_block, half_record * sizeof(double));
  });
}

template <int D>
void NodeTraffic<D>::give(const Nodes& nodes, double* to, int half) {
  domain_.threads.for_each(nodes.patches.size(), [&](std::size_t k) {
    const NodeBlock<D> block = domain_.grid.block(nodes.patches[k]);
    double* of_block = to + std::size_t{half_record} * nodes.places[k].first;
    for (int n = 0; n < block.count; ++n, of_block += half_record)
      std::memcpy(of_block, block.records[n] + half * half_record, half_record * sizeof(double));
  });
}

template bool is_loaded<2>(const Domain<2>&, const Patch<2>&);
template bool is_loaded<3>(const Domain<3>&, const Patch<3>&);
template class NodeTraffic<2>;
template class NodeTraffic<3>;

}  // namespace mpm
