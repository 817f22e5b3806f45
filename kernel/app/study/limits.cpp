// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/app/study/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernel/app/interrupt.hpp"
#include "kernel/app/session.hpp"
#include "kernel/app/study/files.hpp"
#include "kernel/app/text.hpp"
#include "kernel/case/overrides.hpp"
#include "kernel/output/series_file.hpp"

namespace shoal::kernel::app {
namespace {

constexpr double raised_by = 1.1, largest_ratio = 3.0, tolerated_ratio = 2.0;

// Largest magnitude of each column but the first, which is time; not a number if one of them is not.
std::vector<double> magnitudes(const Table& table) {
  std::vector<double> largest(table.names.empty() ? 0 : table.names.size() - 1, 0.0);
  for (const std::vector<double>& row : table.rows)
    for (std::size_t c = 1; c < row.size(); ++c)
      if (!(std::abs(row[c]) <= largest[c - 1])) largest[c - 1] = std::abs(row[c]);
  return largest;
}

std::string missed_reference(const StudyResult& run, const StudyResult& standard) {
  for (std::size_t k = 0; k < std::min(run.errors.size(), standard.errors.size()); ++k) {
    const StudyError &now = run.errors[k], &before = standard.errors[k];
    if (std::isnan(before.error)) continue;
    if (!(now.error <= std::max(before.tolerance, tolerated_ratio * before.error)))
      return fmt::format("{} {} misses its reference by {}, not {}", now.probe, now.measure,
                         percent_text(now.error), percent_text(before.error));
  }
  return {};
}

std::string runaway_probe(const StudyResult& standard, const std::filesystem::path& folder,
                          const std::filesystem::path& standard_folder) {
  if (!std::filesystem::exists(standard_folder / "probes")) return {};
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(standard_folder / "probes"))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const std::filesystem::path& file : files) {
    const std::string name = file.stem().string();
    const bool compared = std::any_of(standard.errors.begin(), standard.errors.end(),
                                      [&](const StudyError& error) { return error.probe == name; });
    if (compared || !std::filesystem::exists(folder / "probes" / file.filename())) continue;
    const Table table = read_table(file);
    const auto before = magnitudes(table), now = magnitudes(read_table(folder / "probes" / file.filename()));
    for (std::size_t c = 0; c < std::min(before.size(), now.size()); ++c)
      if (!std::isnan(before[c]) && !(now[c] <= tolerated_ratio * before[c]))
        return fmt::format("{} of {} reaches {}, not {}", table.names[c + 1], name, significant(now[c], 3),
                           significant(before[c], 3));
  }
  return {};
}

// The runs of one factor, each of them asked for once.
class FactorRuns {
 public:
  FactorRuns(CaseRunner& runner, const StepFactor& factor, const StudyResult& standard,
             const RunRequest& base, std::filesystem::path folder)
      : runner_(runner),
        factor_(factor),
        standard_(standard),
        base_(base),
        folder_(std::move(folder)),
        runs_(matrix({Variation{factor.key, raised_values(factor)}})) {}

  std::size_t size() const { return runs_.size(); }
  const std::string& value(std::size_t k) const { return runs_[k].values[0]; }

  /// Why run k failed; empty if it holds. Nothing if it cannot be known.
  std::optional<std::string> failure(std::size_t k) {
    if (interrupted()) return unknown("interrupted");
    RunRequest request{runs_[k], base_.settings, folder_ / factor_.key / runs_[k].name, "limit  "};
    request.settings.push_back(factor_.key + "=" + value(k));
    const StudyResult result = runner_.run(request);
    if (result.out_of_time || result.status == "interrupted")
      return unknown(fmt::format("{}: {}, {}", value(k), result.status, result.why));
    return failure_of(result, request.folder, standard_, base_.folder);
  }
  const std::string& why_unknown() const { return why_unknown_; }

 private:
  std::nullopt_t unknown(const std::string& why) {
    why_unknown_ = why;
    return std::nullopt;
  }

  CaseRunner& runner_;
  const StepFactor& factor_;
  const StudyResult& standard_;
  const RunRequest& base_;
  std::filesystem::path folder_;
  std::vector<StudyRun> runs_;
  std::string why_unknown_;
};

// Halves the values between one that holds and one that fails.
Limit find_limit(const StepFactor& factor, FactorRuns& runs) {
  Limit limit{factor, significant(factor.standard, 4), "", ""};
  const bool bounded = factor.largest && *factor.largest <= largest_ratio * factor.standard;
  limit.why = bounded ? "the largest that is allowed" : "the largest that was tried";
  std::size_t n_holding = 0, failing = runs.size();  // those before the first hold; that of the second fails
  for (std::size_t next = runs.size(); n_holding < failing; next = (n_holding + failing + 1) / 2) {
    const std::optional<std::string> failure = runs.failure(next - 1);
    if (!failure) {
      limit.why = runs.why_unknown();
      return limit;
    }
    if (failure->empty()) {
      n_holding = next;
      limit.holds_to = runs.value(next - 1);
    } else {
      failing = next - 1;
      limit.fails_at = runs.value(next - 1);
      limit.why = *failure;
    }
  }
  return limit;
}

}  // namespace

