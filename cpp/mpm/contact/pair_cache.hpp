#pragma once
// Normals and gaps that are kept from step to step (decision 0012), while the bodies of a pair have
// moved by less than ContactSettings::normal_refresh_distance. They are state of the run.
#include <cstdint>
#include <vector>

#include "mpm/comm/comm.hpp"
#include "mpm/contact/contact_part.hpp"
#include "mpm/contact/node_solver.hpp"
#include "mpm/contact/settings.hpp"
#include "mpm/particles/body.hpp"

namespace mpm {

struct PairCache {
  bool on = false;                            // ContactSettings::normal_refresh_distance > 0
  std::vector<double> displacement, fastest;  // way of each body so far [m], square of its speed
  std::vector<int> moving;                    // the bodies that have a speed
  double last_time_step = 0.0;                // [s]

  /// Of both bodies of a pair so far [m].
  template <int D>
  double displacement_of(std::span<const BodyAtNode<D>> sides, const ContactPair<D>& pair) const {
    return displacement[static_cast<std::size_t>(sides[pair.r].body)] +
           displacement[static_cast<std::size_t>(sides[pair.s].body)];
  }
  std::size_t bytes() const {
    return bytes_of(displacement) + bytes_of(fastest) + bytes_of(moving);
  }
};

template <int D>
struct Contact;
template <int D>
struct ContactTile;

/// Find all normals and gaps anew, as after a change of the cells.
template <int D>
void invalidate_pairs(Contact<D>& contact);

/// Add to the displacements what the fastest node of each body says.
void add_displacements(PairCache& cache, std::size_t bodies);
/// Note how fast the bodies are in the step that begins, on all ranks.
template <int D>
void note_speeds(Contact<D>& contact, double time_step, Comm& comm);

/// Take over what is cached of the pairs at a node, if it still holds; else false.
template <int D>
bool reuse_pairs(Contact<D>& contact, const std::vector<Body<D>>& bodies,
                 const ContactSettings& settings, double cell_size, const ContactTile<D>& tile,
                 ContactPart<D>& part, const ContactNode& node);
template <int D>
void store_pairs(const PairCache& cache, ContactPart<D>& part, const ContactNode& node);
/// Change the gaps that are cached by what the bodies do in this step.
template <int D>
void move_gaps(ContactPart<D>& part, const ContactNode& node, const NodeSolution<D>& solution,
               double time_step);

}  // namespace mpm
