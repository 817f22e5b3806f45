// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// From the text of a number to its value.
#include "kernel/case/parameters.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include "kernel/case/scalars.hpp"
#include "kernel/case/units.hpp"

namespace shoal::kernel {
namespace {

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\n");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\n") - first + 1);
}

// A number and, behind it, what can only be a unit: "2 cm", "5 %", "20 °C"; but not "2*H" or "2 /H".
struct Quantity {
  NumberText number;
  std::string unit;
};

Quantity split(const std::string& text, bool allow_infinite) {
  Quantity quantity{parse_number(text, allow_infinite), {}};
  if (quantity.number.status != NumberText::Status::prefix) return quantity;
  const std::string rest = trimmed(text.substr(quantity.number.end));
  const auto c = static_cast<unsigned char>(rest[0]);
  if (std::isalpha(c) != 0 || c == '%' || c >= 0x80U) quantity.unit = rest;
  return quantity;
}

// Where in the file a part of an expression stands. Quotes shift it by one; escapes and line breaks are left alone.
Place expression_place(const Node& node, std::size_t offset, std::size_t length) {
  const Place& place = node.place();
  const int quote = node.quoted() ? 1 : 0;
  if (place.line == 0 || place.length < static_cast<int>(node.text().size()) + 2 * quote) return place;
  const int characters = count_characters(std::string_view(node.text()).substr(0, offset));
  return place.part(characters + quote, static_cast<int>(length));
}

void report(const ExpressionError& problem, const Node& node, const NumberRequest& request,
            const Parameters& parameters, Diagnostics& diagnostics) {
  if (parameters.mentions_broken(node.text())) return;
  std::string message = problem.what();
  if (!lone_name(trimmed(node.text())).empty() && message.rfind("unknown name", 0) == 0)
    message += (message.find("; did") == std::string::npos ? "; expected " : " Expected ") +
               described_number(request);
  diagnostics.error(expression_place(node, problem.offset(), problem.length()), message, problem.notes());
}

std::optional<double> convert(const Quantity& quantity, const Node& node, const NumberRequest& request,
                              const Parameters& parameters, Diagnostics& diagnostics) {
  if (request.unit == nullptr) {
    diagnostics.error(node.place(), "expected a number without a unit, got '" + node.text() + "'");
    return std::nullopt;
  }
  try {
    return convert_unit(quantity.number.value, quantity.unit, request.unit, trimmed(node.text()));
  } catch (const UnitError& problem) {
    std::vector<std::string> notes;
    const std::string number = trimmed(node.text()).substr(0, quantity.number.end);
    if (parameters.find(quantity.unit) != nullptr)
      notes.push_back("for a product with the parameter write: " + number + "*" + quantity.unit);
    diagnostics.error(node.place(), problem.what(), notes);
    return std::nullopt;
  }
}

// A parameter alone, "$dx", brings its unit with it.
bool unit_fits(const Node& node, const NumberRequest& request, const Parameters& parameters,
               Diagnostics& diagnostics) {
  const Parameters::Parameter* parameter = parameters.find(lone_name(trimmed(node.text())));
  if (parameter == nullptr || parameter->unit.empty() || request.unit == nullptr) return true;
  if (same_dimension(parameter->unit, request.unit)) return true;
  diagnostics.error(node.place(),
                    "expected " + described_unit(request.unit) + ", got the parameter '" + parameter->name +
                        "', " + described_unit(parameter->unit),
                    {parameter->name + " is set at " + parameter->place.text()});
  return false;
}

// What every scalar must pass before it is a number or an expression. Returns false if it was complained about.
bool check_scalar(const Node& node, const Quantity& quantity, const NumberRequest& request,
                  Diagnostics& diagnostics) {
  if (!node.is_scalar()) {
    diagnostics.error(node.place(), "expected " + described_number(request) + ", got " + node.described());
    return false;
  }
  if (quantity.number.status == NumberText::Status::refused) {
    diagnostics.error(node.place(), "'" + trimmed(node.text()) + "' " + quantity.number.remedy);
    return false;
  }
  const BooleanText boolean = parse_boolean(node.text());
  if (!node.quoted() && (boolean == BooleanText::yes || boolean == BooleanText::no)) {
    diagnostics.error(node.place(), "expected " + described_number(request) + ", got '" + node.text() + "'");
    return false;
  }
  return true;
}

bool check_finite(double value, const Node& node, Diagnostics& diagnostics) {
  if (std::isfinite(value)) return true;
  diagnostics.error(node.place(), "the value of '" + trimmed(node.text()) + "' is " +
                                      (std::isnan(value) ? "not a number" : "infinite") +
                                      "; check for a division by zero or a root of a negative number");
  return false;
}

