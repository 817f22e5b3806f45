// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Fields of a stress law as its members (LawScalar, LawTensor, LawDirection), and LawPoint, through which a law reads
// and writes them for a pack of particles; see shoal/stress_law.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "shoal/interfaces/stress_law.h"
#include "shoal/parameters.hpp"
#include "shoal/vec.hpp"

namespace shoal {
inline namespace SHOAL_ISA_NAMESPACE {

class StressLaw;

// A field of a law. Its values may stand in more than one field of the particles.
class LawField {
 public:
  LawField(const LawField&) = delete;
  LawField& operator=(const LawField&) = delete;

  // Place of its first field among those of the law.
  std::size_t first(int dimensions) const { return first_[dimensions == 2]; }
  virtual std::vector<shoal_access> accesses(int dimensions) const = 0;
  // Values of n undeformed particles; `fields` are those of the law.
  virtual void initialise(int dimensions, std::uint64_t n, const double* position,
                          double* const* fields) const = 0;
  // Values of one undeformed particle for the constants of the material. `direction` counts the directions so far.
  virtual void set_typical(int dimensions, std::size_t& direction, double* const* fields) const = 0;

 protected:
  inline explicit LawField(StressLaw& law);
  virtual ~LawField() = default;

  static shoal_access state(shoal_rank rank, const char* field, const char* unit, const char* doc) {
    return {sizeof(shoal_access), SHOAL_READ | SHOAL_WRITE, rank, SHOAL_DOUBLE, field, unit, doc, 0, 0};
  }
  static shoal_access given(shoal_rank rank, const char* field, const char* unit, const char* doc) {
    return {sizeof(shoal_access), SHOAL_READ, rank, SHOAL_DOUBLE, field, unit, doc, 0, 0};
  }

 private:
  friend class StressLaw;
  std::array<std::size_t, 2> first_{};  // in space, in the plane
};

// A number per particle: state with a value at the start, or, without that value, what others provide (unit and doc
// are null for a shared field).
class LawScalar final : public LawField {
 public:
  LawScalar(StressLaw& law, const char* field, const char* unit, const char* doc)
      : LawField(law), access_(given(SHOAL_SCALAR, field, unit, doc)) {}
  LawScalar(StressLaw& law, const char* field, const char* unit, const char* doc, double initial)
      : LawField(law), access_(state(SHOAL_SCALAR, field, unit, doc)), initial_(initial) {}

  std::vector<shoal_access> accesses(int) const override { return {access_}; }
  void initialise(int dimensions, std::uint64_t n, const double*, double* const* fields) const override {
    if (access_.mode & SHOAL_WRITE) std::fill_n(fields[first(dimensions)], n, initial_);
  }
  void set_typical(int dimensions, std::size_t&, double* const* fields) const override {
    *fields[first(dimensions)] = initial_;
  }

 private:
  shoal_access access_;
  double initial_ = 0;
};

// A symmetric tensor per particle that is the identity at the start. In the plane its zz stands in a field of its own.
class LawTensor final : public LawField {
 public:
  LawTensor(StressLaw& law, const char* field, const char* unit, const char* doc)
      : LawField(law), access_(state(SHOAL_SYMMETRIC, field, unit, doc)), zz_(std::string(field) + "_zz") {}

  std::vector<shoal_access> accesses(int dimensions) const override {
    if (dimensions == 3) return {access_};
    return {access_, state(SHOAL_SCALAR, zz_.c_str(), access_.unit, access_.doc)};
  }
  void initialise(int dimensions, std::uint64_t n, const double*, double* const* fields) const override {
    static constexpr std::array<double, 6> space{1, 0, 0, 1, 0, 1}, plane{1, 0, 1};
    const std::size_t components = dimensions == 2 ? 3 : 6;
    double* const* own = fields + first(dimensions);
    for (std::uint64_t i = 0; i < n; ++i)
      std::copy_n((dimensions == 2 ? plane : space).begin(), components, own[0] + i * components);
    if (dimensions == 2) std::fill_n(own[1], n, 1.0);
  }
  void set_typical(int dimensions, std::size_t&, double* const* fields) const override {
    initialise(dimensions, 1, nullptr, fields);
  }

 private:
  shoal_access access_;
  std::string zz_;
};

// A unit vector per particle in the reference configuration. It is what the parameter says, if the case sets it, else
// the field of that name, given by the body (`initial`) or by an operator.
class LawDirection final : public LawField {
 public:
  // `across`: another direction of the law, to which this one is at right angles.
  LawDirection(StressLaw& law, const char* shared_field, const Param<VectorExpression>& direction,
               const LawDirection* across = nullptr)
      : LawField(law), field_(shared_field), direction_(direction), across_(across) {}

  // For laws that turn out not to need it; in `check`.
  void leave_out() { needed_ = false; }

  std::vector<shoal_access> accesses(int) const override {
    if (!needed_) return {};
    return {direction_.is_set() ? state(SHOAL_RANK_VECTOR, field_, nullptr, nullptr)
                                : given(SHOAL_RANK_VECTOR, field_, nullptr, nullptr)};
  }
  inline void initialise(int dimensions, std::uint64_t n, const double* position,
                         double* const* fields) const override;
  void set_typical(int dimensions, std::size_t& direction, double* const* fields) const override {
    if (!needed_) return;
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimensions); ++a)
      fields[first(dimensions)][a] = a == direction ? 1.0 : 0.0;
    ++direction;
  }

