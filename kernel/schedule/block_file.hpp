// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A binary file of named blocks, each with its size and a checksum:
//
//   "SHOALCKP" | version u32 | byte order u32 = 0x01020304 |
//   kind (16 bytes, zero-padded) | size u64 | payload | checksum u64 | ... | block "end" of size 0
//
// The checksum covers kind, size and payload: FNV-1a over 64-bit words in four lanes, so that any change within one
// word is found. Everything is little-endian as the machine writes it; the byte order mark tells.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iosfwd>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace shoal::kernel {

inline constexpr std::uint32_t checkpoint_version = 1;

class Checksum {
 public:
  void add(const void* data, std::uint64_t bytes);
  std::uint64_t value() const;

 private:
  void word(std::uint64_t value);
  std::uint64_t lanes_[4] = {0xcbf29ce484222325u, 0x84222325cbf29ce4u, 0x9ce484222325cbf2u,
                             0x2325cbf29ce48422u};
  std::uint64_t n_words_ = 0;
  unsigned char rest_[8] = {};
  std::uint64_t n_rest_ = 0, n_bytes_ = 0;
};

/// Bytes of a small block, written value by value.
class BlockBuffer {
 public:
  template <class Value>
  void put(const Value& value) {
    static_assert(std::is_arithmetic_v<Value>);
    put_bytes(&value, sizeof value);
  }
  void put(const std::string& text) {
    put(static_cast<std::uint64_t>(text.size()));
    put_bytes(text.data(), text.size());
  }
  void put_bytes(const void* data, std::uint64_t bytes) {
    const auto* begin = static_cast<const char*>(data);
    bytes_.insert(bytes_.end(), begin, begin + bytes);
  }
  const std::vector<char>& bytes() const { return bytes_; }

 private:
  std::vector<char> bytes_;
};

/// Throws CheckpointError where the stream does not take what it is given.
class BlockWriter {
 public:
  explicit BlockWriter(std::ostream& stream);
  void block(const std::string& kind, const void* payload, std::uint64_t bytes);
  void block(const std::string& kind, const BlockBuffer& buffer) {
    block(kind, buffer.bytes().data(), buffer.bytes().size());
  }
  void finish();

 private:
  std::ostream& stream_;
};

/// A verified block. Large ones (kind "data") stay in the file.
struct Block {
  std::string kind;
  std::uint64_t size = 0;
  std::uint64_t offset = 0;   ///< of the payload, from where the reader began
  std::vector<char> payload;  ///< empty for kind "data"
};

/// Values of a small block. Throws CheckpointError beyond its end.
class BlockCursor {
 public:
  explicit BlockCursor(const Block& block) : block_(block) {}
  template <class Value>
  Value get() {
    static_assert(std::is_arithmetic_v<Value>);
    Value value;
    get_bytes(&value, sizeof value);
    return value;
  }
  std::string get_text();
  void get_bytes(void* data, std::uint64_t bytes);
  std::uint64_t left() const { return block_.payload.size() - position_; }

 private:
  const Block& block_;
  std::uint64_t position_ = 0;
};

/// Reads and verifies a whole file first. Throws CheckpointError: foreign, damaged, truncated.
class BlockReader {
 public:
  explicit BlockReader(std::istream& stream);
  const std::vector<Block>& blocks() const { return blocks_; }
  /// The payload of a block of kind "data".
  void read(const Block& block, void* to);

 private:
  void read_header(std::uint64_t available);
  Block read_block(std::uint64_t available);
  void exact(void* to, std::uint64_t bytes);

  std::istream& stream_;
  std::int64_t begin_ = 0;
  std::uint64_t position_ = 0;
  std::vector<Block> blocks_;
};

}  // namespace shoal::kernel
