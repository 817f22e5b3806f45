// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Builds the tree from the events of yaml-cpp's parser rather than from its nodes: events carry the position of
// every key, value and alias, and let equal keys and merge keys be seen.
#include "kernel/case/yaml_reader.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include "kernel/case/yaml_source.hpp"

namespace shoal::kernel {
namespace {

// Aliases share their node, but whoever walks the tree sees every copy: a few lines could stand for billions.
constexpr std::size_t most_nodes = 1'000'000;
constexpr std::uintmax_t most_bytes = 16U << 20U;

// Thrown by the builder to leave yaml-cpp's parser; the diagnostic has been made already.
struct Stop {};

std::string trimmed_end(std::string text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.pop_back();
  return text;
}

// ------------------------------------------------------------------------------------------------------------

class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const YamlSource& source, Diagnostics& diagnostics)
      : source_(source), diagnostics_(diagnostics) {}

  Node result() const { return root_; }

  // The bracket that is still open, innermost first; empty place if there is none.
  std::optional<std::pair<Place, char>> open_bracket() const {
    for (auto frame = frames_.rbegin(); frame != frames_.rend(); ++frame) {
      if (frame->flow) return std::make_pair(frame->place, frame->kind == Node::Kind::map ? '{' : '[');
    }
    return std::nullopt;
  }