 private:
  const char* field_;
  const Param<VectorExpression>& direction_;
  const LawDirection* across_;
  bool needed_ = true;
};

// Directions of any length are made unit vectors; a zero one is what a field that nobody gives would hold.
inline void LawDirection::initialise(int dimensions, std::uint64_t n, const double* position,
                                     double* const* fields) const {
  if (!needed_) return;
  const auto d = static_cast<std::uint64_t>(dimensions);
  double* const values = fields[first(dimensions)];
  std::vector<double> component(n);
  for (std::size_t a = 0; a < d && direction_.is_set(); ++a) {
    direction_->component[a].evaluate(dimensions, n, position, 0.0, component.data());
    for (std::uint64_t i = 0; i < n; ++i) values[i * d + a] = component[i];
  }
  for (std::uint64_t i = 0; i < n; ++i) {
    double squared = 0.0;
    for (std::uint64_t a = 0; a < d; ++a) squared += values[i * d + a] * values[i * d + a];
    const double length = std::sqrt(squared);
    if (direction_.is_set() && length > 0.0 && std::isfinite(length))
      for (std::uint64_t a = 0; a < d; ++a) values[i * d + a] /= length;
    else if (!(std::fabs(length - 1.0) < 1e-6))
      throw CaseError(std::string("the material needs the direction '") + field_ +
                      "' at every particle, of length 1; give it in the material (" + field_ +
                      ": [1, 0, 0]) or as an initial field of the body");
    if (across_ == nullptr) continue;
    const double* other = fields[across_->first(dimensions)] + i * d;
    double cosine = 0.0;
    for (std::uint64_t a = 0; a < d; ++a) cosine += values[i * d + a] * other[a];
    if (!(std::fabs(cosine) < 1e-6))
      throw CaseError(std::string("the material's directions '") + across_->field_ + "' and '" + field_ +
                      "' must be at right angles to each other at every particle");
  }
}

// The particles of a pack, as a law sees them beside F.
class LawPoint {
 public:
  static constexpr std::size_t most_numbers = 16;  // of the state of one particle

  LawPoint(const shoal_stress_block& block, int dimensions, std::uint64_t first)
      : block_(block), dimensions_(dimensions), first_(first) {
    for (std::uint32_t k = 0; k < SHOAL_PADDING; ++k)
      index_[k] = static_cast<std::uint32_t>(std::min(first + k, block.n - 1));
  }

