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

/// Room for so many bytes more at the end of a letter.
inline std::byte* extend(Letter& letter, std::size_t bytes) {
  const std::size_t at = letter.bytes.size();
  letter.bytes.resize(at + bytes);
  return letter.bytes.data() + at;
}

template <class T>
  requires std::is_trivially_copyable_v<T>
void write(Letter& letter, const T& value) {
  std::memcpy(extend(letter, sizeof(T)), &value, sizeof(T));
}

template <class T>
void write_all(Letter& letter, std::span<const T> values) {
  if (values.empty()) return;
  std::memcpy(extend(letter, values.size_bytes()), values.data(), values.size_bytes());
}

/// values[row] of each row.
template <class T>
void write_rows(Letter& letter, const T* values, std::span<const std::uint32_t> rows) {
  std::byte* to = extend(letter, rows.size() * sizeof(T));
  for (const std::uint32_t row : rows) {
    std::memcpy(to, &values[row], sizeof(T));
    to += sizeof(T);
  }
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
  template <class T>
  void read_rows(T* values, std::span<const std::uint32_t> rows) {
    for (const std::uint32_t row : rows) values[row] = read<T>();
  }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace mpm