  void OnDocumentStart(const YAML::Mark& /*mark*/) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const Spot spot = skip_properties(mark);
    std::string word = word_at(spot);
    const bool written = word == "~" || word == "null" || word == "Null" || word == "NULL";
    Place place = source_.place(spot.line, spot.column, static_cast<int>(word.size()));
    const std::string_view rest = line(spot.line).substr(static_cast<std::size_t>(spot.column));
    const bool flow_item =
        !frames_.empty() && frames_.back().flow && frames_.back().kind == Node::Kind::sequence;
    if (!written && rest.substr(0, 1) == "," && (expects_key() || flow_item)) {
      diagnostics_.error(place, "a value is missing before ','");
      throw Stop{};
    }
    if (expects_key()) {
      diagnostics_.error(place, written ? "'" + word + "' cannot be a key; put it in quotes if it is a name"
                                        : "a key is missing before ':'");
      throw Stop{};
    }
    // The position of a value that is not there is that of whatever comes next: its key says more.
    if (!written && !frames_.empty())
      place = frames_.back().kind == Node::Kind::map ? frames_.back().key_place : frames_.back().place;
    add(Node::null(place), anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const Place place =
        source_.place(mark.line, mark.column, static_cast<int>(word_at({mark.line, mark.column}).size()));
    if (expects_key()) {
      diagnostics_.error(place, "an alias cannot be a key; write the key out");
      throw Stop{};
    }
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) {
      diagnostics_.error(place, "this alias stands inside the value that it refers to");
      throw Stop{};
    }
    count(found->second.second, place);
    // A scalar is complained about where it is used; a map or a list where it is written.
    Node node = found->second.first;
    add_value(node.is_scalar() ? Node::scalar(node.text(), node.quoted(), place) : node);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    check_tag(mark, tag);
    const Spot spot = skip_properties(mark);
    const bool quoted = tag == "!";
    const Place place = source_.place(spot.line, spot.column, scalar_length(spot, quoted, value));
    if (quoted) check_closed(spot, place);
    if (expects_key()) {
      set_key(value, quoted, place);
      return;
    }
    add(Node::scalar(value, quoted, place), anchor);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value style) override {
    open(Node::Kind::sequence, mark, tag, anchor, style);
  }
  void OnSequenceEnd() override {
    Frame frame = close();
    add(Node::sequence(std::move(frame.items), frame.place), frame.anchor, frame.n_nodes);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value style) override {
    open(Node::Kind::map, mark, tag, anchor, style);
  }
  void OnMapEnd() override {
    Frame frame = close();
    std::vector<Node::Entry> entries = merge(std::move(frame.entries));
    add(Node::map(std::move(entries), frame.place), frame.anchor, frame.n_nodes);
  }

 private:
  struct Spot {
    int line;
    int column;
  };
  struct RawEntry {
    Node::Entry entry;
    bool merge = false;
  };
  struct Frame {
    Node::Kind kind = Node::Kind::null;
    bool flow = false;
    Place place;
    YAML::anchor_t anchor = YAML::NullAnchor;
    std::vector<Node> items;
    std::vector<RawEntry> entries;
    bool has_key = false;
    bool key_is_merge = false;
    std::string key;
    Place key_place;
    std::size_t n_nodes = 1;
  };

  bool expects_key() const {
    return !frames_.empty() && frames_.back().kind == Node::Kind::map && !frames_.back().has_key;
  }

  std::string_view line(int number) const {
    const auto index = static_cast<std::size_t>(number);
    return index < source_.lines().size() ? std::string_view(source_.lines()[index]) : std::string_view();
  }

  // Anchors (&name) and tags (!name) stand before the value that is meant.
  Spot skip_properties(const YAML::Mark& mark) const {
    Spot spot{mark.line, mark.column};
    for (int guard = 0; guard < 100; ++guard) {
      const std::string_view rest = line(spot.line);
      auto i = static_cast<std::size_t>(spot.column);
      while (i < rest.size() && rest[i] == ' ') ++i;
      if (i < rest.size() && (rest[i] == '&' || rest[i] == '!')) {
        while (i < rest.size() && rest[i] != ' ') ++i;
      } else if (i < rest.size() && rest[i] != '#') {
        return {spot.line, static_cast<int>(i)};
      } else if (static_cast<std::size_t>(spot.line) + 1 < source_.lines().size()) {
        ++spot.line;
        i = 0;
      } else {
        break;
      }
      spot.column = static_cast<int>(i);
    }
    return {mark.line, mark.column};
  }

  std::string word_at(const Spot& spot) const {
    const std::string_view rest = line(spot.line);
    const auto begin = std::min(static_cast<std::size_t>(spot.column), rest.size());
    const auto end = std::min(rest.find_first_of(" ,]}:#\t", begin), rest.size());
    return std::string(rest.substr(begin, end - begin));
  }

  int scalar_length(const Spot& spot, bool quoted, const std::string& value) const {
    const std::string_view rest = line(spot.line).substr(static_cast<std::size_t>(spot.column));
    if (!quoted) {
      if (rest.rfind(value, 0) == 0) return static_cast<int>(value.size());
      return static_cast<int>(trimmed_end(std::string(rest)).size());
    }
    if (rest.empty() || (rest[0] != '"' && rest[0] != '\'')) return 1;  // a block of text: | or >
    return static_cast<int>(quoted_length(rest));
  }

  // yaml-cpp takes the end of the file for the closing quote.
  void check_closed(const Spot& spot, const Place& place) {
    std::string_view rest = line(spot.line).substr(static_cast<std::size_t>(spot.column));
    if (rest.empty() || (rest[0] != '"' && rest[0] != '\'')) return;
    if (closing_quote(rest) != std::string::npos) return;
    std::string text(rest);
    for (std::size_t n = static_cast<std::size_t>(spot.line) + 1; n < source_.lines().size(); ++n)
      text += "\n" + source_.lines()[n];
    if (closing_quote(text) != std::string::npos) return;
    diagnostics_.error(place.part(0, 1),
                       std::string("this quote is never closed; add ") + rest[0] + " at the end of the text");
    throw Stop{};
  }

  void check_tag(const YAML::Mark& mark, const std::string& tag) {
    if (tag.empty() || tag == "?" || tag == "!") return;
    const std::string word = word_at({mark.line, mark.column});
    diagnostics_.error(
        source_.place(mark.line, mark.column, static_cast<int>(std::max<std::size_t>(word.size(), 1))),
        "YAML tags such as '!' are not used in cases; remove the tag");
    throw Stop{};
  }

  void count(std::size_t n, const Place& place) {
    n_nodes_ += n;
    if (!frames_.empty()) frames_.back().n_nodes += n;
    if (n_nodes_ > most_nodes) {
      diagnostics_.error(place, "the file stands for more than a million values (aliases of aliases?)");
      throw Stop{};
    }
  }

  void open(Node::Kind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
            YAML::EmitterStyle::value style) {
    check_tag(mark, tag);
    Spot spot = skip_properties(mark);
    const std::string_view text = line(spot.line);
    const auto column = std::min(static_cast<std::size_t>(spot.column), text.size());
    const bool flow = style == YAML::EmitterStyle::Flow;
    int length = 1;
    if (flow) {
      length = static_cast<int>(bracket_length(text.substr(column)));
    } else if (kind == Node::Kind::map) {
      length = static_cast<int>(word_at(spot).size());
    }
    const Place place = source_.place(spot.line, spot.column, length);
    if (expects_key()) {
      diagnostics_.error(place, kind == Node::Kind::map ? "a map cannot be a key; a key is a word"
                                                        : "a list cannot be a key; a key is a word");
      throw Stop{};
    }
    Frame frame;
    frame.kind = kind;
    frame.flow = flow;
    frame.place = place;
    frame.anchor = anchor;
    frames_.push_back(std::move(frame));
  }

  Frame close() {
    Frame frame = std::move(frames_.back());
    frames_.pop_back();
    return frame;
  }

  void set_key(const std::string& key, bool quoted, const Place& place) {
    Frame& frame = frames_.back();
    frame.has_key = true;
    frame.key = key;
    frame.key_place = place;
    frame.key_is_merge = key == "<<" && !quoted;
    if (key.empty()) diagnostics_.error(place, "a key cannot be empty");
    for (const RawEntry& other : frame.entries) {
      if (other.entry.key != key || (other.merge != frame.key_is_merge)) continue;
      if (frame.key_is_merge) {
        diagnostics_.error(place, "'<<' stands here twice; merge several maps with a list: '<<: [*a, *b]'");
      } else {
        diagnostics_.error(place, "key '" + key + "' stands here twice; remove one of the two",
                           {"the other is at " + other.entry.key_place.text()});
      }
      return;
    }
  }

  void add(const Node& node, YAML::anchor_t anchor, std::size_t n_nodes = 1) {
    if (anchor != YAML::NullAnchor) anchors_[anchor] = {node, n_nodes};
    if (n_nodes == 1) {
      count(1, node.place());
    } else if (!frames_.empty()) {
      frames_.back().n_nodes += n_nodes;  // its parts were counted one by one
    }
    add_value(node);
  }

  void add_value(const Node& node) {
    if (frames_.empty()) {
      root_ = node;
      return;
    }
    Frame& frame = frames_.back();
    if (frame.kind == Node::Kind::sequence) {
      frame.items.push_back(node);
      return;
    }
    frame.has_key = false;
    const auto same = [&](const RawEntry& e) {
      return e.entry.key == frame.key && e.merge == frame.key_is_merge;
    };
    if (std::none_of(frame.entries.begin(), frame.entries.end(), same))
      frame.entries.push_back({{frame.key, frame.key_place, node}, frame.key_is_merge});
  }

  // YAML 1.1 merge keys: explicit keys win, then earlier maps of a list win over later ones.
  std::vector<Node::Entry> merge(std::vector<RawEntry> raw) {
    std::vector<Node::Entry> entries;
    const auto is_explicit = [&raw](const std::string& key) {
      return std::any_of(raw.begin(), raw.end(),
                         [&](const RawEntry& e) { return !e.merge && e.entry.key == key; });
    };
    const auto present = [&entries](const std::string& key) {
      return std::any_of(entries.begin(), entries.end(), [&](const Node::Entry& e) { return e.key == key; });
    };
    for (const RawEntry& item : raw) {
      if (!item.merge) {
        entries.push_back(item.entry);
        continue;
      }
      const Node& value = item.entry.value;
      const std::vector<Node> maps = value.is_sequence() ? value.items() : std::vector<Node>{value};
      for (const Node& map : maps) {
        if (!map.is_map()) {
          diagnostics_.error(
              map.is_null() ? item.entry.key_place : map.place(),
              "'<<' merges maps, got " + map.described() + "; write '<<: *name' for a map '&name'");
          continue;
        }
        for (const Node::Entry& entry : map.entries()) {
          if (!is_explicit(entry.key) && !present(entry.key)) entries.push_back(entry);
        }
      }
    }
    return entries;
  }

  const YamlSource& source_;
  Diagnostics& diagnostics_;
  Node root_;
  std::vector<Frame> frames_;
  std::map<YAML::anchor_t, std::pair<Node, std::size_t>> anchors_;
  std::size_t n_nodes_ = 0;
};

