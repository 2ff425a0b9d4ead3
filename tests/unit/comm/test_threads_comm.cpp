// Ranks that are threads: letters arrive as they were sent, sums and maxima are those of all, and
// one that fails takes the others with it.
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "check.hpp"
#include "mpm/comm/all_sums.hpp"
#include "on_ranks.hpp"

namespace {

using namespace mpm;
using testing::on_ranks;

std::vector<std::byte> bytes_of(int from, int to, int round, std::size_t length) {
  std::vector<std::byte> bytes(length);
  for (std::size_t k = 0; k < length; ++k)
    bytes[k] = static_cast<std::byte>(from * 7 + to * 13 + round * 31 + static_cast<int>(k));
  return bytes;
}

/// Whom a rank writes in a round, and how much: the same for all who ask.
std::size_t length_of(int from, int to, int round) {
  std::minstd_rand random(static_cast<unsigned>(1 + from + 10 * to + 100 * round));
  random.discard(5);
  return from == to || random() % 3 == 0 ? 0 : random() % 100 + 1;
}

void post(const Comm& comm, int round, Mail& mail) {
  mail.out.clear();
  for (int to = 0; to < comm.size(); ++to)
    if (const std::size_t length = length_of(comm.rank(), to, round))
      mail.out.push_back({to, bytes_of(comm.rank(), to, round, length)});
}

/// How many letters are not what their senders wrote.
int wrong(const Comm& comm, int round, const Mail& mail) {
  int count = 0;
  std::size_t next = 0;
  for (int from = 0; from < comm.size(); ++from) {
    const std::size_t length = length_of(from, comm.rank(), round);
    if (length == 0) continue;
    const bool there = next < mail.in.size() && mail.in[next].rank == from;
    count += !there || mail.in[next].bytes != bytes_of(from, comm.rank(), round, length);
    ++next;
  }
  return count + (next != mail.in.size());
}

/// Rounds of all kinds one behind another, so that fast ranks are ahead of slow ones.
void check_letters(mpm::testing::Report& report, int size) {
  std::vector<int> errors(static_cast<std::size_t>(size));
  on_ranks(size, [&](Comm& comm) {
    Mail mail;
    int& mine = errors[static_cast<std::size_t>(comm.rank())];
    for (int round = 0; round < 300; ++round) {
      post(comm, round, mail);
      if (round % 2 == 0) {
        comm.exchange(mail);
      } else {
        mail.in.clear();
        for (int from = 0; from < comm.size(); ++from)
          if (const std::size_t length = length_of(from, comm.rank(), round))
            mail.in.push_back({from, std::vector<std::byte>(length)});
        comm.start(mail);
        comm.finish(mail);
      }
      mine += wrong(comm, round, mail);
      std::int64_t sums[2] = {comm.rank() + 1, -round};
      comm.all_sum(sums);
      const std::int64_t ranks = comm.size();
      mine += sums[0] != ranks * (ranks + 1) / 2 || sums[1] != -round * ranks;
      double largest[2] = {std::sin(round + comm.rank()), -1.0 * comm.rank()};
      comm.all_max(largest);
      mine += largest[1] != 0.0 || largest[0] < std::sin(round + comm.rank());
    }
    double none[1] = {comm.rank() == size / 2 ? std::nan("") : 1.0};
    comm.all_max(none);
    mine += !std::isnan(none[0]);
    // What is no number is found, and is the same rank's to all.
    const double key = comm.rank() == size / 2 ? std::nan("") : 5.0;
    mine += rank_of_largest(comm, {1.0, key}) != size / 2;
  });
  for (const int count : errors) CHECK_EQUAL(count, 0);
}

void check_failure(mpm::testing::Report& report) {
  constexpr int size = 4;
  std::vector<std::string> told(size);
  on_ranks(size, [&](Comm& comm) {
    Mail mail;
    try {
      if (comm.rank() == 2) comm.fail("rank 2 has no memory left");
      // One waits for a letter, the others for a sum.
      if (comm.rank() == 1) mail.in.push_back({2, std::vector<std::byte>(1)});
      if (comm.rank() == 1) comm.finish(mail);
      std::int64_t number = 1;
      comm.all_sum({&number, 1});
    } catch (const RankFailed& error) {
      told[static_cast<std::size_t>(comm.rank())] = error.what();
    }
  });
  for (const std::string& text : told) CHECK_EQUAL(text, "rank 2 has no memory left");
}

}  // namespace

void test_threads_comm(mpm::testing::Report& report) {
  for (const int size : {1, 2, 3, 8}) check_letters(report, size);
  check_failure(report);
}
