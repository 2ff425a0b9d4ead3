#pragma once
// Every basis, one line in all. From it come the case's words, checks and documentation.
#include <algorithm>
#include <cstdint>

#include "mpm/basis/gimp.hpp"
#include "mpm/basis/linear.hpp"
#include "mpm/basis/quadratic_bspline.hpp"
#include "mpm/catalogue/choice_list.hpp"

namespace mpm {

/// Which basis: its place in `Bases`.
enum class BasisId : std::uint8_t {};

/// Nodes that a cell's particles reach before and after its own, and where that lies in the cell.
struct Reach {
  int before, after;
  double own_node;
};

template <BasisModel... B>
struct BasisList : ChoiceList<BasisId, B...> {
  static constexpr int before_max = std::max({B::before...});
  static constexpr int after_max = std::max({B::nodes - 1 - B::before...});
  static constexpr Reach reach(BasisId id) {
    return value_at(id, Reach{B::before, B::nodes - 1 - B::before, B::own_node}...);
  }
  static constexpr bool odd_at_fixed_walls(BasisId id) {
    return value_at(id, B::odd_at_fixed_walls...);
  }
  static constexpr double second_moment(BasisId id) { return value_at(id, B::second_moment...); }

  /// f(basis of particles with that edge [cells]).
  template <class F>
  static void with(BasisId id, double edge, F&& f) {
    ChoiceList<BasisId, B...>::with(id, f, edge);
  }
  /// f(id, basis) for each, of particles of half a cell.
  template <class F>
  static void for_each(F&& f) {
    ChoiceList<BasisId, B...>::for_each(f, 0.5);
  }

 private:
  /// By comparison: a device reads no table of the host's.
  template <class Value, class... Rest>
  static constexpr Value value_at(BasisId id, Value first, Rest... rest) {
    if constexpr (sizeof...(rest) == 0)
      return first;
    else
      return id == BasisId{} ? first
                             : value_at(static_cast<BasisId>(static_cast<int>(id) - 1), rest...);
  }
};

using Bases = BasisList<Gimp, Linear, QuadraticBSpline>;

template <BasisModel B>
inline constexpr BasisId basis_id = Bases::id_of<B>();

template <>
inline constexpr auto words<BasisId> = Bases::words_of();

constexpr Reach reach_of(BasisId id) { return Bases::reach(id); }

constexpr bool odd_at_fixed_walls(BasisId id) { return Bases::odd_at_fixed_walls(id); }

/// D of APIC along an axis: the sum of N_i (x_i - x)^2 over the nodes [cells^2], if it is the same
/// at all places; else 0.
constexpr double second_moment(BasisId id) { return Bases::second_moment(id); }

/// Half the width of the box over which a particle's function is the mean of the hat [cells], from
/// the particles' edge at the start [cells].
inline double half_width(BasisId id, double edge) {
  double half = 0.0;
  Bases::with(id, edge, [&](const auto& basis) { half = basis.half_width(); });
  return half;
}
/// Distance along an axis at which a particle's function ends [cells]: the hat's own reach and that
/// of the box over which it is averaged.
inline double support(BasisId id, double edge) { return 1.0 + half_width(id, edge); }

}  // namespace mpm
