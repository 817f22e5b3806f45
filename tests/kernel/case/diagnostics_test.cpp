// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Layout and order of messages, and what counts as a misspelling.
#include "kernel/case/diagnostics.hpp"

#include <doctest/doctest.h>

#include <random>

namespace {

using namespace shoal::kernel;

Place place(const std::vector<std::string>& lines, int line, int column, int length) {
  return {std::make_shared<SourceText>(SourceText{"a.yaml", lines}), line, column, length};
}

TEST_CASE("a message has place, line, caret and notes") {
  Diagnostics diagnostics;
  diagnostics.error(place({"run: {edn: 1}"}, 1, 7, 3), "unknown key 'edn'", {"keys: end"});
  CHECK(diagnostics.format() ==
        "a.yaml:1:7: error: unknown key 'edn'\n"
        "    1 | run: {edn: 1}\n"
        "      |       ^~~\n"
        "      keys: end\n");
}

TEST_CASE("line numbers of any length keep the caret in its column") {
  const std::vector<std::string> lines(1234567, "key: 1");
  Diagnostics diagnostics;
  diagnostics.error(place(lines, 1234567, 6, 1), "wrong");
  CHECK(diagnostics.format() ==
        "a.yaml:1234567:6: error: wrong\n"
        "1234567 | key: 1\n"
        "        |      ^\n");
}

TEST_CASE("without a line there is no caret") {
  Diagnostics diagnostics;
  diagnostics.error(place({}, 0, 0, 0), "the file is empty");
  diagnostics.error(Place{}, "nothing is known");
  CHECK(diagnostics.format() == "a.yaml: error: the file is empty\nerror: nothing is known\n");
}

TEST_CASE("the caret stands under the character, whatever stands before it") {
  const auto caret = [](const std::string& line, int column) {
    Diagnostics diagnostics;
    diagnostics.error(place({line}, 1, column, 1), "x");
    const std::string text = diagnostics.format();
    const std::size_t begin = text.rfind("| ") + 2;
    return text.find('^', begin) - begin;
  };
  CHECK(caret("abc", 3) == 2);
  CHECK(caret("\xC3\xA9\xC3\xA9"
              "c",
              3) == 2);  // two characters of two bytes
  CHECK(caret("\xE6\xB0\xB4\xE6\xB0\xB4"
              "c",
              3) == 4);  // two of double width
  CHECK(caret("e\xCC\x81"
              "c",
              3) == 1);  // a combining mark takes no column
  CHECK(caret("\tc", 2) == 4);
  CHECK(caret("ab\tc", 4) == 4);
  CHECK(caret("abc", 9) == 8);  // behind the end
}

TEST_CASE("messages are sorted by place, and equal ones are told once") {
  const auto source = std::make_shared<SourceText>(SourceText{"a.yaml", {"1", "2", "3"}});
  const auto other = std::make_shared<SourceText>(SourceText{"<--set b=1>", {}});
  Diagnostics diagnostics;
  diagnostics.error({source, 3, 1, 1}, "c");
  diagnostics.error({source, 1, 5, 1}, "b");
  diagnostics.warning({source, 1, 1, 1}, "a");
  diagnostics.error({other, 0, 0, 0}, "d");
  diagnostics.error({source, 3, 1, 1}, "c");
  std::string order;
  for (const Diagnostic& item : diagnostics.sorted()) order += item.message;
  CHECK(order == "abcd");
  CHECK(diagnostics.n_errors() == 3);
  CHECK(diagnostics.n_warnings() == 1);
  CHECK(diagnostics.has_errors());
}

TEST_CASE("errors come before warnings when there are too many") {
  const auto source = std::make_shared<SourceText>(SourceText{"a.yaml", {}});
  Diagnostics diagnostics;
  for (int k = 1; k <= 3; ++k) diagnostics.warning({source, k, 1, 1}, "careful " + std::to_string(k));
  for (int k = 4; k <= 6; ++k) diagnostics.error({source, k, 1, 1}, "wrong " + std::to_string(k));
  CHECK(diagnostics.format(4) ==
        "a.yaml:1:1: warning: careful 1\n"
        "a.yaml:4:1: error: wrong 4\n"
        "a.yaml:5:1: error: wrong 5\n"
        "a.yaml:6:1: error: wrong 6\n"
        "... and 2 more warnings\n");
  CHECK(diagnostics.format(2) ==
        "a.yaml:4:1: error: wrong 4\n"
        "a.yaml:5:1: error: wrong 5\n"
        "... and 1 more error and 3 more warnings\n");
}

TEST_CASE("only errors are thrown") {
  Diagnostics diagnostics;
  diagnostics.warning(Place{}, "careful");
  CHECK_NOTHROW(diagnostics.throw_if_errors());
  diagnostics.error(Place{}, "wrong");
  CHECK_THROWS_WITH_AS(diagnostics.throw_if_errors(), "warning: careful\nerror: wrong\n", UserError);
}

TEST_CASE("the edit distance counts insertions, deletions, substitutions and swaps") {
  CHECK(edit_distance("", "") == 0);
  CHECK(edit_distance("", "abc") == 3);
  CHECK(edit_distance("visocity", "viscosity") == 2);
  CHECK(edit_distance("edn", "end") == 1);
  CHECK(edit_distance("kitten", "sitting") == 3);
  CHECK(edit_distance("ca", "abc") == 3);  // no edits between swapped letters
}

TEST_CASE("the edit distance is symmetric, zero only for equal words, and obeys bounds") {
  std::mt19937 random(7);
  const auto word = [&random] {
    std::string text(random() % 7, 'a');
    for (char& c : text) c = static_cast<char>('a' + random() % 3);
    return text;
  };
  for (int k = 0; k < 2000; ++k) {
    const std::string a = word();
    const std::string b = word();
    const std::size_t d = edit_distance(a, b);
    CHECK(d == edit_distance(b, a));
    CHECK((d == 0) == (a == b));
    CHECK(d <= std::max(a.size(), b.size()));
    CHECK(d >= std::max(a.size(), b.size()) - std::min(a.size(), b.size()));
  }
}

TEST_CASE("suggestions are near, and silent when nothing is") {
  const std::vector<std::string> keys{"density", "viscosity", "sound_speed", "n", "end"};
  CHECK(closest("visocity", keys) == "viscosity");
  CHECK(closest("DENSITY", keys) == "density");
  CHECK(closest("edn", keys) == "end");
  CHECK(closest("sound-speed", keys) == "sound_speed");
  CHECK(closest("visc", keys) == "viscosity");
  CHECK(closest("foo", keys).empty());
  CHECK(closest("m", keys).empty());
  CHECK(closest("rint", {"sin"}).empty());
  CHECK(closest("wcsph", {"fluid.wcsph", "fluid.wall"}) == "fluid.wcsph");
  CHECK(closest("fluid.wal", {"fluid.wcsph", "fluid.wall"}) == "fluid.wall");
  CHECK(closest("wall", {"wall_left", "wall_right"}).empty());  // begins both
  CHECK(did_you_mean("edn", keys) == "; did you mean 'end'?");
  CHECK(did_you_mean("foo", keys).empty());
}

TEST_CASE("words are joined for sentences") {
  CHECK(join({}) == "");
  CHECK(join({"a", "b"}) == "a, b");
  CHECK(quoted_alternatives({"a"}) == "'a'");
  CHECK(quoted_alternatives({"a", "b", "c"}) == "'a', 'b' or 'c'");
}

}  // namespace
