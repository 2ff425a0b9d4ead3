#pragma once
// Which schedule a basis has.
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
