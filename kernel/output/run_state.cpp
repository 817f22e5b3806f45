// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/output/run_state.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>

#include "kernel/case/schema.hpp"
#include "kernel/case/yaml_reader.hpp"
#include "kernel/particles/errors.hpp"

namespace shoal::kernel {
namespace {

using Flat = std::map<std::string, std::string>;

void flatten(const Node& node, const std::string& path, Flat& flat) {
  if (node.is_map()) {
    for (const Node::Entry& entry : node.entries())
      if (!is_note(entry.key)) flatten(entry.value, path.empty() ? entry.key : path + "." + entry.key, flat);
  } else if (node.is_sequence()) {
    for (std::size_t k = 0; k < node.items().size(); ++k)
      flatten(node.items()[k], path + "[" + std::to_string(k) + "]", flat);
  } else {
    flat[path] = node.is_null() ? "" : node.text();
  }
}

bool is_physics(const std::string& path) {
  static const std::array<std::string, 8> others{
      "title", "run.end", "run.checkpoint_every", "output", "probes", "reference", "plugins", "study"};
  return std::none_of(others.begin(), others.end(), [&](const std::string& other) {
    return path == other || path.rfind(other + ".", 0) == 0 || path.rfind(other + "[", 0) == 0;
  });
}

Flat flat_case(const std::string& text, const std::string& name) {
  Diagnostics diagnostics;
  Flat flat;
  flatten(read_yaml_text(text, name, diagnostics), "", flat);
  return flat;
}

std::vector<std::string> compare(const Flat& before, const Flat& now, bool (*counts)(const std::string&)) {
  std::vector<std::string> lines;
  for (const auto& [path, value] : before) {
    const auto other = now.find(path);
    if (!counts(path)) continue;
    if (other == now.end())
      lines.push_back(path + ": " + value + " -> (none)");
    else if (other->second != value)
      lines.push_back(path + ": " + value + " -> " + other->second);
  }
  for (const auto& [path, value] : now)
    if (before.count(path) == 0 && counts(path)) lines.push_back(path + ": (none) -> " + value);
  return lines;
}

}  // namespace

std::string to_text(const RunState& state) {
  nlohmann::json json{{"version", state.version},
                      {"case", state.effective_case},
                      {"time", state.time},
                      {"wall_seconds", state.wall_seconds},
                      {"outputs", nlohmann::json::array()},
                      {"probes", nlohmann::json::array()}};
  if (!state.finish_reason.empty()) json["finish_reason"] = state.finish_reason;
  for (const auto& output : state.recorder.outputs)
    json["outputs"].push_back({{"name", output.name}, {"sequence", output.sequence}});
  for (const auto& series : state.recorder.series)
    json["probes"].push_back({{"name", series.probe}, {"bytes", series.bytes}});
  return json.dump();
}

RunState state_from_text(const std::string& text) {
  try {
    const nlohmann::json json = nlohmann::json::parse(text);
    RunState state;
    state.version = json.at("version");
    state.effective_case = json.at("case");
    state.time = json.at("time");
    state.wall_seconds = json.at("wall_seconds");
    state.finish_reason = json.value("finish_reason", "");
    for (const nlohmann::json& output : json.at("outputs"))
      state.recorder.outputs.push_back({output.at("name"), output.at("sequence")});
    for (const nlohmann::json& series : json.at("probes"))
      state.recorder.series.push_back({series.at("name"), series.at("bytes")});
    return state;
  } catch (const nlohmann::json::exception& error) {
    throw CheckpointError(std::string("the head of the checkpoint cannot be understood: ") + error.what());
  }
}

std::vector<std::string> differences(const std::string& before, const std::string& now) {
  return compare(flat_case(before, "<before>"), flat_case(now, "<now>"),
                 [](const std::string&) { return true; });
}

std::vector<std::string> differing_physics(const std::string& before, const std::string& now) {
  return compare(flat_case(before, "<before>"), flat_case(now, "<now>"), is_physics);
}

}  // namespace shoal::kernel
