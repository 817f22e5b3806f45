// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What physics have asked for through the builder, as they said it. Names are resolved when all have spoken
// (resolve.cpp), because a coupling may name loops of physics that are built after it.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "shoal/abi.h"

namespace shoal::kernel {

/// The kernel's copy of an operator; destroys `self` exactly once.
class OwnedOperator {
 public:
  explicit OwnedOperator(const shoal_operator& op) : op_(op) {}
  OwnedOperator(OwnedOperator&& other) noexcept : op_(other.op_) { other.op_.destroy = nullptr; }
  OwnedOperator& operator=(OwnedOperator&& other) noexcept {
    std::swap(op_, other.op_);
    return *this;
  }
  ~OwnedOperator() {
    if (op_.destroy != nullptr) op_.destroy(op_.self);
  }
  const shoal_operator& c() const { return op_; }

 private:
  shoal_operator op_;
};

struct Access {
  std::string field;
  std::uint32_t mode = 0;
  std::uint32_t rank = SHOAL_SCALAR;  ///< as the plugin gave it
  std::uint32_t data_type = SHOAL_DOUBLE;
  const char* unit = nullptr;
  const char* doc = nullptr;
  std::uint32_t array_components = 0;

  bool has(std::uint32_t flags) const { return (mode & flags) != 0; }
  bool changes() const { return has(SHOAL_WRITE | SHOAL_ACCUMULATE); }
};

struct Attachment {
  std::string loop, stage;  ///< loop empty: where the accumulated field is owned
  std::string name;         ///< "fluid.viscous_force"
  std::string declarer;
  OwnedOperator op;
  std::vector<Access> accesses;
  std::vector<shoal_relation_request> relations;
  std::vector<std::uint32_t> reductions;

  std::uint32_t body() const { return op.c().body; }
  bool on_demand() const { return (op.c().flags & SHOAL_OPERATOR_ON_DEMAND) != 0; }
};

struct LoopDeclaration {
  std::string name, parent, parent_stage;
  std::vector<std::string> stages;
  std::string declarer, parent_declarer;
};

struct FieldOwner {
  std::uint32_t body = 0;
  std::string field, loop, stage, declarer;
};

struct GuardDeclaration {
  std::uint32_t body = 0;
  std::string field;
  double minimum = 0.0, maximum = 0.0;
  std::string declarer;
};

struct Demand {
  std::uint32_t body = 0;
  std::string field, place;
};

struct Renewal {
  std::string loop, declarer;
};

struct Declarations {
  std::vector<LoopDeclaration> loops;
  std::vector<Attachment> attachments;
  std::vector<FieldOwner> owners;
  std::vector<GuardDeclaration> guards;
  std::vector<Demand> demands;
  std::vector<Renewal> renewals;
  std::vector<std::string> notes;

  const LoopDeclaration* find_loop(const std::string& name) const {
    for (const LoopDeclaration& loop : loops)
      if (loop.name == name) return &loop;
    return nullptr;
  }
  const FieldOwner* find_owner(std::uint32_t body, const std::string& field) const {
    for (const FieldOwner& owner : owners)
      if (owner.body == body && owner.field == field) return &owner;
    return nullptr;
  }
};

}  // namespace shoal::kernel
