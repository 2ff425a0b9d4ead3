#pragma once
// Sums over the patches of bodies on nodes of their own, in the order of the tiles whatever ranks
// have them: of bodies that several ranks share each tells the others what its patches give.
#include <algorithm>
#include <vector>

#include "mpm/comm/letters.hpp"
#include "mpm/domain.hpp"

namespace mpm {

/// Does this rank have the first tile of a body of Domain::kept_spins?
template <int D>
bool has_first(const Domain<D>& domain, std::size_t k) {
  const auto number = static_cast<std::int32_t>(k);
  const auto at = std::ranges::lower_bound(domain.shared_bodies, number, {}, &SharedBody::spin);
  if (at != domain.shared_bodies.end() && at->spin == number) return at->first;
  return std::ranges::any_of(patches_of<D>(domain.grid.patches, domain.kept_spins[k].body),
                             [](const Patch<D>& patch) { return !patch.foreign; });
}

/// What a patch of a shared body gives.
template <int D, class Term>
struct TermOfPatch {
  std::int32_t spin = 0;  // of Domain::kept_spins
  Index<D> tile{};
  Term term;
};

/// The terms of the patches of bodies that other ranks have too, by body and tile.
template <class Term, int D, class Wanted, class F>
std::vector<TermOfPatch<D, Term>> terms_of_shared_bodies(Domain<D>& domain, Wanted&& wanted,
                                                         F&& of) {
  using Told = TermOfPatch<D, Term>;
  std::vector<Told> all;
  Mail mail;
  for (const SharedBody& shared : domain.shared_bodies) {
    const KeptSpin& turning = domain.kept_spins[static_cast<std::size_t>(shared.spin)];
    if (!wanted(turning)) continue;
    for (const Patch<D>& patch : patches_of<D>(domain.grid.patches, turning.body)) {
      if (patch.foreign) continue;
      const auto p = static_cast<std::size_t>(&patch - domain.grid.patches.data());
      all.push_back({shared.spin, patch.tile, of(p, turning)});
      for (const int rank : shared.others) write(letter_to(mail, rank), all.back());
    }
  }
  domain.grid.partition.comm->exchange(mail);
  for (const Letter& letter : mail.in)
    for (Reader reader(letter); !reader.done();) all.push_back(reader.template read<Told>());
  std::ranges::sort(all, [](const Told& x, const Told& y) {
    return x.spin != y.spin ? x.spin < y.spin : tile_less<D>(x.tile, y.tile);
  });
  return all;
}

/// In place of the number of a patch: another rank has it.
inline constexpr std::size_t of_another_rank = static_cast<std::size_t>(-1);

/// take(turning, sum of of(p, turning), patch) for the bodies of Domain::kept_spins that are wanted
/// and that this rank has patches p of; the patch is the first of all, or `of_another_rank`. All
/// ranks want the same.
template <class Term, int D, class Wanted, class F, class Take>
void sum_over_bodies(Domain<D>& domain, Wanted&& wanted, F&& of, Take&& take) {
  if (std::ranges::none_of(domain.kept_spins, wanted)) return;
  std::vector<TermOfPatch<D, Term>> told;
  if (!domain.grid.partition.alone()) told = terms_of_shared_bodies<Term>(domain, wanted, of);
  domain.threads.for_each(domain.kept_spins.size(), [&](std::size_t k) {
    KeptSpin& turning = domain.kept_spins[k];
    if (!wanted(turning)) return;
    const auto patches = patches_of<D>(domain.grid.patches, turning.body);
    const auto begin = static_cast<std::size_t>(patches.data() - domain.grid.patches.data());
    const auto number = static_cast<std::int32_t>(k);
    const auto shared = std::ranges::equal_range(told, number, {}, &TermOfPatch<D, Term>::spin);
    Term sum;
    std::size_t first = of_another_rank;
    for (std::size_t p = begin; p < begin + patches.size(); ++p) {
      if (domain.grid.patches[p].foreign) continue;
      if (shared.empty()) sum.add(of(p, turning));
      if (first == of_another_rank) first = p;
    }
    if (first == of_another_rank) return;
    for (const TermOfPatch<D, Term>& one : shared) sum.add(one.term);
    if (!shared.empty() && shared.front().tile != domain.grid.patches[first].tile)
      first = of_another_rank;
    take(turning, sum, first);
  });
}

}  // namespace mpm
