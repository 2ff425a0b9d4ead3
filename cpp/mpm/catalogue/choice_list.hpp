#pragma once
// A list of types to choose from at run time, one line in all: each has a name and a text.
#include <array>
#include <type_traits>

#include "mpm/catalogue/words.hpp"

namespace mpm {

/// `Id` is an enumeration without names: a type's place in the list.
template <class Id, class... T>
struct ChoiceList {
  static constexpr int count = sizeof...(T);

  template <class One>
  static constexpr Id id_of() {
    int k = 0, found = -1;
    ((std::is_same_v<One, T> ? found = k++ : k++), ...);
    return static_cast<Id>(found);
  }
  /// The name and text of each, and its place.
  static constexpr std::array<Word<Id>, sizeof...(T)> words_of() {
    return {Word<Id>{T::name, id_of<T>(), T::doc}...};
  }
  /// f(id, T(given...)) for each.
  template <class F, class... Given>
  static void for_each(F&& f, Given... given) {
    int k = 0;
    (f(static_cast<Id>(k++), T(given...)), ...);
  }
  /// f(T(given...)) for the one that was chosen.
  template <class F, class... Given>
  [[gnu::always_inline]] static void with(Id id, F&& f, Given... given) {
    int k = 0;
    ((static_cast<int>(id) == k++ ? static_cast<void>(f(T(given...))) : void()), ...);
  }
};

}  // namespace mpm
