// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What pair and particle operators have in common: the fields that they name as members, where they stand in a run,
// reductions, and the table of C callbacks that the kernel calls.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "shoal/abi.h"
#include "shoal/host.hpp"
#include "shoal/parameters.hpp"
#include "shoal/shared_fields.hpp"
#include "shoal/smoothing_kernel.hpp"
#include "shoal/vec.hpp"

namespace shoal {

// What a field holds per particle: In<Scalar>, In<Vector>, ... The number of components follows from the case.
struct Scalar {};
struct Vector {};
struct Matrix {};
struct Integer {};
// N2 numbers in two dimensions, N3 in three, each on its own: an image at a mirror copies them as they are.
// field[i] is a std::array<double, N>.
template <int N2, int N3 = N2>
struct Array {};

// A particle of a run in D dimensions; indexes fields: `velocity[i]`.
template <int D>
struct Particle {
  static constexpr int dimensions = D;
  std::uint64_t index;
  double* partial;  // this chunk's part of the reductions
};

namespace impl {

template <class T, int D>
struct Element;
template <int D>
struct Element<shoal::Scalar, D> {
  using type = double;
};
template <int D>
struct Element<shoal::Vector, D> {
  using type = Vec<D>;
};
template <int D>
struct Element<shoal::Matrix, D> {
  using type = Mat<D>;
};
template <int D>
struct Element<shoal::Integer, D> {
  using type = std::int64_t;
};
template <int N2, int N3, int D>
struct Element<shoal::Array<N2, N3>, D> {
  using type = std::array<double, static_cast<std::size_t>(D == 2 ? N2 : N3)>;
};

template <class T>
inline constexpr shoal_rank rank_of = SHOAL_SCALAR;
template <>
inline constexpr shoal_rank rank_of<shoal::Vector> = SHOAL_RANK_VECTOR;
template <>
inline constexpr shoal_rank rank_of<shoal::Matrix> = SHOAL_RANK_MATRIX;
template <int N2, int N3>
inline constexpr shoal_rank rank_of<shoal::Array<N2, N3>> = SHOAL_ARRAY;

// Numbers of an array in two and in three dimensions; none of other types.
struct ArraySize {
  std::uint32_t in_2d = 0, in_3d = 0;
};
template <class T>
inline constexpr ArraySize array_size{};
template <int N2, int N3>
inline constexpr ArraySize array_size<shoal::Array<N2, N3>>{N2, N3};

inline constexpr std::size_t max_neighbour_bodies = 16;

}  // namespace impl

// Options of a field member.
struct FieldOption {
  std::uint32_t set = 0, clear = 0;
};
// Not read of the neighbours (In of a pair operator is read of both otherwise).
inline constexpr FieldOption own_only{0, SHOAL_OF_NEIGHBOURS};
// Read of the neighbours only, e.g. the normal of a wall.
inline constexpr FieldOption neighbours_only{SHOAL_OF_NEIGHBOURS | SHOAL_NOT_OWN, 0};
// Written anew in each step before it is read, so it need not be in a checkpoint.
inline constexpr FieldOption derived{SHOAL_DERIVED, 0};

struct Unit {
  const char* text;
};
struct Doc {
  const char* text;
};
// For fields that are not shared: In<Scalar> swelling{"swelling", unit("1"), doc("Relative volume.")}.
constexpr Unit unit(const char* text) { return {text}; }
constexpr Doc doc(const char* text) { return {text}; }

class OperatorBase;

namespace impl {

// A field as a member of an operator.
class FieldMember {
 public:
  FieldMember(const FieldMember&) = delete;
  FieldMember& operator=(const FieldMember&) = delete;
  const char* name() const { return access_.field; }
  // Names another field of the same rank; before the operator is attached.
  void rename(const char* field) { access_.field = field; }
  // Changes an option, e.g. of an operator of the SDK; before the operator is attached.
  void apply(FieldOption option) { access_.mode = (access_.mode | option.set) & ~option.clear; }

 protected:
  inline FieldMember(const char* field, std::uint32_t mode, shoal_rank rank, shoal_data_type type,
                     ArraySize array_size);
  // Of the operator `owner`, whenever it is made; see declared_fields.hpp.
  inline FieldMember(OperatorBase& owner, const shoal_access& access);
  void apply(Unit text) { access_.unit = text.text; }
  void apply(Doc text) { access_.doc = text.text; }

