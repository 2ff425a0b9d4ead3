#include "mpm/run/surfaces.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "mpm/comm/letters.hpp"
#include "mpm/surfaces/approaches.hpp"
#include "mpm/surfaces/bonds.hpp"
#include "mpm/surfaces/levelled.hpp"
#include "mpm/surfaces/near_points.hpp"
#include "mpm/surfaces/overlaps.hpp"
#include "mpm/surfaces/parts.hpp"
#include "mpm/surfaces/press.hpp"
#include "mpm/surfaces/pressing.hpp"
#include "mpm/surfaces/renew_points.hpp"

namespace mpm {

template <int D>
void add_surface(Simulation<D>& simulation, int number, const ContactPointsGiven& given) {
  Domain<D>& domain = simulation.domain;
  require(simulation, Phase::building, "surfaces must be added before prepare()");
  Body<D>& body = domain.body_at(number);
  const auto check = [&](bool holds, const char* rule) {
    if (!holds) throw std::invalid_argument("surface of " + body.name + ": " + rule);
  };
  const std::size_t n = given.particles.size();
  check(given.offsets.size() == n * D && given.normals.size() == n * D && given.areas.size() == n &&
            given.felt_areas.size() == n && given.faces.size() == n,
        "offsets and normals must be (points, D), areas, felt areas and faces (points,)");
  check(given.spacing > 0.0 && std::isfinite(given.spacing), "spacing must be a finite number > 0");
  Surfaces<D>& surfaces = domain.surfaces;
  check(surfaces.given.empty() || surfaces.spacing == given.spacing,
        "the spacing of points is one for all bodies");
  surfaces.spacing = given.spacing;
  body.held_by = given.held_by;
  for (std::size_t k = 0; k < n; ++k) {
    GivenPoint<D> point{
        number, given.particles[k], {}, {}, given.areas[k], given.felt_areas[k], given.faces[k]};
    check(point.particle < body.count, "there is no such particle");
    check(point.face >= 0, "faces must be numbers >= 0");
    for (const double area : {point.area, point.felt_area})
      check(area >= 0.0 && std::isfinite(area), "areas must be finite numbers >= 0");
    for (std::size_t a = 0; a < D; ++a) {
      const double offset = given.offsets[k * D + a];
      check(std::isfinite(offset), "offsets must be finite numbers");
      point.offset[static_cast<int>(a)] = offset;
      point.normal[static_cast<int>(a)] = given.normals[k * D + a];
    }
    check(std::abs(norm(point.normal) - 1.0) < 1e-9, "normals must be of unit length");
    surfaces.given.push_back(point);
  }
}

template <int D>
void start_surfaces(Domain<D>& domain) {
  if (domain.surfaces.given.empty()) return;
  start_parts(domain);
  if (domain.surfaces.meet && bonds(domain.contact_settings)) add_bonds(domain);
  if (domain.surfaces.meet) find_near_points(domain);
  set_back_overlaps(domain);
  level_faces(domain);
  bound_onsets(domain);
  set_back_onsets(domain);
  set_back_pressing(domain);
  domain.surfaces.given = {};
  domain.surfaces.given_of = {};
}

namespace {

constexpr const char* damaged = "its surfaces are damaged";

template <class Value, class Finite>
void exchange_kept(std::vector<KeptOfContact<Value>>& kept, StateStream& stream, std::size_t points,
                   Finite&& finite) {
  stream.vector(kept);
  if (!stream.restores()) return;
  StateStream::check(std::ranges::is_sorted(kept, std::less<>{}), damaged);
  for (const KeptOfContact<Value>& one : kept)
    StateStream::check(one.point < points && finite(one.value), damaged);
}

template <int D>
bool is_finite(const Vec<double, D>& v) {
  return std::isfinite(dot(v, v));
}

/// What a part keeps, for the rank that writes it.
template <int D>
void write_part(Letter& letter, std::size_t number, const SurfacePart<D>& part) {
  write(letter, number);
  write(letter, part.by_walls);
  write(letter, part.moment_by_walls);
  write(letter, part.at_walls);
  write(letter, part.kept.size());
  write_all<KeptOfContact<MemoryOfTouch<D>>>(letter, part.kept);
  write(letter, part.levelled.size());
  write_all<KeptOfContact<Levelled<D>>>(letter, part.levelled);
}
template <int D>
void read_part(Reader& reader, Surfaces<D>& surfaces) {
  SurfacePart<D>& part = surfaces.parts[reader.read<std::size_t>()];
  part.by_walls = reader.read<FaceImpulses<D>>();
  part.moment_by_walls = reader.read<Vector3>();
  part.at_walls = reader.read<bool>();
  part.kept.resize(reader.read<std::size_t>());
  for (auto& one : part.kept) one = reader.read<KeptOfContact<MemoryOfTouch<D>>>();
  part.levelled.resize(reader.read<std::size_t>());
  for (auto& one : part.levelled) one = reader.read<KeptOfContact<Levelled<D>>>();
}

/// The state of the surfaces of all ranks, to the first.
template <int D>
Surfaces<D> gather_surfaces(const Domain<D>& domain) {
  Comm& comm = *domain.grid.partition.comm;
  Surfaces<D> all = domain.surfaces;
  if (comm.alone()) return all;
  Mail mail;
  if (comm.rank() > 0) {
    Letter& letter = letter_to(mail, 0);
    write(letter, all.set_back.size());
    write_all<KeptOfContact<double>>(letter, all.set_back);
    write(letter, all.on_hosts.size());
    write_all<ActingOnHost<D>>(letter, all.on_hosts);
    write(letter, all.pressed_walls);
    for (std::size_t k = 0; k < all.parts.size(); ++k)
      if (!all.parts[k].foreign) write_part(letter, k, all.parts[k]);
  }
  comm.exchange(mail);
  for (const Letter& letter : mail.in) {
    Reader reader(letter);
    for (std::size_t left = reader.read<std::size_t>(); left > 0; --left)
      all.set_back.push_back(reader.read<KeptOfContact<double>>());
    for (std::size_t left = reader.read<std::size_t>(); left > 0; --left)
      all.on_hosts.push_back(reader.read<ActingOnHost<D>>());
    const auto walls = reader.read<PressedWalls<D>>();
    all.pressed_walls.faces.add(walls.faces, 1.0);
    all.pressed_walls.moment += walls.moment;
    all.pressed_walls.any = all.pressed_walls.any || walls.any;
    while (!reader.done()) read_part(reader, all);
  }
  std::sort(all.set_back.begin(), all.set_back.end());
  std::ranges::sort(all.on_hosts, {}, &ActingOnHost<D>::host);
  return all;
}

/// What was restored of all parts, but for own ones, is left out.
template <int D>
void keep_own(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  const auto is_foreign = [&](std::uint32_t host) {
    return surfaces.parts[surfaces.hosts[host].part].foreign;
  };
  std::erase_if(surfaces.set_back, [&](const KeptOfContact<double>& one) {
    return is_foreign(surfaces.points[one.point].host);
  });
  std::erase_if(surfaces.on_hosts,
                [&](const ActingOnHost<D>& one) { return is_foreign(one.host); });
  if (domain.grid.partition.comm->rank() > 0) surfaces.pressed_walls = {};
  std::ranges::fill(surfaces.place_on_hosts, 0);
  for (std::size_t k = 0; k < surfaces.on_hosts.size(); ++k)
    surfaces.place_on_hosts[surfaces.on_hosts[k].host] = static_cast<std::uint32_t>(k + 1);
}

template <int D>
bool are_finite(const ForceAtHost<D>& forces) {
  double sum = dot(forces.force, forces.force);
  for (int a = 0; a < D; ++a)
    for (int b = 0; b < D; ++b)
      sum += std::abs(forces.moment[a][b]) + std::abs(forces.second[a][b]);
  return std::isfinite(sum);
}

/// Of what was restored.
template <int D>
void check_state(const Domain<D>& domain, Surfaces<D>& surfaces) {
  const auto is_body = [&](int body) {
    return body >= 0 && std::cmp_less(body, domain.bodies.size());
  };
  const auto check = [](bool holds) { StateStream::check(holds, damaged); };
  check(std::ranges::all_of(surfaces.places_of_lists, is_finite<D>));
  check(std::isfinite(surfaces.age_of_lists) && surfaces.closing >= 0.0 &&
        std::isfinite(surfaces.closing));
  check(std::ranges::is_sorted(surfaces.on_hosts, {}, &ActingOnHost<D>::host));
  for (const ActingOnHost<D>& on : surfaces.on_hosts)
    check(on.host < surfaces.hosts.size() && are_finite(on.push) && are_finite(on.rub));
  check(std::ranges::is_sorted(surfaces.on_bodies, {}, &ActingOnBody::body));
  for (const ActingOnBody& on : surfaces.on_bodies)
    for (const Wrench& by : {on.push, on.rub, on.restitution})
      check(is_body(on.body) && is_finite(by.force) && is_finite(by.moment));
  for (const ActingBetween<D>& pair : surfaces.between)
    check(is_body(pair.a) &&
          (is_body(pair.b) ? pair.a < pair.b : pair.b >= opposite_wall(D - 1, 1)) &&
          is_finite(pair.on_first) && is_finite(pair.push) && std::isfinite(pair.rub_work) &&
          pair.left >= 0.0 && pair.left <= 1.0);
  check(std::ranges::is_sorted(surfaces.approaches, std::less<>{}));
  for (const Approach& one : surfaces.approaches)
    check(is_body(one.a) && (is_body(one.b) || one.b >= opposite_wall(D - 1, 1)) &&
          one.speed >= 0.0 && std::isfinite(one.speed));
  for (SurfacePart<D>& part : surfaces.parts) {
    bool finite = is_finite(part.moment_by_walls);
    part.by_walls.for_each([&](double x) { finite = finite && std::isfinite(x); });
    check(finite && (!part.at_walls || domain.grid.walls.exist));
  }
}

/// Where nodes were laid anew, or particles have failed, points are not as the case has them.
template <int D>
void exchange_points(Domain<D>& domain, StateStream& stream) {
  const auto is_renewed = [](const Body<D>& body) { return body.renewals > 0; };
  const auto has_failed = [](const Body<D>& body) { return body.failed > 0; };
  const bool others = std::ranges::any_of(domain.bodies, has_failed);
  if (!others) stream.same(domain.surfaces.points.size(), "it was made from another case");
  if (!domain.surfaces.exist() || (!others && std::ranges::none_of(domain.bodies, is_renewed)))
    return;
  const Surfaces<D>& surfaces = domain.surfaces;
  std::vector<LaidPoint<D>> points;
  if (!stream.restores())
    points = laid_points(domain, std::vector<bool>(domain.bodies.size(), false));
  stream.vector(points);
  if (!stream.restores()) return;
  StateStream::check(others || points.size() == surfaces.points.size(), damaged);
  for (std::uint32_t k = 0; k < points.size(); ++k) {
    const auto& [given, place, at_start, failed] = points[k];
    bool fine = std::abs(norm(given.normal) - 1.0) < 1e-9 && given.number == k && given.body >= 0 &&
                std::cmp_less(given.body, domain.bodies.size()) &&
                given.particle < domain.body_at(given.body).count && given.face >= no_face;
    for (const Vec<double, D>& v : {given.offset, given.normal, place, at_start})
      fine = fine && is_finite(v);
    for (const double area : {given.area, given.felt_area})
      fine = fine && area >= 0.0 && std::isfinite(area);
    StateStream::check(fine, damaged);
  }
  drop_bonds_of_failed(domain.surfaces, points);
  lay_points(domain, points);
}

/// All of it, as one rank has it.
template <int D>
void exchange_state(const Domain<D>& domain, Surfaces<D>& surfaces, StateStream& stream) {
  exchange_kept(surfaces.set_back, stream, surfaces.points.size(),
                [](double x) { return std::isfinite(x); });
  for (SurfacePart<D>& part : surfaces.parts) {
    exchange_kept(part.kept, stream, surfaces.points.size(), [](const MemoryOfTouch<D>& one) {
      return is_finite(one.slip) && one.onset >= 0.0 && std::isfinite(one.onset);
    });
    exchange_kept(part.levelled, stream, surfaces.points.size(), [](const Levelled<D>& one) {
      return is_finite(one.slid) && one.by >= 0.0 && std::isfinite(one.by) &&
             std::isfinite(one.first) && std::isfinite(one.gap);
    });
    stream(part.by_walls, part.moment_by_walls, part.at_walls);
  }
  stream.vector(surfaces.on_hosts);
  stream.vector(surfaces.between);
  stream.vector(surfaces.approaches);
  stream.vector(surfaces.on_bodies);
  for (const SurfacePart<D>& part : surfaces.parts)
    if (part.as_one)
      stream.array(std::span(surfaces.places).subspan(part.first_point, part.point_count));
  stream(surfaces.stored_push, surfaces.stored_rub, surfaces.touching, surfaces.touching_max);
  stream(surfaces.pressed_walls.faces, surfaces.pressed_walls.moment, surfaces.pressed_walls.any);
  stream(surfaces.deepest.body, surfaces.deepest.overlap, surfaces.deepest.place);
  if (stream.restores()) surfaces.places_of_lists.resize(surfaces.points.size());
  if (surfaces.meet) {
    stream.array(std::span(surfaces.places_of_lists));
    stream(surfaces.age_of_lists, surfaces.closing);
  }
  if (!stream.restores()) return;
  check_state(domain, surfaces);
}

}  // namespace

template <int D>
void exchange_surfaces(Domain<D>& domain, StateStream& stream) {
  Surfaces<D>& surfaces = domain.surfaces;
  exchange_points(domain, stream);
  if (!surfaces.exist()) return;
  if (!stream.restores()) {
    if (stream.comm().alone()) {
      exchange_state(domain, surfaces, stream);
      return;
    }
    Surfaces<D> all = gather_surfaces(domain);
    exchange_state(domain, all, stream);
    return;
  }
  find_parts(domain);
  exchange_state(domain, surfaces, stream);
  keep_own(domain);
  // Where points are by now; how far they went in the last step is not known.
  place_points(domain);
  for (SurfacePart<D>& part : surfaces.parts)
    part.square_of_step = std::numeric_limits<double>::infinity();
  if (!surfaces.meet) return;
  // How fast near points have moved against each other limits the step, and is known by the lists:
  // they are made where they were.
  std::swap(surfaces.places, surfaces.places_of_lists);
  make_near_lists(domain);
  std::swap(surfaces.places, surfaces.places_of_lists);
}

template void add_surface<2>(Simulation<2>&, int, const ContactPointsGiven&);
template void add_surface<3>(Simulation<3>&, int, const ContactPointsGiven&);
template void start_surfaces<2>(Domain<2>&);
template void start_surfaces<3>(Domain<3>&);
template void exchange_surfaces<2>(Domain<2>&, StateStream&);
template void exchange_surfaces<3>(Domain<3>&, StateStream&);

}  // namespace mpm
