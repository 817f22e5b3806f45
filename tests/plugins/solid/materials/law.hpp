// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A stress law as a solver sees it, through the C interface, made from the values that a case would give.
#pragma once

#include <doctest/doctest.h>

// Slow obvious code; besides, gcc 12 warns of Eigen 3.4 with AVX-512.
#define EIGEN_DONT_VECTORIZE
#include <Eigen/Dense>
#include <charconv>
#include <cmath>
#include <deque>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "shoal/interfaces/stress_law.h"
#include "shoal/material.hpp"

namespace material_test {

using Matrix = Eigen::Matrix3d;
using Vector = Eigen::Vector3d;

inline std::string failure;  // what a callback said last

// A host whose expressions are constants: a handle points to the number.
inline void use_test_host() {
  static const shoal_host host = [] {
    shoal_host table{};
    table.size = sizeof table;
    table.log = [](std::uint32_t, const char*) {};
    table.fail = [](const char* text) { failure = text; };
    table.evaluate = [](const shoal_expression* e, std::int32_t, std::uint64_t n, const double*, double,
                        double* out) {
      for (std::uint64_t k = 0; k < n; ++k) out[k] = *reinterpret_cast<const double*>(e);
      return SHOAL_OK;
    };
    return table;
  }();
  shoal::impl::host_table = &host;
}

// Values of a case by key: numbers, or a word for a choice.
struct Given {
  Given(double x) : numbers{x} {}                         // NOLINT
  Given(std::initializer_list<double> x) : numbers(x) {}  // NOLINT
  Given(const char* w) : word(w) {}                       // NOLINT
  std::vector<double> numbers;
  const char* word = nullptr;
};
using Values = std::map<std::string, Given>;

// The values of a type as the kernel would hand them over.
class Object {
 public:
  Object(const shoal_type& type, const std::vector<shoal_parameter>& table, const Values& given,
         int dimensions) {
    for (const shoal_parameter& p : table) {
      shoal_value value{};
      value.size = sizeof value;
      value.kind = p.kind;
      value.place = "case.yaml:1:1";
      const auto found = given.find(p.key);
      if (found != given.end())
        fill(value, p, found->second, dimensions);
      else if (p.default_text != nullptr)
        fill_default(value, p, dimensions);
      else
        REQUIRE_MESSAGE((p.flags & SHOAL_PARAMETER_REQUIRED) == 0, p.key);
      values_.push_back(value);
    }
    for (const auto& entry : given) {
      const auto& key = entry.first;  // not a binding: the message is put together in a lambda
      bool known = false;
      for (const shoal_parameter& p : table) known = known || key == p.key;
      REQUIRE_MESSAGE(known, key);
    }
    c_ = {sizeof c_, static_cast<std::uint32_t>(values_.size()), &type, values_.data(), "case.yaml:1:1"};
  }
  const shoal_object& c() const { return c_; }

 private:
  void fill(shoal_value& value, const shoal_parameter& p, const Given& given, int dimensions) {
    value.n = static_cast<std::uint32_t>(given.word ? 1 : given.numbers.size());
    words_.push_back(given.word);
    value.texts = &words_.back();
    numbers_.push_back(given.numbers);
    value.reals = numbers_.back().data();
    integers_.push_back(given.numbers.empty() ? 0 : static_cast<std::int64_t>(given.numbers[0]));
    value.integers = &integers_.back();
    if (p.kind != SHOAL_VECTOR_EXPRESSION) return;
    value.n = 1;
    handles_.emplace_back();
    for (int a = 0; a < dimensions; ++a)
      handles_.back().push_back(
          reinterpret_cast<const shoal_expression*>(&numbers_.back()[static_cast<std::size_t>(a)]));
    value.expressions = handles_.back().data();
  }
  void fill_default(shoal_value& value, const shoal_parameter& p, int dimensions) {
    if (p.kind == SHOAL_REAL)
      fill(value, p, Given(std::stod(p.default_text)), dimensions);
    else if (p.kind == SHOAL_BOOLEAN)
      fill(value, p, Given(std::string(p.default_text) == "true" ? 1.0 : 0.0), dimensions);
    else
      fill(value, p, Given(p.default_text), dimensions);
  }

