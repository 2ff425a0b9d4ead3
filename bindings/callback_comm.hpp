#pragma once
// Ranks by an object of Python, as one around mpi4py: for a machine on which no module was built
// for its MPI. Numbers and letters pass as views of the core's memory.
#include "mpm/comm/comm.hpp"
#include "translate.hpp"

namespace mpm::bindings {

class CallbackComm final : public Comm {
 public:
  explicit CallbackComm(nb::object of)
      : of_(std::move(of)),
        rank_(nb::cast<int>(of_.attr("rank"))),
        size_(nb::cast<int>(of_.attr("size"))) {}
  int rank() const override { return rank_; }
  int size() const override { return size_; }
  void all_max(std::span<double> numbers) override {
    reduce("all_max", std::as_writable_bytes(numbers));
  }
  void all_sum(std::span<std::int64_t> numbers) override {
    reduce("all_sum", std::as_writable_bytes(numbers));
  }
  void start(Mail& mail) override {
    const nb::gil_scoped_acquire lock;
    of_.attr("start")(key_of(mail), views(mail.out), views(mail.in));
  }
  void finish(Mail& mail) override {
    const nb::gil_scoped_acquire lock;
    of_.attr("finish")(key_of(mail));
  }
  void release(Mail& mail) override {
    const nb::gil_scoped_acquire lock;
    of_.attr("release")(key_of(mail));
  }
  void exchange(Mail& mail) override {
    const nb::gil_scoped_acquire lock;
    mail.in.clear();
    for (const nb::handle one : of_.attr("exchange")(views(mail.out))) {
      const auto bytes = nb::cast<nb::bytes>(one[1]);
      const auto* const begin = reinterpret_cast<const std::byte*>(bytes.c_str());
      mail.in.push_back({nb::cast<int>(one[0]), {begin, begin + bytes.size()}});
    }
  }
  void fail(const std::string& why) override {
    const nb::gil_scoped_acquire lock;
    of_.attr("fail")(why);
  }

 private:
  static std::uintptr_t key_of(const Mail& mail) { return reinterpret_cast<std::uintptr_t>(&mail); }
  static nb::object view_of(std::span<std::byte> bytes) {
    return nb::steal(PyMemoryView_FromMemory(reinterpret_cast<char*>(bytes.data()),
                                             static_cast<Py_ssize_t>(bytes.size()), PyBUF_WRITE));
  }
  static nb::list views(std::vector<Letter>& letters) {
    nb::list all;
    for (Letter& letter : letters) all.append(nb::make_tuple(letter.rank, view_of(letter.bytes)));
    return all;
  }
  void reduce(const char* how, std::span<std::byte> numbers) {
    if (numbers.empty()) return;
    const nb::gil_scoped_acquire lock;
    of_.attr(how)(view_of(numbers));
  }

  nb::object of_;
  int rank_, size_;
};

/// The ranks that an object of Python stands for: a capsule of mpm3dpp._comm_mpi, which the caller
/// keeps alive, or what CallbackComm takes.
inline std::shared_ptr<Comm> comm_from(const nb::object& of) {
  if (of.is_none()) return nullptr;
  nb::capsule capsule;
  if (nb::try_cast(of, capsule)) {
    if (capsule.name() == nullptr || std::string_view(capsule.name()) != "mpm::Comm")
      throw std::invalid_argument("comm: that is no communicator of mpm3dpp._comm_mpi");
    return {static_cast<Comm*>(capsule.data()), [of](Comm*) {}};
  }
  return std::make_shared<CallbackComm>(of);
}

}  // namespace mpm::bindings