std::vector<StepFactor> declared_step_factors(const CaseModel& model) {
  std::vector<StepFactor> factors;
  for (std::size_t p = 0; p < model.physics.size(); ++p) {
    const shoal_object& object = *model.physics[p];
    for (std::uint32_t k = 0; k < object.type->n_parameters; ++k) {
      const shoal_parameter& parameter = object.type->parameters[k];
      const shoal_value& value = object.values[k];
      if ((parameter.flags & SHOAL_PARAMETER_STEP_FACTOR) == 0 || value.n == 0) continue;
      StepFactor& factor = factors.emplace_back();
      factor.key = fmt::format("physics.{}.{}.{}", p, object.type->name, parameter.key);
      factor.standard = value.reals[0];
      if ((parameter.flags & SHOAL_PARAMETER_HAS_MAXIMUM) != 0) factor.largest = parameter.maximum;
    }
  }
  return factors;
}

StepFactor read_step_factor(const std::string& text, const std::vector<StepFactor>& declared) {
  const Place place = option_place("<--limit " + text + ">");
  const auto equals = text.find('=');
  const std::string key = text.substr(0, equals);
  const auto known = std::find_if(declared.begin(), declared.end(),
                                  [&](const StepFactor& factor) { return factor.key == key; });
  StepFactor factor = known != declared.end() ? *known : StepFactor{key, 0.0, std::nullopt};
  if (equals == std::string::npos && known != declared.end()) return factor;
  std::vector<std::string> keys;
  for (const StepFactor& one : declared) keys.push_back(one.key);
  const std::string hint =
      keys.empty() ? "the physics of this case declares none" : "declared by the physics: " + join(keys);
  if (equals == std::string::npos)
    throw UserError(place, "'" + key + "' is not declared as a factor of time steps, so it needs a value",
                    {"where to begin: --limit " + key + "=VALUE", hint});
  Diagnostics diagnostics;
  const Node node = read_yaml_value(text.substr(equals + 1), place, diagnostics);
  const std::optional<double> value = read_number(node, NumberRequest{"1", false}, Parameters{}, diagnostics);
  diagnostics.throw_if_errors();
  if (!value || !(*value > 0.0)) throw UserError(place, "the value to begin with must be positive", {hint});
  factor.standard = *value;
  return factor;
}

std::vector<std::string> raised_values(const StepFactor& factor) {
  std::vector<std::string> values;
  for (double ratio = raised_by; ratio <= largest_ratio; ratio *= raised_by) {
    const double value = ratio * factor.standard;
    if (factor.largest && value >= *factor.largest) {
      if (*factor.largest > factor.standard) values.push_back(significant(*factor.largest, 4));
      break;
    }
    values.push_back(significant(value, 4));
  }
  return values;
}

std::string failure_of(const StudyResult& run, const std::filesystem::path& folder,
                       const StudyResult& standard, const std::filesystem::path& standard_folder) {
  if (!run.finished()) return run.why.empty() ? run.status : run.why;
  if (std::string why = missed_reference(run, standard); !why.empty()) return why;
  return runaway_probe(standard, folder, standard_folder);
}

std::vector<Limit> find_limits(CaseRunner& runner, const std::vector<StepFactor>& factors,
                               const RunRequest& standard, const std::filesystem::path& folder) {
  std::vector<Limit> limits;
  if (factors.empty() || interrupted()) return limits;
  const StudyResult result = runner.run(standard);
  for (const StepFactor& factor : factors) {
    FactorRuns runs(runner, factor, result, standard, folder);
    limits.push_back(result.finished() ? find_limit(factor, runs)
                                       : Limit{factor, "", "", "as it stands: " + result.why});
  }
  return limits;
}

std::string limits_table(const std::vector<Limit>& limits) {
  std::vector<std::vector<std::string>> rows{
      {"longest stable steps", "default", "holds to", "fails at", "why"}};
  for (const Limit& limit : limits)
    rows.push_back({last_word(limit.factor.key), significant(limit.factor.standard, 4), limit.holds_to,
                    limit.fails_at, limit.why});
  return table(rows, rows[0].size(), "  ");
}

std::string limits_csv(const std::vector<Limit>& limits) {
  std::string text = "parameter,default,holds_to,fails_at,why\n";
  for (const Limit& limit : limits)
    text += fmt::format("{},{},{},{},{}\n", csv_cell(limit.factor.key), significant(limit.factor.standard, 4),
                        limit.holds_to, limit.fails_at, csv_cell(limit.why));
  return text;
}

}  // namespace shoal::kernel::app
