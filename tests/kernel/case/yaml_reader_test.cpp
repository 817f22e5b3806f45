// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The tree: places of keys and values, anchors, merge keys, and what is kept as text. Errors are in broken/.
#include "kernel/case/yaml_reader.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "kernel/case/scalars.hpp"

namespace {

using namespace shoal::kernel;

Node good(const std::string& text) {
  Diagnostics diagnostics;
  Node node = read_yaml_text(text, "a.yaml", diagnostics);
  CHECK(diagnostics.format() == "");
  REQUIRE(node.is_map());
  return node;
}

std::string first_error(const std::string& text) {
  Diagnostics diagnostics;
  read_yaml_text(text, "a.yaml", diagnostics);
  return diagnostics.empty() ? "" : diagnostics.sorted().front().message;
}

std::string where(const Place& place) {
  return std::to_string(place.line) + ":" + std::to_string(place.column) + "+" + std::to_string(place.length);
}

TEST_CASE("every key and value knows its place") {
  const Node root = good(
      "a: 1\n"
      "list: [10, {b: 'x y'}]   # comment\n"
      "block:\n"
      "  - first\n"
      "  - \"second \\\" one\"\n"
      "empty:\n"
      "null_value: ~\n");
  CHECK(where(root.place()) == "1:1+1");
  CHECK(where(root.entries()[0].key_place) == "1:1+1");
  CHECK(where(root.find("a")->place()) == "1:4+1");
  const Node& list = *root.find("list");
  CHECK(where(list.place()) == "2:7+16");
  CHECK(where(list.items()[0].place()) == "2:8+2");
  CHECK(where(list.items()[1].entries()[0].key_place) == "2:13+1");
  CHECK(where(list.items()[1].find("b")->place()) == "2:16+5");
  const Node& block = *root.find("block");
  CHECK(where(block.place()) == "4:3+1");
  CHECK(where(block.items()[0].place()) == "4:5+5");
  CHECK(where(block.items()[1].place()) == "5:5+15");
  CHECK(block.items()[1].text() == "second \" one");
  CHECK(where(root.find("empty")->place()) == "6:1+5");
  CHECK(where(root.find("null_value")->place()) == "7:13+1");
  CHECK(root.find("absent") == nullptr);
}

TEST_CASE("columns count characters, not bytes") {
  const Node root = good("\xC3\xA9\xC3\xA9: {\xE6\xB0\xB4: 1, b: 2}\n");
  const Node& map = root.entries()[0].value;
  CHECK(where(root.entries()[0].key_place) == "1:1+2");
  CHECK(where(map.entries()[0].key_place) == "1:6+1");
  CHECK(where(map.find("b")->place()) == "1:15+1");
}

TEST_CASE("line ends of all systems and a byte order mark are understood") {
  for (const char* text : {"a: 1\r\nb: 2\r\n", "a: 1\rb: 2",
                           "\xEF\xBB\xBF"
                           "a: 1\nb: 2\n"}) {
    const Node root = good(text);
    CHECK(root.find("a")->text() == "1");
    CHECK(where(root.find("b")->place()) == "2:4+1");
  }
}

TEST_CASE("scalars stay text, and quotes are remembered") {
  const Node root =
      good("a: 010\nb: no\nc: '010'\nd: \"no\"\ne: null\nf: 'null'\ng: |\n  two\n  lines\nh: 1:30\n");
  CHECK(root.find("a")->text() == "010");
  CHECK_FALSE(root.find("a")->quoted());
  CHECK(root.find("b")->text() == "no");
  CHECK(root.find("c")->quoted());
  CHECK(root.find("d")->quoted());
  CHECK(root.find("e")->is_null());
  CHECK(root.find("f")->text() == "null");
  CHECK(root.find("g")->text() == "two\nlines\n");
  CHECK(root.find("h")->text() == "1:30");
}

TEST_CASE("aliases repeat values") {
  const Node root = good("a: &n 5\nb: *n\nc: &m {x: 1}\nd: *m\n");
  CHECK(root.find("b")->text() == "5");
  CHECK(where(root.find("b")->place()) == "2:4+2");  // a scalar is where it is used
  CHECK(root.find("d")->find("x")->text() == "1");
  CHECK(where(root.find("d")->find("x")->place()) == "3:11+1");  // a map is where it is written
}

std::string entries(const Node& map) {
  std::string text;
  for (const Node::Entry& entry : map.entries()) text += entry.key + "=" + entry.value.text() + " ";
  return text;
}

TEST_CASE("explicit keys win over merged ones, wherever '<<' stands") {
  CHECK(entries(*good("x: &x {a: 1, b: 2}\ny: {<<: *x, b: 3}\n").find("y")) == "a=1 b=3 ");
  CHECK(entries(*good("x: &x {a: 1, b: 2}\ny: {b: 3, <<: *x}\n").find("y")) == "b=3 a=1 ");
}

TEST_CASE("earlier maps of a merged list win over later ones") {
  CHECK(entries(*good("x: &x {a: 1}\ny: &y {a: 2, b: 2}\nz: {<<: [*x, *y], c: 3}\n").find("z")) ==
        "a=1 b=2 c=3 ");
}

TEST_CASE("merges go through merges") {
  CHECK(entries(*good("x: &x {a: 1}\ny: &y {<<: *x, b: 2}\nz: {<<: *y, c: 3}\n").find("z")) ==
        "a=1 b=2 c=3 ");
}

TEST_CASE("a quoted '<<' is a key like any other") {
  CHECK(entries(*good("y: {'<<': 1}\n").find("y")) == "<<=1 ");
}

TEST_CASE("the values of the first of two equal keys are kept, so that other errors are found") {
  Diagnostics diagnostics;
  const Node root = read_yaml_text("a: 1\na: 2\nb: 3\n", "a.yaml", diagnostics);
  CHECK(diagnostics.n_errors() == 1);
  CHECK(root.find("a")->text() == "1");
  CHECK(root.find("b")->text() == "3");
}

TEST_CASE("aliases of aliases cannot fill the memory") {
  std::string text = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int k = 1; k < 12; ++k) {
    const std::string before = "*a" + std::to_string(k - 1);
    text += "a" + std::to_string(k) + ": &a" + std::to_string(k) + " [" + before;
    for (int n = 1; n < 10; ++n) text += ", " + before;
    text += "]\n";
  }
  CHECK(first_error(text) == "the file stands for more than a million values (aliases of aliases?)");
}

