// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/app/study/result.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "kernel/output/atomic_file.hpp"

namespace shoal::kernel::app {
namespace {

using Json = nlohmann::json;

double number(const Json& value) {
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

double smallest_spacing(const Json& bodies) {
  double of_moving = HUGE_VAL, of_all = HUGE_VAL;
  for (const Json& body : bodies) {
    const double spacing = number(body.at("spacing"));
    of_all = std::min(of_all, spacing);
    if (body.at("moves").get<bool>()) of_moving = std::min(of_moving, spacing);
  }
  return std::isfinite(of_moving) ? of_moving : of_all;
}

double pairs_per_second(const Json& operators) {
  double longest = 0.0, rate = std::numeric_limits<double>::quiet_NaN();
  for (const Json& op : operators) {
    const double pairs = number(op.at("pairs")), seconds = number(op.at("seconds"));
    if (!(pairs > 0.0) || !(seconds > longest)) continue;
    longest = seconds;
    rate = pairs / seconds;
  }
  return rate;
}

void fill(StudyResult& result, const Json& summary) {
  result.status = summary.at("status").get<std::string>();
  result.why = summary.at("failure").get<std::string>();
  result.spacing = smallest_spacing(summary.at("bodies"));
  result.particles = summary.at("particles").get<std::uint64_t>();
  result.outer_steps = summary.at("outer_steps").get<std::uint64_t>();
  const Json& time = summary.at("time");
  result.reached = number(time.at("reached")) / number(time.at("end"));
  const Json& cost = summary.at("cost");
  result.wall_seconds = number(cost.at("wall_seconds")) + number(cost.at("earlier_wall_seconds"));
  result.particle_steps_per_second = number(cost.at("particle_steps_per_second"));
  result.pairs_per_second = pairs_per_second(summary.at("operators"));
  result.peak_memory = cost.at("peak_memory_bytes").get<std::uint64_t>();
  result.bytes_per_particle = number(cost.at("field_and_list_bytes_per_particle"));
  for (const Json& reference : summary.at("references"))
    result.errors.push_back({reference.at("probe").get<std::string>(), reference.value("column", ""),
                             reference.at("measure").get<std::string>(), number(reference.at("error")),
                             number(reference.at("tolerance"))});
}

// Whether two runs agree in all variations but one.
bool agree_but(const StudyRun& a, const StudyRun& b, std::size_t variation) {
  for (std::size_t k = 0; k < a.values.size(); ++k)
    if (k != variation && a.values[k] != b.values[k]) return false;
  return true;
}

double error_of(const StudyResult& result, std::size_t error) {
  return result.finished() && error < result.errors.size() ? result.errors[error].error
                                                           : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

StudyResult read_result(const StudyRun& run, const std::filesystem::path& folder) {
  StudyResult result;
  result.run = run;
  result.status = "no result";
  if (!std::filesystem::exists(folder / "summary.json")) return result;
  try {
    fill(result, Json::parse(read_whole_file(folder / "summary.json")));
  } catch (const Json::exception& error) {
    result.status = "no result";
    result.why = "summary.json cannot be read: " + std::string(error.what());
  }
  return result;
}

std::optional<std::size_t> refined_variation(const std::vector<StudyResult>& results,
                                             std::size_t n_variations) {
  for (std::size_t k = 0; k < n_variations; ++k)
    for (const StudyResult& a : results)
      for (const StudyResult& b : results)
        if (a.spacing > 0.0 && b.spacing > 0.0 && a.spacing != b.spacing && agree_but(a.run, b.run, k))
          return k;
  return std::nullopt;
}

std::vector<std::optional<double>> observed_orders(const std::vector<StudyResult>& results, std::size_t error,
                                                   std::optional<std::size_t> refined) {
  std::vector<std::optional<double>> orders(results.size());
  if (!refined) return orders;
  for (std::size_t k = 0; k < results.size(); ++k) {
    const StudyResult* coarser = nullptr;
    for (const StudyResult& other : results)
      if (std::isfinite(error_of(other, error)) && other.spacing > results[k].spacing &&
          agree_but(other.run, results[k].run, *refined) &&
          (coarser == nullptr || other.spacing < coarser->spacing))
        coarser = &other;
    const double own = error_of(results[k], error);
    if (coarser == nullptr || !(own > 0.0) || !(error_of(*coarser, error) > 0.0)) continue;
    orders[k] = std::log(error_of(*coarser, error) / own) / std::log(coarser->spacing / results[k].spacing);
  }
  return orders;
}

std::vector<bool> pareto_front(const std::vector<StudyResult>& results, std::size_t error) {
  std::vector<bool> front(results.size(), false);
  for (std::size_t k = 0; k < results.size(); ++k) {
    const double own = error_of(results[k], error);
    if (!std::isfinite(own)) continue;
    front[k] = std::none_of(results.begin(), results.end(), [&](const StudyResult& other) {
      const double theirs = error_of(other, error);
      return (theirs < own && other.wall_seconds <= results[k].wall_seconds) ||
             (theirs <= own && other.wall_seconds < results[k].wall_seconds);
    });
  }
  return front;
}

std::optional<std::size_t> cheapest(const std::vector<StudyResult>& results, std::size_t error,
                                    double wanted) {
  std::optional<std::size_t> best;
  for (std::size_t k = 0; k < results.size(); ++k)
    if (error_of(results[k], error) <= wanted &&
        (!best || results[k].wall_seconds < results[*best].wall_seconds))
      best = k;
  return best;
}

}  // namespace shoal::kernel::app