  std::deque<const char*> words_;
  std::deque<std::vector<double>> numbers_;
  std::deque<std::int64_t> integers_;
  std::deque<std::vector<const shoal_expression*>> handles_;
  std::vector<shoal_value> values_;
  shoal_object c_{};
};

inline const shoal_type& nameless() {
  static const shoal_type type{};
  return type;
}

// A law with the fields of n particles.
class Law {
 public:
  template <class M>
  static Law of(const Values& values, std::uint32_t kinematics, std::size_t n = 1) {
    return Law(static_cast<const shoal_material_api*>(M::template api<M>()), M().parameter_table(), values,
               kinematics, n);
  }
  Law(Law&& other) noexcept
      : law(other.law),
        kinematics(other.kinematics),
        api_(other.api_),
        values_(std::move(other.values_)),
        self_(other.self_),
        fields_(std::move(other.fields_)) {
    other.self_ = nullptr;
  }
  ~Law() {
    if (self_ != nullptr) api_->destroy(self_);
  }

  int dimensions() const { return kinematics == SHOAL_THREE_DIMENSIONAL ? 3 : 2; }
  std::size_t d() const { return static_cast<std::size_t>(dimensions()); }
  void* self() const { return self_; }
  std::vector<double>& field(const std::string& name) {
    std::uint32_t n = 0;
    const shoal_access* list = law->fields(self_, kinematics, &n);
    for (std::uint32_t k = 0; k < n; ++k)
      if (name == list[k].field) return fields_[k];
    REQUIRE_MESSAGE(false, name);
    return fields_[0];
  }
  const std::vector<std::vector<double>>& fields() const { return fields_; }

  // Resizes the fields to n particles and initialises them.
  shoal_status initialise(std::size_t n) {
    std::uint32_t n_fields = 0;
    const shoal_access* list = law->fields(self_, kinematics, &n_fields);
    fields_.resize(n_fields);
    for (std::uint32_t k = 0; k < n_fields; ++k) {
      const std::size_t components = list[k].rank == SHOAL_SCALAR        ? 1
                                     : list[k].rank == SHOAL_RANK_VECTOR ? d()
                                                                         : d() * (d() + 1) / 2;
      fields_[k].reserve(n * components + SHOAL_PADDING);  // packs may read behind the last particle
      fields_[k].resize(n * components, 0.0);
    }
    const std::vector<double> position(n * d(), 0.0);
    auto pointers = field_pointers();
    return law->initialise(self_, kinematics, n, position.data(), pointers.data());
  }

  struct Result {
    std::vector<Matrix> P;
    std::vector<double> W, F33;
  };
  // Of particles whose F are the upper left D x D of these.
  Result operator()(const std::vector<Matrix>& F, bool updates = false, double dt = 0.0) const {
    const std::size_t n = F.size();
    const std::vector<double> flat = flatten(F);
    std::vector<double> stress(n * d() * d()), W(n), P33(n), F33(n, 1.0);
    shoal_stress_block block = block_of(flat, n);
    auto pointers = field_pointers();
    block.fields = pointers.data();
    block.flags = updates ? std::uint32_t{SHOAL_STRESS_UPDATES_STATE} : 0u;
    block.dt = dt;
    block.stress = stress.data();
    block.energy = W.data();
    if (d() == 2) block.out_of_plane_stress = P33.data(), block.out_of_plane_stretch = F33.data();
    const shoal_status status = law->stress(self_, &block);
    REQUIRE_MESSAGE(status == SHOAL_OK, failure);
    Result result{{}, W, F33};
    for (std::size_t i = 0; i < n; ++i) {
      Matrix P = Matrix::Zero();
      for (std::size_t r = 0; r < d(); ++r)
        for (std::size_t c = 0; c < d(); ++c)
          P(Eigen::Index(r), Eigen::Index(c)) = stress[(i * d() + r) * d() + c];
      if (d() == 2) P(2, 2) = P33[i];
      result.P.push_back(P);
    }
    return result;
  }
  std::vector<double> wave_speeds(const std::vector<Matrix>& F) const {
    const std::vector<double> flat = flatten(F);
    std::vector<double> speed(F.size());
    shoal_stress_block block = block_of(flat, F.size());
    auto pointers = field_pointers();
    block.fields = pointers.data();
    REQUIRE(law->wave_speed(self_, &block, speed.data()) == SHOAL_OK);
    return speed;
  }
  shoal_elastic_constants constants() const {
    shoal_elastic_constants c{};
    c.size = sizeof c;
    law->constants(self_, kinematics, &c);
    return c;
  }

