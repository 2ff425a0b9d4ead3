#include "mpi_comm.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdio>
#include <limits>
#include <thread>

#include "mpm/comm/letters.hpp"

namespace mpm {
namespace {

constexpr int expected = 1;                  // the tag of letters that are expected
constexpr int unexpected = 2;                // and of others in even rounds; in odd ones one more
constexpr std::chrono::seconds patience(5);  // for ranks that have not failed yet

/// Integers in the order of numbers, what is no number above all others: MPI says nothing of those.
std::int64_t key_of(double number) {
  if (number != number) return std::numeric_limits<std::int64_t>::max();
  const auto bits = std::bit_cast<std::int64_t>(number);
  return bits >= 0 ? bits : std::numeric_limits<std::int64_t>::min() - bits - 1;
}
double number_of(std::int64_t key) {
  if (key == std::numeric_limits<std::int64_t>::max())
    return std::numeric_limits<double>::quiet_NaN();
  return std::bit_cast<double>(key >= 0 ? key : std::numeric_limits<std::int64_t>::min() - key - 1);
}

int length_of(const std::vector<std::byte>& bytes) {
  if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw std::length_error("a letter between ranks has more than 2 GiB: give more ranks");
  return static_cast<int>(bytes.size());
}

void wait_for(std::vector<MPI_Request>& requests) {
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  requests.clear();
}

}  // namespace

MpiComm::MpiComm(MPI_Comm users, std::size_t piece) : piece_(piece) {
  MPI_Comm_dup(users, &comm_);
  MPI_Comm_dup(users, &failed_);
  // mpi4py has errors returned, and its communicators hand that on; none is looked at here.
  MPI_Comm_set_errhandler(comm_, MPI_ERRORS_ARE_FATAL);
  MPI_Comm_set_errhandler(failed_, MPI_ERRORS_ARE_FATAL);
  MPI_Comm_rank(comm_, &rank_);
  MPI_Comm_size(comm_, &size_);
}

MpiComm::~MpiComm() {
  int ended = 0;
  MPI_Finalized(&ended);
  if (ended != 0) return;
  for (auto& [mail, requests] : sending_) wait_for(requests);
  MPI_Comm_free(&comm_);
  MPI_Comm_free(&failed_);
}

void MpiComm::all_max(std::span<double> numbers) {
  std::vector<std::int64_t> keys;
  keys.reserve(numbers.size());
  for (const double number : numbers) keys.push_back(key_of(number));
  MPI_Allreduce(MPI_IN_PLACE, keys.data(), static_cast<int>(keys.size()), MPI_INT64_T, MPI_MAX,
                comm_);
  for (std::size_t k = 0; k < keys.size(); ++k) numbers[k] = number_of(keys[k]);
}

void MpiComm::all_sum(std::span<std::int64_t> numbers) {
  MPI_Allreduce(MPI_IN_PLACE, numbers.data(), static_cast<int>(numbers.size()), MPI_INT64_T,
                MPI_SUM, comm_);
}

void MpiComm::start(Mail& mail) {
  release(mail);
  std::vector<MPI_Request>&receiving = receiving_[&mail], &sending = sending_[&mail];
  for (Letter& letter : mail.in)
    MPI_Irecv(letter.bytes.data(), length_of(letter.bytes), MPI_BYTE, letter.rank, expected, comm_,
              &receiving.emplace_back());
  for (const Letter& letter : mail.out)
    MPI_Isend(letter.bytes.data(), length_of(letter.bytes), MPI_BYTE, letter.rank, expected, comm_,
              &sending.emplace_back());
}

void MpiComm::finish(Mail& mail) {
  std::vector<MPI_Request>& receiving = receiving_[&mail];
  std::vector<MPI_Status> statuses(receiving.size());
  MPI_Waitall(static_cast<int>(receiving.size()), receiving.data(), statuses.data());
  receiving.clear();
  for (std::size_t k = 0; k < statuses.size(); ++k) {
    int length = 0;
    MPI_Get_count(&statuses[k], MPI_BYTE, &length);
    if (length != length_of(mail.in[k].bytes))
      throw std::logic_error("a letter has another length than was agreed");
  }
}

void MpiComm::release(Mail& mail) { wait_for(sending_[&mail]); }

void MpiComm::exchange(Mail& mail) {
  // No rank is more than a round ahead: two tags keep apart what comes in this one and the next.
  const int tag = unexpected + (round_++ & 1);
  std::vector<MPI_Request> sent;
  for (const Letter& letter : mail.out)
    for (std::size_t at = 0; at == 0 || at < letter.bytes.size(); at += piece_)
      MPI_Issend(letter.bytes.data() + at,
                 static_cast<int>(std::min(piece_, letter.bytes.size() - at)), MPI_BYTE,
                 letter.rank, tag, comm_, &sent.emplace_back());
  mail.in.clear();
  MPI_Request all_taken = MPI_REQUEST_NULL;
  for (int done = 0; done == 0;) {
    int here = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, tag, comm_, &here, &status);
    if (here != 0) {
      int length = 0;
      MPI_Get_count(&status, MPI_BYTE, &length);
      // Pieces of a letter come one behind another.
      auto letter = std::ranges::find(mail.in, status.MPI_SOURCE, &Letter::rank);
      if (letter == mail.in.end()) letter = mail.in.insert(letter, Letter{status.MPI_SOURCE, {}});
      MPI_Recv(extend(*letter, static_cast<std::size_t>(length)), length, MPI_BYTE, letter->rank,
               tag, comm_, MPI_STATUS_IGNORE);
    }
    if (all_taken != MPI_REQUEST_NULL) {
      MPI_Test(&all_taken, &done, MPI_STATUS_IGNORE);
      continue;
    }
    // All that this rank has sent is being received: it has nothing to wait for but the others.
    int taken = 0;
    MPI_Testall(static_cast<int>(sent.size()), sent.data(), &taken, MPI_STATUSES_IGNORE);
    if (taken != 0) MPI_Ibarrier(comm_, &all_taken);
  }
  std::ranges::sort(mail.in, {}, &Letter::rank);
}

void MpiComm::fail(const std::string& why) {
  MPI_Request all = MPI_REQUEST_NULL;
  MPI_Ibarrier(failed_, &all);
  const auto last = std::chrono::steady_clock::now() + patience;
  for (int done = 0; done == 0;) {
    MPI_Test(&all, &done, MPI_STATUS_IGNORE);
    if (done != 0) return;
    if (std::chrono::steady_clock::now() > last) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  std::fprintf(stderr, "mpm3dpp: error: rank %d cannot go on, and with it the run: %s\n", rank_,
               why.c_str());
  std::fflush(stderr);
  MPI_Abort(comm_, 1);
}

}  // namespace mpm
