// Formulas: every operation against its own function, any number of lanes, and what is no program.
#include "check.hpp"
#include "mpm/math/expression.hpp"

void test_expression(mpm::testing::Report& report) {
  using mpm::Expression;
  using Program = Expression::Program;
  // For each operation a number, or two, and what comes out: by hand, or by its own function.
  const double a = 0.7, b = -1.3;
  const std::vector<std::pair<std::string, double>> values{{"add", a + b},
                                                           {"subtract", a - b},
                                                           {"multiply", a * b},
                                                           {"divide", a / b},
                                                           {"negate", -a},
                                                           {"pow", std::pow(a, b)},
                                                           {"sin", std::sin(a)},
                                                           {"cos", std::cos(a)},
                                                           {"tan", std::tan(a)},
                                                           {"asin", std::asin(a)},
                                                           {"acos", std::acos(a)},
                                                           {"atan", std::atan(a)},
                                                           {"atan2", std::atan2(a, b)},
                                                           {"sinh", std::sinh(a)},
                                                           {"cosh", std::cosh(a)},
                                                           {"tanh", std::tanh(a)},
                                                           {"exp", std::exp(a)},
                                                           {"log", std::log(a)},
                                                           {"sqrt", std::sqrt(a)},
                                                           {"abs", a},
                                                           {"min", b},
                                                           {"max", a}};
  CHECK_EQUAL(values.size(), mpm::operations.size());
  for (const auto& [name, wanted] : values) {
    const auto found = std::ranges::find(mpm::operations, name, &mpm::Operation::name);
    CHECK(found != mpm::operations.end());
    Program program{{"x", 0.0}};
    if (found->operands == 2) program.emplace_back("number", b);
    program.emplace_back(name, 0.0);
    // The compiler works `wanted` out, exactly rounded; the library may miss by the last bit.
    CHECK_CLOSE(mpm::evaluate_rows(Expression(program), {"x"}, std::array{a}, 1)[0], wanted, 1e-15);
  }
  // 2 x - t / y: more rows than lanes, each the same bits as alone.
  const Expression f(Program{{"number", 2.0},
                             {"x", 0.0},
                             {"multiply", 0.0},
                             {"t", 0.0},
                             {"y", 0.0},
                             {"divide", 0.0},
                             {"subtract", 0.0}});
  CHECK(f.is_of("x") && f.is_of("t") && !f.is_of("X") && !f.is_of("sin"));
  const std::size_t n = 2 * Expression::lanes + 5;
  std::vector<double> rows(3 * n);
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = 0.1 + 0.01 * static_cast<double>(k);
  const std::vector<double> all = mpm::evaluate_rows(f, {"x", "y", "t"}, rows, n);
  for (std::size_t k = 0; k < n; ++k)
    CHECK_EQUAL(all[k], 2.0 * rows[k] - rows[2 * n + k] / rows[n + k]);
  // What is not a number stays so, on either side.
  for (const char* name : {"min", "max"})
    for (const bool first : {true, false}) {
      const double none = std::sqrt(-1.0);
      const Program program{{"x", 0.0}, {"y", 0.0}, {name, 0.0}};
      const std::array<double, 2> row{first ? none : 1.0, first ? 1.0 : none};
      CHECK(std::isnan(mpm::evaluate_rows(Expression(program), {"x", "y"}, row, 1)[0]));
    }
  const auto refused = [&](const Program& program, std::string_view part) {
    CHECK(mpm::testing::throws([&] { Expression made(program); }, part));
  };
  refused({}, "must come to one number");
  refused({{"x", 0.0}, {"y", 0.0}}, "must come to one number");
  refused({{"x", 0.0}, {"add", 0.0}}, "lacks an operand of add");
  refused({{"xx", 0.0}}, "the word xx, which is not known");
  refused({{"number", 1.0 / 0.0}}, "must have finite numbers");
  refused(Program(Expression::most_deep + 1, {"x", 0.0}), "nested too deeply");
  CHECK(mpm::testing::throws([&] { mpm::evaluate_rows(f, {"u"}, rows, 1); }, "must be (variables"));
}
