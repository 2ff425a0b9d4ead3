#include "mpm/device/host_part.hpp"

#include <cstring>
#include <limits>
#include <utility>

#include "mpm/loads/body_forces.hpp"
#include "mpm/loads/carry_loads.hpp"
#include "mpm/step/stages.hpp"
#include "mpm/walls/absorb.hpp"
#include "mpm/walls/mirror.hpp"
#include "mpm/walls/reactions.hpp"

namespace mpm {

namespace {

constexpr int first = 0,
              second = 1;  // halves: mass and velocity; force, increment, remapped velocity

/// Do loads or a body force act on a patch's body?
template <int D>
bool is_loaded(const Domain<D>& domain, const Patch<D>& patch) {
  if (domain.body_of(patch).force >= 0) return true;
  for (const SurfaceLoad<D>& load : domain.loads)
    if (load.body == patch.body) return true;
  return false;
}

}  // namespace

template <int D>
void update_lists(Domain<D>& domain) {
  for (Patch<D>& patch : domain.grid.patches) patch.left_cell = true;
  const double disorder = std::exchange(domain.disorder, std::numeric_limits<double>::infinity());
  Stages<D>::activate.run(domain);
  domain.disorder = disorder;
}

template <int D>
void HostPart<D>::of_rigid(void (*stage)(Domain<D>&)) {
  if (!domain_.has_rigid() && !domain_.has_prescribed()) return;
  // As ranks make stages of their edges first; loops that know no parts go over all patches, and
  // what they find in the blocks of others is read from the device afterwards.
  domain_.grid.partition.part = PatchPart::edge;
  stage(domain_);
  domain_.grid.partition.part = PatchPart::all;
}

template <int D>
void HostPart<D>::Nodes::clear() {
  patches.clear();
  places.clear();
  count = 0;
}

template <int D>
void HostPart<D>::Nodes::add(std::uint32_t number, const Patch<D>& patch) {
  patches.push_back(number);
  places.push_back({patch.body, patch.tile, patch.shape.low, patch.shape.nodes, count});
  count += static_cast<std::uint32_t>(patch.shape.node_count);
}

template <int D>
void HostPart<D>::begin_step() {
  update_lists(domain_);
  wanted_.clear();
  loaded_.clear();
  std::vector<std::uint32_t>& rigid = domain_.grid.partition.edge;
  rigid.clear();
  for (std::uint32_t p = 0; p < domain_.grid.patches.size(); ++p) {
    const Patch<D>& patch = domain_.grid.patches[p];
    if (!is_on_device(domain_.body_of(patch))) {
      rigid.push_back(p);
      continue;
    }
    if (patch.shape.node_count == 0) continue;
    const bool loaded = is_loaded(domain_, patch);
    if (loaded) loaded_.add(p, patch);
    const bool absorbs = patch.at_wall && domain_.grid.walls.absorb();
    if (loaded || absorbs || patch.in_contact) wanted_.add(p, patch);
  }
  run_.choose_nodes(wanted_.places);
  run_.choose_mapped(loaded_.places);
  of_rigid(map_momentum);
  of_rigid(fold_momentum);
  of_rigid(exchange_momentum);
  of_rigid(find_velocities);
}

template <int D>
void HostPart<D>::take(const Nodes& nodes, const double* from, int half) {
  domain_.threads.for_each(nodes.patches.size(), [&](std::size_t k) {
    const NodeBlock<D> block = domain_.grid.block(nodes.patches[k]);
    const double* of_block = from + std::size_t{half_record} * nodes.places[k].first;
    for (int n = 0; n < block.count; ++n, of_block += half_record)
      std::memcpy(block.records[n] + half * half_record, of_block, half_record * sizeof(double));
  });
}

template <int D>
void HostPart<D>::give(const Nodes& nodes, double* to, int half) {
  domain_.threads.for_each(nodes.patches.size(), [&](std::size_t k) {
    const NodeBlock<D> block = domain_.grid.block(nodes.patches[k]);
    double* of_block = to + std::size_t{half_record} * nodes.places[k].first;
    for (int n = 0; n < block.count; ++n, of_block += half_record)
      std::memcpy(of_block, block.records[n] + half * half_record, half_record * sizeof(double));
  });
}

template <int D>
void HostPart<D>::read(int half) {
  take(wanted_, run_.read_nodes(half), half);
}

template <int D>
void HostPart<D>::write(int half) {
  give(wanted_, run_.nodes_of_host(half), half);
  run_.write_nodes(half);
}

/// The factors of the dashpots, which of_rigid(exchange_forces) sums.
template <int D>
void HostPart<D>::start_dashpots() {
  if (!domain_.grid.walls.absorb()) return;
  domain_.threads.for_each(domain_.grid.patches.size(), [&](std::size_t p) {
    const NodeBlock<D> block = domain_.grid.block(p);
    clear(block.dashpots(), block.count, half_record);
  });
  place_dashpots(domain_);
}

template <int D>
void HostPart<D>::make_velocities() {
  read(first);
  contact_momentum(domain_);
  write(first);
}

template <int D>
void HostPart<D>::make_forces() {
  if (!wants(NodeMoment::mapped)) of_rigid(map_forces);
  of_rigid(fold_forces);
  if (domain_.grid.walls.absorb())
    exchange_forces(domain_);  // for the dashpots
  else
    of_rigid(exchange_forces);
  read(second);
  absorb_at_walls(domain_);
  contact_forces(domain_);
  write(second);
  of_rigid(advance_nodes);
  if (!releases_) advance_rigid();
}

template <int D>
void HostPart<D>::advance_rigid() {
  of_rigid(advance_particles);
  of_rigid(project_rigid_velocities);
}

template <int D>
template <int at>
void HostPart<D>::carry(double duration) {
  domain_.threads.for_each(loaded_.patches.size(), [&](std::size_t k) {
    carry_loads<at>(domain_, loaded_.patches[k], duration);
  });
}

template <int D>
void HostPart<D>::add_work_of_dashpots(std::uint32_t p) {
  const Patch<D>& patch = domain_.grid.patches[p];
  const NodeBlock<D> block = domain_.grid.block(p);
  double own[BlockShape<D>::nodes_max];
  own_nodes(domain_.grid, patch, own);
  const Work work = work_of_dashpots(block, own, domain_.time_step);
  PatchSums<D>& sums = domain_.sums[p];
  sums.dashpot_first = work.first;
  sums.dashpot_second = work.second;
  sums.force_work -= work.first;
  add_dashpots(domain_.grid, patch, block, own, domain_.time_step,
               reaction_of(domain_, p, &AngularImpulses::walls));
}

/// As in advance_nodes.
template <int D>
void HostPart<D>::add_works() {
  const bool absorb = domain_.grid.walls.absorb();
  domain_.threads.for_each(wanted_.patches.size(), [&](std::size_t k) {
    const std::uint32_t p = wanted_.patches[k];
    if (absorb && domain_.grid.patches[p].at_wall) add_work_of_dashpots(p);
    if (!is_loaded(domain_, domain_.grid.patches[p])) return;
    Work work;
    if (domain_.has_loads()) work = work_of_loads(domain_, p);
    if (domain_.has_body_forces()) work += work_of_body_force(domain_, p);
    PatchSums<D>& sums = domain_.sums[p];
    sums.load_first = work.first;
    sums.load_second = work.second;
    sums.force_work -= work.first;
  });
}

template <int D>
bool HostPart<D>::wants(NodeMoment moment) const {
  switch (moment) {
    case NodeMoment::mapped:
    case NodeMoment::advanced:
      return has_loads(domain_) || domain_.grid.walls.absorb();
    case NodeMoment::released:
    case NodeMoment::restored:
      return releases_;
    default:
      return true;
  }
}

template <int D>
void HostPart<D>::make_stages(NodeMoment moment) {
  switch (moment) {
    case NodeMoment::velocities:
      make_velocities();
      carry<velocity_at>(domain_.step_before);
      return;
    case NodeMoment::mapped:
      of_rigid(map_forces);
      take(loaded_, run_.read_mapped(), second);
      load_surfaces(domain_);
      add_body_forces(domain_);
      start_dashpots();
      give(loaded_, run_.mapped_of_host(), second);
      run_.write_mapped();
      return;
    case NodeMoment::velocities_and_forces:
      make_velocities();
      make_forces();
      return;
    case NodeMoment::forces:
      make_forces();
      return;
    case NodeMoment::advanced:
      read(first);
      read(second);
      add_works();
      return;
    case NodeMoment::released:
      read(first);
      read(second);
      release_from_contact(domain_);
      write(first);
      advance_rigid();
      return;
    case NodeMoment::restored:
      restore_contact(domain_);
      write(first);
      return;
    case NodeMoment::remapped:
      of_rigid(remap_rigid_bodies);
      of_rigid(fold_remapped);
      of_rigid(exchange_remapped);
      of_rigid(find_remapped);
      read(second);
      contact_remapped(domain_);
      write(second);
      carry<remapped_at>(domain_.time_step);
  }
}

template <int D>
void HostPart<D>::end_step() {
  add_seconds(seconds_.stages, [&] {
    of_rigid(move_rigid_bodies);
    record_contacts(domain_);
  });
}

template void update_lists<2>(Domain<2>&);
template void update_lists<3>(Domain<3>&);
template class HostPart<2>;
template class HostPart<3>;

}  // namespace mpm
