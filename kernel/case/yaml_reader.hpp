// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// YAML as an immutable tree in which every key and value knows its place. Only yaml_reader.cpp includes yaml-cpp:
// version 0.7 keeps the first of two equal keys silently, reads 010 as eight, ignores merge keys and loses
// positions, so nothing else may see it.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kernel/case/diagnostics.hpp"
#include "kernel/case/place.hpp"

namespace shoal::kernel {

/// A value of the tree; cheap to copy, never changes. Scalars are kept as text: what they mean is decided where
/// it is known what is wanted, so `no` is not a boolean and `010` not eight.
class Node {
 public:
  enum class Kind { null, scalar, sequence, map };
  struct Entry;

  Node() : Node(Kind::null, Place{}) {}
  static Node null(Place place) { return {Kind::null, std::move(place)}; }
  static Node scalar(std::string text, bool quoted, Place place);
  static Node sequence(std::vector<Node> items, Place place);
  static Node map(std::vector<Entry> entries, Place place);

  Kind kind() const { return data_->kind; }
  bool is_null() const { return kind() == Kind::null; }
  bool is_scalar() const { return kind() == Kind::scalar; }
  bool is_sequence() const { return kind() == Kind::sequence; }
  bool is_map() const { return kind() == Kind::map; }

  const Place& place() const { return data_->place; }
  const std::string& text() const { return data_->text; }  ///< of a scalar
  bool quoted() const { return data_->quoted; }            ///< of a scalar: in quotes, or a block of text
  const std::vector<Node>& items() const { return data_->items; }
  const std::vector<Entry>& entries() const;  ///< in the order of the file, merged keys where `<<` stands

  /// The value of a key, or nullptr.
  const Node* find(std::string_view key) const;

  /// "a number", "a text", "a list", ... for messages.
  std::string described() const;

 private:
  struct Data {
    Kind kind = Kind::null;
    bool quoted = false;
    Place place;
    std::string text;
    std::vector<Node> items;
    std::vector<Entry> entries;
  };
  Node(Kind kind, Place place);
  std::shared_ptr<const Data> data_;
};

struct Node::Entry {
  std::string key;
  Place key_place;
  Node value;
};

/// Reads a file whose top level is a map. What is wrong goes to `diagnostics`; the tree then holds what could be
/// read, or is null.
Node read_yaml_file(const std::string& path, Diagnostics& diagnostics);

/// The same for a text; `name` stands for the file in messages.
Node read_yaml_text(const std::string& text, const std::string& name, Diagnostics& diagnostics);

/// A single value of any kind, e.g. of a setting of the command line; all places are `place`.
Node read_yaml_value(const std::string& text, const Place& place, Diagnostics& diagnostics);

}  // namespace shoal::kernel
