// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Physics: a named assembly of operators. `build` reads the parameters of the case and says what a run consists of.
#pragma once

#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "shoal/operator.hpp"

namespace shoal {

// A stage of a loop, or "initial" and "sample" with any stage name. Default: where the accumulated field is owned.
struct At {
  const char* loop = nullptr;
  const char* stage = nullptr;
};

template <class Api>
struct Interface {
  const Api* api = nullptr;
  void* self = nullptr;
  explicit operator bool() const { return api != nullptr; }
};

class Builder {
 public:
  explicit Builder(const shoal_builder& c) : c_(c) {}

  int dimensions() const { return c_.dimensions; }
  Vector3 gravity() const { return {c_.gravity[0], c_.gravity[1], c_.gravity[2]}; }
  double end_time() const { return c_.end_time; }
  bool periodic(int axis) const { return c_.periodic[axis] != 0; }
  const shoal_body& body(BodyIndex index) const { return *SHOAL_AT(shoal_body, c_.bodies, index.value); }
  std::uint32_t n_bodies() const { return c_.n_bodies; }

  // Reads the body's material as type M; its name must be `type`.
  template <class M>
  std::unique_ptr<M> material(BodyIndex index, std::string_view type) const {
    const shoal_body& b = body(index);
    if (b.material == nullptr)
      throw CaseError(std::string("body '") + b.name + "' needs a material " + std::string(type));
    if (b.material->type->name != type)
      throw CaseError(std::string(b.material->place) + ": body '" + b.name + "' has material " +
                      b.material->type->name + ", but needs " + std::string(type));
    auto material = std::make_unique<M>();
    material->read(*b.material, c_.dimensions);
    return material;
  }
  template <class Api>
  Interface<Api> material_interface(BodyIndex body, const char* name, std::uint32_t revision = 1) const {
    const void* api = nullptr;
    Interface<Api> found;
    check_host(c_.material_interface(c_.context, body.value, name, revision, &api, &found.self));
    found.api = static_cast<const Api*>(api);
    return found;
  }

  void loop(const char* name, std::initializer_list<const char*> stages) const {
    check_host(c_.loop(c_.context, name, nullptr, nullptr, static_cast<std::uint32_t>(stages.size()),
                       stages.begin()));
  }
  void loop(const char* name, At parent, std::initializer_list<const char*> stages) const {
    check_host(c_.loop(c_.context, name, parent.loop, parent.stage, static_cast<std::uint32_t>(stages.size()),
                       stages.begin()));
  }
  void renew_neighbours_in(const char* loop) const { check_host(c_.renew_neighbours_in(c_.context, loop)); }
  void own_field(BodyIndex body, const char* field, At at) const {
    check_host(c_.own_field(c_.context, body.value, field, at.loop, at.stage));
  }
  void guard(BodyIndex body, const char* field, double minimum, double maximum) const {
    check_host(c_.guard(c_.context, body.value, field, minimum, maximum));
  }
  void body_moves(BodyIndex body) const { check_host(c_.body_moves(c_.context, body.value, 1)); }
  void note(const std::string& text) const { c_.note(c_.context, text.c_str()); }

  // Where an operator on `body` works, with the smoothing kernel of the body. Pair operators without neighbours
  // given look at the body itself.
  Target target(BodyIndex index, std::vector<BodyIndex> neighbours = {}) const {
    const shoal_body& b = body(index);
    const auto kernel = smoothing_kernel_from_name(b.smoothing_kernel);
    if (!kernel) throw CaseError(std::string("unknown smoothing kernel '") + b.smoothing_kernel + "'");
    return {index, std::move(neighbours), *kernel, b.smoothing_length, b.cutoff, b.spacing, SHOAL_CURRENT};
  }

  // Makes an operator, lets `setup(op)` fill its parameters, and attaches it.
  template <class Op, class Setup>
  void attach(const char* name, At at, Target target, Setup&& setup, std::uint32_t flags = 0) const {
    auto attached = std::make_unique<impl::AttachedOperator<Op>>();
    attached->name = name;
    if constexpr (Op::pairs) {
      if (target.neighbours.empty()) target.neighbours = {target.body};
    }
    attached->op.set_target(std::move(target));
    attached->op.set_dimensions(c_.dimensions);
    std::forward<Setup>(setup)(attached->op);
    const shoal_operator c = impl::describe(std::move(attached), flags);
    check_host(c_.attach(c_.context, at.loop, at.stage, &c));
  }
  template <class Op>
  void attach(const char* name, At at, Target target) const {
    attach<Op>(name, at, std::move(target), [](Op&) {});
  }

  const shoal_builder& raw() const { return c_; }

 private:
  const shoal_builder& c_;
};

class Physics : public Parameterised {
 public:
  static constexpr shoal_type_kind type_kind = SHOAL_TYPE_PHYSICS;

  template <class Derived>
  static const void* api() {
    static const shoal_physics_api table{sizeof(shoal_physics_api), 0,
                                         [](const shoal_object* object, const shoal_builder* builder) {
                                           return guarded([&] {
                                             Derived physics;
                                             physics.read(*object, builder->dimensions);
                                             physics.build(Builder(*builder));
                                           });
                                         }};
    return &table;
  }
};

// An operator that a case uses by itself: `physics: [{example.viscous_force: {bodies: [water], viscosity: 1e-3}}]`.
template <class Op>
class OperatorPhysics {
 public:
  static constexpr shoal_type_kind type_kind = SHOAL_TYPE_OPERATOR;

  // What every operator has, then the operator's own.
  std::vector<shoal_parameter> parameter_table() const {
    auto table = own_.parameter_table();
    for (const shoal_parameter& parameter : op_.parameter_table()) table.push_back(parameter);
    return table;
  }

  template <class>
  static const void* api() {
    static const shoal_physics_api table{sizeof(shoal_physics_api), 0,
                                         [](const shoal_object* object, const shoal_builder* builder) {
                                           return guarded([&] { build(*object, Builder(*builder)); });
                                         }};
    return &table;
  }

 private:
  struct Own : Parameterised {
    Param<std::vector<BodyIndex>> bodies{"bodies", nullptr, "Bodies that the operator works on.",
                                         example("[water]")};
    Param<std::vector<BodyIndex>> neighbours{
        "neighbours", nullptr, "Bodies whose particles count as neighbours; without it the body itself.",
        optional, example("[water, tank]")};
    Param<std::string> at{
        "at", nullptr,
        "Loop and stage in which it runs; without it, where the field that it adds to is summed up.",
        optional, example("advection/forces")};
  };

  static void build(const shoal_object& object, const Builder& builder) {
    Own own;
    own.read(object, builder.dimensions());
    const std::string at = own.at.value();
    const std::size_t slash = at.find('/');
    if (own.at.is_set() && slash == std::string::npos)
      throw CaseError(own.at.place() + ": expected loop/stage, e.g. advection/forces, got '" + at + "'");
    const std::string loop = at.substr(0, slash);
    const std::string stage = own.at.is_set() ? at.substr(slash + 1) : "";
    for (const BodyIndex body : own.bodies.value())
      builder.attach<Op>(object.type->name, own.at.is_set() ? At{loop.c_str(), stage.c_str()} : At{},
                         builder.target(body, own.neighbours.value()),
                         [&](Op& op) { op.read(object, builder.dimensions(), own.n_parameters()); });
  }

  Own own_;
  Op op_;
};

}  // namespace shoal
