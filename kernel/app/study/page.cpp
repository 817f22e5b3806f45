// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/app/study/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "kernel/app/text.hpp"

namespace shoal::kernel::app {
namespace {

using Rows = std::vector<std::vector<std::string>>;

std::optional<double> number(const std::string& text) {
  double value = 0.0;
  const auto end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || at != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

// A cell of study.csv as people read it, after the unit or the last word of its column.
std::string readable(const std::string& column, const std::string& cell) {
  const std::optional<double> value = number(cell);
  if (!value) return cell;
  if (column == "wall_time [s]") return duration_text(*value);
  if (column == "peak_memory [byte]") return bytes_text(*value);
  if (column == "particles") return count_text(static_cast<std::uint64_t>(*value));
  if (column.ends_with(" error") || column.ends_with(" tolerance")) return percent_text(*value);
  if (column.ends_with(" order")) return fmt::format("{:.2f}", *value);
  return significant(*value, 3);
}

std::string heading(std::string column) {
  if (const auto unit = column.find(" [byte]"); unit != std::string::npos) column.erase(unit);
  if (column == "wall_time [s]") return "wall time";
  std::replace(column.begin(), column.end(), '_', ' ');
  return column;
}

// study.csv by the meaning of its columns: first the variations, at the end three columns for each reference.
class StudyTable {
 public:
  using Cells = std::vector<std::string>;

  explicit StudyTable(const std::vector<Cells>& table) : table_(table) {
    for (std::size_t c = 0; !table.empty() && c < table[0].size(); ++c) {
      if (table[0][c].ends_with(" error")) references_.push_back(c);
    }
  }
  std::size_t runs() const { return table_.size() < 2 ? 0 : table_.size() - 1; }
  const std::vector<std::size_t>& references() const { return references_; }
  std::string name(std::size_t reference) const {
    return table_[0][reference].substr(0, table_[0][reference].size() - 6);
  }
  bool finished(std::size_t run) const { return text(run, "status") == "finished"; }
  /// Of run 1, 2, ...
  std::optional<double> error(std::size_t run, std::size_t reference) const { return value(run, reference); }
  std::optional<double> tolerance(std::size_t run, std::size_t reference) const {
    return value(run, reference + 1);
  }
  std::string text(std::size_t run, std::size_t column) const {
    return column < table_[run].size() ? readable(table_[0][column], table_[run][column]) : "";
  }
  std::string text(std::size_t run, const std::string& column) const {
    const auto at = std::find(table_[0].begin(), table_[0].end(), column);
    return text(run, static_cast<std::size_t>(at - table_[0].begin()));
  }
  /// "dx = $H/40, scheme = edac"; "error" where nothing is varied.
  std::string label(std::size_t run) const {
    std::string text;
    for (std::size_t c = 1; c < table_[0].size() && table_[0][c] != "status"; ++c)
      text += (text.empty() ? "" : ", ") + table_[0][c].substr(table_[0][c].rfind('.') + 1) + " = " +
              table_[run][c];
    return text.empty() ? "error" : text;
  }
  /// The reference that a run misses most, or meets with least to spare; nothing if one has no error.
  std::optional<std::size_t> hardest(std::size_t run) const {
    std::optional<std::size_t> worst;
    for (const std::size_t r : references_) {
      if (!error(run, r) || !tolerance(run, r)) return std::nullopt;
      if (!worst || share(run, r) > share(run, *worst)) worst = r;
    }
    return worst;
  }
  double share(std::size_t run, std::size_t reference) const {
    return *error(run, reference) / *tolerance(run, reference);
  }

 private:
  std::optional<double> value(std::size_t run, std::size_t column) const {
    return column < table_[run].size() ? number(table_[run][column]) : std::nullopt;
  }
  const std::vector<Cells>& table_;
  std::vector<std::size_t> references_;
};

// What the runs cost: all columns that do not compare; those left out are in study.csv.
Rows costs(const CaseReport& report) {
  Rows rows;
  if (report.table.empty()) return rows;
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < report.table[0].size(); ++c) {
    const std::string& name = report.table[0][c];
    if (name.ends_with(" error")) break;
    if (name != "run" && name != "outer_steps" && name != "spacing [m]") columns.push_back(c);
  }
  for (const auto& row : report.table) {
    auto& out = rows.emplace_back();
    for (const std::size_t c : columns)
      out.push_back(c >= row.size()    ? ""
                    : rows.size() == 1 ? heading(row[c])
                                       : readable(report.table[0][c], row[c]));
  }
  return rows;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '&')
      out += "&amp;";
    else
      out += c;
  }
  return out;
}

