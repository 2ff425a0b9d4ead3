#pragma once
// When the bodies of a pair touch, beside that they approach: every rule, one line in `Detections`.
#include <cstdint>

#include "mpm/catalogue/choice_list.hpp"

namespace mpm {

/// Whether bodies at a distance [m] from each other touch, given the setting `gap_distance` [m] and
/// the cell size [m]; without `uses_gap` the distance does not matter.
template <class T>
concept DetectionRule = requires(double length) {
  { T::name } -> std::convertible_to<std::string_view>;
  { T::doc } -> std::convertible_to<std::string_view>;
  { T::uses_gap } -> std::convertible_to<bool>;
  { T::touches(length, length, length) } -> std::same_as<bool>;
};

/// Eq. (5).
struct GapDetection {
  static constexpr std::string_view name = "gap";
  static constexpr std::string_view doc = "their distance, eq. (5), is small and they approach";
  static constexpr bool uses_gap = true;

  /// Bodies that just touch do, as they are often put into a case: rounding must not choose.
  static bool touches(double gap, double gap_distance, double cell_size) {
    constexpr double rounding = 1e-9;  // [cells]; positions are good to 1e-10 at 2^19 cells
    return gap < gap_distance + rounding * cell_size;
  }
};

/// Bardenhagen et al. 2000: wherever their velocity fields overlap.
struct VelocityDetection {
  static constexpr std::string_view name = "velocity";
  static constexpr std::string_view doc = "they approach";
  static constexpr bool uses_gap = false;

  static bool touches(double, double, double) { return true; }
};

enum class Detection : std::uint8_t {};
template <DetectionRule... T>
using DetectionList = ChoiceList<Detection, T...>;
using Detections = DetectionList<GapDetection, VelocityDetection>;
template <>
inline constexpr auto words<Detection> = Detections::words_of();

}  // namespace mpm
