// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/neighbours/neighbour_list.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <shared_mutex>
#include <stdexcept>
#include <thread>
#include <vector>

#include "kernel/neighbours/row_scan.hpp"
#include "kernel/neighbours/run_finder.hpp"
#include "kernel/neighbours/threads.hpp"

namespace shoal::kernel {

namespace {

constexpr std::size_t block_rows = 256;
constexpr std::uint32_t no_particle = 0xFFFFFFFFu;

// Writes rows one after another into a buffer that grows as needed.
struct RowWriter {
  AlignedBuffer<std::uint32_t>& buffer;
  std::size_t used = 0;

  std::uint32_t* room_for(std::size_t candidates) {
    buffer.reserve(used + candidates + NeighbourList::padding + scan_overrun, used);
    return buffer.data() + used;
  }
  /// Ends a row of `count` neighbours that stand at room_for().
  void finish_row(std::size_t count) {
    if (count == 0) return;
    std::uint32_t* end = buffer.data() + used + count;
    std::fill_n(end, NeighbourList::padding, end[-1]);
    used += (count + NeighbourList::padding - 1) / NeighbourList::padding * NeighbourList::padding;
  }
};

}  // namespace

// What one task of the parallel build works on.
struct NeighbourList::Block {
  std::size_t number = 0, first = 0, last = 0;
  std::uint64_t pairs = 0;
  AlignedBuffer<std::uint32_t> rows;
  std::size_t used = 0;
};

bool is_available(ScanPath path) {
  switch (path) {
    case ScanPath::fastest:
    case ScanPath::plain: return true;
    case ScanPath::avx2:
#if defined(__AVX2__)
      return true;
#else
      return false;
#endif
    case ScanPath::avx512:
#if defined(__AVX512F__) && defined(__AVX512VL__)
      return true;
#else
      return false;
#endif
  }
  return false;
}

void NeighbourList::build(const NeighbourGrid& sources, Positions targets, double cutoff, bool same_body,
                          ScanPath path) {
  if (!(cutoff > 0.0) || cutoff > sources.cutoff())
    throw std::invalid_argument("the cut-off of a neighbour list must be positive and not exceed its grid's");
  if (targets.dimensions != sources.dimensions())
    throw std::invalid_argument("the bodies of a neighbour list must have the same dimensions");
  if (same_body && targets.n > sources.n())
    throw std::invalid_argument("a body cannot have more targets than particles");
  n_rows_ = targets.n;
  cutoff_ = cutoff;
  offsets_.reserve(n_rows_ + 1);
  counts_.reserve(n_rows_);
  const auto with = [&]<class Scan>(Scan) {
    if (targets.dimensions == 2)
      build_rows<2, Scan>(sources, targets, same_body);
    else
      build_rows<3, Scan>(sources, targets, same_body);
  };
  switch (path) {
    case ScanPath::plain: return with(PlainScan{});
#if defined(__AVX2__)
    case ScanPath::avx2: return with(Avx2Scan{});
#endif
    case ScanPath::fastest: return with(FastestScan{});
#if defined(__AVX512F__) && defined(__AVX512VL__)
    case ScanPath::avx512: return with(Avx512Scan{});
#endif
    default: throw std::invalid_argument("this program was not compiled for the instructions asked for");
  }
}

template <int D, class Scan>
void NeighbourList::build_rows(const NeighbourGrid& sources, Positions targets, bool same_body) {
  const RunFinder<D> finder(sources, cutoff_);
  RowTarget<D> scheme{};
  scheme.squared_radius = cutoff_ * cutoff_;
  scheme.order = sources.order();
  for (int a = 0; a < D; ++a) scheme.sorted[a] = sources.sorted(a);
  // Rows first ... last-1 into `writer`; offsets are counted from where the writer stands. Returns the pairs.
  const auto fill_rows = [&](std::size_t first, std::size_t last, RowWriter& writer) {
    RowTarget<D> target = scheme;
    RunBlock<D> runs;
    std::uint64_t pairs = 0;
    for (std::size_t i = first; i < last; ++i) {
      const std::size_t row_of_block = (i - first) % RunBlock<D>::rows;
      if (row_of_block == 0) finder.find(targets.data + i * D, std::min(last - i, RunBlock<D>::rows), runs);
      offsets_[i] = writer.used;
      counts_[i] = 0;
      if (runs.candidates[row_of_block] == 0) continue;
      for (int a = 0; a < D; ++a) target.x[a] = targets.data[i * D + static_cast<std::size_t>(a)];
      target.self = same_body ? static_cast<std::uint32_t>(i) : no_particle;
      std::uint32_t* const row = writer.room_for(runs.candidates[row_of_block]);
      const std::uint32_t* const out = scan_runs<D, Scan>(target, runs, row_of_block, row);
      const auto count = static_cast<std::size_t>(out - row);
      counts_[i] = static_cast<std::uint32_t>(count);
      writer.finish_row(count);
      pairs += count;
    }
    return pairs;
  };
  if (indices_.capacity() == 0) reserve_first(fill_rows);
  if (use_threads_for_rows(n_rows_))
    build_parallel(fill_rows);
  else
    build_serial(fill_rows);
}

// Memory for the first build, from a sample of rows: growing step by step would copy the list several times.
template <class FillRows>
void NeighbourList::reserve_first(const FillRows& fill_rows) {
  constexpr std::size_t samples = 128;
  const std::size_t stride = n_rows_ / samples;
  if (stride < 2) return;
  std::size_t used = 0;
  for (std::size_t k = 0; k < samples; ++k) {
    RowWriter writer{sample_};
    fill_rows(k * stride, k * stride + 1, writer);
    used += writer.used;
  }
  indices_.reserve(static_cast<std::size_t>(1.05 * static_cast<double>(used * stride)) + padding);
}

template <class FillRows>
void NeighbourList::build_serial(const FillRows& fill_rows) {
  RowWriter writer{indices_};
  n_pairs_ = fill_rows(0, n_rows_, writer);
  offsets_[n_rows_] = writer.used;
}

// Threads take blocks of rows in order, fill them in memory of their own, give them their place behind the block before
// when that has one, and copy them there: one pass, no gaps, and offsets that do not depend on the threads. The copy costs
// little, since a block's rows are still in the cache of the core that made them. A thread whose block comes too early
// keeps it and fills another one before it waits.
template <class FillRows>
void NeighbourList::build_parallel(const FillRows& fill_rows) {
  const std::size_t n_blocks = (n_rows_ + block_rows - 1) / block_rows;
  const std::size_t usual =
      indices_.capacity() / n_rows_ * block_rows;  // of the last build, or of the sample
  std::shared_mutex growth;
  std::atomic<std::size_t> next = 0, placed = 0;  // blocks
  std::atomic<bool> failed = false;               // by lack of memory
  std::uint64_t total = 0;  // entries of those placed; this and n_pairs_ belong to whose turn it is
  n_pairs_ = 0;

  const auto give_place = [&](Block& block) {
    const std::uint64_t base = total;
    total += block.used;
    n_pairs_ += block.pairs;
    if (total > indices_.capacity()) {
      const std::unique_lock lock(growth);
      indices_.reserve(total, base);
    }
    placed.store(block.number + 1, std::memory_order_release);
    const std::shared_lock lock(growth);
    std::copy_n(block.rows.data(), block.used, indices_.data() + base);
    for (std::size_t i = block.first; i < block.last; ++i) offsets_[i] += base;
  };
  const auto fill_blocks = [&] {
    std::array<Block, 2> blocks;
    std::size_t filled = 0, gone = 0;  // of this thread, in order
    const auto oldest = [&]() -> Block& { return blocks[gone % blocks.size()]; };
    for (;;) {
      while (gone < filled && placed.load(std::memory_order_acquire) == oldest().number) {
        give_place(oldest());
        ++gone;
      }
      const bool full = filled - gone == blocks.size();
      const std::size_t number = full ? n_blocks : next.fetch_add(1, std::memory_order_relaxed);
      if (number < n_blocks) {
        Block& block = blocks[filled++ % blocks.size()];
        block.number = number;
        block.first = number * block_rows;
        block.last = std::min(n_rows_, block.first + block_rows);
        block.rows.reserve(usual + usual / 4);
        RowWriter writer{block.rows};
        block.pairs = fill_rows(block.first, block.last, writer);
        block.used = writer.used;
      } else if (gone == filled || failed.load(std::memory_order_relaxed)) {
        return;
      } else {
        std::this_thread::yield();
      }
    }
  };
  tbb::parallel_for(
      std::size_t{0}, std::min(available_threads(), n_blocks),
      [&](std::size_t) {
        try {
          fill_blocks();
        } catch (...) {
          failed = true;
          throw;
        }
      },
      tbb::static_partitioner{});
  offsets_[n_rows_] = total;
}

std::size_t NeighbourList::memory_bytes() const {
  return offsets_.memory_bytes() + counts_.memory_bytes() + indices_.memory_bytes() + sample_.memory_bytes();
}

}  // namespace shoal::kernel