  void* own_ = nullptr;
  std::array<const void*, max_neighbour_bodies> of_neighbours_{};
  std::array<const std::uint64_t*, max_neighbour_bodies> changes_{};  // of the neighbours' values

 private:
  friend class shoal::OperatorBase;
  shoal_access access_{};
  ArraySize array_size_;
};

}  // namespace impl

template <class T, bool Writable>
class Field : public impl::FieldMember {
 public:
  using value_tag = T;
  template <int D>
  using Element = typename impl::Element<T, D>::type;

  // The particle's own value.
  template <int D>
  decltype(auto) operator[](Particle<D> i) const {
    if constexpr (Writable)
      return static_cast<Element<D>*>(own_)[i.index];
    else
      return static_cast<const Element<D>*>(own_)[i.index];
  }
  // All owned values, components interleaved, for block-wise code.
  auto data() const {
    using Number = std::conditional_t<std::is_same_v<T, Integer>, std::int64_t, double>;
    if constexpr (Writable)
      return static_cast<Number*>(own_);
    else
      return static_cast<const Number*>(own_);
  }
  // The neighbours' values, for pair loops.
  const double* of_neighbours(std::size_t relation) const {
    return static_cast<const double*>(of_neighbours_[relation]);
  }
  // A number that grows whenever these change; nullptr where nobody counts.
  const std::uint64_t* changes_of_neighbours(std::size_t relation) const { return changes_[relation]; }

 protected:
  Field(const char* field, std::uint32_t mode)
      : FieldMember(field, mode, impl::rank_of<T>, std::is_same_v<T, Integer> ? SHOAL_INT64 : SHOAL_DOUBLE,
                    impl::array_size<T>) {}
};

// Reads a field; in pair operators of the particle and of its neighbours.
template <class T>
class In final : public Field<T, false> {
 public:
  template <class... Options>
  explicit In(const char* field, Options... options) : Field<T, false>(field, SHOAL_READ) {
    (this->apply(options), ...);
  }
};

// Writes a field of the own particle, all of it.
template <class T>
class Out final : public Field<T, true> {
 public:
  template <class... Options>
  explicit Out(const char* field, Options... options) : Field<T, true>(field, SHOAL_WRITE) {
    (this->apply(options), ...);
  }
};

// Reads and changes a field of the own particle.
template <class T>
class InOut final : public Field<T, true> {
 public:
  template <class... Options>
  explicit InOut(const char* field, Options... options) : Field<T, true>(field, SHOAL_READ | SHOAL_WRITE) {
    (this->apply(options), ...);
  }
};

// Adds to a field of the own particle, which its owner clears.
template <class T>
class Accumulate final : public Field<T, true> {
 public:
  template <class... Options>
  explicit Accumulate(const char* field, Options... options) : Field<T, true>(field, SHOAL_ACCUMULATE) {
    (this->apply(options), ...);
  }
};

// A number over all particles of the body, e.g. Maximum speed{}; then speed.update(i, value) in `particle`, and
// speed.result() from `end` on. A NaN of any particle is the result.
template <shoal_reduction How>
class Reduction {
 public:
  inline Reduction();
  template <int D>
  void update(Particle<D> i, double value) const {
    double& partial = i.partial[index_];
    if constexpr (How == SHOAL_SUM)
      partial += value;
    else if constexpr (How == SHOAL_MINIMUM)
      partial = value < partial || value != value ? value : partial;
    else
      partial = value > partial || value != value ? value : partial;
  }
  double result() const { return result_; }

 private:
  friend class OperatorBase;
  std::size_t index_ = 0;
  double result_ = How == SHOAL_SUM       ? 0.0
                   : How == SHOAL_MINIMUM ? std::numeric_limits<double>::infinity()
                                          : -std::numeric_limits<double>::infinity();
};
using Sum = Reduction<SHOAL_SUM>;
using Minimum = Reduction<SHOAL_MINIMUM>;
using Maximum = Reduction<SHOAL_MAXIMUM>;

// Where an operator works: set by the builder before it is attached.
struct Target {
  BodyIndex body;
  std::vector<BodyIndex> neighbours;  // of pair operators
  SmoothingKernel smoothing_kernel = SmoothingKernel::wendland_c2;
  double smoothing_length = 0;  // m
  double cutoff = 0;            // m
  double spacing = 0;           // m
  shoal_configuration configuration = SHOAL_CURRENT;
};

// Which particles leave the operator's body and which join it, before neighbours are renewed.
class Exchange {
 public:
  // Particle i leaves; each at most once.
  void leave(std::uint64_t i) { leaving_.push_back(i); }
  // A particle joins, with the initial values of the case, or as a copy of `source`; `fill` says what else it is.
  void join(std::uint64_t source = UINT64_MAX) { sources_.push_back(source); }
  std::size_t n_leaving() const { return leaving_.size(); }
  std::size_t n_joining() const { return sources_.size(); }

