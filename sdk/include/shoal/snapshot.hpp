// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What outputs and probes see: the bodies of a snapshot and their fields. They are walked by the size that the
// kernel gives them, which may be larger than the one this plugin was compiled with.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "shoal/abi.h"

namespace shoal {

template <class Struct>
class StructRange {
 public:
  class Iterator {
   public:
    Iterator(const StructRange* range, std::size_t index) : range_(range), index_(index) {}
    const Struct& operator*() const { return (*range_)[index_]; }
    Iterator& operator++() {
      ++index_;
      return *this;
    }
    bool operator==(const Iterator& other) const { return index_ == other.index_; }

   private:
    const StructRange* range_;
    std::size_t index_;
  };

  StructRange(const Struct* first, std::size_t size) : first_(first), size_(size) {}
  std::size_t size() const { return size_; }
  const Struct& operator[](std::size_t index) const { return *SHOAL_AT(Struct, first_, index); }
  Iterator begin() const { return {this, 0}; }
  Iterator end() const { return {this, size_}; }

 private:
  const Struct* first_;
  std::size_t size_;
};

inline StructRange<shoal_snapshot_body> bodies_of(const shoal_snapshot& snapshot) {
  return {snapshot.bodies, snapshot.n_bodies};
}
inline StructRange<shoal_snapshot_field> fields_of(const shoal_snapshot_body& body) {
  return {body.fields, body.n_fields};
}

// Null if there is none of that name.
inline const shoal_snapshot_body* find_body(const shoal_snapshot& snapshot, std::string_view name) {
  for (const shoal_snapshot_body& body : bodies_of(snapshot))
    if (body.name == name) return &body;
  return nullptr;
}
inline const shoal_snapshot_field* find_field(const shoal_snapshot_body& body, std::string_view name) {
  for (const shoal_snapshot_field& field : fields_of(body))
    if (field.name == name) return &field;
  return nullptr;
}

}  // namespace shoal
