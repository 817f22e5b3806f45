// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/output/reference.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernel/output/atomic_file.hpp"

namespace shoal::kernel {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<std::string_view, 9> measure_names{"rms",  "relative_rms", "max",    "peak",     "final",
                                                        "mean", "arrival",      "period", "amplitude"};

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

// Headers carry units ("front [m]") that a case need not repeat.
std::string without_unit(const std::string& header) {
  const std::size_t bracket = header.rfind(" [");
  return bracket == std::string::npos ? header : header.substr(0, bracket);
}

std::size_t column_of(const Table& table, const std::string& wanted, const std::filesystem::path& path) {
  for (std::size_t k = 0; k < table.names.size(); ++k) {
    if (table.names[k] == wanted || without_unit(table.names[k]) == wanted) return k;
  }
  const std::size_t n = table.rows[0].size();
  std::size_t number = 0;
  const char* last = wanted.data() + wanted.size();
  if (std::from_chars(wanted.data(), last, number).ptr == last && number >= 1 && number <= n)
    return number - 1;
  throw OutputError(
      "'" + path.string() + "' has no column '" + wanted + "'; it has " +
      (table.names.empty() ? std::to_string(n) + " columns without names" : joined(table.names)));
}

Series sorted(Series series) {
  std::vector<std::size_t> order(series.times.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return series.times[a] < series.times[b]; });
  Series result;
  for (const std::size_t k : order) {
    result.times.push_back(series.times[k]);
    result.values.push_back(series.values[k]);
  }
  return result;
}

// Linear between samples; NaN where either side is, or outside.
double value_at(const Series& series, double time) {
  const double slack = 1e-9 * std::abs(time);
  if (series.times.empty() || time < series.times.front() - slack || time > series.times.back() + slack)
    return nan;
  const auto after = std::upper_bound(series.times.begin(), series.times.end(), time);
  if (after == series.times.begin()) return series.values.front();
  if (after == series.times.end()) return series.values.back();
  const auto k = static_cast<std::size_t>(after - series.times.begin());
  const double share = (time - series.times[k - 1]) / (series.times[k] - series.times[k - 1]);
  if (share <= 0.0) return series.values[k - 1];
  return (1.0 - share) * series.values[k - 1] + share * series.values[k];
}

// What is compared, point by point; NaN where there is no value.
struct Pairs {
  std::vector<double> sampled, reference;

  void add(double value, double known) {
    sampled.push_back(value);
    reference.push_back(known);
  }
};

Pairs with_values(const Pairs& all) {
  Pairs pairs;
  for (std::size_t k = 0; k < all.sampled.size(); ++k)
    if (!std::isnan(all.sampled[k]) && !std::isnan(all.reference[k]))
      pairs.add(all.sampled[k], all.reference[k]);
  return pairs;
}