std::string markdown_table(const Rows& rows) {
  std::string text;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    text += "|";
    for (std::string cell : rows[r]) {
      for (std::size_t at = 0; (at = cell.find('|', at)) != std::string::npos; at += 2) cell.insert(at, "\\");
      text += " " + cell + " |";
    }
    text += "\n";
    if (r == 0) {
      text += "|";
      for (std::size_t c = 0; c < rows[r].size(); ++c) text += "---|";
      text += "\n";
    }
  }
  return text;
}

std::string html_table(const Rows& rows) {
  std::string text = "<table>\n";
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const char* tag = r == 0 ? "th" : "td";
    text += "<tr>";
    for (const std::string& cell : rows[r]) text += fmt::format("<{0}>{1}</{0}>", tag, escaped(cell));
    text += "</tr>\n";
  }
  return text + "</table>\n";
}

std::string machine_text(const MachineReport& machine) {
  std::string text = fmt::format("{}, {} cores, {} threads; shoal {}; {}", machine.processor, machine.cores,
                                 machine.threads, machine.version, machine.date);
  if (!machine.within.empty()) text += "; each case within " + machine.within;
  return text;
}

// How far the runs are from each reference.
Rows errors(const CaseReport& report) {
  const StudyTable table(report.table);
  if (table.runs() == 0 || table.references().empty()) return {};
  Rows rows{{"reference", "tolerance"}};
  for (std::size_t run = 1; run <= table.runs(); ++run) rows[0].push_back(table.label(run));
  rows[0].push_back("last order");
  for (const std::size_t r : table.references()) {
    auto& row = rows.emplace_back(std::vector<std::string>{table.name(r), table.text(1, r + 1)});
    std::string order;
    for (std::size_t run = 1; run <= table.runs(); ++run) {
      row.push_back(table.text(run, r));
      if (const std::string own = table.text(run, r + 2); !own.empty()) order = own;
    }
    row.push_back(order);
  }
  return rows;
}

// ensemble.csv by the meaning of its columns: first the variations.
class MeansTable {
 public:
  explicit MeansTable(const std::vector<std::vector<std::string>>& table) : table_(table) {}
  std::size_t rows() const { return table_.empty() ? 0 : table_.size() - 1; }
  std::string text(std::size_t row, const std::string& column) const {
    const auto at = std::find(table_[0].begin(), table_[0].end(), column) - table_[0].begin();
    const std::string& cell = table_[row].at(static_cast<std::size_t>(at));
    const std::optional<double> value = number(cell);
    const bool is_share =
        column == "error of the mean" || column == "tolerance" || column == "deviation of a run";
    return value && is_share ? percent_text(*value) : cell;
  }
  /// The mean that misses its reference most, or meets it with least to spare; nothing if one has no error.
  std::optional<std::size_t> hardest() const {
    std::optional<std::size_t> worst;
    for (std::size_t row = 1; row <= rows(); ++row) {
      if (!share(row)) return std::nullopt;
      if (!worst || *share(row) > *share(*worst)) worst = row;
    }
    return worst;
  }

 private:
  std::optional<double> share(std::size_t row) const {
    const std::size_t n = table_[0].size();  // ..., error of the mean, tolerance, deviation of a run, verdict
    const auto error = number(table_[row].at(n - 4)), tolerance = number(table_[row].at(n - 3));
    return error && tolerance ? std::optional(*error / *tolerance) : std::nullopt;
  }
  const std::vector<std::vector<std::string>>& table_;
};

Rows means(const CaseReport& report) {
  const MeansTable table(report.means);
  if (table.rows() == 0) return {};
  Rows rows{report.means[0]};
  for (std::size_t row = 1; row <= table.rows(); ++row) {
    auto& out = rows.emplace_back();
    for (const std::string& column : report.means[0]) out.push_back(table.text(row, column));
  }
  return rows;
}

// How far time steps can be raised, as limits.csv says.
Rows limits(const CaseReport& report) {
  if (report.limits.size() < 2) return {};
  Rows rows{{"longest stable steps", "default", "holds to", "fails at", "why"}};
  for (std::size_t k = 1; k < report.limits.size(); ++k) {
    rows.push_back(report.limits[k]);
    rows.back()[0] = last_word(rows.back()[0]);
  }
  return rows;
}

// "acoustic_cfl 0.8 (0.6)"; a factor at which nothing failed is marked.
std::string limits_text(const CaseReport& report) {
  std::string text;
  for (const auto& row : limits(report)) {
    if (row[0] == "longest stable steps") continue;
    text += fmt::format("{}{} {}{} ({})", text.empty() ? "" : ", ", row[0],
                        row[3].empty() && !row[2].empty() ? "at least " : "", row[2].empty() ? "?" : row[2],
                        row[1]);
  }
  return text;
}

