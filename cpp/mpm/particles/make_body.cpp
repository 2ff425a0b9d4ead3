#include "mpm/particles/make_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace mpm {
namespace {

template <int D>
void check_particles(const std::string& name, std::span<const double> positions,
                     std::span<const double> velocities, std::span<const double> volumes) {
  const std::size_t n = positions.size() / D;
  if (n == 0 || n * D != positions.size())
    throw std::invalid_argument(name + ": positions must be (n, D) with n > 0");
  if (velocities.size() != D && velocities.size() != n * D)
    throw std::invalid_argument(name + ": velocities must be (n, D) or (1, D)");
  if (volumes.size() != 1 && volumes.size() != n)
    throw std::invalid_argument(name + ": volumes must be (n,) or (1,)");
  check_finite(positions, name + ": positions");
  check_finite(velocities, name + ": velocities");
  check_finite(volumes, name + ": volumes");
  for (const double v : volumes)
    if (!(v > 0.0)) throw std::invalid_argument(name + ": volumes must be > 0");
}

template <int D>
void add_columns(ParticlePool<D>& pool, const Material& material, bool may_leave) {
  Columns& c = pool.columns;
  pool.position = c.add("position", "m", D);
  pool.at.velocity = c.add("velocity", "m/s", D, Precision::rounded);
  pool.at.mass = c.add("mass", "kg", 1);
  pool.at.volume = c.add("volume", "m^3", 1);
  pool.at.stress = c.add("stress", "Pa", Sym<double, D>::size, Precision::rounded);
  add_material_columns<D>(material, c, pool.at);
  if (!may_leave) return;  // what particles that leave the region need
  if (pool.at.recoverable < 0) pool.at.recoverable = c.add("recoverable_energy", "J/m^3", 1);
  if (pool.at.failed < 0) pool.at.failed = c.add("failed", "1", 1);
}

/// f(row, values) for so many particles of a body in a pool, from row `row` on; of `width` given
/// numbers each has its own, or all have the same.
template <class F>
void for_each_given(const std::vector<double>& given, std::size_t width, std::size_t row,
                    std::size_t count, F&& f) {
  const bool one = given.size() == width;
  for (std::size_t i = 0; i < count; ++i) f(row++, given.data() + (one ? 0 : i * width));
}

/// What all bodies give of one kind, from one member of GivenParticles, which is dropped when it
/// has been taken, so that memory does not hold it twice.
template <int D, class F>
void take(std::vector<Body<D>>& bodies, std::vector<Patch<D>>& patches,
          std::vector<double> GivenParticles::* member, std::size_t width, F&& f) {
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!bodies[b].given) continue;
    std::vector<double>& given = bodies[b].given.get()->*member;
    for_each_given(given, width, patches[b].begin, bodies[b].given->count(),
                   [&](std::size_t row, const double* values) { f(bodies[b], row, values); });
    given = std::vector<double>();  // not {}, which keeps the memory
  }
}

/// Where the particles of each body go, a patch each, and room for them.
template <int D>
void make_rows(std::vector<ParticlePool<D>>& pools, const std::vector<Body<D>>& bodies,
               std::vector<Patch<D>>& patches) {
  constexpr std::size_t most =
      3'000'000'000;  // 32 bits number the entries of the lists, which have some room
  std::vector<std::size_t> rows(pools.size(), 0);
  patches.resize(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    std::size_t& next = rows[static_cast<std::size_t>(bodies[b].material)];
    const std::size_t count = bodies[b].given ? bodies[b].given->count() : 0;
    if (count > most - next)
      throw std::length_error("bodies of one material have more than 3 billion particles");
    patches[b].body = static_cast<int>(b);
    patches[b].begin = static_cast<std::uint32_t>(next);
    patches[b].count = static_cast<std::uint32_t>(count);
    next += count;
  }
  for (std::size_t m = 0; m < pools.size(); ++m) {
    pools[m].columns.allocate(rows[m]);
    pools[m].id.resize(rows[m]);
    pools[m].order.resize(rows[m]);
    std::iota(pools[m].order.begin(), pools[m].order.end(), 0u);
  }
}

