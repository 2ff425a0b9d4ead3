#pragma once
// What passes between particles and nodes: the transfers, one line in all, and the internal force.
#include <algorithm>

#include "mpm/domain.hpp"
#include "mpm/step/transfer/flip_pic.hpp"

namespace mpm {

/// What is mapped from particles to nodes, for a schedule: momentum as the transfer says, and the
/// internal force.
template <class Transfer>
struct Mapping {
  template <class P, class N, class Node>
  MPM_INLINE static void give_momentum(const P& p, const N& N_ip, Node& node) {
    Transfer::give(p, N_ip, node);
  }
  /// f_i -= V_p sigma_p . grad N_ip, eq. (9); p.traction is -V_p (sigma_p - q_p 1), with the
  /// artificial viscosity's pressure q.
  template <class P, class G, class Node>
  MPM_INLINE static void give_force(const P& p, const G& grad_N_ip, Node& node) {
    node.f += p.traction * grad_N_ip;
  }
};

/// f(transfer) for that of the run.
template <int D, class F>
void with_transfer(const Domain<D>& domain, F&& f) {
  const double share = std::min(domain.pic_damping * domain.time_step, 1.0);
  if (share > 0.0)
    f(FlipPic(share));
  else
    f(Flip());
}

}  // namespace mpm
