#pragma once
// The words of a choice: each is written once, beside the enum, and the case's checks, messages and
// documentation come from there.
#include <array>
#include <stdexcept>
#include <string>
#include <string_view>

namespace mpm {

template <class Enum>
struct Word {
  std::string_view word;
  Enum value;
  std::string_view meaning;
  std::string_view also = {};  // another word for the same
};

/// The words of an enum that a user chooses from, specialised beside it.
template <class Enum>
inline constexpr std::array<Word<Enum>, 0> words{};

template <class Enum>
concept Choosable = words<Enum>.size() > 0;

template <Choosable Enum>
std::string_view word_of(Enum value) {
  for (const Word<Enum>& w : words<Enum>)
    if (w.value == value) return w.word;
  return "";
}

/// Throws std::invalid_argument for a word that is none of them.
template <Choosable Enum>
Enum choice_named(std::string_view what, std::string_view word) {
  std::string known;
  for (const Word<Enum>& w : words<Enum>) {
    if (w.word == word || (!w.also.empty() && w.also == word)) return w.value;
    known += (known.empty() ? "" : ", ") + std::string(w.word);
  }
  throw std::invalid_argument(std::string(what) + " is " + std::string(word) +
                              ", but must be one of " + known);
}

}  // namespace mpm
