// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/neighbours/neighbour_grid.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernel/neighbours/threads.hpp"

namespace shoal::kernel {

namespace {

// Up to this many cells per particle (and a few more) the plain box is divided; beyond, empty space is cut out.
constexpr double cells_per_particle = 8.0;
constexpr double cells_at_least = 4096.0;
constexpr double most_cells = 0x1p31 - 64.0;  // cell numbers have 32 bits, with sign where vectors are used

constexpr std::size_t sort_chunk = 16384;
constexpr std::size_t sort_buckets = 256;

struct Bounds {
  double lower[3], upper[3];
  std::size_t n_invalid = 0;
  std::size_t first_invalid = std::numeric_limits<std::size_t>::max();

  Bounds() {
    std::fill(lower, lower + 3, std::numeric_limits<double>::infinity());
    std::fill(upper, upper + 3, -std::numeric_limits<double>::infinity());
  }
  void include(const Bounds& other) {
    for (int a = 0; a < 3; ++a) {
      lower[a] = std::min(lower[a], other.lower[a]);
      upper[a] = std::max(upper[a], other.upper[a]);
    }
    n_invalid += other.n_invalid;
    first_invalid = std::min(first_invalid, other.first_invalid);
  }
};

}  // namespace

void NeighbourGrid::build(Positions positions, double cutoff) {
  if (!(cutoff > 0.0) || !std::isfinite(cutoff)) throw std::invalid_argument("the cut-off must be positive");
  if (positions.n >= std::numeric_limits<std::uint32_t>::max() - slack)
    throw std::length_error("more particles in one body than 32-bit indices can number");
  n_ = positions.n;
  dimensions_ = positions.dimensions;
  cutoff_ = cutoff;
  limit_ = 0x1p40 * cutoff;  // a coordinate beyond keeps less than 12 bits of a cut-off
  order_.reserve(n_ + slack);
  cell_.reserve(n_);
  for (int a = 0; a < dimensions_; ++a) sorted_[a].reserve(n_ + slack);
  if (dimensions_ == 2)
    build_in<2>(positions);
  else
    build_in<3>(positions);
}

template <int D>
void NeighbourGrid::build_in(Positions positions) {
  find_bounds<D>(positions);
  choose_axes();
  choose_cells(positions);
  cell_start_.reserve(n_cells_ + 2);
  if (n_ > sort_chunk && use_threads(n_))
    sort_parallel<D>(positions);
  else
    sort_serial<D>(positions);
  // Whole vectors are read at the end of a run; what they read there must be numbers, and no index out of range.
  for (std::size_t k = n_; k < n_ + slack; ++k) order_[k] = 0;
  for (int a = 0; a < D; ++a)
    for (std::size_t k = n_valid(); k < n_ + slack; ++k)
      sorted_[a][k] = std::numeric_limits<double>::infinity();
}

template <int D>
void NeighbourGrid::find_bounds(Positions positions) {
  const auto scan = [&](std::size_t begin, std::size_t end, Bounds bounds) {
    for (std::size_t i = begin; i < end; ++i) {
      const double* x = positions.data + i * D;
      bool valid = true;
      for (int a = 0; a < D; ++a) valid &= is_valid(x[a]);
      if (!valid) {
        ++bounds.n_invalid;
        bounds.first_invalid = std::min(bounds.first_invalid, i);
        continue;
      }
      for (int a = 0; a < D; ++a) {
        bounds.lower[a] = std::min(bounds.lower[a], x[a]);
        bounds.upper[a] = std::max(bounds.upper[a], x[a]);
      }
    }
    return bounds;
  };
  Bounds bounds;
  if (use_threads(n_)) {
    bounds = tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, n_, sort_chunk), Bounds(),
        [&](const tbb::blocked_range<std::size_t>& r, Bounds b) { return scan(r.begin(), r.end(), b); },
        [](Bounds a, const Bounds& b) {
          a.include(b);
          return a;
        });
  } else {
    bounds = scan(0, n_, bounds);
  }
  n_invalid_ = bounds.n_invalid;
  first_invalid_ = n_invalid_ > 0 ? bounds.first_invalid : n_;
  double largest = 0.0;
  for (int a = 0; a < D; ++a) {
    lower_[a] = n_valid() > 0 ? bounds.lower[a] : 0.0;
    upper_[a] = n_valid() > 0 ? bounds.upper[a] : 0.0;
    largest = std::max({largest, std::abs(lower_[a]), std::abs(upper_[a])});
  }
  rounding_ = 8.0 * std::numeric_limits<double>::epsilon() * (largest + cutoff_);
}

