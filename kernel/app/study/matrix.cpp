// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/app/study/matrix.hpp"

#include <algorithm>
#include <cctype>
#include <set>

#include "kernel/app/session.hpp"

namespace shoal::kernel::app {
namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& text, const std::string& why) {
  throw UserError(option_place("<" + option + " " + text + ">"), why,
                  {"for example: " + option + " dx=0.1,0.05,0.025"});
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts(1);
  int depth = 0;
  for (const char c : text) {
    if (c == '[' || c == '(' || c == '{') ++depth;
    if (c == ']' || c == ')' || c == '}') --depth;
    if (c == ',' && depth == 0)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  for (std::string& part : parts) part = trimmed(part);
  return parts;
}

// The last word of a path, and a value, as they may stand in the name of a file.
std::string file_word(const std::string& key, const std::string& value) {
  std::string word = key.substr(key.rfind('.') + 1) + "=" + value;
  for (char& c : word)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '=' && c != '.' && c != '-' && c != '+')
      c = '_';
  return word;
}

}  // namespace

Variation read_variation(const std::string& option, const std::string& text) {
  const auto equals = text.find('=');
  Variation variation{trimmed(text.substr(0, equals)), {}};
  if (equals == std::string::npos || variation.key.empty())
    refuse(option, text, "it does not say KEY=VALUE,VALUE,...");
  variation.values = split(text.substr(equals + 1));
  for (const std::string& value : variation.values)
    if (value.empty()) refuse(option, text, "one of the values of '" + variation.key + "' is empty");
  std::set<std::string> distinct(variation.values.begin(), variation.values.end());
  if (distinct.size() < variation.values.size())
    refuse(option, text, "two values of '" + variation.key + "' are the same");
  return variation;
}

std::vector<StudyRun> matrix(const std::vector<Variation>& variations) {
  std::vector<StudyRun> runs(1);
  for (const Variation& variation : variations) {
    std::vector<StudyRun> longer;
    for (const StudyRun& run : runs)
      for (const std::string& value : variation.values) {
        StudyRun& next = longer.emplace_back(run);
        next.name += (next.name.empty() ? "" : "_") + file_word(variation.key, value);
        next.values.push_back(value);
      }
    runs = std::move(longer);
  }
  std::set<std::string> names;
  for (StudyRun& run : runs) {
    if (run.name.empty()) run.name = "run";
    const std::string plain = run.name;
    for (int k = 2; !names.insert(run.name).second; ++k) run.name = plain + "_" + std::to_string(k);
  }
  return runs;
}

}  // namespace shoal::kernel::app