double largest_magnitude(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double difference(ErrorMeasure measure, const Pairs& pairs) {
  std::vector<double> differences(pairs.sampled.size());
  for (std::size_t k = 0; k < differences.size(); ++k) differences[k] = pairs.sampled[k] - pairs.reference[k];
  switch (measure) {
    case ErrorMeasure::max: return largest_magnitude(differences);
    case ErrorMeasure::last: return std::abs(differences.back());
    case ErrorMeasure::peak:
      return std::abs(*std::max_element(pairs.sampled.begin(), pairs.sampled.end()) -
                      *std::max_element(pairs.reference.begin(), pairs.reference.end()));
    case ErrorMeasure::mean: {
      double sum = 0.0;
      for (const double value : differences) sum += std::abs(value);
      return sum / static_cast<double>(differences.size());
    }
    case ErrorMeasure::arrival:
    case ErrorMeasure::period:
    case ErrorMeasure::amplitude: return std::abs(differences.front());
    case ErrorMeasure::rms:
    case ErrorMeasure::relative_rms: break;
  }
  return root_mean_square(differences);
}

double divisor(const ReferenceSpecification& specification, const Pairs& pairs) {
  if (specification.scale) return *specification.scale;
  if (specification.measure == ErrorMeasure::last) return std::abs(pairs.reference.back());
  if (specification.measure == ErrorMeasure::relative_rms) return root_mean_square(pairs.reference);
  return largest_magnitude(pairs.reference);
}

bool in_window(const ReferenceSpecification& specification, double time) {
  const double slack = 1e-9 * std::abs(time);
  return time >= specification.from - slack && (!specification.to || time <= *specification.to + slack);
}

// Peaks are taken over all samples: those at the times of the data alone would miss the highest.
Pairs peak_pairs(const ReferenceSpecification& specification, const Series& sampled, const Series& known) {
  double peak = nan;
  for (std::size_t k = 0; k < sampled.times.size(); ++k)
    if (in_window(specification, sampled.times[k])) peak = std::fmax(peak, sampled.values[k]);
  return {std::vector<double>(known.values.size(), peak), known.values};
}

std::uint64_t missing(const ReferenceSpecification& specification, const Series& series) {
  std::uint64_t n = 0;
  for (std::size_t k = 0; k < series.times.size(); ++k)
    if (in_window(specification, series.times[k]) && std::isnan(series.values[k])) ++n;
  return n;
}

// Of the samples within the window.
Series within(const ReferenceSpecification& specification, const Series& series) {
  Series part;
  for (std::size_t k = 0; k < series.times.size(); ++k) {
    if (!in_window(specification, series.times[k]) || std::isnan(series.values[k])) continue;
    part.times.push_back(series.times[k]);
    part.values.push_back(series.values[k]);
  }
  return part;
}

// Times at which the series rises through a level, linear between samples.
std::vector<double> rises(const Series& series, double level) {
  std::vector<double> times;
  for (std::size_t k = 1; k < series.times.size(); ++k) {
    const double a = series.values[k - 1] - level, b = series.values[k] - level;
    if (a < 0.0 && b >= 0.0)
      times.push_back(series.times[k - 1] + (series.times[k] - series.times[k - 1]) * (-a / (b - a)));
  }
  return times;
}

// Mean over time, by trapezoids: samples need not be evenly spaced.
double time_mean(const Series& series) {
  double sum = 0.0;
  for (std::size_t k = 1; k < series.times.size(); ++k)
    sum += 0.5 * (series.values[k] + series.values[k - 1]) * (series.times[k] - series.times[k - 1]);
  return sum / (series.times.back() - series.times.front());
}

// Each value becomes the mean of all within half a window before and behind; a NaN stays one and counts nowhere else.
Series averaged(const Series& series, double window) {
  Series smooth = series;
  std::size_t first = 0;
  for (std::size_t k = 0; k < series.times.size(); ++k) {
    const double half = 0.5 * window * (1.0 + 1e-9);
    while (series.times[first] < series.times[k] - half) ++first;
    double sum = 0.0, n = 0.0;
    for (std::size_t j = first; j < series.times.size() && series.times[j] <= series.times[k] + half; ++j)
      if (!std::isnan(series.values[j])) sum += series.values[j], n += 1.0;
    if (!std::isnan(series.values[k])) smooth.values[k] = sum / n;
  }
  return smooth;
}

// The one number of a series that `arrival`, `period` or `amplitude` compare; nothing if it has none.
std::optional<double> number_of(ErrorMeasure measure, const Series& series, double level) {
  if (measure == ErrorMeasure::amplitude) {
    if (series.values.empty()) return std::nullopt;
    const auto [least, largest] = std::minmax_element(series.values.begin(), series.values.end());
    return 0.5 * (*largest - *least);
  }
  if (measure == ErrorMeasure::arrival) {
    if (!series.values.empty() && series.values.front() >= level) return series.times.front();
    const std::vector<double> times = rises(series, level);
    return times.empty() ? std::nullopt : std::optional(times.front());
  }
  if (series.times.size() < 2) return std::nullopt;
  const std::vector<double> times = rises(series, time_mean(series));
  if (times.size() < 2) return std::nullopt;
  return (times.back() - times.front()) / static_cast<double>(times.size() - 1);
}

Pairs number_pairs(const ReferenceSpecification& specification, const Series& sampled, const Series& known) {
  Pairs pairs;
  if (known.values.empty()) return pairs;
  const double level = 0.5 * *std::max_element(known.values.begin(), known.values.end());
  const auto got = number_of(specification.measure, within(specification, sampled), level);
  const auto wanted = number_of(specification.measure, known, level);
  pairs.add(got.value_or(nan), wanted.value_or(nan));
  return pairs;
}

// An exact solution is compared at the times of the samples.
Series known_series(const ReferenceSpecification& specification, const Series& sampled) {
  if (!specification.exact) return read_reference(specification);
  Series known;
  for (const double time : sampled.times) {
    if (!in_window(specification, time)) continue;
    known.times.push_back(time);
    known.values.push_back(specification.exact(time));
  }
  return known;
}

Pairs pairs_of(const ReferenceSpecification& specification, const Series& sampled, const Series& known) {
  switch (specification.measure) {
    case ErrorMeasure::peak: return peak_pairs(specification, sampled, known);
    case ErrorMeasure::arrival:
    case ErrorMeasure::period:
    case ErrorMeasure::amplitude: return number_pairs(specification, sampled, known);
    default: break;
  }
  Pairs pairs;
  for (std::size_t k = 0; k < known.times.size(); ++k)
    pairs.add(value_at(sampled, known.times[k]), known.values[k]);
  return pairs;
}

Series read_series(const ReferenceSpecification& specification, const std::filesystem::path& path) {
  const Table table = read_table(path);
  const std::size_t value = specification.column.empty() ? 1 : column_of(table, specification.column, path);
  Series series;
  for (const std::vector<double>& row : table.rows) {
    series.times.push_back(row[0]);
    series.values.push_back(row[value]);
  }
  return series;
}

Series as_compared(const ReferenceSpecification& specification, Series sampled) {
  return specification.average > 0.0 ? averaged(sampled, specification.average) : sampled;
}

constexpr const char* no_value = "the probe has no value at the times of the reference";
constexpr const char* no_scale = "the reference is zero: give `scale`, what errors are to be divided by";

}  // namespace

