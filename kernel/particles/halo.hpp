// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Images of owned particles beyond periodic faces and mirror planes. An image is a source particle and a transform
// x' = R x + s, where R is diagonal with entries +1 and -1. Axes are processed one after the other and each takes
// the images of those before it too, so that edges and corners of the box get images of images.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernel/particles/domain.hpp"
#include "kernel/particles/field.hpp"

namespace shoal::kernel {

struct ImageTransform {
  std::array<double, 3> sign{1.0, 1.0, 1.0};   ///< diagonal of R
  std::array<double, 3> shift{0.0, 0.0, 0.0};  ///< s, m

  bool operator==(const ImageTransform&) const = default;
  bool mirrors() const { return sign[0] < 0.0 || sign[1] < 0.0 || sign[2] < 0.0; }
};

class Halo {
 public:
  /// Finds the images of the first n positions that may be nearer than `reach` to a particle inside the domain.
  /// Throws ModelError if the domain is narrower than `reach` between a mirror plane and the opposite face.
  void build(const Domain& domain, double reach, const double* positions, std::uint64_t n);
  void clear();

  std::uint64_t size() const { return sources_.size(); }
  std::uint32_t source(std::uint64_t image) const { return sources_[image]; }
  const ImageTransform& transform(std::uint64_t image) const { return transforms_[kinds_[image]]; }

  /// Sources name particles by index: after a re-sort build anew. Writes the values of all images behind the n_owned
  /// particles, from `first` on: scalars are copied, vectors reflect, matrices become R A R, positions are shifted.
  void renew(Field& field, std::uint64_t first) const;

  std::uint64_t bytes() const;

 private:
  // What a transform does to the components of a field: sign * value + shift.
  struct ComponentMap {
    std::array<double, 9> sign, shift;
  };
  enum class Kind { point, vector, symmetric, matrix };
  static ComponentMap component_map(Kind kind, const ImageTransform& transform, int dimensions);
  static Kind kind_of(const Field& field);

  void add_images_of_axis(const Domain& domain, int axis, double reach, const double* positions,
                          std::uint64_t n);
  std::uint16_t index_of(const ImageTransform& transform);

  int dimensions_ = 0;
  std::vector<std::uint32_t> sources_;
  std::vector<std::uint16_t> kinds_;  ///< index into transforms_
  std::vector<ImageTransform> transforms_;
  std::array<std::vector<ComponentMap>, 4> maps_;  ///< [Kind][transform]
  bool mirrors_ = false;
};

/// Fields whose images are shifted: they hold points of space.
bool is_point(std::string_view field);

/// Moves particles back into the periodic axes of the box. Returns whether one moved.
bool wrap(const Domain& domain, double* positions, std::uint64_t n);

}  // namespace shoal::kernel
