// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The tree that yaml_reader builds, apart from the building.
#include "kernel/case/scalars.hpp"
#include "kernel/case/yaml_reader.hpp"

namespace shoal::kernel {

Node::Node(Kind kind, Place place) {
  Data data;
  data.kind = kind;
  data.place = std::move(place);
  data_ = std::make_shared<const Data>(std::move(data));
}

Node Node::scalar(std::string text, bool quoted, Place place) {
  Data data;
  data.kind = Kind::scalar;
  data.quoted = quoted;
  data.place = std::move(place);
  data.text = std::move(text);
  Node node;
  node.data_ = std::make_shared<const Data>(std::move(data));
  return node;
}

Node Node::sequence(std::vector<Node> items, Place place) {
  Data data;
  data.kind = Kind::sequence;
  data.place = std::move(place);
  data.items = std::move(items);
  Node node;
  node.data_ = std::make_shared<const Data>(std::move(data));
  return node;
}

Node Node::map(std::vector<Entry> entries, Place place) {
  Data data;
  data.kind = Kind::map;
  data.place = std::move(place);
  data.entries = std::move(entries);
  Node node;
  node.data_ = std::make_shared<const Data>(std::move(data));
  return node;
}

const std::vector<Node::Entry>& Node::entries() const { return data_->entries; }

const Node* Node::find(std::string_view key) const {
  for (const Entry& entry : entries()) {
    if (entry.key == key) return &entry.value;
  }
  return nullptr;
}

std::string Node::described() const {
  switch (kind()) {
    case Kind::null: return "nothing";
    case Kind::sequence: return "a list";
    case Kind::map: return "a map";
    case Kind::scalar: break;
  }
  if (!quoted() && parse_number(text()).status == NumberText::Status::number) return "the number " + text();
  return "'" + text() + "'";
}

}  // namespace shoal::kernel