std::optional<ErrorMeasure> error_measure(std::string_view name) {
  for (std::size_t k = 0; k < measure_names.size(); ++k)
    if (measure_names[k] == name) return static_cast<ErrorMeasure>(k);
  return std::nullopt;
}

std::string_view name_of(ErrorMeasure measure) { return measure_names[static_cast<std::size_t>(measure)]; }

std::string_view name_of(Verdict verdict) {
  return verdict == Verdict::pass ? "pass" : verdict == Verdict::fail ? "FAIL" : "incomplete";
}

Series read_reference(const ReferenceSpecification& specification) {
  const Table table = read_table(specification.data);
  const std::size_t time = column_of(table, specification.time_column, specification.data);
  const std::size_t value = column_of(table, specification.value_column, specification.data);
  Series series;
  for (const std::vector<double>& row : table.rows) {
    const double t = specification.time_scale * row[time] + specification.time_shift;
    if (std::isnan(t) || std::isnan(row[value]) || !in_window(specification, t)) continue;
    series.times.push_back(t);
    series.values.push_back(specification.value_scale * row[value] + specification.value_shift);
  }
  return sorted(std::move(series));
}

void check_reference(const ReferenceSpecification& specification) {
  if (specification.exact) return;
  if (read_reference(specification).times.empty())
    throw OutputError("'" + specification.data.string() +
                      "' has no point between the times that are to be compared");
}

