// Rules, words and settings: every row of every table has what users and bindings rely on.
#include <cmath>
#include <set>

#include "check.hpp"
#include "mpm/ledger/history.hpp"
#include "mpm/materials/material.hpp"
#include "mpm/run/derived_fields.hpp"
#include "mpm/run/settings.hpp"

namespace {

using namespace mpm;
using mpm::testing::Report;

/// Defaults, and what has none at the least whole number that its rule allows.
template <SettingsTable Table>
Table with_required() {
  Table table;
  for_each_setting<Table>([&]<class Value>(const Setting<Table, Value>& setting) {
    if constexpr (is_number<Value>)
      if (is_required(setting))
        table.*setting.member =
            static_cast<Value>(setting.rule.lower + (setting.rule.lower_open ? 1.0 : 0.0));
  });
  return table;
}

template <SettingsTable Table>
void check_table(Report& report) {
  std::set<std::string_view> names;
  for_each_setting<Table>([&]<class Value>(const Setting<Table, Value>& setting) {
    CHECK(names.insert(setting.name).second, setting.name);
    CHECK(!setting.meaning.empty() && setting.meaning.back() != '.', setting.name);
    if constexpr (is_number<Value>) {
      Table table = with_required<Table>();
      const std::string key = std::string(Table::table) + "." + std::string(setting.name);
      for (const double bad : {setting.rule.lower - 1.0, setting.rule.upper + 1.0}) {
        if (!std::isfinite(bad)) continue;
        table.*setting.member = static_cast<Value>(bad);
        CHECK(mpm::testing::throws([&] { check_settings(table); }, setting.rule.text()), key);
      }
    }
  });
}

template <Choosable Enum>
void check_words(Report& report) {
  for (const Word<Enum>& w : words<Enum>) {
    CHECK(choice_named<Enum>("x", w.word) == w.value, w.word);
    CHECK_EQUAL(word_of(w.value), w.word);
    CHECK(w.also.empty() || choice_named<Enum>("x", w.also) == w.value, w.also);
    CHECK(!w.meaning.empty(), w.word);
  }
  CHECK(mpm::testing::throws([] { choice_named<Enum>("x", "nothing"); },
                             "must be one of " + std::string(words<Enum>[0].word)));
}

}  // namespace

void test_catalogue(Report& report) {
  CHECK_EQUAL(Rule::positive.text(), std::string("must be > 0"));
  CHECK_EQUAL(Rule::fraction.formula(), std::string("0 < f <= 1"));
  CHECK_EQUAL(Rule::fraction.text(), std::string("must lie between 0 and 1, the first excluded"));
  CHECK(Rule::fraction.allows(1.0) && !Rule::fraction.allows(0.0));
  CHECK(!Rule::any.allows(std::nan("")) && !Rule::positive.allows(HUGE_VAL));

  check_table<GridSettings>(report);
  check_table<CoarseningSettings>(report);
  check_table<RunSettings>(report);
  check_table<ContactSettings>(report);
  check_table<ExecutionSettings>(report);
  CHECK(mpm::testing::throws([] { check_settings(GridSettings{}); }, "grid.dimension"));

  check_words<Scheme>(report);
  check_words<BasisId>(report);
  check_words<Wall>(report);
  check_words<Detection>(report);
  check_words<NormalRule>(report);
  check_words<FailureAction>(report);

  std::set<std::string_view> columns;
  for (const HistoryTerm& term : history_terms) {
    CHECK(columns.insert(term.name).second, term.name);
    CHECK(term.part_of.empty() || columns.contains(term.part_of), term.name);
    CHECK(!term.unit.empty() && !term.meaning.empty(), term.name);
  }
  // The roles are those of the balance: each term counts in the residual as its row says.
  Ledger ledger;
  const StepState state{ledger, 0, 0.0, 0.0, 0.0, 0, 0};
  double* const terms[] = {&ledger.kinetic,  &ledger.internal, &ledger.plastic, &ledger.viscous,
                           &ledger.friction, &ledger.contact,  &ledger.springs, &ledger.external,
                           &ledger.absorbed, &ledger.eroded,   &ledger.left,    &ledger.bounded,
                           &ledger.mapping};
  for (double* const term : terms) {
    *term = 1.0;
    double balance = 0.0;
    for (const HistoryTerm& row : history_terms) {
      if (row.role == Role::energy || row.role == Role::error) balance += row.value(state);
      if (row.role == Role::supply) balance -= row.value(state);
    }
    CHECK(std::abs(balance) == 1.0 && balance == ledger.residual(), balance, ledger.residual());
    *term = 0.0;
  }
  // Those of every frame, in the order in which files have them.
  const ParticleState particle{{-3.0, 0.0, 0.0, 0.0, 0.0, 4.0}, {}, 0.25, 1.0, 2};
  const double expected[] = {1.0, std::sqrt(9.0 + 48.0), 0.5};
  for (std::size_t k = 0; k < std::size(expected); ++k)
    CHECK_CLOSE(derived_fields[k].value(particle, 0), expected[k], 1e-15);
}
