#pragma once
// Which schedule a basis has. With two nodes along an axis a field is a polynomial of 2^D
// coefficients in a cell, and the 2^D nodes of a cell fill registers. With three, 3^D, neither is
// so: there nodes are summed over one by one as particles lie in the lanes (decision 0024), and
// what is given has the four numbers of half a record in the lanes (decision 0018).
#include <type_traits>

#include "mpm/schedule/multilinear_field.hpp"
#include "mpm/schedule/nodal_field.hpp"
#include "mpm/schedule/nodes_in_lanes.hpp"
#include "mpm/schedule/records_in_lanes.hpp"

namespace mpm {

/// From nodes to particles.
template <BasisModel B, int D>
using Field = std::conditional_t<B::nodes == 2, MultilinearField<D>, NodalField<D, B::nodes>>;

/// From particles to nodes.
template <BasisModel B, int D>
using Scatter = std::conditional_t<B::nodes == 2, NodesInLanes<D>, RecordsInLanes<D, B::nodes>>;

/// The fields around a cell; `own`: the records from its own node on.
template <BasisModel B, int D>
[[gnu::always_inline]] inline Field<B, D> field_of(const NodeRecords& own,
                                                   const NodeStrides<D>& stride) {
  return {own.from(stride.to_first(B::before)), stride};
}

}  // namespace mpm
