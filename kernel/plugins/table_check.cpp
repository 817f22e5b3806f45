// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks of types and parameter tables. Units and expressions are only looked at from outside here;
// ParameterCheck brings the rest.
#include "kernel/plugins/table_check.hpp"

#include <charconv>
#include <cstring>
#include <optional>
#include <set>
#include <string_view>

#include "kernel/plugins/abi_reading.hpp"
#include "kernel/plugins/search_path.hpp"

namespace shoal::kernel {
namespace {

constexpr std::uint32_t known_flags = SHOAL_PARAMETER_REQUIRED | SHOAL_PARAMETER_LIST |
                                      SHOAL_PARAMETER_HAS_MINIMUM | SHOAL_PARAMETER_HAS_MAXIMUM |
                                      SHOAL_PARAMETER_MINIMUM_EXCLUDED | SHOAL_PARAMETER_MAXIMUM_EXCLUDED |
                                      SHOAL_PARAMETER_NAMES | SHOAL_PARAMETER_STEP_FACTOR;

bool is_blank(const char* text) {
  return !text || std::string_view(text).find_first_not_of(" \t\n") == std::string_view::npos;
}

bool is_real(std::uint32_t kind) {
  return kind == SHOAL_REAL || kind == SHOAL_VECTOR || kind == SHOAL_MATRIX || kind == SHOAL_EXPRESSION ||
         kind == SHOAL_VECTOR_EXPRESSION;
}
std::string with_article(std::uint32_t kind) {
  const std::string word = value_kind_text(kind);
  return (std::string_view("aeiou").find(word[0]) == std::string_view::npos ? "a " : "an ") + word;
}
bool has_bounds(const shoal_parameter& p) {
  return (p.flags & (SHOAL_PARAMETER_HAS_MINIMUM | SHOAL_PARAMETER_HAS_MAXIMUM)) != 0;
}

// The whole text as a number; nothing for "1 mm", "2*H" or words.
template <class Number>
std::optional<Number> whole_number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

class ParameterTable {
 public:
  ParameterTable(std::string type, const ParameterCheck& deeper, std::vector<std::string>& problems)
      : type_(std::move(type)), deeper_(deeper), problems_(problems) {}

  void check(const shoal_parameter& p) {
    if (!p.key || !is_snake_case(p.key)) {
      problem("", std::string("the key '") + (p.key ? p.key : "") + "' is not in snake_case");
      return;
    }
    key_ = p.key;
    const std::size_t before = problems_.size();
    if (!keys_.insert(p.key).second) problem("there are two parameters of this name");
    if (is_blank(p.doc)) problem("it has no doc");
    if (p.kind < SHOAL_BOOLEAN || p.kind > SHOAL_OBJECT) return problem("unknown " + value_kind_text(p.kind));
    if (p.flags & ~known_flags) problem("it has unknown flags");
    if (p.flags & SHOAL_PARAMETER_STEP_FACTOR && (p.kind != SHOAL_REAL || p.flags & SHOAL_PARAMETER_LIST))
      problem("only a single number can be a factor of time steps");
    check_unit(p);
    check_bounds(p);
    check_choices(p);
    check_object(p);
    check_default(p);
    if (problems_.size() > before || !deeper_) return;
    if (const std::string text = deeper_(p); !text.empty()) problem(text);
  }

 private:
  void problem(const std::string& text) { problem(key_, text); }
  void problem(const std::string& key, const std::string& text) {
    problems_.push_back(type_ + (key.empty() ? "" : ", parameter '" + key + "'") + ": " + text);
  }

  void check_unit(const shoal_parameter& p) {
    if (is_real(p.kind)) {
      if (is_blank(p.unit)) problem("a number needs a unit; without dimension it is \"1\"");
    } else if (p.unit && !(p.kind == SHOAL_INTEGER && std::strcmp(p.unit, "1") == 0)) {
      problem(with_article(p.kind) + " has no unit");
    }
    if (p.unit && p.unit[0] != '\0' && (p.unit[0] == ' ' || p.unit[std::strlen(p.unit) - 1] == ' '))
      problem(std::string("there are blanks around the unit '") + p.unit + "'");
  }

