#pragma once
// What ranks tell each other of surfaces (other_ranks.hpp).
#include "mpm/domain.hpp"

namespace mpm {

/// Where all points of bodies that deform are by now, to all.
template <int D>
void tell_all_places(Domain<D>& domain);

/// Ask for the points of others that may be felt by now, and those that points are bonded to.
template <int D>
void ask_for_awake(Domain<D>& domain);

/// Where these are, and how their hosts move.
template <int D>
void tell_awake(Domain<D>& domain);

/// How bodies turn and move as wholes, to all: restitution asks for it.
template <int D>
void tell_motions(Domain<D>& domain);

/// Entries of all ranks, from those of each; in the order of the ranks.
template <class Entry>
std::vector<Entry> entries_of_all(Comm& comm, const std::vector<Entry>& own) {
  if (comm.alone()) return own;
  Mail mail;
  for (int rank = 0; rank < comm.size(); ++rank) {
    if (rank == comm.rank()) continue;
    mail.out.push_back({rank, {}});
    write_all<Entry>(mail.out.back(), own);
  }
  comm.exchange(mail);
  std::vector<Entry> all = own;
  for (const Letter& letter : mail.in)
    for (Reader reader(letter); !reader.done();) all.push_back(reader.template read<Entry>());
  return all;
}

}  // namespace mpm
