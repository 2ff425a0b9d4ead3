#include "mpm/device/host_contact.hpp"

#include <cstring>

#include "mpm/step/stages.hpp"

namespace mpm {

template <int D>
void HostContact<D>::begin_step() {
  patches_.clear();
  places_.clear();
  std::uint32_t first = 0;
  for (std::uint32_t p = 0; p < domain_.grid.patches.size(); ++p) {
    const Patch<D>& patch = domain_.grid.patches[p];
    if (!patch.in_contact || patch.shape.node_count == 0) continue;
    patches_.push_back(p);
    places_.push_back({patch.body, patch.tile, patch.shape.low, patch.shape.nodes, first});
    first += static_cast<std::uint32_t>(patch.shape.node_count);
  }
  run_.choose_nodes(places_);
}

/// A half of the records of all wanted nodes from the device.
template <int D>
void HostContact<D>::read(int half) {
  const double* const from = run_.read_nodes(half);
  domain_.threads.for_each(patches_.size(), [&](std::size_t k) {
    const NodeBlock<D> block = domain_.grid.block(patches_[k]);
    const double* of_block = from + std::size_t{half_record} * places_[k].first;
    for (int n = 0; n < block.count; ++n, of_block += half_record)
      std::memcpy(block.records[n] + half * half_record, of_block, half_record * sizeof(double));
  });
}

template <int D>
void HostContact<D>::write(int half) {
  double* const to = run_.nodes_of_host(half);
  domain_.threads.for_each(patches_.size(), [&](std::size_t k) {
    const NodeBlock<D> block = domain_.grid.block(patches_[k]);
    double* of_block = to + std::size_t{half_record} * places_[k].first;
    for (int n = 0; n < block.count; ++n, of_block += half_record)
      std::memcpy(of_block, block.records[n] + half * half_record, half_record * sizeof(double));
  });
  run_.write_nodes(half);
}

template <int D>
void HostContact<D>::with_nodes(NodeMoment moment) {
  constexpr int first = 0, second = 1;  // mass and velocity; force, increment, remapped velocity
  switch (moment) {
    case NodeMoment::velocities:
      read(first);
      contact_momentum(domain_);
      write(first);
      return;
    case NodeMoment::forces:
      read(second);
      contact_forces(domain_);
      write(second);
      return;
    case NodeMoment::velocities_and_forces:
      read(first);
      read(second);
      contact_momentum(domain_);
      contact_forces(domain_);
      write(first);
      write(second);
      return;
    case NodeMoment::released:
      read(first);
      read(second);
      release_from_contact(domain_);
      write(first);
      return;
    case NodeMoment::restored:
      restore_contact(domain_);
      write(first);
      return;
    case NodeMoment::remapped:
      read(second);
      contact_remapped(domain_);
      write(second);
  }
}

template class HostContact<2>;
template class HostContact<3>;

}  // namespace mpm
