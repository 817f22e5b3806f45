// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Parameters as members. A type (operator, material, physics, output, ...) derives from Parameterised and declares
//
//     Param<double> viscosity{"viscosity", "m2/s", "Kinematic viscosity.", positive, default_to(1e-6)};
//
// The table that drives reading, validation, `shoal describe`, docs and schema grows from these members, and after
// `read` they hold the checked values of the case in SI units.
#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <deque>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "shoal/abi.h"
#include "shoal/host.hpp"

namespace shoal {

// A vector of the case's dimensions; the third component of a 2D case is zero.
using Vector3 = std::array<double, 3>;

// An expression of x, y, z, t; evaluated for blocks of points.
class Expression {
 public:
  Expression() = default;
  explicit Expression(const shoal_expression* handle) : handle_(handle) {}
  explicit operator bool() const { return handle_ != nullptr; }
  // out[k] at point k of `positions` (n * dimensions numbers, interleaved) and time t.
  void evaluate(int dimensions, std::uint64_t n, const double* positions, double t, double* out) const {
    check_host(host().evaluate(handle_, dimensions, n, positions, t, out));
  }
  // The names of the plugin's own that it uses (parameters with the option `own_names`), and values with columns[k][i]
  // that of the k-th name at point i.
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    if (!SHOAL_HAS(shoal_host, &host(), evaluate_names)) return all;
    for (std::uint32_t k = 0; const char* name = host().expression_name(handle_, k); ++k)
      all.emplace_back(name);
    return all;
  }
  void evaluate(int dimensions, std::uint64_t n, const double* positions, const double* const* columns,
                double t, double* out) const {
    check_host(host().evaluate_names(handle_, dimensions, n, positions, columns, t, out));
  }
  double operator()(int dimensions, const double* position, double t) const {
    double value = 0;
    evaluate(dimensions, 1, position, t, &value);
    return value;
  }

 private:
  const shoal_expression* handle_ = nullptr;
};

struct VectorExpression {
  std::array<Expression, 3> component;
};

struct BodyIndex {
  std::uint32_t value = 0;
};

// A word out of a fixed list.
struct Choice {
  std::string word;
  bool operator==(std::string_view other) const { return word == other; }
};

// The name of a field, e.g. velocity, or of a component of one, e.g. velocity.x.
struct FieldName {
  std::string name;
};

// A nested object of a registered type: `{type.name: {key: value}}`.
struct ObjectHandle {
  const shoal_object* object = nullptr;
};

// Options of a parameter, given after its doc in any order.
struct Bound {
  std::uint32_t flags;
  double minimum = 0, maximum = 0;
};
inline constexpr Bound positive{SHOAL_PARAMETER_HAS_MINIMUM | SHOAL_PARAMETER_MINIMUM_EXCLUDED};
inline constexpr Bound non_negative{SHOAL_PARAMETER_HAS_MINIMUM};
constexpr Bound at_least(double value) { return {SHOAL_PARAMETER_HAS_MINIMUM, value}; }
constexpr Bound above(double value) {
  return {SHOAL_PARAMETER_HAS_MINIMUM | SHOAL_PARAMETER_MINIMUM_EXCLUDED, value};
}
constexpr Bound at_most(double value) { return {SHOAL_PARAMETER_HAS_MAXIMUM, 0, value}; }
constexpr Bound below(double value) {
  return {SHOAL_PARAMETER_HAS_MAXIMUM | SHOAL_PARAMETER_MAXIMUM_EXCLUDED, 0, value};
}
constexpr Bound between(double low, double high) {
  return {SHOAL_PARAMETER_HAS_MINIMUM | SHOAL_PARAMETER_HAS_MAXIMUM, low, high};
}

struct DefaultText {
  std::string text;
};
inline DefaultText default_to(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {std::string(buffer.data(), end)};
}
inline DefaultText default_to(int value) { return {std::to_string(value)}; }
inline DefaultText default_to(bool value) { return {value ? "true" : "false"}; }
inline DefaultText default_to(const char* text) { return {text}; }

struct Example {
  const char* text;
};
constexpr Example example(const char* text) { return {text}; }

// The value may be left out although it has no default; `is_set` tells.
struct Optional {};
inline constexpr Optional optional{};

// An expression may use names that the case does not know; Expression::names tells which.
struct OwnNames {};
inline constexpr OwnNames own_names{};

// Time steps grow in proportion to the number, and beyond some value the scheme fails: `shoal study --limits` finds it.
struct ScalesTimeStep {};
inline constexpr ScalesTimeStep scales_time_step{};

