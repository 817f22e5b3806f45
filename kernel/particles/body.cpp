// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Fields of a body grow, shrink and are re-sorted together.
#include "kernel/particles/body.hpp"

#include <algorithm>
#include <utility>

#include "kernel/particles/errors.hpp"

namespace shoal::kernel {

Body::Body(std::string name, std::uint32_t index, int dimensions)
    : name_(std::move(name)),
      index_(index),
      dimensions_(dimensions),
      ids_({"id", SHOAL_SCALAR, SHOAL_INT64, "1", "Stable name of a particle."}, dimensions, "the kernel") {
  const std::string declarer = "the kernel";
  position_ =
      &declare(specify("position", SHOAL_RANK_VECTOR, SHOAL_DOUBLE, nullptr, nullptr, declarer), declarer);
}

Field& Body::declare(const FieldSpecification& specification, const std::string& declarer) {
  if (Field* known = find(specification.name)) {
    known->merge(specification, declarer);
    return *known;
  }
  fields_.push_back(std::make_unique<Field>(specification, dimensions_, declarer));
  fields_.back()->resize(n_total(), 0);
  return *fields_.back();
}

Field* Body::find(std::string_view field) {
  for (const auto& candidate : fields_)
    if (candidate->name() == field) return candidate.get();
  return nullptr;
}

const Field* Body::find(std::string_view field) const { return const_cast<Body*>(this)->find(field); }

void Body::resize_arrays() {
  for (const auto& field : fields_) {
    field->resize(n_total(), n_owned_);
    field->halo_stale = true;
  }
  ids_.resize(n_owned_, n_owned_);
  ++generation_;
}

void Body::resize(std::uint64_t n) {
  if (n >= (std::uint64_t{1} << 31))
    throw ModelError("body '" + name_ + "' would have " + std::to_string(n) +
                     " particles; one body holds fewer than 2^31, so split it");
  const std::uint64_t kept = std::min(n, n_owned_);
  halo_.clear();
  reference_halo_.clear();
  for (const auto& field : fields_) field->resize(n, kept);
  ids_.resize(n, kept);
  for (std::uint64_t i = kept; i < n; ++i) ids_.integers()[i] = next_id++;
  n_owned_ = n;
  position_changed = true;
  resize_arrays();
}

void Body::permute(const std::uint32_t* order) {
  std::uint32_t widest = 1;
  for (const auto& field : fields_) widest = std::max(widest, field->components());
  scratch_.resize(n_owned_ * widest);
  for (const auto& field : fields_) field->permute(order, n_owned_, scratch_.data());
  ids_.permute(order, n_owned_, scratch_.data());
  halo_.clear();
  ++generation_;
}

void Body::build_halo(const Domain& domain, double reach) {
  halo_.build(domain, reach, position_->reals(), n_owned_);
  resize_arrays();
}

void Body::build_reference_halo(const Domain& domain, double reach) {
  const Field* reference = find("reference_position");
  if (reference == nullptr) throw std::logic_error("a reference halo needs the reference positions");
  reference_halo_.build(domain, reach, reference->reals(), n_owned_);
  resize_arrays();
}

void Body::renew_halo(Field& field) const {
  halo_.renew(field, n_owned_);
  reference_halo_.renew(field, reference_halo_begin());
  field.halo_stale = false;
}

void Body::mark_written(Field& field, bool poison) const {
  field.halo_stale = true;
  if (poison && n_halo() > 0) field.poison(n_owned_, n_total());
}

std::uint64_t Body::bytes() const {
  std::uint64_t sum = ids_.bytes() + halo_.bytes() + reference_halo_.bytes() + 8 * scratch_.capacity();
  for (const auto& field : fields_) sum += field->bytes();
  return sum;
}

}  // namespace shoal::kernel
