// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A named array of a body: [owned particles | images | padding], components interleaved, 64-byte aligned.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "shoal/abi.h"

namespace shoal::kernel {

struct FieldSpecification {
  std::string name;
  shoal_rank rank = SHOAL_SCALAR;
  shoal_data_type data_type = SHOAL_DOUBLE;
  std::string unit, doc;
  std::uint32_t array_components = 0;  ///< of a SHOAL_ARRAY
};

/// `array_components`: of a SHOAL_ARRAY.
std::uint32_t components_of(shoal_rank rank, int dimensions, std::uint32_t array_components = 0);
/// "scalar", "vector", "symmetric matrix", "matrix", "array"
const char* name_of(shoal_rank rank);
const char* name_of(shoal_data_type type);

/// The specification of a field that an operator names: from the shared table where it is there. Throws ModelError
/// if rank, data type or unit contradict the table, or if unit is missing for a field of one's own.
FieldSpecification specify(std::string_view name, std::uint32_t rank, std::uint32_t data_type,
                           const char* unit, const char* doc, const std::string& declarer,
                           std::uint32_t array_components = 0);

class Field {
 public:
  Field(FieldSpecification specification, int dimensions, std::string declarer);

  const FieldSpecification& specification() const { return specification_; }
  const std::string& name() const { return specification_.name; }
  std::uint32_t components() const { return components_; }
  /// Every component has eight bytes.
  std::uint64_t bytes_per_particle() const { return 8u * components_; }
  const std::vector<std::string>& declarers() const { return declarers_; }

  /// One more declarer. Throws ModelError naming both if the specifications clash.
  void merge(const FieldSpecification& other, const std::string& declarer);

  void* data() { return data_.get(); }
  const void* data() const { return data_.get(); }
  double* reals() { return static_cast<double*>(data()); }
  const double* reals() const { return static_cast<const double*>(data()); }
  std::int64_t* integers() { return static_cast<std::int64_t*>(data()); }
  const std::int64_t* integers() const { return static_cast<const std::int64_t*>(data()); }
  std::uint64_t bytes() const { return capacity_ * bytes_per_particle(); }

  /// Room for n particles and the padding behind them; keeps the first `kept` and sets those from `kept` to n and
  /// the padding to zero. Returns whether the array moved.
  bool resize(std::uint64_t n, std::uint64_t kept);
  /// Particle k becomes what particle order[k] was, for k < n. `scratch` holds bytes_per_particle() * n bytes.
  void permute(const std::uint32_t* order, std::uint64_t n, void* scratch);
  void clear(std::uint64_t n);
  /// NaN, or the smallest integer, so that an undeclared read is seen.
  void poison(std::uint64_t begin, std::uint64_t end);

  bool derived = false;       ///< need not survive a restart
  bool halo_stale = true;     ///< written since the images were last renewed
  bool halo_needed = false;   ///< a scheduled operator reads it of its neighbours
  std::uint64_t changes = 0;  ///< grows whenever values change

 private:
  struct Release {
    void operator()(void* memory) const;
  };

  FieldSpecification specification_;
  std::uint32_t components_;
  std::vector<std::string> declarers_;
  std::unique_ptr<void, Release> data_;
  std::uint64_t capacity_ = 0;
};

}  // namespace shoal::kernel
