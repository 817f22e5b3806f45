// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Writing and verifying files of blocks.
#include "kernel/schedule/block_file.hpp"

#include <algorithm>
#include <istream>
#include <ostream>

#include "kernel/particles/errors.hpp"

namespace shoal::kernel {

namespace {

constexpr char magic[8] = {'S', 'H', 'O', 'A', 'L', 'C', 'K', 'P'};
constexpr std::uint32_t byte_order = 0x01020304u;
constexpr std::size_t kind_bytes = 16;
constexpr std::uint64_t piece = std::uint64_t{1} << 20;
constexpr std::uint64_t prime = 0x100000001b3u;

std::uint64_t begin_checksum(Checksum& sum, const std::string& kind, std::uint64_t size) {
  char name[kind_bytes] = {};
  std::memcpy(name, kind.data(), std::min(kind.size(), kind_bytes));
  sum.add(name, sizeof name);
  sum.add(&size, sizeof size);
  return size;
}

}  // namespace

void Checksum::word(std::uint64_t value) {
  std::uint64_t& lane = lanes_[n_words_++ % 4];
  lane = (lane ^ value) * prime;
  // Multiplication carries upwards only; bring high bits down too.
  lane ^= lane >> 32;
}

void Checksum::add(const void* data, std::uint64_t bytes) {
  const auto* from = static_cast<const unsigned char*>(data);
  n_bytes_ += bytes;
  while (bytes > 0 && n_rest_ > 0) {
    rest_[n_rest_++] = *from++;
    --bytes;
    if (n_rest_ < 8) continue;
    std::uint64_t value;
    std::memcpy(&value, rest_, 8);
    word(value);
    n_rest_ = 0;
  }
  for (; bytes >= 8; bytes -= 8, from += 8) {
    std::uint64_t value;
    std::memcpy(&value, from, 8);
    word(value);
  }
  for (; bytes > 0; --bytes) rest_[n_rest_++] = *from++;
}

std::uint64_t Checksum::value() const {
  Checksum copy = *this;
  while (copy.n_rest_ > 0) {
    const unsigned char zero = 0;
    copy.add(&zero, 1);
  }
  copy.word(n_bytes_);
  std::uint64_t sum = 0xcbf29ce484222325u;
  for (const std::uint64_t lane : copy.lanes_) {
    sum = (sum ^ lane) * prime;
    sum ^= sum >> 32;
  }
  return sum;
}

BlockWriter::BlockWriter(std::ostream& stream) : stream_(stream) {
  stream_.write(magic, sizeof magic);
  stream_.write(reinterpret_cast<const char*>(&checkpoint_version), sizeof checkpoint_version);
  stream_.write(reinterpret_cast<const char*>(&byte_order), sizeof byte_order);
}

void BlockWriter::block(const std::string& kind, const void* payload, std::uint64_t bytes) {
  Checksum sum;
  begin_checksum(sum, kind, bytes);
  sum.add(payload, bytes);
  char name[kind_bytes] = {};
  std::memcpy(name, kind.data(), std::min(kind.size(), kind_bytes));
  stream_.write(name, sizeof name);
  stream_.write(reinterpret_cast<const char*>(&bytes), sizeof bytes);
  stream_.write(static_cast<const char*>(payload), static_cast<std::streamsize>(bytes));
  const std::uint64_t value = sum.value();
  stream_.write(reinterpret_cast<const char*>(&value), sizeof value);
  if (!stream_) throw CheckpointError("the checkpoint could not be written (disk full?)");
}

void BlockWriter::finish() {
  block("end", nullptr, 0);
  stream_.flush();
  if (!stream_) throw CheckpointError("the checkpoint could not be written (disk full?)");
}

std::string BlockCursor::get_text() {
  const auto size = get<std::uint64_t>();
  if (size > left())
    throw CheckpointError("the checkpoint is damaged: a text in it is longer than its block");
  std::string text(size, '\0');
  get_bytes(text.data(), size);
  return text;
}

void BlockCursor::get_bytes(void* data, std::uint64_t bytes) {
  if (bytes > left())
    throw CheckpointError("the checkpoint is damaged: block '" + block_.kind +
                          "' is shorter than what it should hold");
  if (bytes > 0) std::memcpy(data, block_.payload.data() + position_, bytes);
  position_ += bytes;
}

BlockReader::BlockReader(std::istream& stream) : stream_(stream) {
  begin_ = static_cast<std::int64_t>(stream_.tellg());
  stream_.seekg(0, std::ios::end);
  const auto end = static_cast<std::int64_t>(stream_.tellg());
  stream_.seekg(begin_);
  if (!stream_ || begin_ < 0 || end < begin_) throw CheckpointError("the checkpoint cannot be read");
  const auto total = static_cast<std::uint64_t>(end - begin_);
  read_header(total);
  for (;;) {
    Block block = read_block(total);
    if (block.kind == "end") break;
    blocks_.push_back(std::move(block));
  }
  if (position_ != total)
    throw CheckpointError("the checkpoint is damaged: there is something behind its end");
}

void BlockReader::exact(void* to, std::uint64_t bytes) {
  stream_.read(static_cast<char*>(to), static_cast<std::streamsize>(bytes));
  if (!stream_ || stream_.gcount() != static_cast<std::streamsize>(bytes))
    throw CheckpointError("the checkpoint is truncated or cannot be read");
  position_ += bytes;
}

void BlockReader::read_header(std::uint64_t available) {
  char start[sizeof magic] = {};
  std::uint32_t version = 0, order = 0;
  if (available < sizeof start)
    throw CheckpointError("this is no checkpoint of Shoal: the file is too short");
  exact(start, sizeof start);
  if (std::memcmp(start, magic, sizeof magic) != 0)
    throw CheckpointError("this is no checkpoint of Shoal: it does not begin with 'SHOALCKP'");
  if (available < sizeof start + sizeof version + sizeof order)
    throw CheckpointError("the checkpoint is truncated");
  exact(&version, sizeof version);
  exact(&order, sizeof order);
  if (order != byte_order)
    throw CheckpointError("the checkpoint was written on a machine with another byte order");
  if (version != checkpoint_version)
    throw CheckpointError("the checkpoint has format version " + std::to_string(version) +
                          "; this Shoal reads " + std::to_string(checkpoint_version));
}

Block BlockReader::read_block(std::uint64_t total) {
  const std::uint64_t head = kind_bytes + sizeof(std::uint64_t), tail = sizeof(std::uint64_t);
  if (total - position_ < head + tail) throw CheckpointError("the checkpoint is truncated");
  Block block;
  char name[kind_bytes + 1] = {};
  exact(name, kind_bytes);
  exact(&block.size, sizeof block.size);
  block.kind = name;
  block.offset = position_;
  if (block.size > total - position_ - tail) throw CheckpointError("the checkpoint is truncated or damaged");
  Checksum sum;
  sum.add(name, kind_bytes);
  sum.add(&block.size, sizeof block.size);
  const bool keep = block.kind != "data";
  if (keep) block.payload.resize(block.size);
  std::vector<char> buffer(keep ? 0 : std::min(block.size, piece));
  for (std::uint64_t done = 0; done < block.size;) {
    const std::uint64_t now = std::min(piece, block.size - done);
    char* to = keep ? block.payload.data() + done : buffer.data();
    exact(to, now);
    sum.add(to, now);
    done += now;
  }
  std::uint64_t expected = 0;
  exact(&expected, sizeof expected);
  if (expected != sum.value())
    throw CheckpointError("the checkpoint is damaged: the checksum of a block at byte " +
                          std::to_string(block.offset) + " does not fit");
  return block;
}

void BlockReader::read(const Block& block, void* to) {
  stream_.clear();
  stream_.seekg(begin_ + static_cast<std::int64_t>(block.offset));
  exact(to, block.size);
}

}  // namespace shoal::kernel
