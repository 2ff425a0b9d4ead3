#include "mpm/loads/body_forces.hpp"

#include <limits>

#include "mpm/schedule/cell_loop.hpp"
#include "mpm/step/kept_nodes.hpp"
#include "mpm/step/patch_loops.hpp"
#include "mpm/step/stage_functions.hpp"

namespace mpm {
namespace {

/// f(row, node of the block, N_ip) for the particles of a patch, one by one: these forces are for
/// verification, where formulas cost more than nodes.
template <int D, class F>
void for_each_weight(const Domain<D>& domain, const Patch<D>& patch, F&& f) {
  const auto& grid = domain.grid;
  const ParticlePool<D>& pool = domain.pool_of(patch);
  with_basis(grid, domain.body_of(patch), [&]<BasisModel B>(const B& basis) {
    Index<D> low, high;  // nodes in reach, from the cell's own
    low.fill(-B::before);
    high.fill(B::nodes - 1 - B::before);
    for_each_cell(grid, pool, patch, [&](const CellRange<D>& cell) {
      for (std::uint32_t k = 0; k < cell.count; ++k) {
        const std::uint32_t row = cell.rows[k];
        AxisWeights<double, B::nodes> w[D];
        for (int a = 0; a < D; ++a)
          w[a] = basis.along(local_coordinate(grid.in_cells(pool.listed(a)[row], a),
                                              cell.cell[static_cast<std::size_t>(a)]));
        for_each_index<D>(low, high, [&](const Index<D>& i) {
          double N = 1.0;
          for (int a = 0; a < D; ++a) N *= w[a].N[i[static_cast<std::size_t>(a)] + B::before];
          f(row, cell.first_node + patch.shape.distance(i), N);
        });
      }
    });
  });
}

/// b_p of a patch's particles in the middle of the step, into their column.
template <int D>
void evaluate_force(const Domain<D>& domain, const BodyForce<D>& force, const Patch<D>& patch,
                    ParticlePool<D>& pool) {
  constexpr std::size_t lanes = Expression::lanes, start = 4, time = 7;  // of expression_variables
  static_assert(expression_variables[start] == "X" && expression_variables[time] == "t");
  Expression::Variables variables{};
  // The middle of the time in which it acts (time_of_forces).
  const double middle = patch.keeps ? 0.0 : 0.5 * domain.time_step;
  variables[time].fill(load_time(domain.time + middle));
  Expression::Lanes result;
  const auto rows = pool.rows(patch);
  for (std::size_t first = 0; first < rows.size(); first += lanes) {
    const auto some = rows.subspan(first, std::min(lanes, rows.size() - first));
    for (std::size_t k = 0; k < some.size(); ++k)
      for (std::size_t a = 0; a < D; ++a) {
        const int axis = static_cast<int>(a);
        variables[a][k] = pool.x(axis)[some[k]];
        if (pool.start_position >= 0)
          variables[start + a][k] = pool.columns.component(pool.start_position + axis)[some[k]];
      }
    for (std::size_t a = 0; a < D; ++a) {
      double* const b = pool.columns.component(pool.body_force + static_cast<int>(a));
      force.value[a].evaluate(variables, some.size(), result);
      for (std::size_t k = 0; k < some.size(); ++k) b[some[k]] = result[k];
    }
  }
}

/// Angular impulse of the body force on a patch's particles; what is not added is not counted. And
/// the sum of its sizes.
template <int D>
Vector3 angular_impulse(const Domain<D>& domain, const Patch<D>& patch, const ParticlePool<D>& pool,
                        double& applied) {
  Vector3 moment = Vector3::zero();
  for (const std::uint32_t row : pool.rows(patch)) {
    Vec<double, D> force;
    for (int a = 0; a < D; ++a) {
      const double b = pool.columns.component(pool.body_force + a)[row];
      const bool added = moves_within_cell(b, domain.time_step, domain.grid.cell_size);
      force[a] = added ? pool.mass()[row] * b : 0.0;
    }
    if (domain.settles()) applied += norm(force);
    moment += cross(in_space<D>(pool.position_of(row)), in_space<D>(force));
  }
  return time_of_forces(domain, patch) * moment;
}

}  // namespace

/// f_i += sum m_p b_p N_ip, beside eq. (9), with b_p at the particle in the middle of the step.
/// Onto the internal forces of the patch's own block, before these are folded and exchanged.
template <int D>
void add_body_forces(Domain<D>& domain) {
  if (!domain.has_body_forces()) return;
  for_each_patch(domain, deformable | in_body, [&](std::size_t p) {
    const Patch<D>& patch = domain.grid.patches[p];
    const int number = domain.body_of(patch).force;
    if (number < 0) return;
    ParticlePool<D>& pool = domain.pool_of(patch);
    const BodyForce<D>& body_force = domain.body_forces[static_cast<std::size_t>(number)];
    if (!body_force.given) evaluate_force(domain, body_force, patch, pool);
    domain.sums[p].angular.loads += angular_impulse(domain, patch, pool, domain.sums[p].applied);
    const NodeBlock<D> block = domain.grid.block(p);
    for_each_weight(domain, patch, [&](std::uint32_t row, int node, double N) {
      for (int a = 0; a < D; ++a) {
        const double b = pool.columns.component(pool.body_force + a)[row];
        // Else the run stops at the end of this step, with places that can be told (find_failure).
        if (moves_within_cell(b, domain.time_step, domain.grid.cell_size))
          block.force(a)[node] += pool.mass()[row] * b * N;
      }
    });
  });
}

template <int D>
Work work_of_body_force(Domain<D>& domain, std::size_t p) {
  const Patch<D>& patch = domain.grid.patches[p];
  if (domain.body_of(patch).force < 0) return {};
  const ParticlePool<D>& pool = domain.pool_of(patch);
  const NodeBlock<D> block = domain.grid.block(p);
  Work work;
  for_each_weight(domain, patch, [&](std::uint32_t row, int node, double N) {
    for (int a = 0; a < D; ++a) {
      // As of loads (work_of_loads): v - dv is the velocity before the step.
      const double b = pool.columns.component(pool.body_force + a)[row];
      // What has not been added does no work that could be told: so the run stops.
      const bool added = moves_within_cell(b, domain.time_step, domain.grid.cell_size);
      const double f = added ? pool.mass()[row] * b * N : std::numeric_limits<double>::quiet_NaN();
      const double dv = block.increment(a)[node];
      work.first += f * (block.velocity(a)[node] - dv);
      work.second += f * dv;
    }
  });
  return {domain.time_step * work.first, 0.5 * domain.time_step * work.second};
}

template void add_body_forces<2>(Domain<2>&);
template void add_body_forces<3>(Domain<3>&);
template Work work_of_body_force<2>(Domain<2>&, std::size_t);
template Work work_of_body_force<3>(Domain<3>&, std::size_t);

}  // namespace mpm
