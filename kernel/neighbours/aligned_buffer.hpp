// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Memory for arrays that are rebuilt again and again: aligned to cache lines, never initialised, and kept between
// rebuilds. std::vector would write zeros over a gigabyte of list that is overwritten at once.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <new>
#include <type_traits>
#include <utility>

namespace shoal::kernel {

template <class T>
class AlignedBuffer {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  static constexpr std::size_t alignment = 64;

  AlignedBuffer() = default;
  AlignedBuffer(AlignedBuffer&& other) noexcept { swap(other); }
  AlignedBuffer& operator=(AlignedBuffer&& other) noexcept {
    swap(other);
    return *this;
  }
  AlignedBuffer(const AlignedBuffer&) = delete;
  AlignedBuffer& operator=(const AlignedBuffer&) = delete;
  ~AlignedBuffer() { release(); }

  T* data() { return data_; }
  const T* data() const { return data_; }
  T& operator[](std::size_t k) { return data_[k]; }
  const T& operator[](std::size_t k) const { return data_[k]; }
  std::size_t capacity() const { return capacity_; }
  std::size_t memory_bytes() const { return capacity_ * sizeof(T); }

  /// Room for n elements; the first `keep` are preserved, the others have no value. Grows by half at least.
  void reserve(std::size_t n, std::size_t keep = 0) {
    if (n <= capacity_) return;
    AlignedBuffer larger;
    larger.capacity_ = std::max(n, capacity_ + capacity_ / 2);
    larger.data_ =
        static_cast<T*>(::operator new (larger.capacity_ * sizeof(T), std::align_val_t{alignment}));
    if (keep > 0) std::memcpy(larger.data_, data_, keep * sizeof(T));
    swap(larger);
  }

  void release() {
    ::operator delete (data_, std::align_val_t{alignment});
    data_ = nullptr;
    capacity_ = 0;
  }

 private:
  void swap(AlignedBuffer& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(capacity_, other.capacity_);
  }

  T* data_ = nullptr;
  std::size_t capacity_ = 0;
};

}  // namespace shoal::kernel
