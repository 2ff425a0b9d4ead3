#pragma once
#include "mpm/math/unrolled.hpp"

namespace mpm {

/// What is mapped from particles to nodes, for a schedule: momentum as the transfer says, and the
/// internal force.
template <class Transfer>
struct Mapping {
  template <class P, class N, class Node>
  MPM_HD MPM_INLINE static void give_momentum(const P& p, const N& N_ip, Node& node) {
    Transfer::give(p, N_ip, node);
  }
  /// With first moments, for an affine part.
  template <class P, class N, class M, class Node>
  MPM_HD MPM_INLINE static void give_momentum(const P& p, const N& N_ip, const M& M_ip,
                                              Node& node) {
    Transfer::give(p, N_ip, M_ip, node);
  }
  /// f_i -= V_p sigma_p . grad N_ip, eq. (9); p.traction is -V_p (sigma_p - q_p 1), with the
  /// artificial viscosity's pressure q.
  template <class P, class G, class Node>
  MPM_HD MPM_INLINE static void give_force(const P& p, const G& grad_N_ip, Node& node) {
    node.f += p.traction * grad_N_ip;
  }
};

}  // namespace mpm
