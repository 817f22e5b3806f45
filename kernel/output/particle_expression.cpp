// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/output/particle_expression.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "kernel/case/diagnostics.hpp"
#include "kernel/particles/errors.hpp"

namespace shoal::kernel {
namespace {

Expression parse(const std::string& text, ExpressionScope scope, int dimensions, const std::string& place) {
  scope.variables = {"x", "y", "t"};
  if (dimensions == 3) scope.variables.insert(scope.variables.begin() + 2, "z");
  scope.is_field = [](const std::string& name) { return is_part_name(name); };
  try {
    return Expression(text, scope);
  } catch (const ExpressionError& error) {
    std::string message = error.what();
    for (const std::string& note : error.notes()) message += " (" + note + ")";
    throw ModelError(message, place);
  }
}

}  // namespace

ParticleExpression::ParticleExpression(const std::string& text, ExpressionScope parameters, int dimensions,
                                       std::string place)
    : expression_(parse(text, std::move(parameters), dimensions, place)),
      dimensions_(dimensions),
      place_(std::move(place)) {}

std::vector<std::string> ParticleExpression::fields() const {
  std::vector<std::string> fields;
  for (const std::string& name : expression_.fields()) {
    const std::string field = field_of(name);
    if (field != "position" && std::find(fields.begin(), fields.end(), field) == fields.end())
      fields.push_back(field);
  }
  return fields;
}

std::string ParticleExpression::unit(const Simulation& run, std::uint32_t body) const {
  const std::vector<std::string>& names = expression_.fields();
  if (names.size() != 1 || names[0] != text()) return {};
  const std::optional<FieldInfo> info = run.field_info(body, field_of(names[0]));
  return info ? FieldPart(*info, names[0], dimensions_, place_).unit() : std::string();
}

void ParticleExpression::bind(const Simulation& run, std::uint32_t body) {
  Bound bound{body, {}};
  for (const std::string& name : expression_.fields()) {
    const std::optional<FieldInfo> info = run.field_info(body, field_of(name));
    if (!info) {
      std::vector<std::string> known;
      for (const FieldInfo& field : run.fields(body)) known.push_back(field.name);
      throw ModelError("body '" + run.body_name(body) + "' has no field '" + field_of(name) + "'" +
                           did_you_mean(field_of(name), known) + " (its fields: " + join(known) + ")",
                       place_);
    }
    bound.parts.emplace_back(*info, name, dimensions_, place_);
  }
  bodies_.push_back(std::move(bound));
}

const ParticleExpression::Bound& ParticleExpression::bound(std::uint32_t body) const {
  for (const Bound& candidate : bodies_)
    if (candidate.body == body) return candidate;
  throw std::logic_error("an expression is evaluated for a body that it is not bound to");
}

void ParticleExpression::evaluate(const Simulation& run, std::uint32_t body, std::uint64_t begin,
                                  std::uint64_t end, double* out) const {
  const Bound& names = bound(body);
  const std::uint64_t n = end - begin;
  std::vector<std::vector<double>> values(names.parts.size());
  std::vector<const double*> columns;
  for (std::size_t k = 0; k < names.parts.size(); ++k) {
    const shoal_field field = run.field(body, field_of(expression_.fields()[k]));
    values[k].resize(n);
    for (std::uint64_t i = 0; i < n; ++i)
      values[k][i] = names.parts[k].value(field, begin + i, {1.0, 1.0, 1.0});
    columns.push_back(values[k].data());
  }
  const auto* positions = static_cast<const double*>(run.field(body, "position").data);
  expression_.evaluate(dimensions_, n, positions + begin * static_cast<std::uint64_t>(dimensions_),
                       columns.data(), run.time(), out);
}

std::vector<double> ParticleExpression::evaluate(const Simulation& run, std::uint32_t body,
                                                 const std::vector<ParticleImage>& particles) const {
  const Bound& names = bound(body);
  std::vector<std::vector<double>> values(names.parts.size());
  std::vector<const double*> columns;
  for (std::size_t k = 0; k < names.parts.size(); ++k) {
    const std::string& name = expression_.fields()[k];
    const shoal_field field = run.field(body, field_of(name));
    for (const ParticleImage& particle : particles) {
      const bool place = field_of(name) == "position" && names.parts[k].is_component();
      values[k].push_back(place ? particle.position[names.parts[k].component()]
                                : names.parts[k].value(field, particle.index, particle.flip));
    }
    columns.push_back(values[k].data());
  }
  std::vector<double> positions, out(particles.size());
  for (const ParticleImage& particle : particles)
    positions.insert(positions.end(), particle.position.begin(), particle.position.begin() + dimensions_);
  expression_.evaluate(dimensions_, particles.size(), positions.data(), columns.data(), run.time(),
                       out.data());
  return out;
}

}  // namespace shoal::kernel
