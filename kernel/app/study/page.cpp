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

// The columns that a page shows; all others are in study.csv.
Rows shown(const CaseReport& report) {
  Rows rows;
  if (report.table.empty()) return rows;
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < report.table[0].size(); ++c) {
    const std::string& name = report.table[0][c];
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
  return fmt::format("{}, {} cores, {} threads; shoal {}; {}", machine.processor, machine.cores,
                     machine.threads, machine.version, machine.date);
}

// The best of each case on one line: the overview.
Rows overview(const std::vector<CaseReport>& cases) {
  Rows rows{{"case", "what", "runs", "smallest error", "of", "last order", "wall time of that run",
             "bytes per particle"}};
  for (const CaseReport& report : cases) {
    auto& row = rows.emplace_back(std::vector<std::string>{report.area + "/" + report.name, report.title});
    if (report.table.size() < 2) {
      row.insert(row.end(), {"0", report.failure, "", "", "", ""});
      continue;
    }
    const auto& names = report.table[0];
    const auto at = [&](const std::string& name) {
      return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    };
    const auto first_error = std::find_if(names.begin(), names.end(),
                                          [](const std::string& name) { return name.ends_with(" error"); });
    std::size_t best = 0;
    for (std::size_t r = 1; r < report.table.size() && first_error != names.end(); ++r) {
      const auto c = static_cast<std::size_t>(first_error - names.begin());
      const auto value = number(report.table[r][c]);
      const auto so_far = best > 0 ? number(report.table[best][c]) : std::nullopt;
      if (value && (!so_far || *value < *so_far)) best = r;
    }
    row.push_back(std::to_string(report.table.size() - 1));
    if (best == 0) {
      row.insert(row.end(), {"-", "no reference", "", "", ""});
      continue;
    }
    const auto c = static_cast<std::size_t>(first_error - names.begin());
    const auto& cells = report.table[best];
    row.push_back(readable(names[c], cells[c]));
    row.push_back(first_error->substr(0, first_error->size() - 6));
    row.push_back(readable(names[c + 2], cells[c + 2]));
    row.push_back(readable("wall_time [s]", cells[at("wall_time [s]")]));
    row.push_back(readable("", cells[at("bytes_per_particle [byte]")]));
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
    text += markdown_table(shown(report)) + "\n";
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
    text += html_table(shown(report));
    for (const auto& [name, svg] : report.pictures)
      text += svg.substr(std::min(svg.find("<svg"), svg.size())) + "\n";
    text += "<details><summary>Plan of a run</summary><pre>" + escaped(report.plan) + "</pre></details>\n";
  }
  return text + "</body></html>\n";
}

}  // namespace shoal::kernel::app