/// A body of so many particles with a volume together [m^3], of which none are given yet.
template <int D>
Body<D> empty_body(std::string name, const Material& material, const ParticlePool<D>& pool,
                   std::size_t count, double volume) {
  Body<D> body;
  body.name = std::move(name);
  body.count = count;
  if (material.moves_as_one()) body.kind = BodyKind::rigid;
  if (pool.reference >= 0) {
    body.kind = BodyKind::material;
    body.averages = material.averages_volume && !material.averages_once_it_flows;
  }
  body.matter = material.matter();
  const double speed = pool.sound_speed;
  body.total_mass = material.density * volume;
  body.stiffness =
      !body.deforms() ? std::numeric_limits<double>::infinity() : material.density * speed * speed;
  body.initial_density = material.density;
  body.pressure_impedance = material.density * speed;
  body.shear_impedance = std::sqrt(material.density * shear_modulus(material));
  body.mean_mass = material.density * volume / static_cast<double>(count);
  body.mean_edge = std::pow(volume / static_cast<double>(count), 1.0 / D);
  return body;
}

}  // namespace

void check_finite(std::span<const double> values, const std::string& what) {
  for (const double v : values)
    if (!std::isfinite(v)) throw std::invalid_argument(what + " must be finite numbers");
}

template <int D>
ParticlePool<D> make_pool(const Material& material, const TileGrid<D>& grid,
                          const TransferColumns& transfer) {
  ParticlePool<D> pool;
  pool.matter = material.matter();
  add_columns(pool, material, grid.outflow_box.exist);
  if (transfer.reference) {
    pool.reference = pool.columns.add("reference_position", "m", D);
    pool.deformation = pool.columns.add("deformation_gradient", "1", D * D);
    if (pool.at.failed >= 0) pool.opened = pool.columns.add("opened", "1", 1);
    const std::vector<ColumnInfo>& known = pool.columns.infos();
    const auto flowed = std::ranges::find(known, "plastic_strain", &ColumnInfo::name);
    if (flowed != known.end()) {
      pool.flowed = flowed->first;
      pool.flowed_before = pool.columns.add("flowed_before", "1", 1);
      pool.stretched_before = pool.columns.add("stretched_before", "1", 1);
    }
  }
  if (transfer.affine) {
    pool.affine = pool.columns.add("affine_velocity", "1/s", D * D, Precision::rounded);
    if (material.flows()) pool.at.growth_limit = pool.columns.add("growth_limit", "m^3", 1);
    if (pool.matter == Matter::gas) pool.at.heat_owed = pool.columns.add("heat_owed", "J", 1);
  }
  if (transfer.unseen)
    pool.unseen = pool.columns.add("unseen_velocity", "m/s", D, Precision::rounded);
  // One particle, to ask for the speed of its waves.
  pool.columns.allocate(1);
  for (int a = 0; a < D; ++a) pool.v(a)[0] = Storage{0.0};
  pool.mass()[0] = material.density;
  pool.volume()[0] = 1.0;
  start_material_columns<D>(material, pool.columns, pool.at);
  Material undamped = material;  // the speed of waves, not that which limits the time step
  undamped.damping = {};
  pool.sound_speed = sound_speed<D>(undamped, pool.columns, pool.at, 0, grid.cell_size);
  pool.columns.allocate(0);
  return pool;
}

template <int D>
Body<D> make_body(const std::string& name, const Material& material, const ParticlePool<D>& pool,
                  std::span<const double> positions, std::span<const double> velocities,
                  std::span<const double> volumes, std::optional<Share> share) {
  check_particles<D>(name, positions, velocities, volumes);
  const std::size_t n = positions.size() / D;
  double total = 0.0;
  for (std::size_t i = 0; i < n; ++i) total += volumes[volumes.size() == 1 ? 0 : i];
  Body<D> body = empty_body(name, material, pool, n, total);
  const Share own = share.value_or(Share(0, n));
  if (own.count() == 0) return body;
  body.given = std::make_unique<GivenParticles>(
      GivenParticles{own, own.of(positions, D), own.of(velocities, D), own.of(volumes, 1)});
  return body;
}

template <int D>
Body<D> make_slice(const std::string& name, const Material& material, const ParticlePool<D>& pool,
                   std::size_t count, Share share, std::span<const double> positions,
                   std::span<const double> velocities, double volume) {
  double total = 0.0;  // as make_body() adds it up
  for (std::size_t i = 0; i < count; ++i) total += volume;
  Body<D> body = empty_body(name, material, pool, count, total);
  if (share.count() == 0) return body;
  check_particles<D>(name, positions, velocities, std::span(&volume, 1));
  if (share.last > count || positions.size() != share.count() * D)
    throw std::invalid_argument(name + ": its particles are not those of the share");
  body.given =
      std::make_unique<GivenParticles>(GivenParticles{share,
                                                      {positions.begin(), positions.end()},
                                                      {velocities.begin(), velocities.end()},
                                                      {volume},
                                                      {}});
  return body;
}

