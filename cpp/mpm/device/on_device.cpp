#include "mpm/device/on_device.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "mpm/device/library.hpp"
#include "mpm/step/fixed_walls.hpp"

namespace mpm {
namespace {

/// The transfer of the step, as a device names it, and the number that it is made with.
template <int D>
std::pair<DeviceTransfer, double> transfer_of(const Domain<D>& domain, TransferShare of) {
  std::pair<DeviceTransfer, double> found{DeviceTransfer::flip, 1.0};
  with_transfer(domain, of, [&](const auto& of_run) {
    const auto transfer = taken_by(of_run);
    using T = std::remove_const_t<decltype(transfer)>;
    if constexpr (std::is_same_v<T, FlipPic>) found = {DeviceTransfer::flip_pic, transfer.pic};
    if constexpr (std::is_same_v<T, Aflip>) found = {DeviceTransfer::aflip, transfer.alpha};
  });
  return found;
}

/// Sums of a device's report, of one body, as those of a patch are.
template <int D>
void take_sums(const double* sums, double fastest, const Vec<double, D>& gravity, double dt,
               PatchSums<D>& to, FaceImpulses<D>& faces) {
  using S = DeviceSum;
  const auto vector = [&](int at) { return Vector3{sums[at], sums[at + 1], sums[at + 2]}; };
  to.force_work += dt * sums[S::work];  // beside that of loads
  to.gravity_first = dt * sums[S::gravity_first];
  to.gravity_second = 0.5 * dt * sums[S::gravity_second];
  to.angular.gravity = dt * cross(vector(S::mass_moment), in_space<D>(gravity));
  to.damping_first = sums[S::damping_first];
  to.damping_second = sums[S::damping_second];
  to.angular.damping = dt * vector(S::damping_moment);
  to.angular.walls += vector(S::walls);  // beside that of dashpots
  to.angular.mapped = vector(S::mapped);
  to.kinetic = sums[S::kinetic];
  to.second_order = sums[S::second_order];
  to.transferred = sums[S::transferred];
  to.carried = sums[S::carried];
  for (int a = 0; a < D; ++a) to.momentum[a] = sums[S::momentum + a];
  to.stress.internal = sums[S::internal];
  to.stress.plastic = sums[S::plastic];
  to.stress.viscous = sums[S::viscous];
  to.stress.damped = sums[S::damped];
  to.stress.bounded = sums[S::bounded];
  to.stress.energy_floor = sums[S::energy_floor];
  to.stress.fracture = sums[S::fracture];
  to.stress.force_power = sums[S::force_power];
  to.stress.fastest = fastest;
  for (int axis = 0; axis < D; ++axis)
    for (int side = 0; side < 2; ++side)
      for (int a = 0; a < D; ++a)
        faces.of[axis][side][a] += sums[S::faces + 3 * (2 * axis + side) + a];
}

}  // namespace

DeviceInfo device_info() {
  DeviceInfo info;
  std::string why;
  device_library().info(info, why);
  if (info.name.empty()) throw std::runtime_error("no device can be used: " + why);
  return info;
}

template <int D>
std::string not_on_device(const Domain<D>& domain, Scheme scheme) {
  if (sizeof(Storage) != sizeof(double)) return "a build with floats";
  if (!domain.grid.partition.alone()) return "several ranks";
  if (scheme == Scheme::usl) return "run.scheme = \"usl\"";
  if (filters(domain.transfer)) return "run.transfer = \"xpic\"";
  if (domain.grid.bonded) return "bonded bodies";
  if (has_kept_nodes(domain)) return "bodies with frame = \"material\"";
  if (domain.averages_volume()) return "volume averaging";
  if (std::ranges::any_of(domain.pools,
                          [](const ParticlePool<D>& pool) { return pool.at.growth_limit >= 0; }))
    return "gases and liquids with an affine transfer (take run.transfer = \"flip\")";
  if (domain.settles()) return "a run that settles";
  if (domain.grid.has_wall_springs) return "walls of the box that touch (\"contact\")";
  if (std::ranges::none_of(domain.grid.patches, [&](const Patch<D>& patch) {
        return patch.count > 0 && is_on_device(domain.body_of(patch));
      }))
    return "runs in which nothing deforms";
  return {};
}

namespace {

/// Let the host have columns of a pool's particles, of those that the device has.
template <int D>
void read_columns(OnDevice<D>& device, Domain<D>& domain, std::size_t m, int first, int count) {
  ParticlePool<D>& pool = domain.pools[m];
  const auto here = [&](const Body<D>& body) {
    return static_cast<std::size_t>(body.material) == m && !is_on_device(body);
  };
  // Those that have been taken out stay as the host has noted them.
  const bool all = pool.removed.empty() && std::ranges::none_of(domain.bodies, here);
  for (int c = first; c < first + count; ++c) {
    const double* const from = device.run->read_column(m, c);
    pool.columns.with_component(c, [&]<class Number>(Number* to) {
      const auto copy = [&](std::size_t row) { to[row] = static_cast<Number>(from[row]); };
      if (all) {
        constexpr std::size_t chunk = 4096;
        const std::size_t rows = pool.count();
        domain.threads.for_each((rows + chunk - 1) / chunk, [&](std::size_t k) {
          for (std::size_t row = k * chunk; row < std::min(rows, (k + 1) * chunk); ++row) copy(row);
        });
        return;
      }
      domain.threads.for_each(domain.grid.patches.size(), [&](std::size_t p) {
        const Patch<D>& patch = domain.grid.patches[p];
        const Body<D>& body = domain.body_of(patch);
        if (static_cast<std::size_t>(body.material) != m || !is_on_device(body)) return;
        for (const std::uint32_t row : pool.rows(patch)) copy(row);
      });
    });
  }
}

/// What the host's part looks at: positions and volumes.
template <int D>
void read_places(OnDevice<D>& device, Domain<D>& domain) {
  for (std::size_t m = 0; m < domain.pools.size(); ++m) {
    if (!device.has_pool[m]) continue;
    read_columns(device, domain, m, domain.pools[m].position, D);
    read_columns(device, domain, m, domain.pools[m].at.volume, 1);
  }
}

}  // namespace

template <int D>
std::unique_ptr<OnDevice<D>> start_on_device(Domain<D>& domain, Scheme scheme) {
  const std::string missing = not_on_device(domain, scheme);
  if (!missing.empty())
    throw std::invalid_argument("steps on a device do not know " + missing +
                                " yet: run without one");
  device_info();
  auto device = std::make_unique<OnDevice<D>>();
  device->stress_first = scheme == Scheme::usf;
  // What has eroded in the last step is taken out before the device is given the rest.
  update_lists(domain);
  DeviceProblem<D> problem;
  problem.grid = domain.grid;
  problem.outflow_box = domain.grid.outflow_box;
  problem.stress_first = device->stress_first;
  problem.disorder = domain.disorder;
  std::vector<std::vector<std::uint32_t>> body_of(domain.pools.size());
  for (std::size_t m = 0; m < domain.pools.size(); ++m)
    body_of[m].assign(domain.pools[m].count(), DevicePool::no_body);
  for (const Patch<D>& patch : domain.grid.patches)
    if (is_on_device(domain.body_of(patch)))
      for (const std::uint32_t row : domain.pool_of(patch).rows(patch))
        body_of[pool_number(domain.bodies, patch.body)][row] =
            static_cast<std::uint32_t>(patch.body);
  device->has_pool.assign(domain.pools.size(), false);
  for (const Body<D>& body : domain.bodies)
    if (is_on_device(body)) device->has_pool[static_cast<std::size_t>(body.material)] = true;
  for (std::size_t m = 0; m < domain.pools.size(); ++m) {
    ParticlePool<D>& pool = domain.pools[m];
    problem.pools.push_back({&domain.materials[m], &pool.columns, pool.at, pool.position,
                             pool.affine, pool.id.data(), body_of[m].data(), device->has_pool[m]});
  }
  for (const Body<D>& body : domain.bodies)
    problem.bodies.push_back({body.material, body.mean_edge / domain.grid.cell_size});
  device->run = make_device_run(problem);
  if (HostPart<D>::needed(domain))
    // Springs leave the velocities as they are, and so do not keep them from particles.
    device->host = std::make_unique<HostPart<D>>(
        *device->run, domain, device->seconds,
        domain.has_contact() && domain.contact_settings.response != Response::springs &&
            takes_of_grid(domain));
  return device;
}

template <int D>
void step_on_device(OnDevice<D>& device, Domain<D>& domain, bool look) {
  DeviceStep<D> step;
  step.time_step = domain.time_step;
  step.strain_time = domain.step_before;
  // As in the step's settings on the host (step/update_stress.cpp).
  step.time_after = domain.time + domain.time_step;
  step.gravity = domain.gravity;
  step.takes_of_grid = takes_of_grid(domain);
  step.look = look;
  if (!domain.dampings.empty())
    for (const Body<D>& body : domain.bodies)
      step.damping.push_back(damping_in(domain.dampings, body.damping));
  for (const ParticlePool<D>& pool : domain.pools) {
    const TransferShare of = share_of(domain, pool);
    const auto [transfer, share] = transfer_of(domain, of);
    step.transfer = transfer;
    step.share.push_back(share);
    step.grid_share.push_back(grid_share(domain, of));
  }
  HostSeconds& seconds = device.seconds;
  add_seconds(seconds.particles, [&] {
    if (device.gone)
      fetch_from_device(device, domain);
    else if (device.host && device.ahead)
      read_places(device, domain);
  });
  if (device.host)
    device.host->expect_step();
  else if (device.gone)
    add_seconds(seconds.lists, [&] { update_lists(domain); });
  device.run->step(step, device.host.get(), device.report);
  device.ahead = true;
  device.gone = device.report.gone;
  if (device.host)
    device.host->end_step();
  else
    leave_sums(domain, {});
  for (std::size_t b = 0; b < domain.bodies.size(); ++b) {
    if (!is_on_device(domain.bodies[b])) continue;
    domain.sums_of.push_back(static_cast<int>(b));
    FaceImpulses<D> none,
        &faces = domain.grid.walls.exist ? domain.face_parts.emplace_back() : none;
    take_sums(device.report.sums.data() + b * DeviceSum::count, device.report.fastest[b],
              domain.gravity, domain.time_step, domain.sums.emplace_back(), faces);
  }
  if (device.report.negative_volume) domain.sums[0].stress.negative_volume = true;
  if (device.stress_first)
    Stages<D>::template sum_energies<true>.run(domain);
  else
    Stages<D>::template sum_energies<false>.run(domain);
}

template <int D>
void fetch_from_device(OnDevice<D>& device, Domain<D>& domain) {
  if (!device.ahead) return;
  for (std::size_t m = 0; m < domain.pools.size(); ++m) {
    if (!device.has_pool[m]) continue;
    const ParticlePool<D>& pool = domain.pools[m];
    const int all = pool.columns.component_count(), of_host = pool.body_force;
    // A body force is evaluated by the host.
    read_columns(device, domain, m, 0, of_host < 0 ? all : of_host);
    if (of_host >= 0) read_columns(device, domain, m, of_host + D, all - of_host - D);
  }
  // The lists are made again from where the particles are, if the host makes a step.
  for (Patch<D>& patch : domain.grid.patches) patch.left_cell = true;
  device.ahead = false;
}

template std::string not_on_device<2>(const Domain<2>&, Scheme);
template std::string not_on_device<3>(const Domain<3>&, Scheme);
template std::unique_ptr<OnDevice<2>> start_on_device<2>(Domain<2>&, Scheme);
template std::unique_ptr<OnDevice<3>> start_on_device<3>(Domain<3>&, Scheme);
template void step_on_device<2>(OnDevice<2>&, Domain<2>&, bool);
template void step_on_device<3>(OnDevice<3>&, Domain<3>&, bool);
template void fetch_from_device<2>(OnDevice<2>&, Domain<2>&);
template void fetch_from_device<3>(OnDevice<3>&, Domain<3>&);

}  // namespace mpm
