#pragma once
// One bit for each node of a block.
#include "mpm/layout/block_shape.hpp"

namespace mpm {

/// 64 bits from bit n on; the word after that of bit n is read too.
inline std::uint64_t bits_from(const std::uint64_t* words, int n) {
  const std::uint64_t* word = words + n / 64;
  const int shift = n % 64;
  // A shift by 64 is undefined, hence the condition.
  return word[0] >> shift | (shift ? word[1] << (64 - shift) : 0);
}
/// The lowest n bits, n < 64.
constexpr std::uint64_t low_bits(int n) { return (std::uint64_t{1} << n) - 1; }

template <int D>
class NodeBits {
 public:
  bool operator[](int node) const { return words_[word(node)] >> node % 64 & 1u; }
  /// Those of `count` nodes from a node on.
  std::uint64_t row(int node, int count) const {
    return bits_from(words_.data(), node) & low_bits(count);
  }
  /// Set the bits of the first `count` nodes, and no others.
  void fill(int count) {
    words_.fill(0);
    for (int n = 0; n < count; n += 64)
      words_[word(n)] = count - n < 64 ? low_bits(count - n) : ~std::uint64_t{0};
  }
  void set_row(int node, int count) {
    words_[word(node)] |= low_bits(count) << node % 64;
    if (node % 64 + count > 64) words_[word(node) + 1] |= low_bits(count) >> (64 - node % 64);
  }
  void clear_row(int node, int count) {
    words_[word(node)] &= ~(low_bits(count) << node % 64);
    // Rows have fewer than 64 nodes, so that they lie in two words at most.
    if (node % 64 + count > 64) words_[word(node) + 1] &= ~(low_bits(count) >> (64 - node % 64));
  }

 private:
  static std::size_t word(int node) { return static_cast<std::size_t>(node / 64); }
  // One word more than needed, for rows that are read across the end.
  std::array<std::uint64_t, BlockShape<D>::nodes_max / 64 + 2> words_{};
};

}  // namespace mpm