// Names that an expression mentions, without reading it.
std::set<std::string> words(const std::string& text) {
  std::set<std::string> found;
  for (std::size_t i = 0; i < text.size();) {
    const auto is_part = [&](std::size_t k) {
      return k < text.size() && (std::isalnum(static_cast<unsigned char>(text[k])) != 0 || text[k] == '_');
    };
    std::size_t end = i;
    while (is_part(end)) ++end;
    if (end > i) found.insert(text.substr(i, end - i));
    i = std::max(end, i + 1);
  }
  return found;
}

}  // namespace

// ------------------------------------------------------------------------------------------------------------

// Depth first through the references; `path_` holds the parameters that wait for one another.
class Parameters::Resolver {
 public:
  Resolver(Parameters& parameters, std::vector<Node> nodes, Diagnostics& diagnostics)
      : all_(parameters),
        nodes_(std::move(nodes)),
        state_(nodes_.size(), State::untouched),
        diagnostics_(diagnostics) {}

  void run() {
    for (std::size_t k = 0; k < nodes_.size(); ++k) resolve(k);
  }

 private:
  enum class State { untouched, waiting, done };

  void resolve(std::size_t k) {
    if (state_[k] != State::untouched) return;
    state_[k] = State::waiting;
    path_.push_back(k);
    evaluate(k);
    path_.pop_back();
    state_[k] = State::done;
  }

  void evaluate(std::size_t k) {
    Parameter& parameter = all_.parameters_[k];
    const Node& node = nodes_[k];
    const std::string text = node.is_scalar() ? trimmed(node.text()) : std::string();
    const Quantity quantity = split(text, false);
    if (!check_scalar(node, quantity, {}, diagnostics_)) {
      parameter.broken = true;
      return;
    }
    if (quantity.number.status == NumberText::Status::number) {
      parameter.value = quantity.number.value;
    } else if (!quantity.unit.empty()) {
      evaluate_quantity(parameter, quantity, node);
    } else {
      evaluate_expression(parameter, node);
    }
    if (!parameter.broken) parameter.broken = !check_finite(parameter.value, node, diagnostics_);
  }

  void evaluate_quantity(Parameter& parameter, const Quantity& quantity, const Node& node) {
    try {
      parameter.unit = si_unit(quantity.unit, trimmed(node.text()));
      parameter.value =
          convert_unit(quantity.number.value, quantity.unit, parameter.unit, trimmed(node.text()));
    } catch (const UnitError& problem) {
      std::vector<std::string> notes;
      const std::string number = trimmed(node.text()).substr(0, quantity.number.end);
      if (all_.find(quantity.unit) != nullptr)
        notes.push_back("for a product with the parameter write: " + number + "*" + quantity.unit);
      diagnostics_.error(node.place(), problem.what(), notes);
      parameter.broken = true;
    }
  }

  void evaluate_expression(Parameter& parameter, const Node& node) {
    ExpressionScope scope;
    scope.constants = all_.names();
    scope.constant = [this](const std::string& name) { return value_of(name); };
    const std::string text = trimmed(node.text());
    for (const std::string& word : words(text)) {
      if (!visit(word, node)) parameter.broken = true;
    }
    if (parameter.broken) return;
    try {
      parameter.value = Expression(text, scope).value();
      if (const Parameter* same = all_.find(lone_name(text))) parameter.unit = same->unit;
    } catch (const ExpressionError& problem) {
      report(problem, node, {}, all_, diagnostics_);
      parameter.broken = true;
    }
  }

  std::optional<double> value_of(const std::string& name) const {
    const Parameter* parameter = all_.find(name);
    return parameter != nullptr ? std::optional<double>(parameter->value) : std::nullopt;
  }

  // Resolves the parameter of this name first; false if that is not possible.
  bool visit(const std::string& name, const Node& user) {
    const Parameter* found = all_.find(name);
    if (found == nullptr) return true;
    const auto k = static_cast<std::size_t>(found - all_.parameters_.data());
    if (state_[k] != State::waiting) {
      resolve(k);
      return !all_.parameters_[k].broken;
    }
    std::vector<std::string> circle;
    for (auto step = std::find(path_.begin(), path_.end(), k); step != path_.end(); ++step) {
      circle.push_back(all_.parameters_[*step].name);
      all_.parameters_[*step].broken = true;
    }
    circle.push_back(name);
    diagnostics_.error(user.place(), circle.size() == 2 ? "parameter '" + name + "' refers to itself"
                                                        : "parameters refer to one another in a circle: " +
                                                              join(circle, " -> "));
    return false;
  }