TEST_CASE("a large but honest file is read") {
  std::string text = "a:\n";
  for (int k = 0; k < 20000; ++k) text += "  - [" + std::to_string(k) + ", 0.5]\n";
  CHECK(good(text).find("a")->items().size() == 20000);
}

TEST_CASE("values that are nested too deeply are refused, not crashed on") {
  CHECK(first_error("a: " + std::string(2000, '[') + std::string(2000, ']') + "\n") ==
        "values are nested too deeply");
}

TEST_CASE("files that cannot be read are named") {
  Diagnostics diagnostics;
  read_yaml_file("no_such_case.yaml", diagnostics);
  read_yaml_file(".", diagnostics);
  CHECK(diagnostics.format() ==
        "no_such_case.yaml: error: cannot read the file: No such file or directory\n"
        ".: error: this is a folder; name the YAML file of a case\n");
  std::ofstream("large.yaml") << "a: '" << std::string(17U << 20U, 'x') << "'\n";
  Diagnostics large;
  read_yaml_file("large.yaml", large);
  std::filesystem::remove("large.yaml");
  CHECK(large.format() == "large.yaml: error: the file is larger than 16 MiB; is it a case?\n");
}

TEST_CASE("a value of the command line may be anything") {
  const Place place{std::make_shared<SourceText>(SourceText{"<--set a=1>", {}}), 0, 0, 0};
  Diagnostics diagnostics;
  CHECK(read_yaml_value("0.5m", place, diagnostics).text() == "0.5m");
  CHECK(read_yaml_value("[0, -9.81]", place, diagnostics).items().size() == 2);
  CHECK(read_yaml_value("{fluid.wall: {}}", place, diagnostics).entries()[0].key == "fluid.wall");
  CHECK(read_yaml_value("", place, diagnostics).is_null());
  CHECK(read_yaml_value("2", place, diagnostics).place().file() == "<--set a=1>");
  CHECK(diagnostics.empty());
}