ReferenceResult compare(const ReferenceSpecification& specification, const Series& as_sampled,
                        bool finished) {
  const Series sampled = as_compared(specification, as_sampled);
  ReferenceResult result;
  result.probe = specification.probe;
  result.column = specification.column;
  result.source =
      specification.exact ? "exact: " + specification.exact_text : specification.data.filename().string();
  result.measure = std::string(name_of(specification.measure));
  result.tolerance = specification.tolerance;
  const Pairs all = pairs_of(specification, sampled, known_series(specification, sampled));
  const Pairs pairs = with_values(all);
  result.points = pairs.sampled.size();
  result.left_out = specification.measure == ErrorMeasure::peak ? missing(specification, sampled)
                                                                : all.sampled.size() - pairs.sampled.size();
  if (pairs.sampled.empty()) {
    result.error = nan;
    result.remark = no_value;
  } else {
    const double by = divisor(specification, pairs);
    result.error = difference(specification.measure, pairs) / by;
    if (by == 0.0)
      result.remark = no_scale;
    else if (result.left_out > 0)
      result.remark = std::to_string(result.left_out) + " points without a value left out";
  }
  const bool whole =
      finished || (specification.to && !sampled.times.empty() && sampled.times.back() >= *specification.to);
  if (!whole)
    result.verdict = Verdict::incomplete;
  else
    result.verdict = result.error <= result.tolerance ? Verdict::pass : Verdict::fail;
  return result;
}

ReferenceResult compare_file(const ReferenceSpecification& specification, const std::filesystem::path& path,
                             bool finished) {
  try {
    return compare(specification, read_series(specification, path), finished);
  } catch (const OutputError& error) {
    ReferenceResult result = compare(specification, Series{}, finished);
    result.remark = error.what();
    return result;
  }
}

EnsembleResult compare_ensemble(const ReferenceSpecification& specification,
                                const std::vector<Series>& runs) {
  EnsembleResult result;
  result.tolerance = specification.mean_tolerance.value_or(specification.tolerance);
  result.error = result.deviation = nan;
  result.remark = no_value;
  if (runs.empty()) return result;
  const Series known = known_series(specification, as_compared(specification, runs[0]));
  std::vector<Pairs> each;
  for (const Series& run : runs)
    each.push_back(pairs_of(specification, as_compared(specification, run), known));
  const auto n = static_cast<double>(runs.size());
  Pairs mean = each[0];
  double squares = 0.0;  // of what runs are off their mean, summed over runs and points
  for (std::size_t k = 0; k < mean.sampled.size(); ++k) {
    double sum = 0.0;
    for (const Pairs& pairs : each) sum += pairs.sampled[k];
    mean.sampled[k] = sum / n;
    if (std::isnan(sum) || std::isnan(mean.reference[k])) continue;
    for (const Pairs& pairs : each) squares += std::pow(pairs.sampled[k] - mean.sampled[k], 2);
  }
  mean = with_values(mean);
  if (mean.sampled.empty()) return result;
  const double by = divisor(specification, mean);
  result.error = difference(specification.measure, mean) / by;
  if (runs.size() > 1)
    result.deviation = std::sqrt(squares / ((n - 1.0) * static_cast<double>(mean.sampled.size()))) / by;
  result.remark = by == 0.0 ? no_scale : "";
  result.verdict = result.error <= result.tolerance ? Verdict::pass : Verdict::fail;
  return result;
}

EnsembleResult compare_ensemble_files(const ReferenceSpecification& specification,
                                      const std::vector<std::filesystem::path>& tables) {
  std::vector<Series> runs;
  try {
    for (const std::filesystem::path& table : tables) runs.push_back(read_series(specification, table));
    return compare_ensemble(specification, runs);
  } catch (const OutputError& error) {
    EnsembleResult result = compare_ensemble(specification, {});
    result.remark = error.what();
    return result;
  }
}

}  // namespace shoal::kernel
