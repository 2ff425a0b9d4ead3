#pragma once
// Choices of the contact law.
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "mpm/catalogue/setting.hpp"
#include "mpm/contact/detection.hpp"
#include "mpm/contact/normal.hpp"
#include "mpm/contact/response.hpp"

namespace mpm {

/// What is chosen for the bodies of two groups.
struct PairLaw {
  double friction = 0.0;     // coefficient of friction
  bool bonded = false;       // they stick together wherever they meet
  double pressed = 0.0;      // depth to which they push each other from the start [m]
  double restitution = 1.0;  // speed of parting over that of approach
};

struct ContactSettings {
  bool enabled = true;
  bool bonded = false;
  Detection detection = Detections::id_of<GapDetection>();
  NormalRule normal = NormalRules::id_of<PlaneNormal>();
  Response response = Response::springs;
  double friction = 0.0, restitution = 1.0;
  double gap_distance = 0.0;  // D of eq. (5)
  double normal_refresh_distance =
      0.0;  // beyond a quarter a pair found apart could meet along another normal
  std::vector<std::pair<std::uint64_t, PairLaw>> pair_laws;  // by pair_key of groups, sorted

  static constexpr std::string_view table = "contact";
  using Self = ContactSettings;
  static constexpr auto settings = std::tuple{
      Setting{"enabled", &Self::enabled, "without contact the bodies do not see each other"},
      Setting{"bonded", &Self::bonded,
              "all bodies have one velocity field, so that they stick together wherever they meet, "
              "as one body of several materials; nothing else of this table then matters"},
      Setting{"detection", &Self::detection,
              "\"gap\" (touching and approaching) or \"velocity\" (approaching only)"},
      Setting{"normal", &Self::normal,
              "direction of impulses: \"plane\" (separates the two bodies' points), or from "
              "gradients of mass, of both (\"pair\") or one (\"first\", \"second\", \"stiffer\"); "
              "springs act along the normals of the surfaces"},
      Setting{"response", &Self::response,
              "\"springs\" (particles push a body whose surface they overlap), \"impulses\" "
              "(approach is stopped at the nodes; the default without an affine transfer) or "
              "\"by_matter\" (springs, but impulses where a gas meets others or liquids each "
              "other; the default where a body flows); walls that are \"contact\" do "
              "the same, but for liquids, whose approach they stop"},
      Setting{"friction", &Self::friction, "Coulomb coefficient of all pairs not listed in `pair`",
              Rule::not_negative},
      Setting{
          "restitution", &Self::restitution,
          "of surfaces that touch each other by contact points (frame = \"material\"): the speed "
          "with which two bodies part over that with which they came, of those that are elastic",
          Rule::share},
      Setting{"gap_distance", &Self::gap_distance, "bodies closer than this touch [m]",
              Rule::not_negative, "m"},
      Setting{"normal_refresh_distance",
              &Self::normal_refresh_distance,
              "the direction and gap of a contact are found anew when its two bodies together have "
              "moved this far [cells]; 0: in every step. 0.1 saves half of the time of contact "
              "where grains move little, and costs one or two per cent of accuracy",
              Rule{0.0, 0.25, false, false},
              {},
              "normal_travel"}};
};

/// One number for an unordered pair of bodies or of groups of bodies.
inline std::uint64_t pair_key(int a, int b) {
  const auto low = static_cast<std::uint64_t>(std::min(a, b)),
             high = static_cast<std::uint64_t>(std::max(a, b));
  return low << 32 | high;
}

inline void set_law(ContactSettings& settings, int a, int b, const PairLaw& law) {
  const std::uint64_t key = pair_key(a, b);
  auto& list = settings.pair_laws;
  const auto at =
      std::ranges::lower_bound(list, key, {}, &std::pair<std::uint64_t, PairLaw>::first);
  if (at != list.end() && at->first == key)
    at->second = law;
  else
    list.insert(at, {key, law});
}

/// Between bodies of two groups, or between bodies of one.
inline PairLaw law_of(const ContactSettings& settings, int a, int b) {
  const std::uint64_t key = pair_key(a, b);
  const auto& list = settings.pair_laws;
  const auto at =
      std::ranges::lower_bound(list, key, {}, &std::pair<std::uint64_t, PairLaw>::first);
  return at != list.end() && at->first == key
             ? at->second
             : PairLaw{settings.friction, false, 0.0, settings.restitution};
}

/// Are any pairs bonded?
inline bool bonds(const ContactSettings& settings) {
  return std::ranges::any_of(settings.pair_laws, [](const auto& x) { return x.second.bonded; });
}

}  // namespace mpm
