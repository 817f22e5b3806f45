// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// How far a probe is from what is known: a measured or computed series, or an exact solution. Every error is a ratio,
// so that a tolerance in per cent means the same everywhere.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kernel/output/series_file.hpp"

namespace shoal::kernel {

enum class ErrorMeasure {
  rms,           ///< root of the mean square difference, over the largest |reference|
  relative_rms,  ///< root of the mean square difference, over the root of the mean square of the reference
  max,           ///< largest difference, over the largest |reference|
  peak,          ///< difference of the largest values, over the largest |reference|
  last,          ///< difference at the last point of the reference, over the |reference| there ("final")
  mean,          ///< mean of the magnitudes of the differences, over the largest |reference|
  arrival,  ///< of the times of the first rise through half the reference's largest value, over the reference's
  period,    ///< of the mean times between rises through the series' means, over the reference's
  amplitude  ///< of half the differences between largest and least value, over the reference's
};

/// rms, relative_rms, max, peak, final, mean, arrival, period, amplitude.
std::optional<ErrorMeasure> error_measure(std::string_view name);
std::string_view name_of(ErrorMeasure measure);

struct ReferenceSpecification {
  std::string probe;
  std::string column;             ///< of the probe; empty: its first
  std::filesystem::path data;     ///< CSV; empty where `exact` is set
  std::string time_column = "1";  ///< by name, or by number from 1
  std::string value_column = "2";
  double time_scale = 1.0, time_shift = 0.0;  ///< time in s = scale * column + shift
  double value_scale = 1.0, value_shift = 0.0;
  std::function<double(double t)> exact;
  std::string exact_text;
  ErrorMeasure measure = ErrorMeasure::rms;
  double tolerance = 0.0;
  std::optional<double> mean_tolerance;  ///< of the mean over the runs of an ensemble; else `tolerance`
  std::optional<double> scale;           ///< what differences are divided by, instead of the above
  double average = 0.0;  ///< s; the probe is averaged over such a window about each of its times; 0: not
  double from = 0.0;     ///< s; what is before and behind is not compared
  std::optional<double> to;
};

enum class Verdict { pass, fail, incomplete };
std::string_view name_of(Verdict verdict);

struct ReferenceResult {
  std::string probe, source;
  std::string column;  ///< of the probe's file; empty for the first
  std::string measure;
  double error = 0.0;  ///< NaN where nothing could be compared
  double tolerance = 0.0;
  Verdict verdict = Verdict::fail;
  std::uint64_t points = 0;    ///< compared
  std::uint64_t left_out = 0;  ///< where the probe has no value (NaN)
  std::string remark;          ///< why there is no error, what was left out
};

/// A series of times, ascending, and values.
struct Series {
  std::vector<double> times, values;
};

/// The reference in SI units, within its window. Throws OutputError if the file or its columns are not there.
Series read_reference(const ReferenceSpecification& specification);

/// Checks at the start of a run what would otherwise be found at its end. Throws OutputError.
void check_reference(const ReferenceSpecification& specification);

/// `sampled` is the probe's series until now; `finished`: the run reached its end. Verdicts are given to the whole
/// window only: `incomplete` where the run stopped before.
ReferenceResult compare(const ReferenceSpecification& specification, const Series& sampled, bool finished);

/// The same with the probe's table from its file.
ReferenceResult compare_file(const ReferenceSpecification& specification, const std::filesystem::path& table,
                             bool finished);

/// Runs that differ by chance alone, together.
struct EnsembleResult {
  double error = 0.0;      ///< of their mean, point by point; NaN where nothing could be compared
  double deviation = 0.0;  ///< standard deviation of one run, over the same divisor; NaN for a single run
  double tolerance = 0.0;
  Verdict verdict = Verdict::fail;
  std::string remark;  ///< why there is no error
};

/// Of the measures that look for one number (peak, arrival, period, amplitude) the mean is that of the numbers. Exact
/// solutions are compared at the times of the first run.
EnsembleResult compare_ensemble(const ReferenceSpecification& specification, const std::vector<Series>& runs);

/// The same with the probe's table of each run.
EnsembleResult compare_ensemble_files(const ReferenceSpecification& specification,
                                      const std::vector<std::filesystem::path>& tables);

}  // namespace shoal::kernel
