// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A probe: numbers that are watched during a run, one row of a table per sample.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kernel/case/expression.hpp"
#include "kernel/output/series_file.hpp"
#include "kernel/particles/domain.hpp"
#include "kernel/schedule/simulation.hpp"
#include "shoal/abi.h"

namespace shoal::kernel {

class Probe {
 public:
  Probe() = default;
  Probe(const Probe&) = delete;
  Probe& operator=(const Probe&) = delete;
  virtual ~Probe() = default;

  struct FieldOfBody {
    std::uint32_t body = 0;
    std::string field, place;
  };
  /// Fields that must be computed for it; asked before the run is finalised.
  virtual std::vector<FieldOfBody> demands() const = 0;
  /// Once, after the run was finalised. Throws ModelError.
  virtual void bind(const Simulation& run) = 0;
  /// After bind.
  virtual std::vector<Column> columns() const = 0;
  /// One number per column; NaN where there is nothing to measure. After the stage `sample` of the run.
  virtual std::vector<double> sample(const Simulation& run) = 0;
};

/// What probes know of the case beside their own parameters.
struct ProbeContext {
  std::string name;  ///< of the probe
  int dimensions = 3;
  ExpressionScope parameters;  ///< of the case, for expressions
  Domain domain;
  const shoal_body* bodies = nullptr;
  std::uint32_t n_bodies = 0;
};

/// point, maximum, minimum, sum, mean.
const std::vector<const shoal_type*>& own_probe_types();

/// The probe of an object of a probe type, of the kernel or of a plugin. Throws ModelError, and the exceptions of
/// call_plugin().
std::unique_ptr<Probe> make_probe(const shoal_object& object, const ProbeContext& context);

}  // namespace shoal::kernel
