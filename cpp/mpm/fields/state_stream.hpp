#pragma once
// The state of a run as a stream of bytes. One function says what belongs to it, for both ways, so
// that what is saved and what is restored cannot differ.
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <vector>

namespace mpm {

class StateStream {
 public:
  /// Takes bytes when a state is saved, gives them when it is restored, and returns how many.
  using Transfer = std::function<std::size_t(std::span<std::byte>)>;
  enum class Way { save, restore };

  /// `size`: how many bytes there are, when restoring.
  StateStream(Way way, const Transfer& transfer,
              std::size_t size = std::numeric_limits<std::size_t>::max())
      : way_(way), transfer_(transfer), left_(size) {}

  bool restores() const { return way_ == Way::restore; }

  template <class... T>
  void operator()(T&... values) {
    (one(values), ...);
  }
  /// As many values as there are, when restoring too. Throws std::invalid_argument if not all of
  /// them pass.
  template <class T>
  void array(std::span<T> values) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_const_v<T>);
    const auto bytes = std::as_writable_bytes(values);
    if (bytes.empty()) return;
    if (bytes.size() > left_ || transfer_(bytes) != bytes.size())
      throw std::invalid_argument(restores() ? "it ends too early" : "not all of it was taken");
    if (restores()) left_ -= bytes.size();
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
  /// be anything.
  static void check(bool holds, const char* sentence) {
    if (!holds) throw std::invalid_argument(sentence);
  }
  /// The same unless a flag, among bytes that were restored as they are, is 0 or 1.
  static void check_flag(const bool& flag) {
    std::uint8_t byte;
    std::memcpy(&byte, &flag, 1);
    check(byte <= 1, "it is damaged");
  }
  /// Throws std::invalid_argument unless all has been restored that there is.
  void end() const { check(left_ == 0, "it is too long"); }
  /// A value that must be the same in the run that is restored. Throws std::invalid_argument with
  /// the sentence, if it is not.
  template <class T>
  void same(const T& value, const char* sentence) {
    T found = value;
    (*this)(found);
    check(found == value, sentence);
  }

 private:
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

  Way way_;
  const Transfer& transfer_;
  std::size_t left_;
};

}  // namespace mpm