  void check_bounds(const shoal_parameter& p) {
    const bool low = p.flags & SHOAL_PARAMETER_HAS_MINIMUM;
    const bool high = p.flags & SHOAL_PARAMETER_HAS_MAXIMUM;
    if ((low || high) && !is_real(p.kind) && p.kind != SHOAL_INTEGER)
      problem(with_article(p.kind) + " has no bounds");
    if ((p.flags & SHOAL_PARAMETER_MINIMUM_EXCLUDED && !low) ||
        (p.flags & SHOAL_PARAMETER_MAXIMUM_EXCLUDED && !high))
      problem("a bound is excluded that is not there");
    const bool open = p.flags & (SHOAL_PARAMETER_MINIMUM_EXCLUDED | SHOAL_PARAMETER_MAXIMUM_EXCLUDED);
    // Written so that NaN is a problem too.
    if ((low && !(p.minimum == p.minimum)) || (high && !(p.maximum == p.maximum)) ||
        (low && high && !(open ? p.minimum < p.maximum : p.minimum <= p.maximum)))
      problem("no number lies between its bounds");
  }

  void check_choices(const shoal_parameter& p) {
    if (p.kind != SHOAL_CHOICE) {
      if (p.n_choices > 0) problem(with_article(p.kind) + " has no choices");
      return;
    }
    if (p.n_choices == 0 || !p.choices) return problem("there is nothing to choose from");
    std::set<std::string_view> words;
    for (std::uint32_t k = 0; k < p.n_choices; ++k) {
      const char* word = p.choices[k];
      if (is_blank(word)) return problem("a choice is empty");
      if (!words.insert(word).second) problem("the choice '" + std::string(word) + "' is listed twice");
    }
    if (p.default_text && !(p.flags & SHOAL_PARAMETER_LIST) && !words.count(p.default_text))
      problem("the default '" + std::string(p.default_text) + "' is not one of the choices");
  }

  void check_object(const shoal_parameter& p) {
    const bool is_kind = p.object_kind >= SHOAL_TYPE_OPERATOR && p.object_kind <= SHOAL_TYPE_PROBE;
    if (p.kind == SHOAL_OBJECT && !is_kind) problem("it does not say which kind of object fits");
    if (p.kind != SHOAL_OBJECT && p.object_kind != 0) problem("only an object has an object kind");
  }

  void check_default(const shoal_parameter& p) {
    if (!p.default_text) return;
    const std::string text = p.default_text;
    if (p.flags & SHOAL_PARAMETER_REQUIRED) problem("it is required, so it cannot have a default");
    if (is_blank(p.default_text) && p.kind != SHOAL_TEXT && !(p.flags & SHOAL_PARAMETER_LIST))
      return problem("its default is empty");
    if (p.flags & SHOAL_PARAMETER_LIST) return;
    if (p.kind == SHOAL_BOOLEAN && text != "true" && text != "false")
      problem("the default '" + text + "' is neither true nor false");
    // An integer may depend on the case's parameters, e.g. $n; what looks like a number must be one.
    const bool looks_like_number = text.find_first_not_of("+-.0123456789eE") == std::string::npos;
    if (p.kind == SHOAL_INTEGER && looks_like_number && !whole_number<std::int64_t>(text))
      problem("the default '" + text + "' is no integer");
    const auto value = whole_number<double>(text);
    if (is_real(p.kind) && looks_like_number && !value) problem("the default '" + text + "' is no number");
    if (value && has_bounds(p)) check_inside(p, *value);
  }

  void check_inside(const shoal_parameter& p, double value) {
    const bool above = !(p.flags & SHOAL_PARAMETER_HAS_MINIMUM) ||
                       (p.flags & SHOAL_PARAMETER_MINIMUM_EXCLUDED ? value > p.minimum : value >= p.minimum);
    const bool below = !(p.flags & SHOAL_PARAMETER_HAS_MAXIMUM) ||
                       (p.flags & SHOAL_PARAMETER_MAXIMUM_EXCLUDED ? value < p.maximum : value <= p.maximum);
    if (!above || !below) problem("the default " + std::string(p.default_text) + " lies outside its bounds");
  }

