// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Fields of a body grow, shrink and are re-sorted together.
#include "kernel/particles/body.hpp"

#include <algorithm>
#include <cstring>
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

namespace {

// Which particle moves where, so that those that stay are 0 ... n_kept.
struct Move {
  std::uint64_t from, to;
};

std::vector<Move> close_gaps(std::uint64_t n, std::span<const std::uint64_t> leaving) {
  std::vector<Move> moves;
  const std::uint64_t n_kept = n - leaving.size();
  std::size_t last = leaving.size();
  std::uint64_t from = n;
  for (const std::uint64_t gap : leaving) {
    if (gap >= n_kept) break;
    for (--from; last > 0 && leaving[last - 1] == from; --from) --last;
    moves.push_back({from, gap});
  }
  return moves;
}

}  // namespace

void Body::exchange(std::span<const std::uint64_t> leaving, std::span<const std::uint64_t> sources) {
  const std::uint64_t n_before = n_owned_, n_kept = n_before - leaving.size();
  const std::vector<Move> moves = close_gaps(n_before, leaving);
  // First the copies are put aside, for their sources may leave; then the gaps are closed.
  std::vector<std::vector<char>> copies;
  for (const auto& field : fields_) {
    const std::uint64_t bytes = field->bytes_per_particle();
    char* data = static_cast<char*>(field->data());
    std::vector<char>& copy = copies.emplace_back(sources.size() * bytes, '\0');
    for (std::size_t k = 0; k < sources.size(); ++k)
      if (sources[k] != no_source) std::memcpy(&copy[k * bytes], data + sources[k] * bytes, bytes);
    for (const Move& move : moves) std::memcpy(data + move.to * bytes, data + move.from * bytes, bytes);
  }
  for (const Move& move : moves) ids_.integers()[move.to] = ids_.integers()[move.from];
  resize(n_kept);
  resize(n_kept + sources.size());
  if (sources.empty()) return;
  for (std::size_t f = 0; f < fields_.size(); ++f)
    std::memcpy(static_cast<char*>(fields_[f]->data()) + n_kept * fields_[f]->bytes_per_particle(),
                copies[f].data(), copies[f].size());
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
  ++field.changes;
}

void Body::mark_written(Field& field, bool poison) const {
  field.halo_stale = true;
  ++field.changes;
  if (poison && n_halo() > 0) field.poison(n_owned_, n_total());
}

std::uint64_t Body::bytes() const {
  std::uint64_t sum = ids_.bytes() + halo_.bytes() + reference_halo_.bytes() + 8 * scratch_.capacity();
  for (const auto& field : fields_) sum += field->bytes();
  return sum;
}

}  // namespace shoal::kernel
