#pragma once
// Every material model, one line per kind. From it come the case keys, checks, documentation,
// columns and law tests.
#include <variant>

#include "mpm/materials/strength/elastic.hpp"
#include "mpm/materials/strength/j2.hpp"
#include "mpm/materials/strength/neo_hookean.hpp"

namespace mpm {

template <StrengthModel... Models>
struct Catalogue {
  using Any = std::variant<Models...>;
  /// f(model) for a default instance of each.
  template <class F>
  static void for_each(F&& f) {
    (f(Models{}), ...);
  }
};

using StrengthModels = Catalogue<Elastic, J2, NeoHookean>;

}  // namespace mpm
