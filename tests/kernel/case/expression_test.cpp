// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Expressions against the same formula in C++, their errors, and concurrent evaluation.
#include "kernel/case/expression.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <thread>

#include "kernel/case/parameters.hpp"

namespace {

using namespace shoal::kernel;

ExpressionScope scope(const std::vector<std::string>& variables = {}) {
  static const std::map<std::string, double> values{{"H", 2.0}, {"dx", 0.1}, {"g", 9.81}};
  ExpressionScope result;
  result.constants = {"H", "dx", "g"};
  result.variables = variables;
  result.constant = [](const std::string& name) -> std::optional<double> {
    const auto found = values.find(name);
    return found == values.end() ? std::nullopt : std::optional<double>(found->second);
  };
  return result;
}

double value(const std::string& text) { return Expression(text, scope()).value(); }

std::string problem(const std::string& text, const std::vector<std::string>& variables = {}) {
  try {
    Expression(text, scope(variables));
  } catch (const ExpressionError& error) {
    return std::to_string(error.offset()) + "+" + std::to_string(error.length()) + " " + error.what();
  }
  return "no error";
}

TEST_CASE("constant expressions follow the rules of mathematics") {
  CHECK(value("2*H") == 4);
  CHECK(value("$H") == 2);
  CHECK(value("$dx*$H") == 0.2);
  CHECK(value("sqrt(g*H)") == std::sqrt(9.81 * 2));
  CHECK(value("-2^2") == -4);  // not (-2)^2
  CHECK(value("-H^2") == -4);
  CHECK(value("2^-1") == 0.5);
  CHECK(value("2^3^2") == 512);
  CHECK(value("1 - 2 - 3") == -4);
  CHECK(value("8/4/2") == 1);
  CHECK(value("2 + 3*4") == 14);
  CHECK(value("1e-3*H") == 2e-3);
  CHECK(value("H > 1 ? 3 : 4") == 3);
  CHECK(value("H > 1 && dx > 1") == 0);
  CHECK(value("H == 2 || dx != 0.1") == 1);
  CHECK(value("pi") == std::numbers::pi);
}

TEST_CASE("functions are those of C++") {
  CHECK(value("sin(0.3)") == std::sin(0.3));
  CHECK(value("cos(0.3)") == std::cos(0.3));
  CHECK(value("tan(0.3)") == std::tan(0.3));
  CHECK(value("asin(0.3)") == std::asin(0.3));
  CHECK(value("acos(0.3)") == std::acos(0.3));
  CHECK(value("atan(0.3)") == std::atan(0.3));
  CHECK(value("atan2(-1, -2)") == std::atan2(-1, -2));
  CHECK(value("sinh(0.3)") == std::sinh(0.3));
  CHECK(value("cosh(0.3)") == std::cosh(0.3));
  CHECK(value("tanh(0.3)") == std::tanh(0.3));
  CHECK(value("exp(0.3)") == std::exp(0.3));
  CHECK(value("log(0.3)") == std::log(0.3));
  CHECK(value("log10(0.3)") == std::log10(0.3));
  CHECK(value("cbrt(0.3)") == doctest::Approx(std::cbrt(0.3)).epsilon(1e-15));  // folded by the compiler
  CHECK(value("hypot(3, 4)") == 5);
  CHECK(value("abs(-3)") == 3);
  CHECK(value("floor(-1.5)") == -2);
  CHECK(value("ceil(-1.5)") == -1);
  CHECK(value("round(2.5)") == 3);
  CHECK(value("sign(-3) + sign(0) + sign(2)") == 0);
  CHECK(value("mod(-1, 3)") == 2);
  CHECK(value("mod(5.5, 2)") == 1.5);
  CHECK(value("min(3, 1, 2)") == 1);
  CHECK(value("max(3, 1, 2)") == 3);
  CHECK(value("step(1, 0.99)") == 0);
  CHECK(value("step(1, 1)") == 1);
  CHECK(value("smoothstep(1, 3, 0)") == 0);
  CHECK(value("smoothstep(1, 3, 2)") == 0.5);
  CHECK(value("smoothstep(1, 3, 1.5)") == doctest::Approx(0.15625).epsilon(1e-15));
  CHECK(value("smoothstep(1, 3, 4)") == 1);
}

TEST_CASE("every function that is documented exists") {
  for (const ExpressionFunction& function : expression_functions()) {
    INFO(function.name);
    CHECK(is_reserved_name(function.name));
    const std::string usage = function.usage;
    const auto n_arguments = 1 + std::count(usage.begin(), usage.end(), ',');
    std::string call = std::string(function.name) + "(0.5";
    for (std::ptrdiff_t k = 1; k < n_arguments; ++k) call += ", 0.5";
    CHECK(problem(call + ")") == "no error");
  }
}

TEST_CASE("errors say what and where") {
  CHECK(problem("") == "0+1 the expression is empty");
  CHECK(problem("2*") == "1+1 the expression ends too early");
  CHECK(problem("2*(H") == "3+1 a ')' is missing");
  CHECK(problem("2*H)") == "3+1 unexpected ')'");
  CHECK(problem("2 H") == "2+1 an operator is missing before 'H'");
  CHECK(problem("2 (H)") == "2+1 an operator is missing before '('");
  CHECK(problem("*2") == "0+1 unexpected operator '*'; a value is missing before it");
  CHECK(problem("3 + 2H") ==
        "4+2 '2H' is no number; write '2*H' for a product (units cannot stand in expressions)");
  CHECK(problem("010*H") ==
        "0+3 '010' has a leading zero, which other YAML readers take for octal; write 10");
  CHECK(problem("H = 3") == "2+1 '=' cannot stand in an expression; write '==' to compare");
  CHECK(problem("2**3") == "1+2 unknown operator '**'; write '^' for powers");
  CHECK(problem("5 % 2") == "2+1 '%' cannot stand in an expression; write mod(a, b) for a remainder");
  CHECK(problem("1, 2") == "1+1 a ',' stands outside of a function");
  CHECK(problem("(1, 2)") == "0+6 a ',' stands outside of a function");
  CHECK(problem("sin") == "0+3 the function 'sin' needs its arguments: sin(x)");
  CHECK(problem("1 + sine(2)") == "4+4 unknown function 'sine'; did you mean 'sin'?");
  CHECK(problem("1 + Hx") == "4+2 unknown name 'Hx'; did you mean 'dx'?");
  CHECK(problem("$Q") == "0+2 unknown name 'Q'");
  CHECK(problem("$") == "0+1 a name is missing after '$'");
  CHECK(problem("sin(1, 2)").find("too many arguments: sin(x)") != std::string::npos);
  CHECK(problem("step(1)").find("too few arguments: step(a, x)") != std::string::npos);
  CHECK(problem("H ? 1") == "4+1 ':' is missing after '?'");
  CHECK(problem("1.2.3") == "3+1 a number has one decimal point");
  CHECK(problem("\"a\"") == "0+1 '\"' cannot stand in an expression");
  // Names that muParser would bring along.
  for (const char* name : {"_pi", "_e", "e"}) CHECK(problem(name).find("unknown name") != std::string::npos);
  for (const char* call : {"rint(2)", "sum(1, 2)", "avg(1, 2)", "ln(2)", "log2(2)"})
    CHECK(problem(call).find("unknown function") != std::string::npos);
}

TEST_CASE("coordinates and time exist where the scope says so") {
  CHECK(problem("x") == "0+1 'x' cannot stand here: this value is the same everywhere and always");
  CHECK(problem("x + y + t", {"x", "y", "t"}) == "no error");
  CHECK(problem("z", {"x", "y", "t"}) == "0+1 'z' does not exist in two dimensions");
  CHECK(problem("t", {"x", "y", "z"}) == "0+1 't' cannot stand here: this value does not change in time");
  CHECK(problem("$x", {"x"}) != "no error");  // $ is for parameters
}

TEST_CASE("field expressions give the formula at every point") {
  const Expression expression("sin(2*pi*x)*cos(2*pi*y)*exp(-t) + z*H", scope({"x", "y", "z", "t"}));
  CHECK_FALSE(expression.is_constant());
  const std::size_t n = 257;
  std::vector<double> x(n), y(n), z(n), points(3 * n), out(n), interleaved(n);
  for (std::size_t i = 0; i < n; ++i) {
    points[3 * i] = x[i] = 0.01 * static_cast<double>(i);
    points[3 * i + 1] = y[i] = 1.0 - 0.02 * static_cast<double>(i);
    points[3 * i + 2] = z[i] = -0.5 + 0.003 * static_cast<double>(i);
  }
  const double t = 0.7;
  expression.evaluate(n, x.data(), y.data(), z.data(), t, out.data());
  expression.evaluate(3, n, points.data(), t, interleaved.data());
  for (std::size_t i = 0; i < n; ++i) {
    const double expected =
        std::sin(2 * std::numbers::pi * x[i]) * std::cos(2 * std::numbers::pi * y[i]) * std::exp(-t) +
        z[i] * 2.0;
    CHECK(out[i] == doctest::Approx(expected).epsilon(1e-14));
    CHECK(out[i] == interleaved[i]);
  }
}

TEST_CASE("constants fill the block, and two dimensions leave z alone") {
  std::vector<double> out(5, -1.0);
  Expression(3.5).evaluate(5, nullptr, nullptr, nullptr, 0, out.data());
  for (const double v : out) CHECK(v == 3.5);
  const std::vector<double> points{1, 2, 3, 4};
  Expression("10*x + y", scope({"x", "y"})).evaluate(2, 2, points.data(), 0, out.data());
  CHECK(out[0] == 12);
  CHECK(out[1] == 34);
}

TEST_CASE("NaN stays visible") {
  const Expression expression("sqrt(x)", scope({"x"}));
  const double x = -1;
  double out = 0;
  expression.evaluate(1, &x, nullptr, nullptr, 0, &out);
  CHECK(std::isnan(out));
}

TEST_CASE("many threads evaluate one expression at once") {
  const Expression expression("x^2 + 3*t", scope({"x", "t"}));
  const std::size_t n = 500;
  std::vector<std::thread> threads;
  std::vector<int> wrong(8, 0);
  for (std::size_t k = 0; k < wrong.size(); ++k) {
    threads.emplace_back([&, k] {
      std::vector<double> x(n), out(n);
      for (int repeat = 0; repeat < 100; ++repeat) {
        const double t = static_cast<double>(k) + 0.01 * repeat;
        for (std::size_t i = 0; i < n; ++i) x[i] = static_cast<double>(i * (k + 1));
        expression.evaluate(n, x.data(), nullptr, nullptr, t, out.data());
        for (std::size_t i = 0; i < n; ++i)
          wrong[k] += std::fabs(out[i] - (x[i] * x[i] + 3 * t)) > 1e-9 * (1 + out[i]) ? 1 : 0;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const int count : wrong) CHECK(count == 0);
}

// ------------------------------------------------------------------------------------------------------------

Parameters parameters(const std::string& section, Diagnostics& diagnostics) {
  const Node root = read_yaml_text("parameters: " + section + "\n", "a.yaml", diagnostics);
  return {*root.find("parameters"), diagnostics};
}

TEST_CASE("parameters refer to earlier and later ones, and have units") {
  Diagnostics diagnostics;
  const Parameters p = parameters("{dx: $H/40, H: 50 cm, L: 2*H, n: 3, W: L, share: 5 %}", diagnostics);
  CHECK(diagnostics.format() == "");
  CHECK(p.find("H")->value == 0.5);
  CHECK(p.find("H")->unit == "m");
  CHECK(p.find("dx")->value == 0.0125);
  CHECK(p.find("dx")->unit.empty());  // units of expressions are not known
  CHECK(p.find("L")->value == 1.0);
  CHECK(p.find("W")->value == 1.0);
  CHECK(p.find("share")->value == doctest::Approx(0.05));
  CHECK(p.find("absent") == nullptr);
}

TEST_CASE("a parameter alone keeps its unit through others") {
  Diagnostics diagnostics;
  const Parameters p = parameters("{b: $a, c: b, a: 2 kg}", diagnostics);
  CHECK(p.find("c")->unit == "kg");
  CHECK_FALSE(read_number(Node::scalar("$c", false, {}), {"m", false}, p, diagnostics));
  CHECK(diagnostics.sorted()[0].message == "expected a length (m), got the parameter 'c', a mass (kg)");
}

TEST_CASE("a circle is told once, with its way round, and spoils only who is in it") {
  Diagnostics diagnostics;
  const Parameters p = parameters("{a: b + 1, b: c, c: a, d: 2*a, e: 3}", diagnostics);
  CHECK(diagnostics.n_errors() == 1);
  CHECK(diagnostics.sorted()[0].message == "parameters refer to one another in a circle: a -> b -> c -> a");
  CHECK(p.find("d")->broken);
  CHECK_FALSE(p.find("e")->broken);
  // What depends on a broken parameter is not complained about again.
  CHECK_FALSE(read_number(Node::scalar("2*d", false, {}), {"m", false}, p, diagnostics));
  CHECK(diagnostics.n_errors() == 1);
}

TEST_CASE("a number is plain, or has a unit, or is an expression") {
  Diagnostics diagnostics;
  const Parameters p = parameters("{H: 2 m, dx: 0.1}", diagnostics);
  const auto number = [&](const char* text, const char* unit) {
    return read_number(Node::scalar(text, false, {}), {unit, false}, p, diagnostics).value_or(-1);
  };
  CHECK(number("1000", "kg/m3") == 1000);
  CHECK(number("25 mm", "m") == 0.025);
  CHECK(number("0.5m", "m") == 0.5);
  CHECK(number("5%", "1") == doctest::Approx(0.05));
  CHECK(number("$H", "m") == 2);
  CHECK(number("H", "m") == 2);
  CHECK(number("2*H", "m") == 4);
  CHECK(number("4*$dx", "m") == doctest::Approx(0.4));
  CHECK(number("  2 * H ", "m") == 4);
  CHECK(number("-$dx", "m") == -0.1);
  CHECK(diagnostics.format() == "");
}

}  // namespace