  Parameters& all_;
  std::vector<Node> nodes_;
  std::vector<State> state_;
  std::vector<std::size_t> path_;
  Diagnostics& diagnostics_;
};

Parameters::Parameters(const Node& section, Diagnostics& diagnostics) {
  if (section.is_null()) return;
  if (!section.is_map()) {
    diagnostics.error(section.place(), "expected a map of names and numbers, got " + section.described(),
                      {"example: parameters: {H: 1 m, dx: 25 mm}"});
    return;
  }
  std::vector<Node> nodes;
  for (const Node::Entry& entry : section.entries()) {
    if (entry.key.rfind("x-", 0) == 0) continue;
    Parameter parameter;
    parameter.name = entry.key;
    parameter.place = entry.value.place();
    if (entry.value.is_scalar()) parameter.text = trimmed(entry.value.text());
    if (lone_name(entry.key) != entry.key) {
      diagnostics.error(entry.key_place, "'" + entry.key + "' cannot be the name of a parameter",
                        {"a name has letters, digits and '_', and begins with a letter or '_'"});
      continue;
    }
    if (is_reserved_name(entry.key)) {
      const bool coordinate = entry.key == "x" || entry.key == "y" || entry.key == "z" || entry.key == "t";
      const std::string meaning = entry.key == "pi" ? "a number" : coordinate ? "a coordinate" : "a function";
      diagnostics.error(entry.key_place,
                        "'" + entry.key + "' is " + meaning +
                            " of expressions and cannot be a parameter; choose another name");
      continue;
    }
    parameters_.push_back(std::move(parameter));
    nodes.push_back(entry.value);
  }
  Resolver(*this, std::move(nodes), diagnostics).run();
}

std::vector<std::string> Parameters::names() const {
  std::vector<std::string> result;
  for (const Parameter& parameter : parameters_) result.push_back(parameter.name);
  return result;
}

const Parameters::Parameter* Parameters::find(const std::string& name) const {
  for (const Parameter& parameter : parameters_) {
    if (parameter.name == name) return &parameter;
  }
  return nullptr;
}

ExpressionScope Parameters::scope(const std::vector<std::string>& variables) const {
  ExpressionScope scope;
  scope.constants = names();
  scope.variables = variables;
  scope.constant = [this](const std::string& name) -> std::optional<double> {
    const Parameter* parameter = find(name);
    if (parameter == nullptr || parameter->broken) return std::nullopt;
    return parameter->value;
  };
  return scope;
}

bool Parameters::mentions_broken(const std::string& expression) const {
  for (const std::string& word : words(expression)) {
    const Parameter* parameter = find(word);
    if (parameter != nullptr && parameter->broken) return true;
  }
  return false;
}

// ------------------------------------------------------------------------------------------------------------

std::optional<Expression> read_expression(const Node& node, const NumberRequest& request,
                                          const std::vector<std::string>& variables,
                                          const Parameters& parameters, Diagnostics& diagnostics,
                                          bool any_name) {
  const std::string text = node.is_scalar() ? trimmed(node.text()) : std::string();
  const Quantity quantity = split(text, request.allow_infinite);
  if (!check_scalar(node, quantity, request, diagnostics)) return std::nullopt;
  if (quantity.number.status == NumberText::Status::number) return Expression(quantity.number.value);
  if (!quantity.unit.empty()) {
    const std::optional<double> value = convert(quantity, node, request, parameters, diagnostics);
    return value ? std::optional<Expression>(Expression(*value)) : std::nullopt;
  }
  try {
    ExpressionScope scope = parameters.scope(variables);
    if (any_name)
      scope.is_field = [](const std::string& name) { return name.find('.') == std::string::npos; };
    Expression expression(text, scope);
    if (!unit_fits(node, request, parameters, diagnostics)) return std::nullopt;
    if (expression.is_constant() && !check_finite(expression.value(), node, diagnostics)) return std::nullopt;
    return expression;
  } catch (const ExpressionError& problem) {
    report(problem, node, request, parameters, diagnostics);
    return std::nullopt;
  }
}

std::optional<double> read_number(const Node& node, const NumberRequest& request,
                                  const Parameters& parameters, Diagnostics& diagnostics) {
  const std::optional<Expression> expression = read_expression(node, request, {}, parameters, diagnostics);
  return expression ? std::optional<double>(expression->value()) : std::nullopt;
}

std::string described_number(const NumberRequest& request) {
  return request.unit == nullptr || std::string(request.unit) == "1" ? "a number"
                                                                     : described_unit(request.unit);
}

}  // namespace shoal::kernel
