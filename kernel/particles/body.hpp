// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A body: particles with one material, in arrays of their own. Fields exist only because somebody declared them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kernel/particles/field.hpp"
#include "kernel/particles/halo.hpp"

namespace shoal::kernel {

class Body {
 public:
  Body(std::string name, std::uint32_t index, int dimensions);

  const std::string& name() const { return name_; }
  std::uint32_t index() const { return index_; }
  int dimensions() const { return dimensions_; }

  double spacing = 0.0;           // m
  double smoothing_length = 0.0;  // m
  double cutoff = 0.0;            // m
  std::string smoothing_kernel;
  const shoal_object* material = nullptr;
  bool sorted_as_it_moves = false;
  bool position_changed = true;  ///< since its neighbours were last found

  /// Adds a field or one more declarer of it. Throws ModelError on a clash.
  Field& declare(const FieldSpecification& specification, const std::string& declarer);
  Field* find(std::string_view field);
  const Field* find(std::string_view field) const;
  const std::vector<std::unique_ptr<Field>>& fields() const { return fields_; }
  Field& position() { return *position_; }
  const Field& position() const { return *position_; }
  /// Stable names of the particles; not among fields().
  Field& ids() { return ids_; }
  const Field& ids() const { return ids_; }

  std::uint64_t n_owned() const { return n_owned_; }
  std::uint64_t n_total() const { return n_owned_ + reference_halo_.size() + halo_.size(); }
  std::uint64_t n_halo() const { return n_total() - n_owned_; }
  /// Changes whenever an array moved or a number of particles changed.
  std::uint64_t generation() const { return generation_; }

  /// Room for n owned particles; those beyond the present ones are zero, with ids of their own. Drops the images.
  void resize(std::uint64_t n);
  /// Of the owned particles those of `leaving` (ascending) go; the last ones that stay take their places. Then particles
  /// with ids of their own join behind: copies of those of `sources`, which are counted before any has gone and may be
  /// among the leaving, or zero where the source is no_source. Drops the images.
  void exchange(std::span<const std::uint64_t> leaving, std::span<const std::uint64_t> sources);
  static constexpr std::uint64_t no_source = UINT64_MAX;
  /// Owned particle k becomes what order[k] was, in all fields. Drops the images of the current configuration.
  void permute(const std::uint32_t* order);

  /// Arrays are [owned | images of the current configuration | images of the reference configuration]. Both sets
  /// move with their sources; they differ in the positions by which they were chosen.
  const Halo& halo() const { return halo_; }
  const Halo& reference_halo() const { return reference_halo_; }
  void build_halo(const Domain& domain, double reach);
  void build_reference_halo(const Domain& domain, double reach);
  /// First reference image in the arrays.
  std::uint64_t reference_halo_begin() const { return n_owned_ + halo_.size(); }
  /// Gives the images of a field their sources' values.
  void renew_halo(Field& field) const;
  /// To be called after owned values were written.
  void mark_written(Field& field, bool poison) const;

  std::uint64_t bytes() const;
  std::int64_t next_id = 0;  ///< for particles still to be created

 private:
  void resize_arrays();

  std::string name_;
  std::uint32_t index_;
  int dimensions_;
  std::vector<std::unique_ptr<Field>> fields_;
  Field* position_ = nullptr;
  Field ids_;
  std::uint64_t n_owned_ = 0;
  std::uint64_t generation_ = 1;
  Halo halo_, reference_halo_;
  std::vector<std::uint64_t> scratch_;
};

}  // namespace shoal::kernel
