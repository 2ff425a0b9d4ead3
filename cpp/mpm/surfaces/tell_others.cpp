#include "mpm/surfaces/tell_others.hpp"

#include <algorithm>
#include <span>

#include "mpm/comm/letters.hpp"
#include "mpm/step/sum_over_bodies.hpp"
#include "mpm/surfaces/host_motion.hpp"

namespace mpm {
namespace {

SurfacePartner& partner_with(std::vector<SurfacePartner>& partners, int rank) {
  const auto at = std::ranges::find(partners, rank, &SurfacePartner::rank);
  return at == partners.end() ? partners.emplace_back(SurfacePartner{rank}) : *at;
}

void sort_once(std::vector<std::uint32_t>& numbers) {
  std::ranges::sort(numbers);
  const auto twice = std::ranges::unique(numbers);
  numbers.erase(twice.begin(), twice.end());
}

template <int D>
HostElsewhere<D> state_of(Domain<D>& domain, std::uint32_t number) {
  const Host<D>& host = domain.surfaces.hosts[number];
  const int body = domain.surfaces.parts[host.part].body;
  return {number, deformation_of(domain.pool_of(domain.body_at(body)), host),
          motion_of<velocity_at>(domain, host)};
}

/// How a body turns, by its place among them.
struct SpinOf {
  std::uint64_t number;
  KeptSpin spin;
};

}  // namespace

template <int D>
void tell_all_places(Domain<D>& domain) {
  Comm& comm = *domain.grid.partition.comm;
  Surfaces<D>& surfaces = domain.surfaces;
  if (comm.alone()) return;
  const auto places_of = [&](const SurfacePart<D>& part) {
    return std::span(surfaces.places).subspan(part.first_point, part.point_count);
  };
  Mail mail;
  mail.out.resize(static_cast<std::size_t>(comm.size()) - 1);
  mail.in.resize(mail.out.size());
  for (std::size_t k = 0; k < mail.out.size(); ++k) {
    const int rank = static_cast<int>(k) + (static_cast<int>(k) < comm.rank() ? 0 : 1);
    mail.out[k].rank = mail.in[k].rank = rank;
    for (const SurfacePart<D>& part : surfaces.parts) {
      if (part.as_one) continue;
      if (!part.foreign)
        write_all<Vec<double, D>>(mail.out[k], places_of(part));
      else if (part.rank == rank)
        extend(mail.in[k], part.point_count * sizeof(Vec<double, D>));
    }
  }
  comm.start(mail);
  comm.finish(mail);
  for (const Letter& letter : mail.in) {
    Reader reader(letter);
    for (const SurfacePart<D>& part : surfaces.parts)
      if (part.foreign && !part.as_one && part.rank == letter.rank)
        for (Vec<double, D>& place : places_of(part))
          place = reader.template read<Vec<double, D>>();
  }
  comm.release(mail);
}

template <int D>
void ask_for_awake(Domain<D>& domain) {
  Comm& comm = *domain.grid.partition.comm;
  Surfaces<D>& surfaces = domain.surfaces;
  if (comm.alone()) return;
  std::vector<SurfacePartner>& partners = surfaces.others.partners;
  partners.clear();
  const auto ask = [&](std::uint32_t point) {
    const SurfacePart<D>& part = part_of_point(surfaces, point);
    if (!part.foreign || part.as_one) return;
    SurfacePartner& partner = partner_with(partners, part.rank);
    partner.take_points.push_back(point);
    partner.take_hosts.push_back(surfaces.points[point].host);
  };
  for (const SurfacePart<D>& part : surfaces.parts)
    if (!part.foreign) std::ranges::for_each(part.awake, ask);
  for (const Bond<D>& bond : surfaces.bonds)
    if (!part_of_point(surfaces, bond.first).foreign) ask(bond.second);
  Mail mail;
  for (SurfacePartner& partner : partners) {
    sort_once(partner.take_points);
    sort_once(partner.take_hosts);
    Letter& letter = letter_to(mail, partner.rank);
    write(letter, partner.take_points.size());
    write_all<std::uint32_t>(letter, partner.take_points);
    write_all<std::uint32_t>(letter, partner.take_hosts);
  }
  comm.exchange(mail);
  for (const Letter& letter : mail.in) {
    SurfacePartner& partner = partner_with(partners, letter.rank);
    Reader reader(letter);
    const auto count = reader.template read<std::size_t>();
    for (std::size_t k = 0; k < count; ++k)
      partner.give_points.push_back(reader.template read<std::uint32_t>());
    while (!reader.done()) partner.give_hosts.push_back(reader.template read<std::uint32_t>());
  }
}

template <int D>
void tell_awake(Domain<D>& domain) {
  Comm& comm = *domain.grid.partition.comm;
  Surfaces<D>& surfaces = domain.surfaces;
  if (comm.alone()) return;
  OtherRanks<D>& others = surfaces.others;
  Mail& mail = others.mail;
  comm.release(mail);
  mail.out.assign(others.partners.size(), {});
  mail.in.assign(others.partners.size(), {});
  for (std::size_t k = 0; k < others.partners.size(); ++k) {
    const SurfacePartner& partner = others.partners[k];
    mail.out[k].rank = mail.in[k].rank = partner.rank;
    for (const std::uint32_t point : partner.give_points)
      write(mail.out[k], surfaces.places[point]);
    for (const std::uint32_t host : partner.give_hosts) write(mail.out[k], state_of(domain, host));
    extend(mail.in[k], partner.take_points.size() * sizeof(Vec<double, D>) +
                           partner.take_hosts.size() * sizeof(HostElsewhere<D>));
  }
  comm.start(mail);
  comm.finish(mail);
  others.hosts.clear();
  for (std::size_t k = 0; k < others.partners.size(); ++k) {
    Reader reader(mail.in[k]);
    for (const std::uint32_t point : others.partners[k].take_points)
      surfaces.places[point] = reader.template read<Vec<double, D>>();
    while (!reader.done()) others.hosts.push_back(reader.template read<HostElsewhere<D>>());
  }
  std::ranges::sort(others.hosts, {}, &HostElsewhere<D>::host);
}

template <int D>
void ask_for_pressed(Domain<D>& domain) {
  Comm& comm = *domain.grid.partition.comm;
  Surfaces<D>& surfaces = domain.surfaces;
  if (comm.alone()) return;
  std::vector<HostElsewhere<D>>& known = surfaces.others.hosts;
  std::vector<SurfacePartner> partners;
  for (const PressingPatch<D>& of : surfaces.pressing)
    for (const FeltPoint<D>& felt : of.felt) {
      const SurfacePart<D>& part = part_of_point(surfaces, felt.point);
      const std::uint32_t host = surfaces.points[felt.point].host;
      if (!part.foreign || part.as_one) continue;
      if (std::ranges::binary_search(known, host, {}, &HostElsewhere<D>::host)) continue;
      partner_with(partners, part.rank).take_hosts.push_back(host);
    }
  Mail asked, told;
  for (SurfacePartner& partner : partners) {
    sort_once(partner.take_hosts);
    write_all<std::uint32_t>(letter_to(asked, partner.rank), partner.take_hosts);
  }
  comm.exchange(asked);
  for (const Letter& letter : asked.in)
    for (Reader reader(letter); !reader.done();)
      write(letter_to(told, letter.rank), state_of(domain, reader.template read<std::uint32_t>()));
  comm.exchange(told);
  for (const Letter& letter : told.in)
    for (Reader reader(letter); !reader.done();)
      known.push_back(reader.template read<HostElsewhere<D>>());
  std::ranges::sort(known, {}, &HostElsewhere<D>::host);
}

template <int D>
void tell_motions(Domain<D>& domain) {
  Comm& comm = *domain.grid.partition.comm;
  if (comm.alone()) return;
  std::vector<SpinOf> own;
  for (std::size_t k = 0; k < domain.kept_spins.size(); ++k)
    if (has_first(domain, k)) own.push_back({k, domain.kept_spins[k]});
  entries_of_all(comm, own);
  for (const SpinOf& one : own) domain.kept_spins[one.number] = one.spin;
}

template void tell_all_places<2>(Domain<2>&);
template void tell_all_places<3>(Domain<3>&);
template void ask_for_awake<2>(Domain<2>&);
template void ask_for_awake<3>(Domain<3>&);
template void tell_awake<2>(Domain<2>&);
template void tell_awake<3>(Domain<3>&);
template void ask_for_pressed<2>(Domain<2>&);
template void ask_for_pressed<3>(Domain<3>&);
template void tell_motions<2>(Domain<2>&);
template void tell_motions<3>(Domain<3>&);

}  // namespace mpm