// ------------------------------------------------------------------------------------------------------------
void report_syntax_error(const YAML::Exception& problem, const YamlSource& source, const TreeBuilder& builder,
                         Diagnostics& diagnostics) {
  const int line = std::max(problem.mark.line, 0);
  const int column = std::max(problem.mark.column, 0);
  const bool at_end = static_cast<std::size_t>(line) >= source.lines().size();
  const std::string text = at_end ? std::string() : source.lines()[static_cast<std::size_t>(line)];
  const auto at = static_cast<std::size_t>(column);
  const auto bracket = builder.open_bracket();
  const bool in_flow = problem.msg.find("flow not found") != std::string::npos;
  if (in_flow && bracket) {
    const std::string closing = bracket->second == '{' ? "'}'" : "']'";
    const std::string opened = std::string("'") + bracket->second + "'";
    if (at_end || text.find_first_not_of(" \t", at) == std::string::npos ||
        text.find(':', at) != std::string::npos) {
      Place place = bracket->first;
      place.length = place.line == 0 ? 0 : 1;
      diagnostics.error(place,
                        opened + " is never closed; add " + closing + " or a comma between its values");
      return;
    }
    diagnostics.error(source.place(line, column, 1), "',' or " + closing + " is missing here",
                      {opened + " was opened at " + bracket->first.text()});
    return;
  }
  if (problem.msg.find("illegal flow end") != std::string::npos && bracket) {
    const std::string closing = bracket->second == '{' ? "'}'" : "']'";
    diagnostics.error(source.place(line, column, 1),
                      "expected " + closing + ", got '" + text.substr(at, 1) + "'",
                      {std::string("'") + bracket->second + "' was opened at " + bracket->first.text()});
    return;
  }
  diagnostics.error(source.place(line, column, 1), yaml_problem(problem.msg, text, at));
}

