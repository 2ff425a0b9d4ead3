#include "mpm/contact/record.hpp"
#include "mpm/step/stage_functions.hpp"
#include "mpm/step/transfer/transfer.hpp"

namespace mpm {

template <int D>
void record_contacts(Domain<D>& domain) {
  // Zero without contact, as the ledger adds them all the same.
  domain.contact_sums = {};
  if (domain.has_contact())
    domain.contact_sums =
        record_pairs(domain.contact, domain.grid, domain.bodies,
                     {domain.time_after, domain.time_step, domain.step + 1}, domain.threads);
}

namespace {

/// The work of the stress in each group's patches.
template <int D>
void add_part_energies(Domain<D>& domain) {
  for (std::size_t p = 0; p < domain.sums.size(); ++p) {
    const StressSums& stress = domain.sums[p].stress;
    domain.part_energies[domain.group_of[body_of_sums(domain, p)]].add(
        {stress.internal - stress.fracture + domain.sums[p].returned, stress.plastic,
         stress.viscous});
  }
}

/// The impulses of the box's faces in the step, and so far; of rigid bodies, which all ranks know,
/// by the first.
template <int D>
void add_faces(Domain<D>& domain, bool is_first) {
  if (!domain.grid.walls.exist) return;
  domain.faces_in_step = {};
  const auto add = [&](FaceImpulses<D>& part) {
    std::size_t k = 0;
    part.for_each([&](double x) {
      if (x != 0.0) {
        domain.faces_in_step[k].add(x);
        domain.faces[k].add(x);
      }
      ++k;
    });
  };
  for (FaceImpulses<D>& part : domain.face_parts) add(part);
  if (is_first) add(domain.rigid_at_faces);
}

}  // namespace

template <int D, bool forces_follow>
void sum_energies(Domain<D>& domain) {
  // All sums over patches at once, exactly: no order of patches matters (decision 0038).
  Comm& comm = *domain.grid.partition.comm;
  RemovedTotal eroded, outflow;
  if (may_remove(domain.grid, domain.pools)) {
    eroded = total_of(domain.eroded, comm);
    outflow = total_of(domain.outflow, comm);
  }
  domain.ledger.add(domain.sums, domain.contact_sums,
                    {domain.surfaces.stored_push, domain.surfaces.stored_rub}, eroded, outflow,
                    forces_follow, is_affine(domain.transfer), comm);
  domain.ledger.angular.impulses.walls += domain.rigid_at_walls;
  add_part_energies(domain);
  add_faces(domain, comm.rank() == 0);
}

template void record_contacts<2>(Domain<2>&);
template void record_contacts<3>(Domain<3>&);
template void sum_energies<2, false>(Domain<2>&);
template void sum_energies<2, true>(Domain<2>&);
template void sum_energies<3, false>(Domain<3>&);
template void sum_energies<3, true>(Domain<3>&);

}  // namespace mpm
