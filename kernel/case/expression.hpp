// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Expressions of a case: of its parameters ("2*H"), and of place and time where a field or a profile is meant
// ("1 - (y/H)^2"). Only expression.cpp includes muParser.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

struct shoal_expression;

namespace shoal::kernel {

/// The text is not an expression. `what()` is a sentence without a full stop; offset and length (characters from
/// the beginning of the text) say which part of it is meant.
class ExpressionError : public std::runtime_error {
 public:
  ExpressionError(const std::string& message, std::size_t offset, std::size_t length,
                  std::vector<std::string> notes = {})
      : std::runtime_error(message), offset_(offset), length_(length), notes_(std::move(notes)) {}
  std::size_t offset() const { return offset_; }
  std::size_t length() const { return length_; }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::size_t offset_;
  std::size_t length_;
  std::vector<std::string> notes_;
};

/// The names that an expression may use beside the functions and pi.
struct ExpressionScope {
  /// Values of parameters; nothing for a name that is not one. Written `name` or `$name`.
  std::function<std::optional<double>(const std::string&)> constant;
  std::vector<std::string> constants;  ///< their names, for messages
  std::vector<std::string> variables;  ///< some of x, y, z, t
  /// Whether a name is a value of a particle, "pressure" or "velocity.x"; asked for names that are nothing else.
  std::function<bool(const std::string&)> is_field;
};

/// Immutable; a copy shares everything.
class Expression {
 public:
  explicit Expression(double value);
  /// Throws ExpressionError.
  Expression(const std::string& text, const ExpressionScope& scope);

  const std::string& text() const;
  bool is_constant() const;
  /// Of a constant expression.
  double value() const;

  /// out[i] at (x[i], y[i], z[i], t); coordinates that the scope has not may be null. [any thread, concurrently]
  void evaluate(std::size_t n, const double* x, const double* y, const double* z, double t,
                double* out) const;
  /// The same for points of `dimensions` interleaved coordinates. [any thread, concurrently]
  void evaluate(int dimensions, std::size_t n, const double* points, double t, double* out) const;

  /// The values of particles that it uses, by name; empty unless the scope has fields.
  const std::vector<std::string>& fields() const;
  /// The same for particles: columns[k][i] is the value of fields()[k] of particle i. [any thread, concurrently]
  void evaluate(int dimensions, std::size_t n, const double* points, const double* const* columns, double t,
                double* out) const;

  /// As plugins hold it; valid as long as this object.
  const shoal_expression* handle() const { return reinterpret_cast<const shoal_expression*>(this); }
  static const Expression& from_handle(const shoal_expression* handle) {
    return *reinterpret_cast<const Expression*>(handle);
  }

 private:
  class Program;
  struct Points;
  void run(std::size_t n, const Points& points, double t, double* out) const;
  std::shared_ptr<Program> program_;
};

/// Names that parameters cannot have: functions, pi, x, y, z, t.
bool is_reserved_name(std::string_view name);

/// The lone name of "H" or "$H", else empty.
std::string lone_name(std::string_view text);

struct ExpressionFunction {
  const char* name;
  const char* usage;  ///< "smoothstep(a, b, x)"
  const char* doc;
};
/// All functions, for `shoal describe` and messages.
const std::vector<ExpressionFunction>& expression_functions();

}  // namespace shoal::kernel