  void clear() {
    leaving_.clear();
    sources_.clear();
  }
  void to_c(shoal_exchange& c) {
    std::sort(leaving_.begin(), leaving_.end());
    c.n_leaving = leaving_.size();
    c.leaving = leaving_.data();
    c.n_joining = sources_.size();
    c.sources = sources_.data();
  }

 private:
  std::vector<std::uint64_t> leaving_, sources_;
};

class OperatorBase : public Parameterised {
 public:
  virtual ~OperatorBase() = default;

  const shoal_step& step() const { return step_; }
  double dt() const { return step_.dt; }
  double time() const { return step_.time; }
  int dimensions() const { return dimensions_; }
  double smoothing_length() const { return target_.smoothing_length; }
  double spacing() const { return target_.spacing; }
  std::uint64_t n_particles() const { return n_owned_; }
  const Target& target() const { return target_; }
  void set_target(Target target) { target_ = std::move(target); }
  void set_dimensions(int dimensions) { dimensions_ = dimensions; }

  void bind(const shoal_binding& binding) {
    dimensions_ = binding.dimensions;
    n_owned_ = binding.n_owned;
    const std::size_t n = fields_.size();
    for (std::size_t a = 0; a < n; ++a) {
      fields_[a]->own_ = SHOAL_AT(shoal_field, binding.own, a)->data;
      for (std::size_t k = 0; k < target_.neighbours.size(); ++k) {
        const shoal_field field = copy_of(*SHOAL_AT(shoal_field, binding.of_neighbours, k * n + a));
        fields_[a]->of_neighbours_[k] = field.data;
        fields_[a]->changes_[k] = field.changes;
      }
    }
    neighbours_.clear();
    n_of_neighbours_.assign(target_.neighbours.size(), 0);
    for (std::size_t k = 0; k < target_.neighbours.size(); ++k) {
      neighbours_.push_back(copy_of(*SHOAL_AT(shoal_neighbours, binding.neighbours, k)));
      for (std::size_t a = 0; a < n; ++a)
        n_of_neighbours_[k] =
            std::max(n_of_neighbours_[k], SHOAL_AT(shoal_field, binding.of_neighbours, k * n + a)->n_total);
    }
  }
  void set_step(const shoal_step& step) { step_ = copy_of(step); }
  void set_results(const double* results) {
    for (std::size_t k = 0; k < results_.size(); ++k) *results_[k] = results[k];
  }
  const shoal_neighbours& neighbours(std::size_t relation) const { return neighbours_[relation]; }
  const std::vector<shoal_neighbours>& lists() const { return neighbours_; }
  std::size_t n_relations() const { return target_.neighbours.size(); }
  // Particles and images of the neighbours' body.
  std::uint64_t n_of_neighbours(std::size_t relation) const { return n_of_neighbours_[relation]; }

  std::vector<shoal_access> accesses() const {
    std::vector<shoal_access> list;
    for (const auto* field : fields_) {
      list.push_back(field->access_);
      list.back().components = dimensions_ == 2 ? field->array_size_.in_2d : field->array_size_.in_3d;
    }
    return list;
  }
  const std::vector<std::uint32_t>& reductions() const { return reductions_; }

 protected:
  explicit OperatorBase(bool pairs) : pairs_(pairs) { enrolling_ = this; }

 private:
  friend class impl::FieldMember;
  template <shoal_reduction>
  friend class Reduction;

  inline static thread_local OperatorBase* enrolling_ = nullptr;