struct Choices {
  std::vector<const char*> words;
};
template <class... Words>
Choices one_of(Words... words) {
  return {{words...}};
}

struct ObjectsOf {
  shoal_type_kind kind;
};

class Parameterised;

namespace impl {

class ParameterBase {
 public:
  ParameterBase(const ParameterBase&) = delete;
  ParameterBase& operator=(const ParameterBase&) = delete;
  virtual ~ParameterBase() = default;

  bool is_set() const { return is_set_; }
  // "case.yaml:12:5", for messages; empty unless read from a case.
  const std::string& place() const { return place_; }

 protected:
  ParameterBase() = default;
  inline void enrol(const char* key, const char* unit, const char* doc, std::uint32_t kind,
                    std::uint32_t flags);
  void apply(const Bound& bound) {
    description_.flags |= bound.flags;
    if (bound.flags & SHOAL_PARAMETER_HAS_MINIMUM) description_.minimum = bound.minimum;
    if (bound.flags & SHOAL_PARAMETER_HAS_MAXIMUM) description_.maximum = bound.maximum;
  }
  void apply(DefaultText text) {
    default_text_ = std::move(text.text);
    optional_ = true;
  }
  void apply(Example text) { description_.example = text.text; }
  void apply(Optional) { optional_ = true; }
  void apply(OwnNames) { description_.flags |= SHOAL_PARAMETER_NAMES; }
  void apply(ScalesTimeStep) { description_.flags |= SHOAL_PARAMETER_STEP_FACTOR; }
  void apply(Choices choices) { choices_ = std::move(choices.words); }
  void apply(ObjectsOf objects) { description_.object_kind = objects.kind; }

  virtual void set(const shoal_value& value, int dimensions) = 0;

 private:
  friend class shoal::Parameterised;
  shoal_parameter description() const {
    shoal_parameter d = description_;
    if (!optional_) d.flags |= SHOAL_PARAMETER_REQUIRED;
    d.default_text = default_text_ ? default_text_->c_str() : nullptr;
    d.n_choices = static_cast<std::uint32_t>(choices_.size());
    d.choices = choices_.empty() ? nullptr : choices_.data();
    return d;
  }

  shoal_parameter description_{};
  std::optional<std::string> default_text_;
  std::vector<const char*> choices_;
  std::string place_;
  bool optional_ = false;
  bool is_set_ = false;
};

inline thread_local Parameterised* enrolling = nullptr;

}  // namespace impl

// Base of everything with parameters. Its address must not change: members are enrolled by it.
class Parameterised {
 public:
  Parameterised(const Parameterised&) = delete;
  Parameterised& operator=(const Parameterised&) = delete;

  std::vector<shoal_parameter> parameter_table() const {
    std::vector<shoal_parameter> table;
    for (const auto* parameter : parameters_) table.push_back(parameter->description());
    return table;
  }
  std::size_t n_parameters() const { return parameters_.size(); }

  // Takes the values of an object of this type; `first` is the place of our first parameter in its table.
  void read(const shoal_object& object, int dimensions, std::size_t first = 0) {
    for (std::size_t k = 0; k < parameters_.size() && first + k < object.n_values; ++k) {
      const shoal_value& value = *SHOAL_AT(shoal_value, object.values, first + k);
      if (value.place) parameters_[k]->place_ = value.place;
      if (value.n == 0) continue;
      parameters_[k]->set(value, dimensions);
      parameters_[k]->is_set_ = true;
    }
  }

 protected:
  Parameterised() { impl::enrolling = this; }
  ~Parameterised() = default;

 private:
  friend class impl::ParameterBase;
  std::vector<impl::ParameterBase*> parameters_;
};

