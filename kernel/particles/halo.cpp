// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Building and renewing images.
#include "kernel/particles/halo.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>

#include "kernel/particles/errors.hpp"
#include "kernel/particles/parallel.hpp"

namespace shoal::kernel {

bool is_point(std::string_view field) { return field == "position" || field == "reference_position"; }

void Halo::clear() {
  sources_.clear();
  kinds_.clear();
  transforms_.assign(1, ImageTransform{});
  mirrors_ = false;
}

void Halo::build(const Domain& domain, double reach, const double* positions, std::uint64_t n) {
  clear();
  dimensions_ = domain.dimensions;
  if (!(reach > 0.0) || n == 0) return;
  for (int axis = 0; axis < domain.dimensions; ++axis) add_images_of_axis(domain, axis, reach, positions, n);
  for (const ImageTransform& transform : transforms_) mirrors_ = mirrors_ || transform.mirrors();
  for (std::size_t kind = 0; kind < maps_.size(); ++kind) {
    maps_[kind].clear();
    for (const ImageTransform& transform : transforms_)
      maps_[kind].push_back(component_map(static_cast<Kind>(kind), transform, dimensions_));
  }
}

Halo::ComponentMap Halo::component_map(Kind kind, const ImageTransform& transform, int dimensions) {
  ComponentMap map{};
  const auto d = static_cast<std::size_t>(dimensions);
  const auto& sign = transform.sign;
  std::size_t k = 0;
  switch (kind) {
    case Kind::point:
    case Kind::vector:
      for (std::size_t a = 0; a < d; ++a) {
        map.sign[a] = sign[a];
        map.shift[a] = kind == Kind::point ? transform.shift[a] : 0.0;
      }
      break;
    case Kind::symmetric:
      for (std::size_t a = 0; a < d; ++a)
        for (std::size_t b = a; b < d; ++b) map.sign[k++] = sign[a] * sign[b];
      break;
    case Kind::matrix:
      for (std::size_t a = 0; a < d; ++a)
        for (std::size_t b = 0; b < d; ++b) map.sign[k++] = sign[a] * sign[b];
      break;
  }
  return map;
}

Halo::Kind Halo::kind_of(const Field& field) {
  if (is_point(field.name())) return Kind::point;
  switch (field.specification().rank) {
    case SHOAL_SYMMETRIC: return Kind::symmetric;
    case SHOAL_RANK_MATRIX: return Kind::matrix;
    default: return Kind::vector;
  }
}

std::uint16_t Halo::index_of(const ImageTransform& transform) {
  for (std::size_t k = 0; k < transforms_.size(); ++k)
    if (transforms_[k] == transform) return static_cast<std::uint16_t>(k);
  if (transforms_.size() > std::numeric_limits<std::uint16_t>::max())
    throw ModelError("the periodic domain is so small against the cut-off that it needs too many images");
  transforms_.push_back(transform);
  return static_cast<std::uint16_t>(transforms_.size() - 1);
}

namespace {

std::string axis_name(int axis) { return std::string(1, "xyz"[axis]); }

// x' = sign x + shift along one axis: a periodic repetition or a reflection.
struct AxisMap {
  double sign, shift;
};

ImageTransform compose(const AxisMap& outer, int axis, ImageTransform inner) {
  const auto a = static_cast<std::size_t>(axis);
  inner.sign[a] *= outer.sign;
  inner.shift[a] = outer.sign * inner.shift[a] + outer.shift;
  return inner;
}

// Maps that bring particles of the box to places nearer than `reach` to it.
std::vector<AxisMap> maps_of_axis(const Domain& domain, int axis, double reach) {
  const AxisBoundary& boundary = domain.boundary[axis];
  const double lower = domain.lower[axis], upper = domain.upper[axis];
  std::vector<AxisMap> maps;
  if (domain.periodic(axis)) {
    // One more than fits, for particles that have left the box since they were wrapped.
    const double n = std::floor(reach / domain.length(axis)) + 2.0;
    for (double k = 1.0; k <= n; k += 1.0) {
      maps.push_back({1.0, k * domain.length(axis)});
      maps.push_back({1.0, -k * domain.length(axis)});
    }
    return maps;
  }
  for (const bool at_upper : {false, true}) {
    if ((at_upper ? boundary.upper : boundary.lower) != BoundaryKind::mirror) continue;
    if (domain.length(axis) < reach)
      throw ModelError("the domain is narrower along " + axis_name(axis) + " (" +
                       std::to_string(domain.length(axis)) + " m) than the cut-off (" +
                       std::to_string(reach) +
                       " m), so a mirror plane there would need images of images; make it wider");
    maps.push_back({-1.0, 2.0 * (at_upper ? upper : lower)});
  }
  return maps;
}

}  // namespace

void Halo::add_images_of_axis(const Domain& domain, int axis, double reach, const double* positions,
                              std::uint64_t n) {
  const std::vector<AxisMap> maps = maps_of_axis(domain, axis, reach);
  if (maps.empty()) return;
  const auto d = static_cast<std::uint64_t>(dimensions_);
  const auto a = static_cast<std::size_t>(axis);
  const double lower = domain.lower[axis] - reach, upper = domain.upper[axis] + reach;
  const std::uint64_t n_before = sources_.size();
  for (const AxisMap& map : maps) {
    // Images of images share a few transforms; look each up once.
    std::vector<int> composed(transforms_.size(), -1);
    const auto add = [&](std::uint32_t source, std::uint16_t kind) {
      const ImageTransform& inner = transforms_[kind];
      const double inner_x = inner.sign[a] * positions[source * d + a] + inner.shift[a];
      const double x = map.sign * inner_x + map.shift;
      if (!(x >= lower && x <= upper)) return;
      // A particle in a mirror plane is its own image.
      if (map.sign < 0.0 && std::abs(x - inner_x) <= 1e-9 * reach) return;
      // A mirror fills only the space behind it.
      if (map.sign < 0.0 && std::abs(x - 0.5 * map.shift) > reach) return;
      if (composed[kind] < 0) composed[kind] = index_of(compose(map, axis, inner));
      sources_.push_back(source);
      kinds_.push_back(static_cast<std::uint16_t>(composed[kind]));
    };
    for (std::uint64_t i = 0; i < n; ++i) add(static_cast<std::uint32_t>(i), 0);
    for (std::uint64_t k = 0; k < n_before; ++k) add(sources_[k], kinds_[k]);
  }
}

namespace {

template <class Value, std::size_t N>
void copy_images(const Value* from, Value* to, const std::uint32_t* sources, std::uint64_t n) {
  for_each_range(n, [=](std::uint64_t begin, std::uint64_t end) {
    for (std::uint64_t k = begin; k < end; ++k)
      for (std::size_t c = 0; c < N; ++c) to[k * N + c] = from[sources[k] * N + c];
  });
}

// Of any number of components, which all have eight bytes.
void copy_array_images(Field& field, std::uint64_t first, const std::uint32_t* sources, std::uint64_t n) {
  const std::uint64_t bytes = field.bytes_per_particle();
  auto* values = static_cast<char*>(field.data());
  for_each_range(n, [=](std::uint64_t begin, std::uint64_t end) {
    for (std::uint64_t k = begin; k < end; ++k)
      std::memcpy(values + (first + k) * bytes, values + sources[k] * bytes, bytes);
  });
}

template <std::size_t N, class ComponentMap>
void map_images(const double* from, double* to, const std::uint32_t* sources, const std::uint16_t* kinds,
                const ComponentMap* maps, std::uint64_t n) {
  for_each_range(n, [=](std::uint64_t begin, std::uint64_t end) {
    for (std::uint64_t k = begin; k < end; ++k) {
      const auto& map = maps[kinds[k]];
      for (std::size_t c = 0; c < N; ++c)
        to[k * N + c] = map.sign[c] * from[sources[k] * N + c] + map.shift[c];
    }
  });
}

}  // namespace

void Halo::renew(Field& field, std::uint64_t first) const {
  const std::uint64_t n = size();
  if (n == 0) return;
  if (field.specification().rank == SHOAL_ARRAY) {
    copy_array_images(field, first, sources_.data(), n);
    return;
  }
  const std::uint32_t components = field.components();
  const bool integers = field.specification().data_type == SHOAL_INT64;
  const shoal_rank rank = field.specification().rank;
  const bool plain = integers || rank == SHOAL_SCALAR || (!mirrors_ && !is_point(field.name()));
  const auto dispatch = [&](auto size) {
    constexpr std::size_t N = decltype(size)::value;
    if (integers) {
      copy_images<std::int64_t, N>(field.integers(), field.integers() + first * N, sources_.data(), n);
    } else if (plain) {
      copy_images<double, N>(field.reals(), field.reals() + first * N, sources_.data(), n);
    } else {
      const std::vector<ComponentMap>& maps = maps_[static_cast<std::size_t>(kind_of(field))];
      map_images<N>(field.reals(), field.reals() + first * N, sources_.data(), kinds_.data(), maps.data(), n);
    }
  };
  switch (components) {
    case 1: dispatch(std::integral_constant<std::size_t, 1>{}); break;
    case 2: dispatch(std::integral_constant<std::size_t, 2>{}); break;
    case 3: dispatch(std::integral_constant<std::size_t, 3>{}); break;
    case 4: dispatch(std::integral_constant<std::size_t, 4>{}); break;
    case 6: dispatch(std::integral_constant<std::size_t, 6>{}); break;
    case 9: dispatch(std::integral_constant<std::size_t, 9>{}); break;
    default: throw std::logic_error("a field has an impossible number of components");
  }
}

std::uint64_t Halo::bytes() const {
  return sources_.capacity() * sizeof sources_[0] + kinds_.capacity() * sizeof kinds_[0];
}

bool wrap(const Domain& domain, double* positions, std::uint64_t n) {
  if (!domain.any_periodic()) return false;
  const auto d = static_cast<std::uint64_t>(domain.dimensions);
  std::atomic<bool> moved = false;
  for_each_range(n, [&](std::uint64_t begin, std::uint64_t end) {
    bool moved_here = false;
    for (int axis = 0; axis < domain.dimensions; ++axis) {
      if (!domain.periodic(axis)) continue;
      const double lower = domain.lower[axis], upper = domain.upper[axis], length = upper - lower;
      for (std::uint64_t i = begin; i < end; ++i) {
        double& x = positions[i * d + static_cast<std::uint64_t>(axis)];
        if (x >= lower && x < upper) continue;
        x -= length * std::floor((x - lower) / length);
        if (x >= upper) x = lower;  // rounding; NaN stays what it is and is found by the health check
        moved_here = true;
      }
    }
    if (moved_here) moved.store(true, std::memory_order_relaxed);
  });
  return moved.load();
}

}  // namespace shoal::kernel