// The best run of each case on one line: that whose hardest reference is met best.
Rows overview(const std::vector<CaseReport>& cases) {
  Rows rows{{"case", "what", "runs", "largest error", "tolerance", "of reference", "order", "wall time",
             "bytes per particle", "steps hold to (default)"}};
  for (const CaseReport& report : cases) {
    auto& row = rows.emplace_back(std::vector<std::string>{report.area + "/" + report.name, report.title});
    const StudyTable table(report.table);
    if (table.runs() == 0) {
      row.insert(row.end(), {"0", report.failure, "", "", "", "", "", ""});
      continue;
    }
    row.push_back(std::to_string(table.runs()));
    std::optional<std::size_t> best;
    for (std::size_t run = 1; run <= table.runs(); ++run) {
      if (const auto r = table.hardest(run))
        if (!best || table.share(run, *r) < table.share(*best, *table.hardest(*best))) best = run;
    }
    const std::size_t run = best.value_or(table.runs());
    const MeansTable together(report.means);
    if (const auto mean = together.hardest()) {  // a single run says nothing where no two are the same
      row.insert(row.end(),
                 {together.text(*mean, "error of the mean"), together.text(*mean, "tolerance"),
                  "mean of " + together.text(*mean, "runs") + ": " + together.text(*mean, "reference"), ""});
    } else if (best) {
      const std::size_t r = *table.hardest(run);
      row.insert(row.end(),
                 {table.text(run, r), table.text(run, r + 1), table.name(r), table.text(run, r + 2)});
    } else {
      row.insert(row.end(), {!table.finished(run)         ? table.text(run, "status")
                             : table.references().empty() ? "no reference"
                                                          : "not all compared",
                             "", "", ""});
    }
    row.push_back(table.text(run, "wall_time [s]"));
    row.push_back(table.text(run, "bytes_per_particle [byte]"));
    row.push_back(limits_text(report));
  }
  return rows;
}

constexpr const char* style =
    "body{font:16px/1.5 sans-serif;max-width:62em;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;font-size:14px;margin:1em 0;display:block;overflow-x:auto}"
    "th,td{border-bottom:1px solid #ddd;padding:.25em .7em;text-align:left;white-space:nowrap}"
    "pre{background:#f6f6f6;padding:1em;overflow-x:auto;font-size:13px}"
    "svg{width:100%;max-width:30em;height:auto}h2{margin-top:2.5em}";

}  // namespace

std::string picture_file(const CaseReport& report, const std::string& picture) {
  return report.area + "_" + report.name + "_" + picture + ".svg";
}

std::string markdown_page(const MachineReport& machine, const std::vector<CaseReport>& cases) {
  std::string text = "# What the cases give, and at what cost\n\n" + machine_text(machine) +
                     "\n\nMade by `shoal report`; nothing here is written by hand.\n\n" +
                     markdown_table(overview(cases));
  for (const CaseReport& report : cases) {
    text += fmt::format("\n## {}/{}: {}\n\n", report.area, report.name, report.title);
    if (!report.what.empty()) text += report.what + "\n\n";
    text += "Plugins: " + report.plugins + ".\n\n";
    if (!report.failure.empty()) text += "**" + report.failure + "**\n\n";
    for (const Rows& rows : {errors(report), means(report), costs(report), limits(report)})
      if (!rows.empty()) text += markdown_table(rows) + "\n";
    for (const auto& [name, svg] : report.pictures)
      text += fmt::format("![{}]({})\n", heading(name), picture_file(report, name));
    text += "\n<details><summary>Plan of a run</summary>\n\n```\n" + report.plan + "```\n\n</details>\n";
  }
  return text;
}

std::string html_page(const MachineReport& machine, const std::vector<CaseReport>& cases) {
  std::string text = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Shoal: "
      "cases</title><style>{}</style>"
      "</head><body>\n<h1>What the cases give, and at what cost</h1>\n<p>{}</p>\n",
      style, escaped(machine_text(machine)));
  text += html_table(overview(cases));
  for (const CaseReport& report : cases) {
    text += fmt::format("<h2>{}/{}: {}</h2>\n<p>{}</p>\n<p>Plugins: {}.</p>\n", report.area, report.name,
                        escaped(report.title), escaped(report.what), escaped(report.plugins));
    if (!report.failure.empty()) text += "<p><strong>" + escaped(report.failure) + "</strong></p>\n";
    for (const Rows& rows : {errors(report), means(report), costs(report), limits(report)})
      if (!rows.empty()) text += html_table(rows);
    for (const auto& [name, svg] : report.pictures)
      text += svg.substr(std::min(svg.find("<svg"), svg.size())) + "\n";
    text += "<details><summary>Plan of a run</summary><pre>" + escaped(report.plan) + "</pre></details>\n";
  }
  return text + "</body></html>\n";
}

}  // namespace shoal::kernel::app
