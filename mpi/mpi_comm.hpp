#pragma once
// Ranks that are processes, by MPI: the one place where its header is read. Messages pass between
// those who expect them, and by the "nonblocking consensus" of Hoefler, Siebert & Lumsdaine (2010)
// to those who do not.
#include <map>

#include <mpi.h>

#include "mpm/comm/comm.hpp"

namespace mpm {

/// On a communicator of its own, made from one that the user has. Called by one thread.
class MpiComm final : public Comm {
 public:
  /// Letters to those who do not expect them go in pieces of so many bytes at most.
  MpiComm(MPI_Comm users, std::size_t piece);
  ~MpiComm() override;

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  void all_max(std::span<double> numbers) override;
  void all_sum(std::span<std::int64_t> numbers) override;
  void start(Mail& mail) override;
  void finish(Mail& mail) override;
  void release(Mail& mail) override;
  void exchange(Mail& mail) override;
  /// Returns once all ranks have called it: then all have failed alike, and may go on. If some do
  /// not within seconds, none can, and the job ends with the sentence.
  void fail(const std::string& why) override;

 private:
  MPI_Comm comm_ = MPI_COMM_NULL, failed_ = MPI_COMM_NULL;
  int rank_ = 0, size_ = 1;
  int round_ = 0;      // of exchange()
  std::size_t piece_;  // bytes
  /// What was started and is not known to have ended, by its mail.
  std::map<const Mail*, std::vector<MPI_Request>> receiving_, sending_;
};

}  // namespace mpm