TEST_CASE("nodes describe themselves for messages") {
  const Node root = good("a: 1\nb: text\nc: [1]\nd: {e: 1}\nf:\ng: '1'\n");
  CHECK(root.find("a")->described() == "the number 1");
  CHECK(root.find("b")->described() == "'text'");
  CHECK(root.find("c")->described() == "a list");
  CHECK(root.find("d")->described() == "a map");
  CHECK(root.find("f")->described() == "nothing");
  CHECK(root.find("g")->described() == "'1'");
}

// ------------------------------------------------------------------------------------------------------------

TEST_CASE("numbers are read exactly, or not at all") {
  const auto value = [](const char* text) {
    const NumberText parsed = parse_number(text);
    CHECK(parsed.status == NumberText::Status::number);
    return parsed.value;
  };
  CHECK(value("0") == 0.0);
  CHECK(value("-1.5e-3") == -1.5e-3);
  CHECK(value("+2") == 2.0);
  CHECK(value(".5") == 0.5);
  CHECK(value("5.") == 5.0);
  CHECK(value("0.1") == 0.1);
  CHECK(value("1E5") == 1e5);
  for (const char* text : {"010", "-007", "00", "00.5", "0x1F", "0b1", "0o7", "1_000", "1,5", "nan", ".NaN",
                           "inf", "-.inf", "Infinity", "1e400", "1e-400"}) {
    INFO(text);
    CHECK(parse_number(text).status == NumberText::Status::refused);
  }
  for (const char* text : {"", "-", ".", "e5", "abc", "--1", "$dx"}) {
    INFO(text);
    CHECK(parse_number(text).status == NumberText::Status::none);
  }
  const std::vector<std::pair<const char*, std::size_t>> prefixes{{"2 cm", 1}, {"2*H", 1}, {"1e-3 m", 4},
                                                                  {"5e", 1},   {"5%", 1},  {"1.2.3", 3}};
  for (const auto& prefix : prefixes) {
    INFO(prefix.first);
    CHECK(parse_number(prefix.first).status == NumberText::Status::prefix);
    CHECK(parse_number(prefix.first).end == prefix.second);
  }
  CHECK(parse_number("-inf", true).value == -std::numeric_limits<double>::infinity());
  CHECK(parse_number("nan", true).status == NumberText::Status::refused);
  CHECK(parse_number("010").remedy ==
        "has a leading zero, which other YAML readers take for octal; write 10");
  CHECK(parse_number("-007.5").remedy ==
        "has a leading zero, which other YAML readers take for octal; write -7.5");
}

TEST_CASE("numbers are written so that they come back the same") {
  for (const double value : {0.025, 1.0 / 3.0, 1e-300, 101325.0, -0.0, 5e-324, 1.7976931348623157e308})
    CHECK(parse_number(format_number(value)).value == value);
  CHECK(format_number(1000) == "1000");
  CHECK(format_number(0.1) == "0.1");
}

TEST_CASE("booleans are true and false alone") {
  CHECK(parse_boolean("true") == BooleanText::yes);
  CHECK(parse_boolean("false") == BooleanText::no);
  for (const char* text : {"yes", "No", "ON", "off", "True", "FALSE", "y", "N"})
    CHECK(parse_boolean(text) == BooleanText::other_word);
  CHECK(parse_boolean("1") == BooleanText::not_boolean);
}

}  // namespace
