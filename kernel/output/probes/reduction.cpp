// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Maximum, minimum, sum and mean of an expression over the particles of bodies. Chunks and the order in which their
// results are put together do not depend on the number of threads.
#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "kernel/output/particle_expression.hpp"
#include "kernel/output/probes/own_probes.hpp"
#include "kernel/plugins/host.hpp"

namespace shoal::kernel {
namespace {

constexpr std::uint64_t chunk = 4096;

struct Partial {
  double value = 0.0;
  std::uint64_t count = 0;
};

double identity(Reduce how) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  return how == Reduce::maximum ? -infinite : how == Reduce::minimum ? infinite : 0.0;
}

// NaN wins, so that it is seen.
double combined(Reduce how, double a, double b) {
  if (how == Reduce::maximum) return std::isnan(a) || a > b ? a : b;
  if (how == Reduce::minimum) return std::isnan(a) || a < b ? a : b;
  return a + b;
}

class Reduction final : public Probe {
 public:
  Reduction(Reduce how, const shoal_object& object, const ProbeContext& context)
      : how_(how), name_(context.name) {
    parameters_.read(object, context.dimensions);
    for (const std::string& text : parameters_.of.value())
      of_.emplace_back(text, context.parameters, context.dimensions, parameters_.of.place());
    if (parameters_.where.is_set())
      where_.emplace(parameters_.where.value(), context.parameters, context.dimensions,
                     parameters_.where.place());
  }

  std::vector<FieldOfBody> demands() const override {
    std::vector<FieldOfBody> all;
    for (const BodyIndex body : parameters_.body.value()) {
      for (const ParticleExpression& expression : of_) add(all, expression, body.value);
      if (where_) add(all, *where_, body.value);
    }
    return all;
  }

  void bind(const Simulation& run) override {
    for (const BodyIndex body : parameters_.body.value()) {
      for (ParticleExpression& expression : of_) expression.bind(run, body.value);
      if (where_) where_->bind(run, body.value);
    }
    for (const ParticleExpression& expression : of_) {
      const std::string unit = parameters_.unit.is_set() ? parameters_.unit.value()
                               : parameters_.root        ? ""
                                                  : expression.unit(run, parameters_.body.value()[0].value);
      columns_.push_back({of_.size() == 1 ? name_ : expression.text(), unit});
    }
  }

  std::vector<Column> columns() const override { return columns_; }

  std::vector<double> sample(const Simulation& run) override {
    std::vector<double> values;
    for (const ParticleExpression& expression : of_) {
      const double value = reduce(run, expression);
      values.push_back(parameters_.root ? std::sqrt(value) : value);
    }
    return values;
  }

 private:
  static void add(std::vector<FieldOfBody>& all, const ParticleExpression& expression, std::uint32_t body) {
    for (const std::string& field : expression.fields()) all.push_back({body, field, expression.place()});
  }

  double reduce(const Simulation& run, const ParticleExpression& expression) {
    Partial total{identity(how_), 0};
    for (const BodyIndex body : parameters_.body.value()) {
      const std::uint64_t n = run.n_particles(body.value);
      std::vector<Partial> partials((n + chunk - 1) / chunk);
      tbb::parallel_for(std::size_t{0}, partials.size(), [&](std::size_t k) {
        partials[k] = reduce_chunk(run, expression, body.value, k * chunk, std::min(n, (k + 1) * chunk));
      });
      for (const Partial& partial : partials) {
        total.value = combined(how_, total.value, partial.value);
        total.count += partial.count;
      }
    }
    if (how_ == Reduce::sum) return total.value;
    if (total.count == 0) {
      warn_once();
      return std::numeric_limits<double>::quiet_NaN();
    }
    return how_ == Reduce::mean ? total.value / static_cast<double>(total.count) : total.value;
  }

  Partial reduce_chunk(const Simulation& run, const ParticleExpression& expression, std::uint32_t body,
                       std::uint64_t begin, std::uint64_t end) const {
    std::vector<double> values(end - begin), conditions;
    expression.evaluate(run, body, begin, end, values.data());
    if (where_) {
      conditions.resize(values.size());
      where_->evaluate(run, body, begin, end, conditions.data());
    }
    Partial partial{identity(how_), 0};
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (where_ && conditions[i] == 0.0) continue;
      partial.value = combined(how_, partial.value, values[i]);
      ++partial.count;
    }
    return partial;
  }

  void warn_once() {
    if (!std::exchange(warned_, true))
      log(LogLevel::warning, "probe '" + name_ + "': no particle meets its condition; its value is NaN then");
  }

  Reduce how_;
  std::string name_;
  ReductionParameters parameters_;
  std::vector<ParticleExpression> of_;
  std::optional<ParticleExpression> where_;
  std::vector<Column> columns_;
  bool warned_ = false;
};

}  // namespace

std::unique_ptr<Probe> make_reduction(Reduce how, const shoal_object& object, const ProbeContext& context) {
  return std::make_unique<Reduction>(how, object, context);
}

}  // namespace shoal::kernel
