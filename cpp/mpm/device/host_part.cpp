#include "mpm/device/host_part.hpp"

#include <limits>
#include <utility>

#include "mpm/contact/respond.hpp"
#include "mpm/loads/body_forces.hpp"
#include "mpm/loads/carry_loads.hpp"
#include "mpm/step/stages.hpp"
#include "mpm/walls/absorb.hpp"
#include "mpm/walls/mirror.hpp"
#include "mpm/walls/reactions.hpp"

namespace mpm {

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
void HostPart<D>::begin_step() {
  std::vector<std::uint32_t>& rigid = domain_.grid.partition.edge;
  rigid.clear();
  for (std::uint32_t p = 0; p < domain_.grid.patches.size(); ++p)
    if (!is_on_device(domain_.body_of(domain_.grid.patches[p]))) rigid.push_back(p);
  nodes_.choose();
  of_rigid(map_momentum);
  of_rigid(fold_momentum);
  of_rigid(exchange_momentum);
  of_rigid(find_velocities);
}

/// The factors of the dashpots, before exchange_forces sums them.
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
  nodes_.read(first_half);
  contact_momentum(domain_);
  if (changes_velocities(domain_.contact_settings)) nodes_.write(first_half);
}

template <int D>
void HostPart<D>::make_forces() {
  if (!wants(NodeMoment::mapped)) of_rigid(map_forces);
  of_rigid(fold_forces);
  if (domain_.has_rigid() || domain_.has_prescribed() || domain_.grid.walls.absorb())
    exchange_forces(domain_);
  nodes_.read(second_half);
  absorb_at_walls(domain_);
  contact_forces(domain_);
  nodes_.write(second_half);
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
  domain_.threads.for_each(nodes_.loaded().size(), [&](std::size_t k) {
    carry_loads<at>(domain_, nodes_.loaded()[k], duration);
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
  domain_.threads.for_each(nodes_.wanted().size(), [&](std::size_t k) {
    const std::uint32_t p = nodes_.wanted()[k];
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
void HostPart<D>::with_nodes(NodeMoment moment) {
  if (!begun_) add_seconds(seconds_.lists, [&] { update_lists(domain_); });
  nodes_.wait();  // for the device, which is not the host's time
  add_seconds(seconds_.stages, [&] {
    if (!begun_) begin_step();
    begun_ = true;
    make_stages(moment);
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
      nodes_.read_mapped();
      load_surfaces(domain_);
      add_body_forces(domain_);
      start_dashpots();
      nodes_.write_mapped();
      return;
    case NodeMoment::velocities_and_forces:
      make_velocities();
      make_forces();
      return;
    case NodeMoment::forces:
      make_forces();
      return;
    case NodeMoment::advanced:
      nodes_.read(first_half);
      nodes_.read(second_half);
      add_works();
      return;
    case NodeMoment::released:
      nodes_.read(first_half);
      nodes_.read(second_half);
      release_from_contact(domain_);
      nodes_.write(first_half);
      advance_rigid();
      return;
    case NodeMoment::restored:
      restore_contact(domain_);
      nodes_.write(first_half);
      return;
    case NodeMoment::remapped:
      of_rigid(remap_rigid_bodies);
      of_rigid(fold_remapped);
      of_rigid(exchange_remapped);
      of_rigid(find_remapped);
      nodes_.read(second_half);
      contact_remapped(domain_);
      if (changes_velocities(domain_.contact_settings)) nodes_.write(second_half);
      carry<remapped_at>(domain_.time_step);
  }
}

template <int D>
void leave_sums(Domain<D>& domain, const std::vector<std::uint32_t>& patches) {
  std::vector<PatchSums<D>> sums;
  std::vector<FaceImpulses<D>> faces;
  domain.sums_of.clear();
  for (const std::uint32_t p : patches) {
    sums.push_back(domain.sums[p]);
    domain.sums_of.push_back(domain.grid.patches[p].body);
    if (domain.grid.walls.exist) faces.push_back(domain.face_parts[p]);
  }
  domain.sums = std::move(sums);
  domain.face_parts = std::move(faces);
}

template <int D>
void HostPart<D>::end_step() {
  add_seconds(seconds_.stages, [&] {
    of_rigid(move_rigid_bodies);
    record_contacts(domain_);
  });
  std::vector<std::uint32_t> own = domain_.grid.partition.edge;  // of bodies that do not deform
  if (wants(NodeMoment::advanced))
    own.insert(own.end(), nodes_.wanted().begin(), nodes_.wanted().end());
  leave_sums(domain_, own);
}

template void leave_sums<2>(Domain<2>&, const std::vector<std::uint32_t>&);
template void leave_sums<3>(Domain<3>&, const std::vector<std::uint32_t>&);
template void update_lists<2>(Domain<2>&);
template void update_lists<3>(Domain<3>&);
template class HostPart<2>;
template class HostPart<3>;

}  // namespace mpm
