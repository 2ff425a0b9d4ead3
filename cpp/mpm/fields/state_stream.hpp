#pragma once
// The state of a run as a stream of bytes. One function says what belongs to it, for both ways, so
// that what is saved and what is restored cannot differ.
#include <cstddef>
#include <functional>
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

  StateStream(Way way, const Transfer& transfer) : way_(way), transfer_(transfer) {}

  bool restores() const { return way_ == Way::restore; }

  template <class... T>
  void operator()(T&... values) {
    (array(std::span<T>(&values, 1)), ...);
  }
  /// As many values as there are, when restoring too. Throws std::invalid_argument if not all of
  /// them pass.
  template <class T>
  void array(std::span<T> values) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_const_v<T>);
    const auto bytes = std::as_writable_bytes(values);
    if (!bytes.empty() && transfer_(bytes) != bytes.size())
      throw std::invalid_argument(restores() ? "it ends too early" : "not all of it was taken");
  }
  /// The length of a vector, which when restoring then holds values to be filled.
  template <class T>
  void length(std::vector<T>& values) {
    std::size_t n = values.size();
    (*this)(n);
    if (!restores()) return;
    values.clear();
    values.resize(n);
  }
  template <class T>
  void vector(std::vector<T>& values) {
    length(values);
    array(std::span<T>(values));
  }
  /// A value that must be the same in the run that is restored. Throws std::invalid_argument with
  /// the sentence, if it is not.
  template <class T>
  void same(const T& value, const char* sentence) {
    T found = value;
    (*this)(found);
    if (!(found == value)) throw std::invalid_argument(sentence);
  }

 private:
  Way way_;
  const Transfer& transfer_;
};

}  // namespace mpm
