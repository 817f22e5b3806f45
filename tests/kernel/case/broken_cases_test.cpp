// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Every message that a user can meet, word for word: broken/NAME.yaml must give exactly broken/NAME.txt. Lines
// "# --set ..." at the beginning of a case are given as settings of the command line. With the variable
// SHOAL_WRITE_EXPECTED set, the texts are written instead of compared; read them before you keep them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "kernel/case/model.hpp"
#include "test_types.hpp"

namespace {

using namespace shoal::kernel;

const std::filesystem::path folder = std::filesystem::path(SHOAL_SOURCE_FOLDER) / "tests/kernel/case/broken";

std::string read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::filesystem::path> cases() {
  std::vector<std::filesystem::path> result;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".yaml") result.push_back(entry.path());
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<std::string> settings(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream stream(text);
  const std::string mark = "# --set ";
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind(mark, 0) == 0) result.push_back(line.substr(mark.size()));
  }
  return result;
}

// What a user sees, with the folder of this checkout taken out.
std::string messages(const std::filesystem::path& path) {
  const std::string text = read(path);
  Diagnostics diagnostics;
  const CaseFile file(text, path.filename().string(), folder.string(), settings(text), diagnostics);
  const test::TestTypes types;
  if (file.readable()) check_case(file, types, diagnostics);
  std::string shown = diagnostics.format();
  for (std::size_t at = shown.find(folder.string()); at != std::string::npos;
       at = shown.find(folder.string()))
    shown.replace(at, folder.string().size(), "FOLDER");
  return shown;
}

TEST_CASE("every broken case gives exactly its messages") {
  const bool write = std::getenv("SHOAL_WRITE_EXPECTED") != nullptr;
  const std::vector<std::filesystem::path> all = cases();
  CHECK(all.size() >= 60);
  for (const std::filesystem::path& path : all) {
    std::filesystem::path expected = path;
    expected.replace_extension(".txt");
    INFO(path.filename().string());
    const std::string shown = messages(path);
    if (write) {
      std::ofstream(expected, std::ios::binary) << shown;
    } else {
      CHECK(std::filesystem::exists(expected));
      CHECK(shown == read(expected));
    }
  }
}

TEST_CASE("no expected text is left without its case, and none is empty") {
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::filesystem::path yaml = entry.path();
    INFO(yaml.string());
    if (yaml.extension() != ".txt") continue;
    CHECK(std::filesystem::file_size(yaml) > 0);
    CHECK(std::filesystem::exists(yaml.replace_extension(".yaml")));
  }
}

}  // namespace
