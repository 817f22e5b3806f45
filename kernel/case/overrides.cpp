// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Rebuilds the tree along the path of each setting.
#include "kernel/case/overrides.hpp"

#include <algorithm>
#include <charconv>
#include <optional>

namespace shoal::kernel {
namespace {

using Words = std::vector<std::string>;

Words split_path(const std::string& path) {
  Words words;
  std::size_t begin = 0;
  for (std::size_t dot = path.find('.'); dot != std::string::npos; dot = path.find('.', begin)) {
    words.push_back(path.substr(begin, dot - begin));
    begin = dot + 1;
  }
  words.push_back(path.substr(begin));
  return words;
}

std::string joined(const Words& words, std::size_t begin, std::size_t end) {
  return join(Words(words.begin() + static_cast<std::ptrdiff_t>(begin),
                    words.begin() + static_cast<std::ptrdiff_t>(end)),
              ".");
}

Words keys_of(const Node& map) {
  Words keys;
  for (const Node::Entry& entry : map.entries()) keys.push_back(entry.key);
  return keys;
}

// A list item `fluid.wall` or `{fluid.wcsph: {...}}` goes by the name of its type.
std::string type_name(const Node& item) {
  if (item.is_scalar()) return item.text();
  if (item.is_map() && !item.entries().empty()) return item.entries().front().key;
  return {};
}

class Override {
 public:
  Override(Words words, Node value, Place place, const Words& sections, Diagnostics& diagnostics)
      : words_(std::move(words)),
        value_(std::move(value)),
        place_(std::move(place)),
        sections_(sections),
        diagnostics_(diagnostics) {}

  /// The node with what the words from `at` on name set in it; nothing if an error was reported.
  std::optional<Node> apply(const Node& node, std::size_t at) const {
    if (at == words_.size()) return value_;
    if (node.is_null()) return created(at);
    if (node.is_map()) return in_map(node, at);
    if (node.is_sequence()) return in_sequence(node, at);
    // A type that stands alone, `material: fluid.liquid`, takes values too.
    const std::size_t end = matching_end(node.text(), at);
    if (end > at && end < words_.size()) {
      std::optional<Node> inside = apply(Node::null(place_), end);
      if (!inside) return std::nullopt;
      return Node::map({{node.text(), node.place(), *inside}}, node.place());
    }
    fail("'" + joined(words_, 0, at) + "' is " + node.described() + " and has no '" + words_[at] + "'");
    return std::nullopt;
  }

 private:
  void fail(const std::string& message, std::vector<std::string> notes = {}) const {
    diagnostics_.error(place_, message, std::move(notes));
  }

  // Where the words that spell `name`, which may hold points, end; `at` if they do not.
  std::size_t matching_end(const std::string& name, std::size_t at) const {
    for (std::size_t end = at + 1; end <= words_.size(); ++end) {
      if (joined(words_, at, end) == name) return end;
    }
    return at;
  }

  Node created(std::size_t at) const {
    Node node = value_;
    for (std::size_t k = words_.size(); k > at; --k)
      node = Node::map({{words_[k - 1], place_, node}}, place_);
    return node;
  }

  std::optional<Node> in_map(const Node& map, std::size_t at) const {
    std::vector<Node::Entry> entries = map.entries();
    for (Node::Entry& entry : entries) {
      const std::size_t end = matching_end(entry.key, at);
      if (end == at) continue;
      std::optional<Node> value = apply(entry.value, end);
      if (!value) return std::nullopt;
      entry.value = *value;
      if (end == words_.size()) entry.key_place = place_;
      return Node::map(std::move(entries), map.place());
    }
    if (!may_add(map, at)) return std::nullopt;
    entries.push_back({words_[at], place_, created(at + 1)});
    return Node::map(std::move(entries), map.place());
  }

