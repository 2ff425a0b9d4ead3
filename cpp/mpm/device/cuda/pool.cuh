#pragma once
// The particles of one material on the device.
#include <cstddef>
#include <vector>

#include "mpm/device/cuda/book_kernels.cuh"
#include "mpm/device/cuda/memory.cuh"
#include "mpm/device/cuda/stress.cuh"

namespace mpm {

/// The columns of one material on the device, each in memory of its own, so that putting one in
/// order is to write it anew.
template <int D>
struct PoolOnDevice {
  const Material* material = nullptr;
  MaterialColumns at{};
  int position = 0, affine = -1;
  std::size_t rows = 0, in_lists = 0;
  std::vector<DeviceArray<double>> columns;  // empty where one is of the material's state
  DeviceArray<double> state;                 // the others, `rows` from one to the next
  std::vector<std::ptrdiff_t> place;         // of each column among these; -1: it is none of them
  DeviceArray<std::uint32_t> id, home;       // home: the host's row of each
  double share, grid_share;                  // of the step (DeviceStep)

  double* column(int c) {
    if (c < 0) return nullptr;
    const auto k = static_cast<std::size_t>(c);
    return place[k] < 0 ? columns[k].data()
                        : state.data() + static_cast<std::size_t>(place[k]) * rows;
  }
  /// Is a column one of its own, and not of the state of the material, whose columns follow each
  /// other?
  bool is_own(int c) const {
    const auto within = [&](int first, int count) {
      return first >= 0 && c >= first && c < first + count;
    };
    return within(position, D) || within(at.velocity, D) || within(at.mass, 1) ||
           within(at.volume, 1) || within(at.stress, Sym<double, D>::size) || within(affine, D * D);
  }
};

template <int D>
PoolOnDevice<D> take_pool(const DevicePool& pool) {
  PoolOnDevice<D> mine;
  mine.material = pool.material;
  mine.at = pool.at;
  mine.position = pool.position;
  mine.affine = pool.affine;
  mine.rows = pool.is_there ? pool.columns->rows() : 0;
  const int count = pool.columns->component_count();
  std::ptrdiff_t others = 0;
  for (int c = 0; c < count; ++c) mine.place.push_back(mine.is_own(c) ? -1 : others++);
  mine.state.allocate(static_cast<std::size_t>(others) * mine.rows);
  mine.columns.resize(static_cast<std::size_t>(count));
  for (int c = 0; c < count; ++c) {
    if (mine.is_own(c)) mine.columns[static_cast<std::size_t>(c)].allocate(mine.rows);
    pool.columns->with_component(c, [&]<class Number>(const Number* from) {
      static_assert(std::is_same_v<Number, double>, "floats have no device");
      check_cuda(
          cudaMemcpy(mine.column(c), from, mine.rows * sizeof(double), cudaMemcpyHostToDevice),
          "taking particles");
    });
  }
  mine.id.allocate(mine.rows);
  mine.id.take(pool.id, mine.rows);
  mine.home.allocate(mine.rows);
  launch(count_up, blocks_of(mine.rows), 256, mine.home.data(), mine.rows);
  return mine;
}

/// What kernels see of it; the shares are those of the step.
template <int D>
ParticleView<D> view_of(PoolOnDevice<D>& pool, double cell_size) {
  ParticleView<D> view{};
  for (int a = 0; a < D; ++a) {
    view.x[a] = pool.column(pool.position + a);
    view.v[a] = pool.column(pool.at.velocity + a);
  }
  view.mass = pool.column(pool.at.mass);
  view.volume = pool.column(pool.at.volume);
  for (int c = 0; c < ParticleView<D>::parts; ++c) {
    view.stress[c] = pool.column(pool.at.stress + c);
    view.damping[c] =
        pool.at.damping_stress < 0 ? nullptr : pool.column(pool.at.damping_stress + c);
  }
  for (int k = 0; k < D * D; ++k)
    view.affine[k] = pool.affine < 0 ? nullptr : pool.column(pool.affine + k);
  view.q = pool.column(pool.at.force_pressure >= 0 ? pool.at.force_pressure
                                                   : pool.at.viscosity_pressure);
  view.failed = pool.column(pool.at.failed);
  view.id = pool.id.data();
  view.cell_size = cell_size;
  view.share = pool.share;
  view.grid_share = pool.grid_share;
  return view;
}

/// What the material works on.
template <int D>
BlockColumns<D> block_columns(PoolOnDevice<D>& pool) {
  BlockColumns<D> columns;
  columns.stride = pool.rows;
  columns.mass = pool.column(pool.at.mass);
  columns.volume = pool.column(pool.at.volume);
  for (int a = 0; a < D; ++a) columns.velocity[a] = pool.column(pool.at.velocity + a);
  for (int c = 0; c < BlockColumns<D>::parts; ++c) {
    columns.stress[c] = pool.column(pool.at.stress + c);
    if (pool.at.damping_stress >= 0)
      columns.damping_stress[c] = pool.column(pool.at.damping_stress + c);
  }
  columns.energy = pool.column(pool.at.energy);
  columns.recoverable = pool.column(pool.at.recoverable);
  columns.viscosity_pressure = pool.column(pool.at.viscosity_pressure);
  columns.failed = pool.column(pool.at.failed);
  columns.state = pool.column(pool.at.state);
  columns.failure_state = pool.column(pool.at.failure_state);
  return columns;
}

/// Entries of a body that follow one another in the lists.
struct EntryRange {
  std::size_t first, count;
};

/// Rows that are not among the first `listed` behind them; seldom, so by the host. Returns how many
/// there are then.
inline std::size_t add_unlisted(std::size_t count, std::size_t listed, std::uint32_t* rows) {
  std::vector<std::uint32_t> of_host(count);
  check_cuda(
      cudaMemcpy(of_host.data(), rows, listed * sizeof(std::uint32_t), cudaMemcpyDeviceToHost),
      "sorting columns");
  std::vector<bool> is_listed(count, false);
  for (std::size_t k = 0; k < listed; ++k) is_listed[of_host[k]] = true;
  std::size_t next = listed;
  for (std::size_t row = 0; row < count; ++row)
    if (!is_listed[row]) of_host[next++] = static_cast<std::uint32_t>(row);
  check_cuda(cudaMemcpy(rows + listed, of_host.data() + listed,
                        (count - listed) * sizeof(std::uint32_t), cudaMemcpyHostToDevice),
             "sorting columns");
  return next;
}

/// The rows of all its columns in the order of its bodies' entries, which are numbered anew; behind
/// them those of particles that are in no list. `spare`: a column; `rows`: room for a number of
/// each.
template <int D>
void sort_pool(PoolOnDevice<D>& pool, const std::vector<EntryRange>& bodies, std::uint32_t* order,
               std::uint32_t* rows, DeviceArray<double>& spare) {
  std::size_t next = 0;
  for (const EntryRange& body : bodies) {
    check_cuda(cudaMemcpyAsync(rows + next, order + body.first, body.count * sizeof(std::uint32_t),
                               cudaMemcpyDeviceToDevice),
               "sorting columns");
    next += body.count;
  }
  const std::size_t listed = next;
  if (listed < pool.rows) next = add_unlisted(pool.rows, listed, rows);
  for (std::size_t c = 0; c < pool.columns.size(); ++c) {
    double* const column = pool.column(static_cast<int>(c));
    launch(take_rows<double>, blocks_of(next), 256, column, rows, next, spare.data());
    if (pool.place[c] < 0 && spare.size() == pool.columns[c].size())
      pool.columns[c].swap(spare);
    else
      check_cuda(
          cudaMemcpyAsync(column, spare.data(), next * sizeof(double), cudaMemcpyDeviceToDevice),
          "sorting columns");
  }
  for (DeviceArray<std::uint32_t>* numbers : {&pool.id, &pool.home}) {
    auto* const to = reinterpret_cast<std::uint32_t*>(spare.data());
    launch(take_rows<std::uint32_t>, blocks_of(next), 256, numbers->data(), rows, next, to);
    check_cuda(cudaMemcpyAsync(numbers->data(), to, next * sizeof(std::uint32_t),
                               cudaMemcpyDeviceToDevice),
               "sorting columns");
  }
  launch(count_up, blocks_of(next), 256, rows, next);
  next = 0;
  for (const EntryRange& body : bodies) {
    check_cuda(cudaMemcpyAsync(order + body.first, rows + next, body.count * sizeof(std::uint32_t),
                               cudaMemcpyDeviceToDevice),
               "sorting columns");
    next += body.count;
  }
  check_cuda(cudaGetLastError(), "sorting columns");
}

}  // namespace mpm