Node parse(const YamlSource& source, Diagnostics& diagnostics) {
  if (!check_yaml_text(source, diagnostics)) return {};
  TreeBuilder builder(source, diagnostics);
  std::istringstream stream(source.text());
  try {
    YAML::Parser parser(stream);
    if (!parser.HandleNextDocument(builder)) return {};
    const Node root = builder.result();
    TreeBuilder second(source, diagnostics);
    if (parser.HandleNextDocument(second)) {
      int line = 0;
      for (std::size_t i = 1; i < source.lines().size(); ++i) {
        if (source.lines()[i].rfind("---", 0) == 0) line = static_cast<int>(i);
      }
      diagnostics.error(source.place(line, 0, 3),
                        "a second document begins here; a case is one document, remove '---'");
    }
    return root;
  } catch (const Stop&) {
    return {};
  } catch (const YAML::Exception& problem) {
    report_syntax_error(problem, source, builder, diagnostics);
    return {};
  }
}

std::optional<std::string> read_file(const std::string& path, Diagnostics& diagnostics) {
  const Place place{std::make_shared<SourceText>(SourceText{path, {}}), 0, 0, 0};
  std::error_code problem;
  if (std::filesystem::is_directory(path, problem)) {
    diagnostics.error(place, "this is a folder; name the YAML file of a case");
    return std::nullopt;
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    diagnostics.error(place, std::string("cannot read the file: ") + std::strerror(errno));
    return std::nullopt;
  }
  const std::uintmax_t size = std::filesystem::file_size(path, problem);
  if (!problem && size > most_bytes) {
    diagnostics.error(place, "the file is larger than 16 MiB; is it a case?");
    return std::nullopt;
  }
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace

Node read_yaml_text(const std::string& text, const std::string& name, Diagnostics& diagnostics) {
  const YamlSource source(text, name, std::nullopt);
  const std::size_t before = diagnostics.n_errors();
  const Node root = parse(source, diagnostics);
  if (diagnostics.n_errors() > before) return root.is_map() ? root : Node();
  if (root.is_null()) {
    diagnostics.error(source.whole(), "the file is empty; a case begins with 'shoal: 1'");
    return {};
  }
  if (!root.is_map()) {
    std::string hint = "expected 'key: value' lines, got " + root.described();
    if (root.is_scalar() && root.text().find(':') != std::string::npos)
      hint = "expected 'key: value' lines; a space is missing after ':'";
    diagnostics.error(root.place(), hint);
    return {};
  }
  return root;
}

Node read_yaml_file(const std::string& path, Diagnostics& diagnostics) {
  const std::optional<std::string> text = read_file(path, diagnostics);
  return text ? read_yaml_text(*text, path, diagnostics) : Node();
}

Node read_yaml_value(const std::string& text, const Place& place, Diagnostics& diagnostics) {
  // As the value of a key: yaml-cpp takes an unclosed bracket at the top level for a key.
  const Node root = parse(YamlSource("value: " + text, place.file(), place), diagnostics);
  const Node* value = root.is_map() ? root.find("value") : nullptr;
  return value != nullptr ? *value : Node::null(place);
}

}  // namespace shoal::kernel
