#pragma once
// A setting of a case: written once, as a member of its table's struct and a row of `settings`
// there. Bindings, checks, the case's fields and the reference page are loops over these rows.
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>

#include "mpm/catalogue/rule.hpp"
#include "mpm/catalogue/words.hpp"

namespace mpm {

/// A row. The member's start is the default; one that its own rule forbids must be given.
template <class Table, class Value>
struct Setting {
  std::string_view name;
  Value Table::* member;
  std::string_view meaning;
  Rule rule = Rule::any;           // of a number
  std::string_view unit = {};      // of a number; empty for none
  std::string_view formerly = {};  // its name before, which cases may have for one release more
};

/// A table of a case: its name, and the rows.
template <class T>
concept SettingsTable = requires {
  { T::table } -> std::convertible_to<std::string_view>;
  T::settings;
};

/// f(row) for each setting of a table, in the order in which one writes them.
template <SettingsTable Table, class F>
void for_each_setting(F&& f) {
  std::apply([&](const auto&... row) { (f(row), ...); }, Table::settings);
}

template <class Value>
inline constexpr bool is_number = std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool>;

/// Must it be given? The default is none then.
template <class Table, class Value>
bool is_required(const Setting<Table, Value>& setting) {
  if constexpr (is_number<Value>)
    return !setting.rule.allows(static_cast<double>(Table{}.*setting.member));
  else
    return false;
}

/// Throws std::invalid_argument, in one sentence, for the first number that breaks its rule.
template <SettingsTable Table>
void check_settings(const Table& table) {
  for_each_setting<Table>([&]<class Value>(const Setting<Table, Value>& setting) {
    const auto check = [&](auto value) {
      if (!setting.rule.allows(static_cast<double>(value)))
        throw std::invalid_argument(std::string(Table::table) + "." + std::string(setting.name) +
                                    " = " + std::to_string(value) + ' ' + setting.rule.text());
    };
    const Value& value = table.*setting.member;
    if constexpr (is_number<Value>) {
      check(value);
    } else if constexpr (requires { value.has_value(); }) {
      if (value) check(*value);
    }
  });
}

}  // namespace mpm