void NeighbourGrid::choose_axes() {
  for (int a = 0; a < 3; ++a) axis_[a] = a;
  std::stable_sort(axis_, axis_ + dimensions_,
                   [&](int a, int b) { return upper_[a] - lower_[a] < upper_[b] - lower_[b]; });
}

bool NeighbourGrid::fits() const {
  double cells = 1.0;
  for (int rank = 0; rank < dimensions_; ++rank) cells *= static_cast<double>(map_[rank].cells());
  return cells <= std::min(most_cells, cells_at_least + cells_per_particle * static_cast<double>(n_));
}

void NeighbourGrid::choose_cells(Positions positions) {
  // A cell must not be narrower than the cut-off by rounding.
  const double width = cutoff_ * (1.0 + 1e-9) + rounding_;
  bool found = false;
  for (int divisions = fast_divisions; divisions >= 1 && !found; divisions /= 2) {
    for (int rank = 0; rank < dimensions_; ++rank) {
      const int a = axis_[rank];
      map_[rank].set_uniform(lower_[a], upper_[a], width, rank == 0 ? divisions : 1);
    }
    found = fits();
  }
  // Few particles in a large box: cut out the empty space, and if that is not enough enlarge the cells.
  for (double factor = 1.0; !found; factor *= 2.0) {
    for (int divisions = fast_divisions; divisions >= 1 && !found; divisions /= 2) {
      compress_axes(positions, factor * width, divisions);
      found = fits();
    }
  }
  n_cells_ = 1;
  for (int rank = 0; rank < dimensions_; ++rank) n_cells_ *= static_cast<std::uint64_t>(map_[rank].cells());
}

void NeighbourGrid::compress_axes(Positions positions, double width, int divisions) {
  const auto d = static_cast<std::size_t>(dimensions_);
  const double* coordinates = positions.data;
  if (n_invalid_ > 0) {
    valid_.reserve(n_ * d);
    std::size_t m = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      const double* x = positions.data + i * d;
      if (!std::all_of(x, x + d, [&](double c) { return is_valid(c); })) continue;
      std::copy(x, x + d, valid_.data() + d * m++);
    }
    coordinates = valid_.data();
  }
  for (int rank = 0; rank < dimensions_; ++rank)
    map_[rank].set_compressed(coordinates + axis_[rank], n_valid(), d, width, rank == 0 ? divisions : 1);
}

template <int D>
inline std::uint32_t NeighbourGrid::cell_of(const double* x) const {
  bool valid = true;
  for (int a = 0; a < D; ++a) valid &= is_valid(x[a]);
  if (!valid)
    return static_cast<std::uint32_t>(n_cells_);  // one cell behind the others, which no search visits
  std::int64_t c = map_[D - 1].cell(x[axis_[D - 1]]);
  for (int rank = D - 2; rank >= 0; --rank) c = c * map_[rank].cells() + map_[rank].cell(x[axis_[rank]]);
  return static_cast<std::uint32_t>(c);
}

template <int D>
inline void NeighbourGrid::place(const double* x, std::uint32_t particle, std::uint32_t place) {
  order_[place] = particle;
  for (int a = 0; a < D; ++a) sorted_[a][place] = x[a];
}

template <int D>
void NeighbourGrid::sort_serial(Positions positions) {
  std::uint32_t* start = cell_start_.data();
  std::fill(start, start + n_cells_ + 2, 0u);
  for (std::size_t i = 0; i < n_; ++i) {
    const std::uint32_t c = cell_of<D>(positions.data + i * D);
    cell_[i] = c;
    ++start[c + 1];
  }
  // Now start[c + 1] counts cell c. Shifted by one, the running sum serves as the place of the next particle, and
  // has become the start of the next cell when all are placed.
  std::uint32_t sum = 0;
  for (std::uint64_t c = 0; c <= n_cells_; ++c) {
    const std::uint32_t count = start[c + 1];
    start[c + 1] = sum;
    sum += count;
  }
  for (std::size_t i = 0; i < n_; ++i)
    place<D>(positions.data + i * D, static_cast<std::uint32_t>(i), start[cell_[i] + 1]++);
}

