#pragma once
// Formulas that a case gives, of places and of time, as programs in postfix order: operands first,
// then what is done with them. For many particles at once, with the scalar functions of the C++
// library, so that the bits are those of one particle alone, whatever the width of vectors.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace mpm {

/// What a formula may do with one number or two; with one, b is 0.
struct Operation {
  std::string_view name;
  int operands;
  double (*apply)(double a, double b);
};

// Not a number where an operand is none: std::min and std::max may hide it.
inline constexpr auto operations = std::to_array<Operation>({
    {"add", 2, [](double a, double b) { return a + b; }},
    {"subtract", 2, [](double a, double b) { return a - b; }},
    {"multiply", 2, [](double a, double b) { return a * b; }},
    {"divide", 2, [](double a, double b) { return a / b; }},
    {"negate", 1, [](double a, double) { return -a; }},
    {"pow", 2, [](double a, double b) { return std::pow(a, b); }},
    {"sin", 1, [](double a, double) { return std::sin(a); }},
    {"cos", 1, [](double a, double) { return std::cos(a); }},
    {"tan", 1, [](double a, double) { return std::tan(a); }},
    {"asin", 1, [](double a, double) { return std::asin(a); }},
    {"acos", 1, [](double a, double) { return std::acos(a); }},
    {"atan", 1, [](double a, double) { return std::atan(a); }},
    {"atan2", 2, [](double a, double b) { return std::atan2(a, b); }},
    {"sinh", 1, [](double a, double) { return std::sinh(a); }},
    {"cosh", 1, [](double a, double) { return std::cosh(a); }},
    {"tanh", 1, [](double a, double) { return std::tanh(a); }},
    {"exp", 1, [](double a, double) { return std::exp(a); }},
    {"log", 1, [](double a, double) { return std::log(a); }},
    {"sqrt", 1, [](double a, double) { return std::sqrt(a); }},
    {"abs", 1, [](double a, double) { return std::abs(a); }},
    {"min", 2, [](double a, double b) { return a < b || std::isnan(a) ? a : b; }},
    {"max", 2, [](double a, double b) { return a > b || std::isnan(a) ? a : b; }},
});

/// What a formula may be of: present place [m], distance from the mass centre [m], place at the
/// start [m], time [s].
inline constexpr auto expression_variables =
    std::to_array<std::string_view>({"x", "y", "z", "r", "X", "Y", "Z", "t"});

/// A program. An instruction puts a number or a variable on a stack, or an operation takes its
/// operands from there and puts its result.
class Expression {
 public:
  static constexpr std::size_t lanes = 64;      // particles at once
  static constexpr std::size_t most_deep = 32;  // numbers on the stack
  using Lanes = std::array<double, lanes>;
  using Variables = std::array<Lanes, expression_variables.size()>;
  /// A word and a number: "number" and its value, or a variable or an operation by its name.
  using Program = std::vector<std::pair<std::string, double>>;

  /// The number 0.
  Expression() : code_{{Kind::number, 0, 0.0}} {}
  /// Throws std::invalid_argument, in one sentence, for what is no program, and for one that needs
  /// more than `most_deep` numbers at a time.
  explicit Expression(const Program& program) {
    std::size_t depth = 0;
    for (const auto& [word, value] : program) {
      const Instruction one = instruction(word, value);
      const std::size_t taken = one.kind == Kind::operation
                                    ? static_cast<std::size_t>(operations[one.place].operands)
                                    : 0;
      if (taken > depth) throw std::invalid_argument("a formula lacks an operand of " + word);
      depth += 1 - taken;
      if (depth > most_deep) throw std::invalid_argument("a formula is nested too deeply");
      code_.push_back(one);
    }
    if (depth != 1) throw std::invalid_argument("a formula must come to one number");
  }

  /// Is it of the variable, by its name?
  bool is_of(std::string_view variable) const {
    return std::ranges::any_of(code_, [&](const Instruction& one) {
      return one.kind == Kind::variable && expression_variables[one.place] == variable;
    });
  }

  /// Its value for the first `count` lanes.
  void evaluate(const Variables& variables, std::size_t count, Lanes& result) const {
    std::array<Lanes, most_deep> stack;
    std::size_t depth = 0;
    for (const Instruction& one : code_) {
      if (one.kind == Kind::number) {
        stack[depth++].fill(one.value);
      } else if (one.kind == Kind::variable) {
        stack[depth++] = variables[one.place];
      } else {
        const Operation& operation = operations[one.place];
        depth -= static_cast<std::size_t>(operation.operands) - 1;
        Lanes& a = stack[depth - 1];
        // With one operand the second is not used.
        const Lanes& b = operation.operands == 2 ? stack[depth] : a;
        for (std::size_t k = 0; k < count; ++k) a[k] = operation.apply(a[k], b[k]);
      }
    }
    std::copy_n(stack[0].begin(), count, result.begin());
  }

 private:
  enum class Kind { number, variable, operation };
  struct Instruction {
    Kind kind;
    std::size_t place;  // in the list of its kind
    double value;
  };

  static Instruction instruction(const std::string& word, double value) {
    if (word == "number") {
      if (!std::isfinite(value)) throw std::invalid_argument("a formula must have finite numbers");
      return {Kind::number, 0, value};
    }
    const auto variable = std::ranges::find(expression_variables, word);
    if (variable != expression_variables.end())
      return {Kind::variable, static_cast<std::size_t>(variable - expression_variables.begin()),
              0.0};
    const auto operation = std::ranges::find(operations, word, &Operation::name);
    if (operation == operations.end())
      throw std::invalid_argument("a formula has the word " + word + ", which is not known");
    return {Kind::operation, static_cast<std::size_t>(operation - operations.begin()), 0.0};
  }

  std::vector<Instruction> code_;
};

/// The same for rows of numbers: those of variable `names[k]` are values[k n ... (k + 1) n - 1].
inline std::vector<double> evaluate_rows(const Expression& expression,
                                         const std::vector<std::string>& names,
                                         std::span<const double> values, std::size_t n) {
  if (values.size() != names.size() * n)
    throw std::invalid_argument("values must be (variables, n)");
  std::vector<double> found(n);
  Expression::Variables variables{};
  Expression::Lanes result;
  for (std::size_t first = 0; first < n; first += Expression::lanes) {
    const std::size_t count = std::min(Expression::lanes, n - first);
    for (std::size_t k = 0; k < names.size(); ++k) {
      const auto place = std::ranges::find(expression_variables, names[k]);
      if (place == expression_variables.end())
        throw std::invalid_argument(names[k] + " is no variable of a formula");
      const auto lane = static_cast<std::size_t>(place - expression_variables.begin());
      std::copy_n(&values[k * n + first], count, variables[lane].begin());
    }
    expression.evaluate(variables, count, result);
    std::copy_n(result.begin(), count, &found[first]);
  }
  return found;
}

}  // namespace mpm