  const shoal_stress_law* law = nullptr;
  std::uint32_t kinematics;

  static shoal_status create(const shoal_material_api& api, const std::vector<shoal_parameter>& table,
                             const Values& values, int dimensions, void** self) {
    use_test_host();
    const Object object(nameless(), table, values, dimensions);
    return api.create(&object.c(), dimensions, self);
  }

 private:
  Law(const shoal_material_api* api, const std::vector<shoal_parameter>& table, const Values& values,
      std::uint32_t which, std::size_t n)
      : kinematics(which), api_(api), values_(nameless(), table, values, dimensions()) {
    use_test_host();
    REQUIRE_MESSAGE(api->create(&values_.c(), dimensions(), &self_) == SHOAL_OK, failure);
    law = static_cast<const shoal_stress_law*>(
        api->interface(self_, SHOAL_STRESS_LAW, SHOAL_STRESS_LAW_REVISION));
    REQUIRE(law != nullptr);
    REQUIRE_MESSAGE(initialise(n) == SHOAL_OK, failure);
  }
  std::vector<double> flatten(const std::vector<Matrix>& F) const {
    std::vector<double> flat;
    flat.reserve(F.size() * d() * d() + SHOAL_PADDING);
    for (const Matrix& f : F)
      for (std::size_t r = 0; r < d(); ++r)
        for (std::size_t c = 0; c < d(); ++c) flat.push_back(f(Eigen::Index(r), Eigen::Index(c)));
    return flat;
  }
  shoal_stress_block block_of(const std::vector<double>& flat, std::size_t n) const {
    shoal_stress_block block{};
    block.size = sizeof block;
    block.kinematics = kinematics;
    block.n = n;
    block.deformation_gradient = flat.data();
    return block;
  }
  std::vector<double*> field_pointers() const {
    std::vector<double*> pointers;
    for (const auto& field : fields_) pointers.push_back(const_cast<double*>(field.data()));
    return pointers;
  }

  const shoal_material_api* api_ = nullptr;
  Object values_;
  void* self_ = nullptr;
  std::vector<std::vector<double>> fields_;
};

// F = I + random numbers of at most `size`, with its volume between 0.4 and 2.5; in the plane F33 = 1.
inline std::vector<Matrix> random_deformations(std::size_t n, double size, int dimensions, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> number(-size, size);
  std::vector<Matrix> list;
  while (list.size() < n) {
    Matrix F = Matrix::Identity();
    for (int r = 0; r < dimensions; ++r)
      for (int c = 0; c < dimensions; ++c) F(r, c) += number(random);
    if (F.determinant() > 0.4 && F.determinant() < 2.5) list.push_back(F);
  }
  return list;
}

inline Matrix random_rotation(int dimensions, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const Vector axis =
      dimensions == 2 ? Vector(0, 0, 1) : Vector(number(random), number(random), number(random));
  return Eigen::AngleAxisd(3.0 * number(random), axis.normalized()).toRotationMatrix();
}

}  // namespace material_test