// Two stable passes: chunks of particles into buckets of consecutive cells, then each bucket by itself. The result of
// a stable sort is unique, so neither chunks nor threads show in it.
template <int D>
void NeighbourGrid::sort_parallel(Positions positions) {
  const std::uint64_t all_cells = n_cells_ + 1;
  int shift =
      0;  // cells of a bucket as a power of two: a division per particle would cost more than the sort
  while ((all_cells - 1) >> shift >= sort_buckets) ++shift;
  const std::size_t n_chunks = (n_ + sort_chunk - 1) / sort_chunk;
  scratch_.reserve(n_);
  counts_.reserve(n_chunks * sort_buckets + sort_buckets + 1);
  std::uint32_t* counts = counts_.data();
  std::uint32_t* bucket_start = counts + n_chunks * sort_buckets;

  tbb::parallel_for(std::size_t{0}, n_chunks, [&](std::size_t chunk) {
    std::uint32_t* mine = counts + chunk * sort_buckets;
    std::fill(mine, mine + sort_buckets, 0u);
    const std::size_t end = std::min(n_, (chunk + 1) * sort_chunk);
    for (std::size_t i = chunk * sort_chunk; i < end; ++i) {
      cell_[i] = cell_of<D>(positions.data + i * D);
      ++mine[cell_[i] >> shift];
    }
  });
  std::uint32_t sum = 0;
  for (std::size_t bucket = 0; bucket < sort_buckets; ++bucket) {
    bucket_start[bucket] = sum;
    for (std::size_t chunk = 0; chunk < n_chunks; ++chunk) {
      std::uint32_t& count = counts[chunk * sort_buckets + bucket];
      sum += std::exchange(count, sum);
    }
  }
  bucket_start[sort_buckets] = sum;
  tbb::parallel_for(std::size_t{0}, n_chunks, [&](std::size_t chunk) {
    std::uint32_t* mine = counts + chunk * sort_buckets;
    const std::size_t end = std::min(n_, (chunk + 1) * sort_chunk);
    for (std::size_t i = chunk * sort_chunk; i < end; ++i)
      scratch_[mine[cell_[i] >> shift]++] = static_cast<std::uint32_t>(i);
  });
  cell_start_[0] = 0;
  tbb::parallel_for(std::size_t{0}, sort_buckets, [&](std::size_t bucket) {
    const std::uint64_t first = std::min<std::uint64_t>(all_cells, bucket << shift);
    const std::uint64_t last = std::min<std::uint64_t>(all_cells, (bucket + 1) << shift);
    std::uint32_t* start = cell_start_.data() + 1;  // as in sort_serial, of the cells of this bucket
    std::fill(start + first, start + last, 0u);
    for (std::uint32_t k = bucket_start[bucket]; k < bucket_start[bucket + 1]; ++k)
      ++start[cell_[scratch_[k]]];
    std::uint32_t place_of_next = bucket_start[bucket];
    for (std::uint64_t c = first; c < last; ++c) place_of_next += std::exchange(start[c], place_of_next);
    for (std::uint32_t k = bucket_start[bucket]; k < bucket_start[bucket + 1]; ++k) {
      const std::uint32_t i = scratch_[k];
      place<D>(positions.data + std::size_t{i} * D, i, start[cell_[i]]++);
    }
  });
}

std::size_t NeighbourGrid::memory_bytes() const {
  std::size_t bytes = order_.memory_bytes() + cell_start_.memory_bytes() + cell_.memory_bytes() +
                      scratch_.memory_bytes() + counts_.memory_bytes() + valid_.memory_bytes();
  for (const auto& coordinate : sorted_) bytes += coordinate.memory_bytes();
  return bytes;
}

}  // namespace shoal::kernel
