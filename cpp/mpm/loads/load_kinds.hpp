#pragma once
// What loads on surfaces do: every kind, one file and one line in `LoadKinds`.
#include <cstdint>

#include "mpm/catalogue/choice_list.hpp"
#include "mpm/loads/kinds/point_force.hpp"
#include "mpm/loads/kinds/pressure.hpp"
#include "mpm/loads/kinds/traction.hpp"

namespace mpm {

/// A load by a value that is a function of time, a number or a vector: its force [N] on a piece of
/// the surface with an outward area vector and an area [m^2], which at an edge of the body is more
/// than the vector's length. Of a kind that acts at a point: on a particle, with no area vector and
/// the share of the force in place of an area.
template <class T>
concept LoadModel = requires(Vec<double, 3> vector, double area) {
  { T::name } -> std::convertible_to<std::string_view>;  // the key in a case
  { T::doc } -> std::convertible_to<std::string_view>;
  { T::unit } -> std::convertible_to<std::string_view>;  // of the value
  { T::is_vector } -> std::convertible_to<bool>;
  { T::force(vector, vector, area) } -> std::same_as<Vec<double, 3>>;
};

/// Does it act at a point? A kind says so by `is_at_point`.
template <class T>
inline constexpr bool acts_at_point = requires { requires T::is_at_point; };

enum class LoadKind : std::uint8_t {};
template <LoadModel... T>
using LoadList = ChoiceList<LoadKind, T...>;
using LoadKinds = LoadList<Pressure, Traction, PointForce>;
template <>
inline constexpr auto words<LoadKind> = LoadKinds::words_of();

}  // namespace mpm
