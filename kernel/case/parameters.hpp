// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The section `parameters` of a case, {H: 1 m, dx: $H/40}, and how any number of a case becomes a value: a plain
// number (SI), a number with a unit, or an expression of parameters.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kernel/case/diagnostics.hpp"
#include "kernel/case/expression.hpp"
#include "kernel/case/yaml_reader.hpp"

namespace shoal::kernel {

/// Evaluated parameters. They may refer to one another in any order.
class Parameters {
 public:
  struct Parameter {
    std::string name;
    Place place;          ///< of the value
    std::string text;     ///< as written
    std::string unit;     ///< "m" where the value was written with one; empty if not known
    double value = 0;     ///< SI; where the unit is known, of that unit's SI unit
    bool broken = false;  ///< its error was reported already
  };

  Parameters() = default;
  /// `section` is the map (null: no parameters). What is wrong goes to `diagnostics`.
  Parameters(const Node& section, Diagnostics& diagnostics);

  const std::vector<Parameter>& all() const { return parameters_; }  ///< in the order of the file
  std::vector<std::string> names() const;
  const Parameter* find(const std::string& name) const;

  /// Of expressions that use parameters and, of x, y, z and t, the given ones.
  ExpressionScope scope(const std::vector<std::string>& variables) const;

  /// Whether an expression uses a broken parameter, so that its error would be a consequence only.
  bool mentions_broken(const std::string& expression) const;

 private:
  class Resolver;
  std::vector<Parameter> parameters_;
};

struct NumberRequest {
  const char* unit = nullptr;  ///< the unit that is wanted; null: a plain number
  bool allow_infinite = false;
};

/// The value of a scalar in the wanted unit. Without a value the error was reported.
std::optional<double> read_number(const Node& node, const NumberRequest& request,
                                  const Parameters& parameters, Diagnostics& diagnostics);

/// The same, or an expression of the given variables; with `any_name` also of names that the case does not know, which
/// are the fields of the expression.
std::optional<Expression> read_expression(const Node& node, const NumberRequest& request,
                                          const std::vector<std::string>& variables,
                                          const Parameters& parameters, Diagnostics& diagnostics,
                                          bool any_name = false);

/// "a length (m)", "a number".
std::string described_number(const NumberRequest& request);

}  // namespace shoal::kernel
