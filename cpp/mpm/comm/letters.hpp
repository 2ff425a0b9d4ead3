#pragma once
// What letters hold: numbers one behind another.
#include <cstring>
#include <type_traits>

#include "mpm/comm/comm.hpp"

namespace mpm {

/// The letter to a rank, a new one if there is none yet. Few ranks are written to at once.
inline Letter& letter_to(Mail& mail, int rank) {
  for (Letter& letter : mail.out)
    if (letter.rank == rank) return letter;
  mail.out.push_back({rank, {}});
  return mail.out.back();
}

template <class T>
  requires std::is_trivially_copyable_v<T>
void write(Letter& letter, const T& value) {
  const std::size_t at = letter.bytes.size();
  letter.bytes.resize(at + sizeof(T));
  std::memcpy(&letter.bytes[at], &value, sizeof(T));
}

/// Reads what was written, in the same order.
class Reader {
 public:
  explicit Reader(const Letter& letter) : bytes_(letter.bytes) {}
  bool done() const { return bytes_.empty(); }
  template <class T>
    requires std::is_trivially_copyable_v<T>
  T read() {
    if (bytes_.size() < sizeof(T)) throw std::logic_error("a letter ends too early");
    T value;
    std::memcpy(&value, bytes_.data(), sizeof(T));
    bytes_ = bytes_.subspan(sizeof(T));
    return value;
  }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace mpm