  std::string type_, key_;
  const ParameterCheck& deeper_;
  std::vector<std::string>& problems_;
  std::set<std::string, std::less<>> keys_;
};

std::string check_name(std::string_view name, const std::string& id) {
  if (id.empty()) return is_snake_case(name) ? "" : "a type of the kernel has a plain name in snake_case";
  if (name == id) return {};
  const auto dot = name.find('.');
  if (dot != std::string_view::npos && name.substr(0, dot) == id && is_snake_case(name.substr(dot + 1)))
    return {};
  return "its name must be '" + id + "' or begin with '" + id + ".', all in snake_case";
}

template <class Api>
std::string check_functions(const void* api, std::initializer_list<std::size_t> offsets) {
  std::uint32_t size = 0;
  std::memcpy(&size, api, sizeof(size));
  if (size < abi_smallest<Api>) return "its table of functions is too short";
  for (const std::size_t offset : offsets) {
    void* function = nullptr;
    std::memcpy(&function, static_cast<const char*>(api) + offset, sizeof(function));
    if (!function) return "its table of functions has a gap";
  }
  return {};
}

// `destroy` may be missing where `create` allocates nothing.
std::string check_api(const shoal_type& type) {
  if (!type.api) return "it has no functions";
  switch (type.kind) {
    case SHOAL_TYPE_OPERATOR:
    case SHOAL_TYPE_PHYSICS:
      return check_functions<shoal_physics_api>(type.api, {offsetof(shoal_physics_api, build)});
    case SHOAL_TYPE_MATERIAL:
      return check_functions<shoal_material_api>(
          type.api, {offsetof(shoal_material_api, create), offsetof(shoal_material_api, interface)});
    case SHOAL_TYPE_SHAPE:
      return check_functions<shoal_shape_api>(
          type.api, {offsetof(shoal_shape_api, create), offsetof(shoal_shape_api, distance),
                     offsetof(shoal_shape_api, bounds)});
    case SHOAL_TYPE_OUTPUT:
      return check_functions<shoal_output_api>(
          type.api, {offsetof(shoal_output_api, create), offsetof(shoal_output_api, write)});
    case SHOAL_TYPE_PROBE:
      return check_functions<shoal_probe_api>(
          type.api, {offsetof(shoal_probe_api, create), offsetof(shoal_probe_api, columns),
                     offsetof(shoal_probe_api, fields), offsetof(shoal_probe_api, sample)});
    default: return {};
  }
}

}  // namespace

std::string kind_text(std::uint32_t kind) {
  switch (kind) {
    case SHOAL_TYPE_OPERATOR: return "operator";
    case SHOAL_TYPE_MATERIAL: return "material";
    case SHOAL_TYPE_PHYSICS: return "physics";
    case SHOAL_TYPE_SHAPE: return "shape";
    case SHOAL_TYPE_OUTPUT: return "output";
    case SHOAL_TYPE_PROBE: return "probe";
    default: return "kind " + std::to_string(kind);
  }
}

std::string value_kind_text(std::uint32_t kind) {
  switch (kind) {
    case SHOAL_BOOLEAN: return "boolean";
    case SHOAL_INTEGER: return "integer";
    case SHOAL_REAL: return "number";
    case SHOAL_VECTOR: return "vector";
    case SHOAL_MATRIX: return "matrix";
    case SHOAL_TEXT: return "text";
    case SHOAL_CHOICE: return "choice";
    case SHOAL_EXPRESSION: return "expression";
    case SHOAL_VECTOR_EXPRESSION: return "vector of expressions";
    case SHOAL_BODY: return "body";
    case SHOAL_FIELD: return "field";
    case SHOAL_FILE: return "file";
    case SHOAL_OBJECT: return "object";
    default: return "kind of value " + std::to_string(kind);
  }
}

bool is_known(const shoal_type& type) {
  if (type.kind < SHOAL_TYPE_OPERATOR || type.kind > SHOAL_TYPE_PROBE) return false;
  for (std::uint32_t k = 0; type.parameters && k < type.n_parameters; ++k) {
    const auto* parameter = abi_element(type.parameters, k);
    if (parameter->kind < SHOAL_BOOLEAN || parameter->kind > SHOAL_OBJECT || parameter->flags & ~known_flags)
      return false;
  }
  return true;
}

std::vector<std::string> check_type(const shoal_type& type, const std::string& id,
                                    const ParameterCheck& deeper) {
  std::vector<std::string> problems;
  if (type.size < abi_smallest<shoal_type>) return {"a type is too short a struct"};
  if (!type.name) return {"a type has no name"};
  const std::string name = type.name;
  const auto problem = [&](const std::string& text) {
    if (!text.empty()) problems.push_back(name + ": " + text);
  };
  problem(check_name(name, id));
  if (kind_text(type.kind).starts_with("kind")) problem("unknown " + kind_text(type.kind) + " of type");
  if (is_blank(type.doc)) problem("it has no doc");
  problem(check_api(type));
  if (type.n_parameters > 0 && !type.parameters) {
    problem("it counts parameters but lists none");
    return problems;
  }
  ParameterTable table(name, deeper, problems);
  for (std::uint32_t k = 0; k < type.n_parameters; ++k) {
    const auto* parameter = abi_element(type.parameters, k);
    if (parameter->size < abi_smallest<shoal_parameter>) {
      problem("a parameter is too short a struct");
      break;
    }
    table.check(*parameter);
  }
  return problems;
}

}  // namespace shoal::kernel
