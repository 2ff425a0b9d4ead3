#pragma once
// The state of a run as a stream of bytes. One function says what belongs to it, for both ways, so
// that what is saved and what is restored cannot differ.
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <functional>
#include <limits>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "mpm/comm/all_sums.hpp"

namespace mpm {

/// All functions are called by all ranks, in the same order. What is saved is what rank 0 has; what
/// is restored is what it gets, on all ranks.
class StateStream {
 public:
  /// Takes bytes when a state is saved, gives them when it is restored, and returns how many.
  /// Called by rank 0 alone.
  using Transfer = std::function<std::size_t(std::span<std::byte>)>;
  enum class Way { save, restore };

  /// `size`: how many bytes there are, when restoring; that of rank 0 counts.
  StateStream(Way way, const Transfer& transfer, Comm& comm,
              std::size_t size = std::numeric_limits<std::size_t>::max())
      : way_(way), transfer_(transfer), comm_(comm), left_(size) {
    broadcast(comm, 0, left_);
  }

  bool restores() const { return way_ == Way::restore; }
  Comm& comm() const { return comm_; }

  template <class... T>
  void operator()(T&... values) {
    (one(values), ...);
  }
  /// As many values as there are, when restoring too. Throws std::invalid_argument if there are not
  /// so many bytes.
  template <class T>
  void array(std::span<T> values) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_const_v<T>);
    const auto bytes = std::as_writable_bytes(values);
    if (bytes.empty()) return;
    if (!restores()) {
      save(bytes);
      return;
    }
    check(bytes.size() <= left_, "it ends too early");
    left_ -= bytes.size();
    for (std::size_t at = 0; at < bytes.size(); at += most)
      restore(bytes.subspan(at, std::min(most, bytes.size() - at)));
  }
  /// The length of a vector, which when restoring then holds values to be filled, each from `each`
  /// bytes at least. Throws std::invalid_argument if there are not so many bytes.
  template <class T>
  void length(std::vector<T>& values, std::size_t each) {
    std::size_t n = values.size();
    (*this)(n);
    if (!restores()) return;
    check(n <= left_ / each, "it ends too early");
    values.clear();
    values.resize(n);
  }
  template <class T>
  void vector(std::vector<T>& values) {
    length(values, sizeof(T));
    array(std::span<T>(values));
  }
  /// Throws std::invalid_argument with the sentence, unless a condition holds: what is restored may
  /// be anything. All ranks must find the same.
  static void check(bool holds, const char* sentence) {
    if (!holds) throw std::invalid_argument(sentence);
  }
  /// The same of a condition that each rank finds for what it has.
  void check_all(bool holds, const char* sentence) const {
    check(!any_of_all(comm_, !holds), sentence);
  }
  /// The same unless a flag, among bytes that were restored as they are, is 0 or 1.
  static void check_flag(const bool& flag) {
    std::uint8_t byte;
    std::memcpy(&byte, &flag, 1);
    check(byte <= 1, "it is damaged");
  }
  /// Throws std::invalid_argument unless all has been restored that there is; or what kept rank 0
  /// from saving, on the others std::runtime_error.
  void end() {
    if (restores()) {
      check(left_ == 0, "it is too long");
      return;
    }
    const bool failed = any_of_all(comm_, error_ != nullptr);
    if (error_) std::rethrow_exception(error_);
    if (failed) throw std::runtime_error("rank 0 could not write the checkpoint");
  }
  /// A value that must be the same in the run that is restored. Throws std::invalid_argument with
  /// the sentence, if it is not.
  template <class T>
  void same(const T& value, const char* sentence) {
    T found = value;
    (*this)(found);
    check(found == value, sentence);
  }

 private:
  static constexpr std::size_t most = std::size_t{1} << 20;  // bytes that pass at once

  template <class T>
  void one(T& value) {
    array(std::span<T>(&value, 1));
  }
  /// A byte that is no bool must not become one.
  void one(bool& value) {
    std::uint8_t byte = value ? 1 : 0;
    array(std::span(&byte, 1));
    check(byte <= 1, "it is damaged");
    value = byte == 1;
  }
  /// The others go on until all learn in end() that it has failed.
  void save(std::span<std::byte> bytes) {
    if (comm_.rank() != 0 || error_) return;
    try {
      if (transfer_(bytes) != bytes.size()) throw std::invalid_argument("not all of it was taken");
    } catch (...) {
      error_ = std::current_exception();
    }
  }
  void restore(std::span<std::byte> bytes) {
    if (comm_.rank() == 0) {
      try {
        if (transfer_(bytes) != bytes.size()) throw std::invalid_argument("it ends too early");
      } catch (...) {
        error_ = std::current_exception();
      }
    }
    std::vector<std::byte> told;
    if (comm_.rank() == 0 && !error_) told.assign(bytes.begin(), bytes.end());
    broadcast(comm_, 0, told);
    if (error_) std::rethrow_exception(error_);
    check(told.size() == bytes.size(), "it ends too early");
    std::ranges::copy(told, bytes.begin());
  }

  Way way_;
  const Transfer& transfer_;
  Comm& comm_;
  std::size_t left_;
  std::exception_ptr error_;
};

}  // namespace mpm
