// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/app/study/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernel/app/text.hpp"

namespace shoal::kernel::app {
namespace {

// The run that names the references: they are the same in all that got so far.
const StudyResult* with_errors(const Study& study) {
  for (const StudyResult& result : study.results)
    if (!result.errors.empty()) return &result;
  return nullptr;
}

std::string order_text(const std::optional<double>& order) {
  return order ? fmt::format("{:.2f}", *order) : "";
}

// What distinguishes the curves of a picture: the values of all variations but the refined one.
std::string curve_of(const Study& study, const StudyResult& result) {
  std::string name;
  for (std::size_t k = 0; k < study.variations.size(); ++k) {
    if (study.refined && k == *study.refined) continue;
    name += (name.empty() ? "" : ", ") + last_word(study.variations[k].key) + "=" + result.run.values[k];
  }
  return name;
}

struct Curve {
  std::string name;
  std::vector<const StudyResult*> points;
};

std::vector<Curve> curves(const Study& study) {
  std::vector<Curve> all;
  for (const StudyResult& result : study.results) {
    if (!result.finished() || study.chosen >= result.errors.size()) continue;
    if (!(result.errors[study.chosen].error > 0.0)) continue;
    const std::string name = curve_of(study, result);
    auto known = std::find_if(all.begin(), all.end(), [&](const Curve& curve) { return curve.name == name; });
    if (known == all.end()) known = all.insert(all.end(), Curve{name, {}});
    known->points.push_back(&result);
  }
  for (Curve& curve : all)
    std::sort(curve.points.begin(), curve.points.end(),
              [](const StudyResult* a, const StudyResult* b) { return a->spacing > b->spacing; });
  return all;
}

std::string quoted(std::string text) {
  for (std::size_t at = 0; (at = text.find('\'', at)) != std::string::npos; at += 2) text.insert(at, "'");
  return "'" + text + "'";
}

// Lines of order 1 and 2 through the coarsest point of the first curve, to compare slopes with.
std::string order_lines(const Study& study, const std::vector<Curve>& all) {
  const StudyResult& coarsest = *all[0].points.front();
  if (all[0].points.size() < 2) return "";
  const double finest = all[0].points.back()->spacing, error = coarsest.errors[study.chosen].error;
  std::string text;
  for (const int order : {1, 2})
    text += fmt::format(
        ", \
     [{}:{}] {}*(x/{})**{} with lines dashtype {} linecolor 'grey50' title 'order {}'",
        finest, coarsest.spacing, error, coarsest.spacing, order, order + 1, order);
  return text;
}

std::string picture(const std::vector<Curve>& all, const std::string& name, const std::string& label,
                    int column, const std::string& lines) {
  std::string text;
  for (const char* terminal : {"svg size 760,520 dynamic enhanced background 'white' font 'sans,14'",
                               "pngcairo size 1140,780 noenhanced font 'sans,16'"}) {
    const std::string ending = terminal[0] == 's' ? "svg" : "png";
    text += fmt::format("set terminal {}\nset output '{}.{}'\nset xlabel {}\nplot ", terminal, name, ending,
                        quoted(label));
    for (std::size_t k = 0; k < all.size(); ++k)
      text += fmt::format("{}$curve{} using {}:3 with linespoints linewidth 2 pointtype 7 title {}",
                          k > 0 ? ", \\\n     " : "", k, column,
                          quoted(all[k].name.empty() ? "measured" : all[k].name));
    text += lines + "\n";
  }
  return text;
}

}  // namespace

std::string csv_cell(std::string text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2) text.insert(at, "\"");
  return '"' + text + '"';
}

std::string csv_number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

std::vector<std::string> error_names(const Study& study) {
  std::vector<std::string> names;
  if (const StudyResult* result = with_errors(study))
    for (const StudyError& error : result->errors) {
      const std::string of = error.probe + (error.column.empty() ? "" : "." + error.column);
      std::string name = of + " " + error.measure;
      for (int k = 2; std::find(names.begin(), names.end(), name) != names.end(); ++k)
        name = fmt::format("{} {} {}", of, k, error.measure);
      names.push_back(name);
    }
  return names;
}