  bool pairs_;
  int dimensions_ = 0;
  std::uint64_t n_owned_ = 0;
  Target target_;
  shoal_step step_{};
  std::vector<impl::FieldMember*> fields_;
  std::vector<shoal_neighbours> neighbours_;
  std::vector<std::uint64_t> n_of_neighbours_;
  std::vector<std::uint32_t> reductions_;
  std::vector<double*> results_;
};

namespace impl {

inline FieldMember::FieldMember(const char* field, std::uint32_t mode, shoal_rank rank, shoal_data_type type,
                                ArraySize array_size)
    : array_size_(array_size) {
  OperatorBase& owner = *OperatorBase::enrolling_;
  access_.size = sizeof(shoal_access);
  access_.mode = mode;
  if (owner.pairs_ && mode == SHOAL_READ) access_.mode |= SHOAL_OF_NEIGHBOURS;
  access_.rank = rank;
  access_.data_type = type;
  access_.field = field;
  owner.fields_.push_back(this);
}

inline FieldMember::FieldMember(OperatorBase& owner, const shoal_access& access) : access_(access) {
  owner.fields_.push_back(this);
}

}  // namespace impl

template <shoal_reduction How>
Reduction<How>::Reduction() {
  OperatorBase& owner = *OperatorBase::enrolling_;
  index_ = owner.reductions_.size();
  owner.reductions_.push_back(How);
  owner.results_.push_back(&result_);
}

namespace impl {

// An operator with the arrays that its C description borrows; what `self` points to.
template <class Op>
struct AttachedOperator {
  Op op;
  std::string name;
  std::vector<shoal_access> accesses;
  std::vector<shoal_relation_request> relations;
  Exchange exchange;
};

template <class Op>
Op& op_of(void* self) {
  return static_cast<AttachedOperator<Op>*>(self)->op;
}

template <class Op, int D>
concept HasParticleTimeStep = requires(const Op& op, Particle<D> i) {
  { op.time_step_of(i) } -> std::convertible_to<double>;
};
template <class Op, int D>
concept HasBlockTimeStep = requires(const Op& op, std::uint64_t i) {
  { op.template time_step_of_block<D>(i, i) } -> std::convertible_to<double>;
};
template <class Op>
concept HasTimeStep = requires(const Op& op, double h) {
  { op.time_step(h) } -> std::convertible_to<double>;
};
template <class Op>
concept HasState = requires(Op& op, const shoal_stream& stream) {
  op.save(stream);
  op.load(stream);
};

template <class Op>
double time_step_of_chunk(void* self, const shoal_step* step, const shoal_chunk* chunk) noexcept {
  const Op& op = op_of<Op>(self);
  double limit = std::numeric_limits<double>::infinity();
  if constexpr (HasBlockTimeStep<Op, 2>) {
    limit = step->dimensions == 2 ? op.template time_step_of_block<2>(chunk->begin, chunk->end)
                                  : op.template time_step_of_block<3>(chunk->begin, chunk->end);
  } else if constexpr (HasParticleTimeStep<Op, 2>) {
    const auto over_particles = [&]<int D>() {
      for (std::uint64_t i = chunk->begin; i < chunk->end; ++i) {
        const double particle_limit = op.time_step_of(Particle<D>{i, nullptr});
        // A NaN must not be lost in a minimum: it stops the run.
        if (particle_limit < limit || particle_limit != particle_limit) limit = particle_limit;
      }
    };
    step->dimensions == 2 ? over_particles.template operator()<2>() : over_particles.template operator()<3>();
  } else if constexpr (HasTimeStep<Op>) {
    limit = op.time_step(op.smoothing_length());
  }
  return limit;
}

// The C description of an operator; the kernel calls `destroy` when it no longer needs it.
template <class Op>
shoal_operator describe(std::unique_ptr<AttachedOperator<Op>> attached, std::uint32_t flags) {
  const Target& target = attached->op.target();
  if (target.neighbours.size() > max_neighbour_bodies)
    throw CaseError(attached->name + ": more than " + std::to_string(max_neighbour_bodies) +
                    " neighbour bodies");
  attached->accesses = attached->op.accesses();
  for (const BodyIndex neighbour : target.neighbours)
    attached->relations.push_back({sizeof(shoal_relation_request), neighbour.value,
                                   static_cast<std::uint32_t>(target.configuration), 0, target.cutoff});
  shoal_operator c{};
  c.size = sizeof(shoal_operator);
  c.flags = flags;
  c.name = attached->name.c_str();
  c.body = target.body.value;
  c.n_accesses = static_cast<std::uint32_t>(attached->accesses.size());
  c.accesses = attached->accesses.data();
  c.n_relations = static_cast<std::uint32_t>(attached->relations.size());
  c.relations = attached->relations.data();
  c.n_reductions = static_cast<std::uint32_t>(attached->op.reductions().size());
  c.reductions = attached->op.reductions().data();
  c.destroy = [](void* self) { delete static_cast<AttachedOperator<Op>*>(self); };
  c.bind = [](void* self, const shoal_binding* binding) {
    return guarded([&] {
      op_of<Op>(self).bind(*binding);
      if constexpr (requires(Op & op) { op.bound(); }) op_of<Op>(self).bound();
    });
  };
  c.begin = [](void* self, const shoal_step* step) {
    return guarded([&] {
      op_of<Op>(self).set_step(*step);
      if constexpr (requires(Op & op) { op.before_begin(); }) op_of<Op>(self).before_begin();
      if constexpr (requires(Op & op) { op.begin(); }) op_of<Op>(self).begin();
    });
  };
  c.run = [](void* self, const shoal_step* step, const shoal_chunk* chunk) {
    return guarded([&] {
      const Op& op = op_of<Op>(self);
      step->dimensions == 2 ? op.template run_chunk<2>(*chunk) : op.template run_chunk<3>(*chunk);
    });
  };
  c.end = [](void* self, const shoal_step*, const double* results) {
    return guarded([&] {
      op_of<Op>(self).set_results(results);
      if constexpr (requires(Op & op) { op.end(); }) op_of<Op>(self).end();
    });
  };
  constexpr bool of_particles = HasParticleTimeStep<Op, 2> || HasBlockTimeStep<Op, 2>;
  if constexpr (of_particles || HasTimeStep<Op>) {
    c.time_step = &time_step_of_chunk<Op>;
    if constexpr (of_particles) c.flags |= SHOAL_OPERATOR_TIME_STEP_OF_PARTICLES;
  }
  if constexpr (HasState<Op>) {
    c.save = [](void* self, const shoal_stream* stream) {
      return guarded([&] { op_of<Op>(self).save(*stream); });
    };
    c.load = [](void* self, const shoal_stream* stream) {
      return guarded([&] { op_of<Op>(self).load(*stream); });
    };
  }
  if constexpr (requires(Op & op, Exchange & exchange) { op.exchange(exchange); }) {
    c.exchange = [](void* self, const shoal_step* step, shoal_exchange* asked) {
      return guarded([&] {
        auto& operator_ = *static_cast<AttachedOperator<Op>*>(self);
        operator_.op.set_step(*step);
        operator_.exchange.clear();
        operator_.op.exchange(operator_.exchange);
        operator_.exchange.to_c(*asked);
      });
    };
    if constexpr (requires(Op & op) { op.fill(std::uint64_t{}, std::uint64_t{}); })
      c.fill = [](void* self, const shoal_step*, std::uint64_t begin, std::uint64_t end) {
        return guarded([&] { op_of<Op>(self).fill(begin, end); });
      };
  }
  if constexpr (requires(const Op& op) { std::string(op.remark()); })
    c.remark = [](void* self, char* text, std::uint64_t size) {
      if (size == 0) return;
      text[0] = '\0';
      guarded([&] { std::snprintf(text, size, "%s", std::string(op_of<Op>(self).remark()).c_str()); });
    };
  if constexpr (requires(Op & op) { op.bytes_per_pair(); }) c.bytes_per_pair = attached->op.bytes_per_pair();
  if constexpr (requires(Op & op) { op.bytes_per_particle(); })
    c.bytes_per_particle = attached->op.bytes_per_particle();
  if constexpr (requires(const Op& op, const shoal_chunk& chunk) { op.template prepare_chunk<2>(chunk); })
    if (attached->op.prepares())
      c.prepare = [](void* self, const shoal_step* step, const shoal_chunk* chunk) {
        return guarded([&] {
          const Op& op = op_of<Op>(self);
          step->dimensions == 2 ? op.template prepare_chunk<2>(*chunk) : op.template prepare_chunk<3>(*chunk);
        });
      };
  c.self = attached.release();
  return c;
}

}  // namespace impl
}  // namespace shoal
