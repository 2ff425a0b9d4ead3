#include "mpm/surfaces/parts.hpp"

#include <algorithm>
#include <stdexcept>

#include "mpm/comm/letters.hpp"
#include "mpm/grid/connect.hpp"
#include "mpm/schedule/cell_loop.hpp"
#include "mpm/surfaces/host_motion.hpp"

namespace mpm {
namespace {

/// A piece of the surface of a body, in one tile, as the rank that has its particles tells of it.
template <int D>
struct PieceHead {
  std::int32_t body = 0, rank = 0;
  Index<D> tile{};
  bool as_one = false;
  std::uint32_t host_count = 0, point_count = 0;
};
template <int D>
struct PieceOfSurface {
  struct Point {
    std::uint32_t given = 0, host = 0;  // among those given; from the first of the piece
    Vec<double, D> place;               // [m]
    Vec<double, D> second;              // of PlaceAtHost [m^2]
  };
  PieceHead<D> head;
  std::vector<Point> points{};
  std::vector<Host<D>> hosts{};  // of own ones
};

/// b of a point, by how far its surface is from its host along the normal: along the surface the
/// sum over particles is what it should be.
template <int D>
Vec<double, D> second_order_of(const Domain<D>& domain, const Patch<D>& patch, const Host<D>& host,
                               const GivenPoint<D>& point) {
  const double h = domain.grid.cell_size, away = dot(point.offset, point.normal) / h;
  Vec<double, D> second = Vec<double, D>::zero();
  with_basis(domain.grid, domain.body_of(patch), [&]<BasisModel B>(const B& basis) {
    if constexpr (ActsOnFaces<B>)
      second = h * h * second_order_of(basis, host.xi, away * point.normal);
  });
  return second;
}

/// The piece of a patch, of the points of its body by their particles. Bodies that do not deform
/// have one host.
template <int D>
PieceOfSurface<D> piece_of_patch(const Domain<D>& domain, const Patch<D>& patch,
                                 std::span<const GivenPoint<D>> of_body) {
  const ParticlePool<D>& pool = domain.pool_of(patch);
  const bool as_one = !patch.keeps;
  PieceOfSurface<D> piece{
      {patch.body, domain.grid.partition.comm->rank(), patch.tile, as_one, 0, 0}};
  if (as_one) piece.hosts.push_back({0, 0, 0, {}});
  const auto add = [&](std::uint32_t row, auto&& make_host) {
    const auto own = std::ranges::equal_range(of_body, pool.id[row], {}, &GivenPoint<D>::particle);
    if (own.empty()) return;
    make_host();
    for (const GivenPoint<D>& point : own)
      piece.points.push_back(
          {static_cast<std::uint32_t>(&point - domain.surfaces.given.data()),
           static_cast<std::uint32_t>(piece.hosts.size() - 1),
           pool.position_of(row) + point.offset - (0.5 * domain.surfaces.spacing) * point.normal,
           as_one ? Vec<double, D>::zero()
                  : second_order_of(domain, patch, piece.hosts.back(), point)});
  };
  if (as_one) {
    for (const std::uint32_t row : pool.rows(patch)) add(row, [] {});
  } else {
    for_each_cell(domain.grid, pool, patch, [&](const CellRange<D>& cell) {
      for (std::uint32_t k = 0; k < cell.count; ++k) {
        const std::uint32_t row = cell.rows[k];
        add(row, [&] {
          Host<D> host{0, row, cell.first_node, {}};
          for (int a = 0; a < D; ++a)
            host.xi[a] = local_coordinate(domain.grid.in_cells(pool.listed(a)[row], a),
                                          cell.cell[static_cast<std::size_t>(a)]);
          piece.hosts.push_back(host);
        });
      }
    });
  }
  piece.head.host_count = static_cast<std::uint32_t>(piece.hosts.size());
  piece.head.point_count = static_cast<std::uint32_t>(piece.points.size());
  return piece;
}

/// Those of all ranks, by body and tile.
template <int D>
std::vector<PieceOfSurface<D>> all_pieces(const Domain<D>& domain) {
  const std::vector<GivenPoint<D>>& given = domain.surfaces.given;
  std::vector<PieceOfSurface<D>> pieces;
  for (const Patch<D>& patch : domain.grid.patches) {
    const auto own = std::ranges::equal_range(given, patch.body, {}, &GivenPoint<D>::body);
    if (own.empty() || patch.foreign) continue;
    pieces.push_back(piece_of_patch<D>(domain, patch, {own.begin(), own.end()}));
    if (pieces.back().points.empty()) pieces.pop_back();
  }
  Comm& comm = *domain.grid.partition.comm;
  Mail mail;
  for (int rank = 0; rank < comm.size(); ++rank) {
    if (rank == comm.rank()) continue;
    mail.out.push_back({rank, {}});
    for (const PieceOfSurface<D>& piece : pieces) {
      write(mail.out.back(), piece.head);
      write_all<typename PieceOfSurface<D>::Point>(mail.out.back(), piece.points);
    }
  }
  comm.exchange(mail);
  for (const Letter& letter : mail.in)
    for (Reader reader(letter); !reader.done();) {
      PieceOfSurface<D>& piece = pieces.emplace_back();
      piece.head = reader.template read<PieceHead<D>>();
      for (std::uint32_t k = 0; k < piece.head.point_count; ++k)
        piece.points.push_back(reader.template read<typename PieceOfSurface<D>::Point>());
    }
  std::ranges::sort(pieces, [](const PieceOfSurface<D>& x, const PieceOfSurface<D>& y) {
    return patch_less<D>(x.head.body, x.head.tile, y.head.body, y.head.tile);
  });
  return pieces;
}

/// A part of its own, or of a body that does not deform more of the last.
template <int D>
void add_piece(Surfaces<D>& surfaces, int here, const PieceOfSurface<D>& piece) {
  const PieceHead<D>& head = piece.head;
  if (!head.as_one || surfaces.parts.empty() || surfaces.parts.back().body != head.body) {
    SurfacePart<D>& part = surfaces.parts.emplace_back();
    part.body = head.body;
    part.tile = head.tile;
    part.as_one = head.as_one;
    part.rank = head.rank;
    part.foreign = head.rank != here;
    part.first_host = static_cast<std::uint32_t>(surfaces.hosts.size());
    part.host_count = head.host_count;
    part.first_point = static_cast<std::uint32_t>(surfaces.points.size());
    const auto number = static_cast<std::uint32_t>(surfaces.parts.size() - 1);
    for (std::uint32_t k = 0; k < head.host_count; ++k) {
      surfaces.hosts.push_back(piece.hosts.empty() ? Host<D>{} : piece.hosts[k]);
      surfaces.hosts.back().part = number;
    }
  }
  SurfacePart<D>& part = surfaces.parts.back();
  for (const auto& point : piece.points) {
    const GivenPoint<D>& given = surfaces.given[point.given];
    surfaces.points.push_back({part.first_host + point.host,
                               given.face,
                               {given.offset, point.second},
                               given.normal,
                               given.area,
                               given.felt_area});
    surfaces.given_of.push_back(point.given);
    surfaces.places.push_back(point.place);
  }
  part.point_count += head.point_count;
}

}  // namespace

template <int D>
void start_parts(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  std::vector<GivenPoint<D>>& given = surfaces.given;
  if (given.empty()) return;
  std::ranges::stable_sort(given, [](const GivenPoint<D>& x, const GivenPoint<D>& y) {
    return x.body != y.body ? x.body < y.body : x.particle < y.particle;
  });
  surfaces.parts.clear();
  surfaces.part_of.clear();
  surfaces.hosts.clear();
  surfaces.points.clear();
  surfaces.places.clear();
  surfaces.given_of.clear();
  const Comm& comm = *domain.grid.partition.comm;
  surfaces.points.reserve(given.size());
  surfaces.places.reserve(given.size());
  surfaces.given_of.reserve(given.size());
  for (PieceOfSurface<D>& piece : all_pieces(domain)) {
    add_piece(surfaces, comm.rank(), piece);
    piece = {};  // its memory is that of the next parts
  }
  if (!comm.alone()) surfaces.others.places_at_start = surfaces.places;
  surfaces.place_on_hosts.assign(surfaces.hosts.size(), 0);
  surfaces.place_of_motion.assign(surfaces.hosts.size(), 0);
  find_parts(domain);
}

template <int D>
void find_parts(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  const std::vector<Patch<D>>& patches = domain.grid.patches;
  const bool known =
      surfaces.part_of.size() == patches.size() &&
      std::ranges::all_of(surfaces.parts, [&](const SurfacePart<D>& part) {
        return part.as_one || part.foreign ||
               (part.patch < patches.size() && part.body == patches[part.patch].body &&
                part.tile == patches[part.patch].tile);
      });
  if (known) return;
  surfaces.part_of.assign(patches.size(), -1);
  for (std::size_t k = 0; k < surfaces.parts.size(); ++k) {
    SurfacePart<D>& part = surfaces.parts[k];
    if (part.as_one || part.foreign) continue;
    const int p = find_patch<D>(domain.grid, part.body, part.tile);
    if (p < 0) throw std::logic_error("a tile of a surface has no patch");
    part.patch = static_cast<std::uint32_t>(p);
    surfaces.part_of[part.patch] = static_cast<std::int32_t>(k);
  }
}

template <int D>
void place_points(Domain<D>& domain) {
  Surfaces<D>& surfaces = domain.surfaces;
  domain.threads.for_each(surfaces.parts.size(), [&](std::size_t k) {
    SurfacePart<D>& part = surfaces.parts[k];
    if (part.as_one) return;
    part.square_of_step = 0.0;
    if (part.foreign) return;  // told by others
    const ParticlePool<D>& pool = domain.pool_of(domain.body_at(part.body));
    std::uint32_t host = part.first_host;
    Mat<double, D> F = deformation_of(pool, surfaces.hosts[host]);
    Mat<double, D> second = second_derivatives_of(domain, surfaces.hosts[host]);
    for (std::uint32_t c = part.first_point; c < part.first_point + part.point_count; ++c) {
      const ContactPoint<D>& point = surfaces.points[c];
      if (point.host != host) {
        host = point.host;
        F = deformation_of(pool, surfaces.hosts[host]);
        second = second_derivatives_of(domain, surfaces.hosts[host]);
      }
      const Fibre<D> fibre(F, point.normal, behind_surface(surfaces, point));
      move_point(surfaces, part, c,
                 pool.position_of(surfaces.hosts[host].row) + product(F, point.surface.away) +
                     product(second, point.surface.second) - fibre.behind * fibre.direction);
    }
  });
}

template <int D>
void add_work_of_surfaces(Domain<D>& domain, std::size_t patch) {
  const SurfacePart<D>* const part = part_of(domain, patch);
  if (part == nullptr) return;
  PatchSums<D>& sums = domain.sums[patch];
  for (const ActingOnHost<D>& on : acting_on(domain.surfaces, *part)) {
    const HostMotion<D> motion = motion_of<velocity_at>(domain, domain.surfaces.hosts[on.host]);
    sums.surface_push += 0.5 * domain.time_step * motion.power(on.push);
    sums.surface_rub += 0.5 * domain.time_step * motion.power(on.rub);
  }
}

template void add_work_of_surfaces<2>(Domain<2>&, std::size_t);
template void add_work_of_surfaces<3>(Domain<3>&, std::size_t);
template void start_parts<2>(Domain<2>&);
template void start_parts<3>(Domain<3>&);
template void find_parts<2>(Domain<2>&);
template void find_parts<3>(Domain<3>&);
template void place_points<2>(Domain<2>&);
template void place_points<3>(Domain<3>&);

}  // namespace mpm