template <int D>
void fill_pools(std::vector<ParticlePool<D>>& pools, const std::vector<Material>& materials,
                std::vector<Body<D>>& bodies, std::vector<Patch<D>>& patches) {
  const auto pool_of = [&](const Body<D>& body) -> ParticlePool<D>& {
    return pools[static_cast<std::size_t>(body.material)];
  };
  make_rows(pools, bodies, patches);
  take(bodies, patches, &GivenParticles::positions, D,
       [&](const Body<D>& body, std::size_t row, const double* given) {
         for (int a = 0; a < D; ++a) pool_of(body).x(a)[row] = given[a];
       });
  take(bodies, patches, &GivenParticles::velocities, D,
       [&](const Body<D>& body, std::size_t row, const double* given) {
         for (int a = 0; a < D; ++a) pool_of(body).v(a)[row] = static_cast<Storage>(given[a]);
       });
  take(bodies, patches, &GivenParticles::volumes, 1,
       [&](const Body<D>& body, std::size_t row, const double* given) {
         pool_of(body).volume()[row] = *given;
         pool_of(body).mass()[row] = body.initial_density * *given;
       });
  for (std::size_t m = 0; m < pools.size(); ++m)
    if (pools[m].count() > 0)
      start_material_columns<D>(materials[m], pools[m].columns, pools[m].at);
  for (ParticlePool<D>& pool : pools)
    for (int a = 0; a < (pool.start_position < 0 ? 0 : D); ++a)
      std::copy_n(pool.x(a), pool.count(), pool.columns.component(pool.start_position + a));
  for (ParticlePool<D>& pool : pools) {
    if (pool.reference < 0) continue;
    for (int a = 0; a < D; ++a)
      std::copy_n(pool.x(a), pool.count(), pool.columns.component(pool.reference + a));
    for (int k = 0; k < D * D; ++k)
      std::fill_n(pool.deformation_part(k), pool.count(), k / D == k % D ? 1.0 : 0.0);
  }
  for (ParticlePool<D>& pool : pools)
    for (int a = 0; a < (pool.unseen < 0 ? 0 : D); ++a)
      std::fill_n(pool.unseen_velocity(a), pool.count(), Storage{0.0});
  for (ParticlePool<D>& pool : pools) {
    if (pool.set_back >= 0) std::fill_n(pool.columns.component(pool.set_back), pool.count(), 0.0);
    if (pool.pressing.force < 0) continue;
    for (int k = pool.pressing.force; k <= pool.pressing.set_back; ++k)
      std::fill_n(pool.columns.component(k), pool.count(), 0.0);
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!bodies[b].given) continue;
    ParticlePool<D>& pool = pool_of(bodies[b]);
    const std::size_t first = patches[b].begin, count = bodies[b].given->count();
    for (std::size_t i = 0; i < count; ++i) pool.id[first + i] = bodies[b].given->number(i);
    for (const auto& [component, values] : bodies[b].given->states)
      pool.columns.with_component(component, [&]<class Number>(Number* to) {
        for (std::size_t i = 0; i < count; ++i) to[first + i] = static_cast<Number>(values[i]);
      });
    bodies[b].given.reset();
  }
  for (ParticlePool<D>& pool : pools)
    if (pool.flowed_before >= 0) {
      std::copy_n(pool.columns.component(pool.flowed), pool.count(),
                  pool.columns.component(pool.flowed_before));
      std::fill_n(pool.columns.component(pool.stretched_before), pool.count(), 1.0);
    }
}

template ParticlePool<2> make_pool<2>(const Material&, const TileGrid<2>&, const TransferColumns&);
template ParticlePool<3> make_pool<3>(const Material&, const TileGrid<3>&, const TransferColumns&);
template Body<2> make_body<2>(const std::string&, const Material&, const ParticlePool<2>&,
                              std::span<const double>, std::span<const double>,
                              std::span<const double>, std::optional<Share>);
template Body<2> make_slice<2>(const std::string&, const Material&, const ParticlePool<2>&,
                               std::size_t, Share, std::span<const double>, std::span<const double>,
                               double);
template Body<3> make_slice<3>(const std::string&, const Material&, const ParticlePool<3>&,
                               std::size_t, Share, std::span<const double>, std::span<const double>,
                               double);
template Body<3> make_body<3>(const std::string&, const Material&, const ParticlePool<3>&,
                              std::span<const double>, std::span<const double>,
                              std::span<const double>, std::optional<Share>);
template void fill_pools<2>(std::vector<ParticlePool<2>>&, const std::vector<Material>&,
                            std::vector<Body<2>>&, std::vector<Patch<2>>&);
template void fill_pools<3>(std::vector<ParticlePool<3>>&, const std::vector<Material>&,
                            std::vector<Body<3>>&, std::vector<Patch<3>>&);

}  // namespace mpm
