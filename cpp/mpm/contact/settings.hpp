#pragma once
// Choices of the contact law.
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace mpm {

/// gap: bodies touch when they approach and their distance, eq. (5), is below `gap_distance`.
/// velocity: when they approach.
enum class Detection { gap, velocity };

/// The normal of a pair: that of the plane which separates their particles, or from gradients of
/// mass: of both bodies (n_r - n_s), of the first, of the second, or of the stiffer.
enum class NormalRule { plane, pair, first, second, stiffer };

struct ContactSettings {
  bool enabled = false;
  Detection detection = Detection::gap;
  NormalRule normal = NormalRule::plane;
  double gap_distance = 0.0;  // D of eq. (5) [m]
  // A normal and a gap are found anew when the two bodies together have moved by this [cells].
  double normal_travel = 0.0;
  double friction = 0.0;                                        // default coefficient
  std::vector<std::pair<std::uint64_t, double>> pair_friction;  // by pair_key of groups, sorted
};

/// One number for an unordered pair of bodies or of groups of bodies.
inline std::uint64_t pair_key(int a, int b) {
  const auto low = static_cast<std::uint64_t>(std::min(a, b)),
             high = static_cast<std::uint64_t>(std::max(a, b));
  return low << 32 | high;
}

inline void set_friction(ContactSettings& settings, int a, int b, double mu) {
  const std::uint64_t key = pair_key(a, b);
  auto& list = settings.pair_friction;
  const auto at = std::lower_bound(list.begin(), list.end(), key,
                                   [](const auto& x, std::uint64_t k) { return x.first < k; });
  if (at != list.end() && at->first == key) {
    at->second = mu;
  } else {
    list.insert(at, {key, mu});
  }
}

/// Coefficient between bodies of two groups, or between bodies of one.
inline double friction(const ContactSettings& settings, int a, int b) {
  const std::uint64_t key = pair_key(a, b);
  const auto& list = settings.pair_friction;
  const auto at = std::lower_bound(list.begin(), list.end(), key,
                                   [](const auto& x, std::uint64_t k) { return x.first < k; });
  return at != list.end() && at->first == key ? at->second : settings.friction;
}

}  // namespace mpm
