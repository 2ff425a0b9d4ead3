#pragma once
// Sums and choices over all ranks that depend on no number of them.
#include <algorithm>
#include <cmath>
#include <limits>

#include "mpm/comm/letters.hpp"
#include "mpm/math/exact_sum.hpp"

namespace mpm {

/// Of each sum that of all ranks.
inline void all_sum(Comm& comm, std::span<ExactSum> sums) {
  if (comm.alone() || sums.empty()) return;
  constexpr std::size_t words = ExactSum::words;
  std::vector<std::int64_t> all(sums.size() * words);
  for (std::size_t k = 0; k < sums.size(); ++k)
    sums[k].write(std::span<std::int64_t, words>(&all[k * words], words));
  comm.all_sum(all);
  for (std::size_t k = 0; k < sums.size(); ++k)
    sums[k] = ExactSum::read(std::span<const std::int64_t, words>(&all[k * words], words));
}

inline double all_max(Comm& comm, double number) {
  comm.all_max({&number, 1});
  return number;
}
inline std::int64_t all_sum(Comm& comm, std::int64_t number) {
  comm.all_sum({&number, 1});
  return number;
}
inline bool any_of_all(Comm& comm, bool here) { return all_sum(comm, std::int64_t{here}) > 0; }

/// The rank with the largest key, the numbers compared one after another; of equal ones the lowest.
/// What is no number is larger than all that are: it is what has gone wrong.
inline int rank_of_largest(Comm& comm, std::vector<double> key) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (double& number : key)
    if (std::isnan(number)) number = infinity;
  bool in = true;
  key.push_back(-comm.rank());
  for (double& number : key) {
    const double largest = all_max(comm, in ? number : -infinity);
    in = in && number == largest;
    number = largest;
  }
  return static_cast<int>(-key.back());
}

/// The entries of all ranks: own ones, then those of the others by rank.
template <class Entry>
  requires std::is_trivially_copyable_v<Entry>
void entries_of_all(Comm& comm, std::vector<Entry>& entries) {
  if (comm.alone()) return;
  Mail mail;
  for (int rank = 0; rank < comm.size(); ++rank) {
    if (rank == comm.rank()) continue;
    mail.out.push_back({rank, {}});
    write_all<Entry>(mail.out.back(), entries);
  }
  comm.exchange(mail);
  for (const Letter& letter : mail.in)
    for (Reader reader(letter); !reader.done();) entries.push_back(reader.read<Entry>());
}

/// What one rank has, to all.
inline void broadcast(Comm& comm, int from, std::vector<std::byte>& bytes) {
  if (comm.alone()) return;
  Mail mail;
  if (comm.rank() == from)
    for (int rank = 0; rank < comm.size(); ++rank)
      if (rank != from) mail.out.push_back({rank, bytes});
  comm.exchange(mail);
  if (comm.rank() != from) bytes = std::move(mail.in.at(0).bytes);
}
template <class T>
  requires std::is_trivially_copyable_v<T>
void broadcast(Comm& comm, int from, T& value) {
  std::vector<std::byte> bytes(sizeof(T));
  std::memcpy(bytes.data(), &value, sizeof(T));
  broadcast(comm, from, bytes);
  std::memcpy(&value, bytes.data(), sizeof(T));
}

}  // namespace mpm
