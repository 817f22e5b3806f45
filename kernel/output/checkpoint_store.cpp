// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/output/checkpoint_store.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <string_view>
#include <system_error>

#include "kernel/output/atomic_file.hpp"
#include "kernel/particles/errors.hpp"

namespace shoal::kernel {
namespace {

constexpr std::array<char, 16> magic{'s', 'h', 'o', 'a', 'l', ' ', 'c', 'h',
                                     'e', 'c', 'k', 'p', 'o', 'i', 'n', 't'};
constexpr std::uint64_t version = 1;
constexpr std::uint64_t longest_header = 1ULL << 28;
constexpr std::string_view extension = ".checkpoint";

struct Prefix {
  std::array<char, 16> magic;
  std::uint64_t version;
  std::uint64_t header_bytes;
  std::uint64_t header_sum;
};

// FNV-1a
std::uint64_t sum_of(std::string_view text) {
  std::uint64_t sum = 14695981039346656037ULL;
  for (const char c : text) sum = (sum ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return sum;
}

// As many digits as 64 bits can have, so that names sort by their numbers.
std::string name_of(std::uint64_t step) {
  std::string digits = std::to_string(step);
  digits.insert(0, 20 - std::min<std::size_t>(20, digits.size()), '0');
  return "step_" + digits + std::string(extension);
}

}  // namespace

std::filesystem::path CheckpointStore::write(std::uint64_t step, const std::string& header,
                                             const std::function<void(std::ostream&)>& body) {
  make_folder(folder_);
  const std::filesystem::path path = folder_ / name_of(step);
  AtomicFile file(path);
  const Prefix prefix{magic, version, header.size(), sum_of(header)};
  file.stream().write(reinterpret_cast<const char*>(&prefix), sizeof prefix);
  file.stream().write(header.data(), static_cast<std::streamsize>(header.size()));
  body(file.stream());
  file.commit();
  const std::vector<std::filesystem::path> all = newest_first();
  std::error_code ignored;
  for (std::size_t k = kept; k < all.size(); ++k) std::filesystem::remove(all[k], ignored);
  return path;
}

std::vector<std::filesystem::path> CheckpointStore::newest_first() const {
  std::vector<std::filesystem::path> paths;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, none))
    if (entry.path().extension() == extension) paths.push_back(entry.path());
  std::sort(paths.rbegin(), paths.rend());
  return paths;
}

void CheckpointStore::remove_newer_than(const std::filesystem::path& path) const {
  std::error_code ignored;
  for (const std::filesystem::path& other : newest_first())
    if (other.filename() > path.filename()) std::filesystem::remove(other, ignored);
}

void CheckpointStore::read(const std::filesystem::path& path,
                           const std::function<void(const std::string&, std::istream&)>& reader) {
  const auto damaged = [&](const std::string& what) {
    return CheckpointError("'" + path.string() + "' " + what);
  };
  std::ifstream stream(path, std::ios::binary);
  Prefix prefix{};
  if (!stream.read(reinterpret_cast<char*>(&prefix), sizeof prefix) || prefix.magic != magic)
    throw damaged("is no checkpoint, or is damaged");
  if (prefix.version != version)
    throw damaged("is a checkpoint of version " + std::to_string(prefix.version) +
                  "; this program reads version " + std::to_string(version));
  if (prefix.header_bytes > longest_header) throw damaged("is damaged");
  std::string header(prefix.header_bytes, '\0');
  if (!stream.read(header.data(), static_cast<std::streamsize>(header.size())) ||
      sum_of(header) != prefix.header_sum)
    throw damaged("is damaged");
  reader(header, stream);
}

}  // namespace shoal::kernel