  double dt() const { return block_.dt; }      // s since the state was last written
  double time() const { return block_.time; }  // s
  int dimensions() const { return dimensions_; }
  IndexPack indices() const { return IndexPack::load(index_); }
  std::uint64_t first() const { return first_; }
  std::uint64_t n() const { return std::min<std::uint64_t>(lanes, block_.n - first_); }

  Pack operator()(const LawScalar& field) const { return gather<1>(values(field), indices()); }
  Mat<3, Pack> operator()(const LawTensor& field) const {
    const double* base = values(field);
    if (dimensions_ == 2) {
      const Pack xx = gather<3, 0>(base, indices()), xy = gather<3, 1>(base, indices());
      const Pack yy = gather<3, 2>(base, indices()), zz = gather<1>(values(field, 1), indices());
      return {xx, xy, 0.0, xy, yy, 0.0, 0.0, 0.0, zz};
    }
    const Pack xx = gather<6, 0>(base, indices()), xy = gather<6, 1>(base, indices());
    const Pack xz = gather<6, 2>(base, indices()), yy = gather<6, 3>(base, indices());
    const Pack yz = gather<6, 4>(base, indices()), zz = gather<6, 5>(base, indices());
    return {xx, xy, xz, xy, yy, yz, xz, yz, zz};
  }
  Vec<3, Pack> operator()(const LawDirection& field) const {
    const double* base = values(field);
    if (dimensions_ == 2) return {gather<2, 0>(base, indices()), gather<2, 1>(base, indices()), 0.0};
    return gather_vec<3>(base, indices());
  }

  // The new state, kept when the step is made. May be set again: the last value counts.
  void set(const LawScalar& field, Pack value) { fresh(field.first(dimensions_), 1)[0] = value; }
  void set(const LawTensor& field, const Mat<3, Pack>& a) {
    const std::size_t at = field.first(dimensions_);
    if (dimensions_ == 2) {
      Pack* plane = fresh(at, 3);
      plane[0] = a(0, 0), plane[1] = a(0, 1), plane[2] = a(1, 1);
      fresh(at + 1, 1)[0] = a(2, 2);
    } else {
      Pack* c = fresh(at, 6);
      c[0] = a(0, 0), c[1] = a(0, 1), c[2] = a(0, 2);
      c[3] = a(1, 1), c[4] = a(1, 2), c[5] = a(2, 2);
    }
  }
  // Writes the state that was set into the fields of the particles.
  void keep() const {
    for (std::size_t k = 0; k < n_fresh_; ++k) {
      const Fresh& state = fresh_[k];
      for (std::uint64_t lane = 0; lane < n(); ++lane)
        for (std::size_t c = 0; c < state.n; ++c)
          block_.fields[state.field][(first_ + lane) * state.n + c] =
              numbers_[state.first + c][static_cast<int>(lane)];
    }
  }

 private:
  struct Fresh {
    std::size_t field, first, n;
  };
  const double* values(const LawField& field, std::size_t next = 0) const {
    return block_.fields[field.first(dimensions_) + next];
  }
  Pack* fresh(std::size_t field, std::size_t n) {
    std::size_t used = 0;
    for (std::size_t k = 0; k < n_fresh_; ++k) {
      if (fresh_[k].field == field) return &numbers_[fresh_[k].first];
      used = fresh_[k].first + fresh_[k].n;
    }
    if (used + n > most_numbers) throw std::logic_error("a stress law with too much state");
    fresh_[n_fresh_++] = {field, used, n};
    return &numbers_[used];
  }

  const shoal_stress_block& block_;
  int dimensions_;
  std::uint64_t first_;
  std::uint32_t index_[SHOAL_PADDING];
  std::array<Pack, most_numbers> numbers_;
  std::array<Fresh, most_numbers> fresh_;
  std::size_t n_fresh_ = 0;
};

}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