namespace impl {

inline void ParameterBase::enrol(const char* key, const char* unit, const char* doc, std::uint32_t kind,
                                 std::uint32_t flags) {
  description_.size = sizeof(shoal_parameter);
  description_.kind = kind;
  description_.flags |= flags;
  description_.key = key;
  description_.unit = unit;
  description_.doc = doc;
  enrolling->parameters_.push_back(this);
}

// How one element of a value becomes a T.
template <class T>
struct ValueTraits;
template <>
struct ValueTraits<double> {
  static constexpr std::uint32_t kind = SHOAL_REAL;
  static double get(const shoal_value& v, std::uint32_t k, int) { return v.reals[k]; }
};
template <>
struct ValueTraits<std::int64_t> {
  static constexpr std::uint32_t kind = SHOAL_INTEGER;
  static std::int64_t get(const shoal_value& v, std::uint32_t k, int) { return v.integers[k]; }
};
template <>
struct ValueTraits<bool> {
  static constexpr std::uint32_t kind = SHOAL_BOOLEAN;
  static bool get(const shoal_value& v, std::uint32_t k, int) { return v.integers[k] != 0; }
};
template <>
struct ValueTraits<std::string> {
  static constexpr std::uint32_t kind = SHOAL_TEXT;
  static std::string get(const shoal_value& v, std::uint32_t k, int) { return v.texts[k]; }
};
template <>
struct ValueTraits<Choice> {
  static constexpr std::uint32_t kind = SHOAL_CHOICE;
  static Choice get(const shoal_value& v, std::uint32_t k, int) { return {v.texts[k]}; }
};
template <>
struct ValueTraits<Vector3> {
  static constexpr std::uint32_t kind = SHOAL_VECTOR;
  static Vector3 get(const shoal_value& v, std::uint32_t k, int dimensions) {
    Vector3 out{};
    const auto n = static_cast<std::size_t>(dimensions);
    for (std::size_t d = 0; d < n; ++d) out[d] = v.reals[k * n + d];
    return out;
  }
};
template <>
struct ValueTraits<Expression> {
  static constexpr std::uint32_t kind = SHOAL_EXPRESSION;
  static Expression get(const shoal_value& v, std::uint32_t k, int) { return Expression(v.expressions[k]); }
};
template <>
struct ValueTraits<VectorExpression> {
  static constexpr std::uint32_t kind = SHOAL_VECTOR_EXPRESSION;
  static VectorExpression get(const shoal_value& v, std::uint32_t k, int dimensions) {
    VectorExpression out;
    const auto n = static_cast<std::size_t>(dimensions);
    for (std::size_t d = 0; d < n; ++d) out.component[d] = Expression(v.expressions[k * n + d]);
    return out;
  }
};
template <>
struct ValueTraits<BodyIndex> {
  static constexpr std::uint32_t kind = SHOAL_BODY;
  static BodyIndex get(const shoal_value& v, std::uint32_t k, int) {
    return {static_cast<std::uint32_t>(v.integers[k])};
  }
};
template <>
struct ValueTraits<FieldName> {
  static constexpr std::uint32_t kind = SHOAL_FIELD;
  static FieldName get(const shoal_value& v, std::uint32_t k, int) { return {v.texts[k]}; }
};
template <>
struct ValueTraits<ObjectHandle> {
  static constexpr std::uint32_t kind = SHOAL_OBJECT;
  static ObjectHandle get(const shoal_value& v, std::uint32_t k, int) { return {v.objects[k]}; }
};

template <class T>
inline constexpr bool is_list = false;
template <class T>
inline constexpr bool is_list<std::vector<T>> = true;

}  // namespace impl

// A parameter of type double, std::int64_t, bool, std::string, Choice, Vector3, Expression, VectorExpression,
// BodyIndex, FieldName or ObjectHandle, or a std::vector of these. `unit` is UDUNITS-2 text, nullptr where it makes no sense.
template <class T>
class Param final : public impl::ParameterBase {
 public:
  template <class... Options>
  Param(const char* key, const char* unit, const char* doc, Options... options) {
    if constexpr (impl::is_list<T>)
      enrol(key, unit, doc, impl::ValueTraits<typename T::value_type>::kind, SHOAL_PARAMETER_LIST);
    else
      enrol(key, unit, doc, impl::ValueTraits<T>::kind, 0);
    (apply(std::move(options)), ...);
  }

  const T& value() const { return value_; }
  operator const T&() const { return value_; }
  const T* operator->() const { return &value_; }
  Param& operator=(T value) {
    value_ = std::move(value);
    return *this;
  }
  // The value if the case sets it (or it has a default), else `other`.
  T value_or(T other) const { return is_set() ? value_ : other; }

 private:
  void set(const shoal_value& value, int dimensions) override {
    if constexpr (impl::is_list<T>) {
      value_.clear();
      for (std::uint32_t k = 0; k < value.n; ++k)
        value_.push_back(impl::ValueTraits<typename T::value_type>::get(value, k, dimensions));
    } else {
      value_ = impl::ValueTraits<T>::get(value, 0, dimensions);
    }
  }

  T value_{};
};

}  // namespace shoal
