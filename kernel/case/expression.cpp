// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The only file that knows muParser. The text is taken apart here first: muParser's own grammar has assignment,
// several results and names of its own, and its messages do not know what a parameter is.
#include "kernel/case/expression.hpp"

#include <muParser.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <set>
#include <variant>

#include "kernel/case/diagnostics.hpp"
#include "kernel/case/scalars.hpp"

namespace shoal::kernel {
namespace {

constexpr std::array<const char*, 4> variable_names{"x", "y", "z", "t"};

bool is_name_begin(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_name_part(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

// GLSL's definitions.
double step(double a, double x) { return x < a ? 0.0 : 1.0; }
double smoothstep(double a, double b, double x) {
  const double s = std::clamp((x - a) / (b - a), 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}
double sign(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0; }
double modulo(double a, double b) { return a - b * std::floor(a / b); }
double smallest(const double* values, int n) { return *std::min_element(values, values + n); }
double largest(const double* values, int n) { return *std::max_element(values, values + n); }

using Callback = std::variant<double (*)(double), double (*)(double, double),
                              double (*)(double, double, double), double (*)(const double*, int)>;

const std::map<std::string, Callback, std::less<>>& callbacks() {
  using One = double (*)(double);
  using Two = double (*)(double, double);
  static const std::map<std::string, Callback, std::less<>> table{
      {"sin", static_cast<One>(std::sin)},
      {"cos", static_cast<One>(std::cos)},
      {"tan", static_cast<One>(std::tan)},
      {"asin", static_cast<One>(std::asin)},
      {"acos", static_cast<One>(std::acos)},
      {"atan", static_cast<One>(std::atan)},
      {"atan2", static_cast<Two>(std::atan2)},
      {"sinh", static_cast<One>(std::sinh)},
      {"cosh", static_cast<One>(std::cosh)},
      {"tanh", static_cast<One>(std::tanh)},
      {"exp", static_cast<One>(std::exp)},
      {"erf", static_cast<One>(std::erf)},
      {"log", static_cast<One>(std::log)},
      {"log10", static_cast<One>(std::log10)},
      {"sqrt", static_cast<One>(std::sqrt)},
      {"cbrt", static_cast<One>(std::cbrt)},
      {"hypot", static_cast<Two>(std::hypot)},
      {"abs", static_cast<One>(std::fabs)},
      {"floor", static_cast<One>(std::floor)},
      {"ceil", static_cast<One>(std::ceil)},
      {"round", static_cast<One>(std::round)},
      {"sign", sign},
      {"mod", modulo},
      {"min", smallest},
      {"max", largest},
      {"step", step},
      {"smoothstep", smoothstep},
  };
  return table;
}

// Without the names that muParser brings. Copies of it get only the functions that they use: a case has dozens of
// expressions, and defining all functions takes longer than compiling one.
const mu::Parser& bare_parser() {
  static const mu::Parser parser = [] {
    mu::Parser bare;
    bare.ClearFun();
    bare.ClearConst();
    bare.DefineConst("pi", std::numbers::pi);
    return bare;
  }();
  return parser;
}

const ExpressionFunction* find_function(std::string_view name) {
  for (const ExpressionFunction& function : expression_functions()) {
    if (name == function.name) return &function;
  }
  return nullptr;
}

std::vector<std::string> function_names() {
  std::vector<std::string> names;
  for (const ExpressionFunction& function : expression_functions()) names.emplace_back(function.name);
  return names;
}

bool contains(const std::vector<std::string>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// ------------------------------------------------------------------------------------------------------------

// Goes through a text, checks every word and sign of it, and leaves a text that muParser reads alike.
class Scanner {
 public:
  Scanner(const std::string& text, const ExpressionScope& scope) : text_(text), clean_(text), scope_(scope) {
    scan();
  }

  const std::string& clean() const { return clean_; }
  const std::map<std::string, double>& constants() const { return constants_; }
  const std::set<std::string>& functions() const { return functions_; }
  const std::vector<std::string>& fields() const { return fields_; }
  bool uses_variables() const { return uses_variables_ || !fields_.empty(); }

 private:
  void scan() {
    if (text_.find_first_not_of(" \t\n") == std::string::npos)
      throw ExpressionError("the expression is empty", 0, 1);
    int depth = 0;
    for (std::size_t i = 0; i < text_.size();) {
      const char c = text_[i];
      const bool number_point =
          c == '.' && i + 1 < text_.size() && std::isdigit(static_cast<unsigned char>(text_[i + 1])) != 0;
      if (is_name_begin(c) || c == '$') {
        i = name(i);
      } else if (std::isdigit(static_cast<unsigned char>(c)) != 0 || number_point) {
        i = number(i);
      } else {
        if (c == '(') ++depth;
        if (c == ')') --depth;
        if (c == ',' && depth == 0) fail("a ',' stands outside of a function", i);
        i = sign_at(i);
      }
    }
  }

  [[noreturn]] static void fail(const std::string& message, std::size_t offset, std::size_t length = 1) {
    throw ExpressionError(message, offset, length);
  }

  std::size_t sign_at(std::size_t i) const {
    const std::string two = text_.substr(i, 2);
    for (const char* good : {"==", "!=", "<=", ">=", "&&", "||"}) {
      if (two == good) return i + 2;
    }
    if (two == "**") fail("unknown operator '**'; write '^' for powers", i, 2);
    if (text_[i] == '=') fail("'=' cannot stand in an expression; write '==' to compare", i);
    if (text_[i] == '%') fail("'%' cannot stand in an expression; write mod(a, b) for a remainder", i);
    if (std::string_view("+-*/^()<>?:,").find(text_[i]) != std::string_view::npos) return i + 1;
    if (text_[i] == ' ' || text_[i] == '\t' || text_[i] == '\n') return i + 1;
    std::size_t length = 1;
    while (i + length < text_.size() && (static_cast<unsigned char>(text_[i + length]) & 0xC0U) == 0x80U)
      ++length;
    fail("'" + text_.substr(i, length) + "' cannot stand in an expression", i, 1);
  }

  std::size_t number(std::size_t i) const {
    std::size_t last = i;  // of what looks like one number to a reader
    while (last < text_.size() && (is_name_part(text_[last]) || text_[last] == '.' ||
                                   ((text_[last] == '+' || text_[last] == '-') &&
                                    (text_[last - 1] == 'e' || text_[last - 1] == 'E'))))
      ++last;
    const std::string whole = text_.substr(i, last - i);
    const NumberText parsed = parse_number(whole);
    if (parsed.status == NumberText::Status::refused)
      fail("'" + whole + "' " + parsed.remedy, i, whole.size());
    const std::size_t end = i + parsed.end;
    if (end < text_.size() && is_name_begin(text_[end])) {
      fail("'" + whole + "' is no number; write '" + whole.substr(0, parsed.end) + "*" +
               whole.substr(parsed.end) + "' for a product (units cannot stand in expressions)",
           i, whole.size());
    }
    if (end < text_.size() && text_[end] == '.') fail("a number has one decimal point", end);
    return end;
  }

  std::size_t name(std::size_t begin) {
    const bool dollar = text_[begin] == '$';
    const std::size_t first = begin + (dollar ? 1 : 0);
    std::size_t end = first;
    while (end < text_.size() && is_name_part(text_[end])) ++end;
    const std::string word = text_.substr(first, end - first);
    if (word.empty() || !is_name_begin(word[0])) fail("a name is missing after '$'", begin);
    if (!dollar && scope_.is_field) {
      if (const std::size_t field_end = field(begin)) return field_end;
    }
    if (end < text_.size() && text_[end] == '.')
      fail("'" + word + ".' cannot stand in an expression; names have no points", begin, end - begin + 1);
    if (dollar) clean_[begin] = ' ';
    const std::size_t next = text_.find_first_not_of(" \t\n", end);
    const bool call = next != std::string::npos && text_[next] == '(';
    if (!dollar && (call || find_function(word) != nullptr)) {
      check_function(word, call, begin, end - begin);
      functions_.insert(word);
    } else if (!dollar && contains(scope_.variables, word)) {
      uses_variables_ = true;
    } else if (dollar || word != "pi") {
      constant(word, begin, end - begin);
    }
    return end;
  }

  // The end of the name of a field, or 0.
  std::size_t field(std::size_t begin) {
    std::size_t end = begin;
    while (end < text_.size() && (is_name_part(text_[end]) || text_[end] == '.')) ++end;
    const std::string name = text_.substr(begin, end - begin);
    const std::size_t next = text_.find_first_not_of(" \t\n", end);
    if ((next != std::string::npos && text_[next] == '(') || find_function(name) != nullptr || name == "pi" ||
        contains(scope_.variables, name) || (scope_.constant && scope_.constant(name)) ||
        !scope_.is_field(name))
      return 0;
    if (!contains(fields_, name)) fields_.push_back(name);
    return end;
  }

  static void check_function(const std::string& word, bool call, std::size_t offset, std::size_t length) {
    const ExpressionFunction* function = find_function(word);
    if (function == nullptr)
      throw ExpressionError("unknown function '" + word + "'" + did_you_mean(word, function_names()), offset,
                            length, {"functions: " + join(function_names())});
    if (!call) fail("the function '" + word + "' needs its arguments: " + function->usage, offset, length);
  }

  void constant(const std::string& word, std::size_t offset, std::size_t length) {
    if (const std::optional<double> value = scope_.constant ? scope_.constant(word) : std::nullopt) {
      constants_[word] = *value;
      return;
    }
    if (std::find(variable_names.begin(), variable_names.end(), word) != variable_names.end()) {
      if (scope_.variables.empty())
        fail("'" + word + "' cannot stand here: this value is the same everywhere and always", offset,
             length);
      if (word != "t") fail("'" + word + "' does not exist in two dimensions", offset, length);
      fail("'t' cannot stand here: this value does not change in time", offset, length);
    }
    std::vector<std::string> known = scope_.constants;
    known.insert(known.end(), scope_.variables.begin(), scope_.variables.end());
    known.emplace_back("pi");
    std::vector<std::string> notes{"names: " + join(known)};
    throw ExpressionError("unknown name '" + word + "'" + did_you_mean(word, known), offset, length, notes);
  }

  const std::string& text_;
  std::string clean_;
  const ExpressionScope& scope_;
  std::map<std::string, double> constants_;
  std::set<std::string> functions_;
  std::vector<std::string> fields_;
  bool uses_variables_ = false;
};

// muParser's complaint as a sentence; what the scanner has checked cannot be the reason.
[[noreturn]] void rethrow(const mu::ParserError& problem, const std::string& text) {
  const std::string token = problem.GetToken();
  auto position = static_cast<std::size_t>(std::max(0, problem.GetPos()));
  if (!token.empty()) {
    const std::size_t near = text.find(token, position > token.size() ? position - token.size() : 0);
    if (near != std::string::npos) position = near;
  }
  position = std::min(position, text.size() - 1);
  const auto at = [&](const std::string& message) -> ExpressionError {
    return {message, position, std::max<std::size_t>(1, std::min(token.size(), text.size() - position))};
  };
  const ExpressionFunction* function = find_function(token);
  const std::string usage = function != nullptr ? ": " + std::string(function->usage) : std::string();
  switch (problem.GetCode()) {
    case mu::ecUNEXPECTED_EOF: throw ExpressionError("the expression ends too early", text.size() - 1, 1);
    case mu::ecMISSING_PARENS: throw ExpressionError("a ')' is missing", text.size() - 1, 1);
    case mu::ecUNEXPECTED_PARENS:
      if (token == "(") throw at("an operator is missing before '('");
      throw at("unexpected '" + (token.empty() ? ")" : token) + "'");
    case mu::ecUNEXPECTED_OPERATOR:
      throw at("unexpected operator '" + token + "'; a value is missing before it");
    case mu::ecUNEXPECTED_VAL:
    case mu::ecUNEXPECTED_VAR:
    case mu::ecUNEXPECTED_FUN: throw at("an operator is missing before '" + token + "'");
    case mu::ecUNEXPECTED_ARG:
    case mu::ecUNEXPECTED_ARG_SEP:
      throw ExpressionError("a ',' stands outside of a function", 0, text.size());
    case mu::ecTOO_MANY_PARAMS: throw at("too many arguments" + usage);
    case mu::ecTOO_FEW_PARAMS: throw at("too few arguments" + usage);
    case mu::ecMISSING_ELSE_CLAUSE: throw ExpressionError("':' is missing after '?'", text.size() - 1, 1);
    case mu::ecMISPLACED_COLON: throw at("':' without '?' before it");
    default: throw at("this is not an expression (" + std::string(problem.GetMsg()) + ")");
  }
}

}  // namespace

// ------------------------------------------------------------------------------------------------------------

// A parser of muParser has one stack of its own, so each concurrent evaluation takes a copy from a pool that grows
// to the number of threads.
class Expression::Program {
 public:
  struct Instance {
    mu::Parser parser = bare_parser();
    std::array<double, 4> variables{};
    std::vector<double> fields;
  };

  explicit Program(double value) : text(format_number(value)), constant(true), value(value) {}

  Program(const std::string& source, const ExpressionScope& scope) : text(source) {
    const Scanner scanner(source, scope);
    clean_ = scanner.clean();
    constants_ = scanner.constants();
    functions_ = scanner.functions();
    fields = scanner.fields();
    constant = !scanner.uses_variables();
    try {
      std::unique_ptr<Instance> first = make();
      value = first->parser.Eval();
      if (first->parser.GetNumResults() > 1)
        throw ExpressionError("a ',' stands outside of a function", 0, text.size());
      if (!constant) pool_.push_back(std::move(first));
    } catch (const mu::ParserError& problem) {
      rethrow(problem, clean_);
    }
  }

  std::unique_ptr<Instance> take() {
    const std::lock_guard guard(lock_);
    if (pool_.empty()) return make();
    std::unique_ptr<Instance> instance = std::move(pool_.back());
    pool_.pop_back();
    return instance;
  }

  void give_back(std::unique_ptr<Instance> instance) {
    const std::lock_guard guard(lock_);
    pool_.push_back(std::move(instance));
  }

  std::string text;
  std::vector<std::string> fields;
  bool constant = false;
  double value = 0;

 private:
  std::unique_ptr<Instance> make() const {
    auto instance = std::make_unique<Instance>();
    for (const std::string& name : functions_)
      std::visit([&](auto function) { instance->parser.DefineFun(name, function); }, callbacks().at(name));
    for (const auto& [name, number] : constants_) instance->parser.DefineConst(name, number);
    for (std::size_t k = 0; k < variable_names.size(); ++k) {
      if (constants_.count(variable_names[k]) == 0)
        instance->parser.DefineVar(variable_names[k], &instance->variables[k]);
    }
    if (!fields.empty()) {
      instance->parser.DefineNameChars("0123456789_.abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ");
      instance->fields.resize(fields.size());
      for (std::size_t k = 0; k < fields.size(); ++k)
        instance->parser.DefineVar(fields[k], &instance->fields[k]);
    }
    instance->parser.SetExpr(clean_);
    return instance;
  }

  std::string clean_;
  std::map<std::string, double> constants_;
  std::set<std::string> functions_;
  std::mutex lock_;
  std::vector<std::unique_ptr<Instance>> pool_;
};

Expression::Expression(double value) : program_(std::make_shared<Program>(value)) {}
Expression::Expression(const std::string& text, const ExpressionScope& scope)
    : program_(std::make_shared<Program>(text, scope)) {}

const std::string& Expression::text() const { return program_->text; }
bool Expression::is_constant() const { return program_->constant; }
double Expression::value() const { return program_->value; }

const std::vector<std::string>& Expression::fields() const { return program_->fields; }

struct Expression::Points {
  std::array<const double*, 3> coordinates{};
  std::size_t stride = 1;
  const double* const* columns = nullptr;  // of the fields
};

namespace {

std::array<const double*, 3> interleaved(int dimensions, const double* points) {
  if (points == nullptr) return {};  // a list without a point may have no place
  return {dimensions > 0 ? points : nullptr, dimensions > 1 ? points + 1 : nullptr,
          dimensions > 2 ? points + 2 : nullptr};
}

}  // namespace

void Expression::evaluate(std::size_t n, const double* x, const double* y, const double* z, double t,
                          double* out) const {
  run(n, Points{{x, y, z}}, t, out);
}

void Expression::evaluate(int dimensions, std::size_t n, const double* points, double t, double* out) const {
  run(n, Points{interleaved(dimensions, points), static_cast<std::size_t>(dimensions)}, t, out);
}

void Expression::evaluate(int dimensions, std::size_t n, const double* points, const double* const* columns,
                          double t, double* out) const {
  run(n, Points{interleaved(dimensions, points), static_cast<std::size_t>(dimensions), columns}, t, out);
}

void Expression::run(std::size_t n, const Points& points, double t, double* out) const {
  if (program_->constant) {
    std::fill(out, out + n, program_->value);
    return;
  }
  std::unique_ptr<Program::Instance> instance = program_->take();
  std::array<double, 4>& variables = instance->variables;
  variables = {0, 0, 0, t};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (points.coordinates[k] != nullptr) variables[k] = points.coordinates[k][i * points.stride];
    }
    for (std::size_t k = 0; k < instance->fields.size(); ++k) instance->fields[k] = points.columns[k][i];
    out[i] = instance->parser.Eval();
  }
  program_->give_back(std::move(instance));
}

bool is_reserved_name(std::string_view name) {
  return name == "pi" || find_function(name) != nullptr ||
         std::find(variable_names.begin(), variable_names.end(), name) != variable_names.end();
}

std::string lone_name(std::string_view text) {
  if (!text.empty() && text[0] == '$') text.remove_prefix(1);
  const bool good =
      !text.empty() && is_name_begin(text[0]) && std::all_of(text.begin(), text.end(), is_name_part);
  return good ? std::string(text) : std::string();
}

const std::vector<ExpressionFunction>& expression_functions() {
  static const std::vector<ExpressionFunction> functions{
      {"sin", "sin(x)", "sine of an angle in rad"},
      {"cos", "cos(x)", "cosine"},
      {"tan", "tan(x)", "tangent"},
      {"asin", "asin(x)", "arc sine"},
      {"acos", "acos(x)", "arc cosine"},
      {"atan", "atan(x)", "arc tangent"},
      {"atan2", "atan2(y, x)", "angle of the point (x, y)"},
      {"sinh", "sinh(x)", "hyperbolic sine"},
      {"cosh", "cosh(x)", "hyperbolic cosine"},
      {"tanh", "tanh(x)", "hyperbolic tangent"},
      {"exp", "exp(x)", "exponential"},
      {"erf", "erf(x)", "error function"},
      {"log", "log(x)", "natural logarithm"},
      {"log10", "log10(x)", "decimal logarithm"},
      {"sqrt", "sqrt(x)", "square root"},
      {"cbrt", "cbrt(x)", "cube root"},
      {"hypot", "hypot(x, y)", "sqrt(x^2 + y^2)"},
      {"abs", "abs(x)", "absolute value"},
      {"floor", "floor(x)", "next whole number below"},
      {"ceil", "ceil(x)", "next whole number above"},
      {"round", "round(x)", "nearest whole number"},
      {"sign", "sign(x)", "-1, 0 or 1"},
      {"mod", "mod(a, b)", "remainder of a / b, with the sign of b"},
      {"min", "min(a, b, ...)", "smallest"},
      {"max", "max(a, b, ...)", "largest"},
      {"step", "step(a, x)", "0 for x < a, else 1"},
      {"smoothstep", "smoothstep(a, b, x)", "rises smoothly from 0 at a to 1 at b"},
  };
  return functions;
}

}  // namespace shoal::kernel