std::string study_table(const Study& study) {
  std::vector<std::vector<std::string>> rows(1);
  for (const Variation& variation : study.variations) rows[0].push_back(last_word(variation.key));
  const std::size_t left = rows[0].size() + 1;
  for (const char* title : {"", "spacing", "particles", "wall time", "particle-steps/s", "pairs/s", "memory"})
    rows[0].emplace_back(title);
  const std::vector<std::string> names = error_names(study);
  std::vector<std::vector<std::optional<double>>> orders;
  for (std::size_t e = 0; e < names.size(); ++e) {
    rows[0].push_back(names[e]);
    rows[0].emplace_back("order");
    orders.push_back(observed_orders(study.results, e, study.refined));
  }
  const std::vector<bool> front = pareto_front(study.results, study.chosen);
  for (std::size_t k = 0; k < study.results.size(); ++k) {
    const StudyResult& result = study.results[k];
    std::vector<std::string> row = result.run.values;
    row.push_back(!result.finished() ? result.status : front[k] ? "*" : "");
    const bool known = result.status != "no result";
    row.push_back(known ? significant(result.spacing, 3) : "");
    row.push_back(known ? count_text(result.particles) : "");
    row.push_back(known ? duration_text(result.wall_seconds) : "");
    row.push_back(known ? significant(result.particle_steps_per_second, 3) : "");
    row.push_back(std::isfinite(result.pairs_per_second) && known ? significant(result.pairs_per_second, 3)
                                                                  : "");
    row.push_back(known ? bytes_text(static_cast<double>(result.peak_memory)) : "");
    for (std::size_t e = 0; e < names.size(); ++e) {
      const bool has = result.finished() && e < result.errors.size() && std::isfinite(result.errors[e].error);
      row.push_back(has ? significant(result.errors[e].error, 3) : "");
      row.push_back(order_text(orders[e][k]));
    }
    rows.push_back(std::move(row));
  }
  return table(rows, left, "  ");
}

std::string study_csv(const Study& study) {
  std::string text = "run";
  for (const Variation& variation : study.variations) text += "," + csv_cell(variation.key);
  text +=
      ",status,spacing [m],particles,outer_steps,wall_time [s],particle_steps_per_second "
      "[1/s],pairs_per_second [1/s],peak_memory "
      "[byte],"
      "bytes_per_particle [byte]";
  const std::vector<std::string> names = error_names(study);
  std::vector<std::vector<std::optional<double>>> orders;
  for (std::size_t e = 0; e < names.size(); ++e) {
    text += fmt::format(",{},{},{}", csv_cell(names[e] + " error"), csv_cell(names[e] + " tolerance"),
                        csv_cell(names[e] + " order"));
    orders.push_back(observed_orders(study.results, e, study.refined));
  }
  text += "\n";
  for (std::size_t k = 0; k < study.results.size(); ++k) {
    const StudyResult& r = study.results[k];
    text += csv_cell(r.run.name);
    for (const std::string& value : r.run.values) text += "," + csv_cell(value);
    text += fmt::format(",{},{},{},{},{},{},{},{},{}", csv_cell(r.status), r.spacing, r.particles,
                        r.outer_steps, r.wall_seconds, r.particle_steps_per_second,
                        csv_number(r.pairs_per_second), r.peak_memory, r.bytes_per_particle);
    for (std::size_t e = 0; e < names.size(); ++e) {
      const bool has = r.finished() && e < r.errors.size();  // what came before is another comparison
      text += has ? fmt::format(",{},{},", r.errors[e].error, r.errors[e].tolerance) : ",,,";
      if (orders[e][k]) text += fmt::format("{}", *orders[e][k]);
    }
    text += "\n";
  }
  return text;
}

std::string study_plot(const Study& study) {
  const std::vector<Curve> all = curves(study);
  std::size_t points = 0;
  for (const Curve& curve : all) points += curve.points.size();
  if (points < 2) return {};
  std::string text = "# Drawn with: gnuplot study.gnuplot\n";
  for (std::size_t k = 0; k < all.size(); ++k) {
    text += fmt::format("$curve{} << END\n", k);
    for (const StudyResult* point : all[k].points)
      text +=
          fmt::format("{} {} {}\n", point->spacing, point->wall_seconds, point->errors[study.chosen].error);
    text += "END\n";
  }
  text += fmt::format(
      "set logscale xy\nset format '%g'\nset grid\nset key outside bottom center horizontal\nset rmargin 6\n"
      "set title {} noenhanced\nset ylabel {} noenhanced\n",
      quoted(study.title), quoted(error_names(study)[study.chosen] + " error"));
  if (study.refined) text += picture(all, "error_against_spacing", "spacing, m", 1, order_lines(study, all));
  return text + picture(all, "error_against_time", "wall time, s", 2, "");
}

}  // namespace shoal::kernel::app