  // The last word may be new (whether it is a key of its map is checked with the rest of the case), and a section
  // that the file leaves out. Anything else would make a new body of a misspelt one.
  bool may_add(const Node& map, std::size_t at) const {
    Words known = keys_of(map);
    if (at == 0) {
      known.insert(known.end(), sections_.begin(), sections_.end());
      const bool is_section = std::find(sections_.begin(), sections_.end(), words_[0]) != sections_.end();
      if (is_section || words_[0].rfind("x-", 0) == 0) return true;
      if (const Node* parameters = map.find("parameters"); parameters != nullptr && words_.size() == 1) {
        const Words names = keys_of(*parameters);
        known.insert(known.end(), names.begin(), names.end());
      }
      fail("the case has no section or parameter '" + words_[0] + "'" + did_you_mean(words_[0], known));
      return false;
    }
    if (at + 1 == words_.size()) return true;
    fail("there is no '" + words_[at] + "' in '" + joined(words_, 0, at) + "'" +
             did_you_mean(words_[at], known),
         {"it has: " + join(known)});
    return false;
  }

  std::optional<Node> in_sequence(const Node& sequence, std::size_t at) const {
    std::vector<Node> items = sequence.items();
    const std::string& word = words_[at];
    std::size_t index = 0;
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), index);
    if (problem == std::errc() && end == word.data() + word.size()) return in_item(sequence, at, index);
    for (std::size_t k = 0; k < items.size(); ++k) {
      if (matching_end(type_name(items[k]), at) == at) continue;
      std::optional<Node> item = apply(items[k], at);
      if (!item) return std::nullopt;
      items[k] = *item;
      return Node::sequence(std::move(items), sequence.place());
    }
    Words types;
    for (const Node& item : items) types.push_back(type_name(item));
    const std::string wanted = joined(words_, at, std::min(words_.size(), at + 2));
    fail("there is no '" + wanted + "' in the list '" + joined(words_, 0, at) + "'" +
             did_you_mean(wanted, types),
         {"it has: " + join(types)});
    return std::nullopt;
  }

  std::optional<Node> in_item(const Node& sequence, std::size_t at, std::size_t index) const {
    std::vector<Node> items = sequence.items();
    if (index >= items.size()) {
      fail("the list '" + joined(words_, 0, at) + "' has no item " + words_[at] + "; it has " +
           std::to_string(items.size()) + ", counted from 0");
      return std::nullopt;
    }
    std::optional<Node> item = apply(items[index], at + 1);
    if (!item) return std::nullopt;
    items[index] = *item;
    return Node::sequence(std::move(items), sequence.place());
  }

  Words words_;
  Node value_;
  Place place_;
  const Words& sections_;
  Diagnostics& diagnostics_;
};

}  // namespace

Place command_line_place(const std::string& setting) {
  return {std::make_shared<SourceText>(SourceText{"<--set " + setting + ">", {}}), 0, 0, 0};
}

bool is_command_line(const Place& place) { return place.file().rfind("<--", 0) == 0; }

Node apply_overrides(const Node& root, const std::vector<std::string>& settings, const Words& sections,
                     Diagnostics& diagnostics) {
  Node result = root;
  for (const std::string& setting : settings) {
    const Place place = command_line_place(setting);
    const std::size_t equals = setting.find('=');
    const std::string path = setting.substr(0, std::min(equals, setting.size()));
    Words words = split_path(path);
    if (equals == std::string::npos || std::find(words.begin(), words.end(), "") != words.end()) {
      diagnostics.error(place, "expected PATH=VALUE, e.g. --set run.end=1 or --set H=0.5m");
      continue;
    }
    const std::size_t errors = diagnostics.n_errors();
    const Node value = read_yaml_value(setting.substr(equals + 1), place, diagnostics);
    if (diagnostics.n_errors() > errors) continue;
    const Node* parameters = result.is_map() ? result.find("parameters") : nullptr;
    if (words.size() == 1 && parameters != nullptr && parameters->is_map() &&
        parameters->find(words[0]) != nullptr)
      words.insert(words.begin(), "parameters");
    const Override change(std::move(words), value.is_null() ? Node::null(place) : value, place, sections,
                          diagnostics);
    if (const std::optional<Node> changed = change.apply(result, 0)) result = *changed;
  }
  return result;
}

}  // namespace shoal::kernel
