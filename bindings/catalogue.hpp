#pragma once
// Tables of the core as Python sees them: loops over their rows.
#include "mpm/catalogue/setting.hpp"
#include "mpm/math/time_function.hpp"
#include "translate.hpp"

namespace mpm::bindings {

inline nb::str text(std::string_view s) { return nb::str(s.data(), s.size()); }

/// Lower and upper bound of a rule, and whether they are open.
inline nb::tuple bounds_of(const Rule& rule) {
  return nb::make_tuple(rule.lower, rule.upper, rule.lower_open, rule.upper_open);
}

/// The words of a choice: word -> meaning, and other words for the same -> word.
template <Choosable Enum>
nb::tuple words_of() {
  nb::dict meanings, also;
  for (const Word<Enum>& w : words<Enum>) {
    meanings[text(w.word)] = text(w.meaning);
    if (!w.also.empty()) also[text(w.also)] = text(w.word);
  }
  return nb::make_tuple(meanings, also);
}

using FunctionVector = std::array<TimeFunction, 3>;

/// What a setting takes: "number", "whole number", "flag", "word" or "functions of time".
template <class Value>
nb::str kind_of() {
  if constexpr (requires {
                  typename Value::value_type;
                  requires !std::is_same_v<Value, FunctionVector>;
                })
    return kind_of<typename Value::value_type>();  // of an optional
  else if constexpr (std::is_same_v<Value, FunctionVector>)
    return nb::str("functions of time");
  else if constexpr (std::is_same_v<Value, bool>)
    return nb::str("flag");
  else if constexpr (std::is_enum_v<Value>)
    return nb::str("word");
  else
    return nb::str(std::is_integral_v<Value> ? "whole number" : "number");
}

/// A row as a dictionary, with `default` None where there is none.
template <class Table, class Value>
nb::dict row_of(const Setting<Table, Value>& setting) {
  nb::dict row;
  const Value start = Table{}.*setting.member;
  row["kind"] = kind_of<Value>();
  row["meaning"] = text(setting.meaning);
  row["unit"] = text(setting.unit);
  row["rule"] = setting.rule.formula();
  row["bounds"] = bounds_of(setting.rule);
  row["required"] = is_required(setting);
  row["formerly"] = text(setting.formerly);
  row["default"] = nb::none();
  if constexpr (std::is_enum_v<Value>) {
    row["default"] = text(word_of(start));
    row["words"] = words_of<Value>();
  } else if constexpr (std::is_arithmetic_v<Value>) {
    if (!is_required(setting)) row["default"] = nb::cast(start);
  }
  return row;
}

/// A class with the table's settings as attributes (a choice takes its word), and the rows of it in
/// `tables`, by the table's name.
template <SettingsTable Table>
nb::class_<Table> add_table(nb::module_& m, const char* name, nb::dict& tables) {
  nb::class_<Table> made(m, name);
  made.def(nb::init<>());
  nb::dict rows;
  for_each_setting<Table>([&]<class Value>(const Setting<Table, Value>& setting) {
    const std::string key(setting.name);
    const auto member = setting.member;
    rows[key.c_str()] = row_of(setting);
    if constexpr (std::is_enum_v<Value>)
      made.def_prop_rw(
          key.c_str(), [member](const Table& t) { return std::string(word_of(t.*member)); },
          [member, key](Table& t, const std::string& word) {
            t.*member = choice_named<Value>(key, word);
          });
    else
      made.def_rw(key.c_str(), member);
  });
  tables[text(Table::table)] = rows;
  return made;
}

}  // namespace mpm::bindings
