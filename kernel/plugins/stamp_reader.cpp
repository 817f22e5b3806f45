// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A small ELF reader. dlopen would run the static constructors of a library that may be made for another
// kernel or processor, and dies with SIGBUS on a truncated file; so the stamp is taken from the file first.
// Boost's library_info only lists names, out of a table that strip removes, and trusts every offset that it
// reads.
#include "kernel/plugins/stamp_reader.hpp"

#include <elf.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <vector>

#include "kernel/plugins/abi_reading.hpp"

namespace shoal::kernel {
namespace {

#if defined(__x86_64__)
constexpr unsigned this_machine = EM_X86_64;
#elif defined(__aarch64__)
constexpr unsigned this_machine = EM_AARCH64;
#else
#error "The stamp reader knows 64-bit x86 and ARM; add the ELF number of this machine."
#endif

struct Refusal {
  LoadProblem problem;
  std::string text;
};
const Refusal truncated{LoadProblem::truncated, "ends too early: it was copied or written only in part"};

class File {
 public:
  explicit File(const std::filesystem::path& path)
      : handle_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
    if (handle_ < 0)
      throw Refusal{LoadProblem::not_a_file,
                    "cannot be read: " + std::error_code(errno, std::generic_category()).message()};
    struct stat status {};
    if (::fstat(handle_, &status) == 0 && S_ISREG(status.st_mode)) {
      size_ = static_cast<std::uint64_t>(status.st_size);
      return;
    }
    ::close(handle_);
    throw Refusal{LoadProblem::not_a_file,
                  S_ISDIR(status.st_mode) ? "is a folder, not a library" : "is not a regular file"};
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() { ::close(handle_); }

  std::uint64_t size() const { return size_; }

  void read(std::uint64_t offset, std::uint64_t bytes, void* to) const {
    if (offset > size_ || bytes > size_ - offset) throw truncated;
    auto* at = static_cast<char*>(to);
    while (bytes > 0) {
      const ssize_t n = ::pread(handle_, at, bytes, static_cast<off_t>(offset));
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) throw truncated;
      at += n;
      offset += static_cast<std::uint64_t>(n);
      bytes -= static_cast<std::uint64_t>(n);
    }
  }
  template <class T>
  T read(std::uint64_t offset) const {
    T value;
    read(offset, sizeof(T), &value);
    return value;
  }
  template <class T>
  std::vector<T> read_array(std::uint64_t offset, std::uint64_t n) const {
    if (offset > size_ || n > (size_ - offset) / sizeof(T)) throw truncated;
    std::vector<T> values(n);
    read(offset, n * sizeof(T), values.data());
    return values;
  }

 private:
  int handle_;
  std::uint64_t size_ = 0;
};

Elf64_Ehdr read_header(const File& file) {
  if (file.size() < SELFMAG) throw Refusal{LoadProblem::not_a_library, "is not a shared library"};
  const auto magic = file.read_array<char>(0, SELFMAG);
  if (std::memcmp(magic.data(), ELFMAG, SELFMAG) != 0)
    throw Refusal{LoadProblem::not_a_library, "is not a shared library"};
  const auto header = file.read<Elf64_Ehdr>(0);
  if (header.e_ident[EI_CLASS] != ELFCLASS64 || header.e_ident[EI_DATA] != ELFDATA2LSB ||
      header.e_machine != this_machine)
    throw Refusal{LoadProblem::other_machine, "was built for another kind of processor (ELF machine " +
                                                  std::to_string(header.e_machine) + ", this is " +
                                                  std::to_string(this_machine) + ")"};
  if (header.e_type != ET_DYN) throw Refusal{LoadProblem::not_a_library, "is not a shared library"};
  if (header.e_phentsize != sizeof(Elf64_Phdr) ||
      (header.e_shnum > 0 && header.e_shentsize != sizeof(Elf64_Shdr)))
    throw Refusal{LoadProblem::not_a_library, "is a damaged library"};
  return header;
}

std::optional<Elf64_Sym> find_symbol(const File& file, const Elf64_Ehdr& header, const std::string& wanted) {
  const auto sections = file.read_array<Elf64_Shdr>(header.e_shoff, header.e_shnum);
  for (const Elf64_Shdr& section : sections) {
    if (section.sh_type != SHT_DYNSYM || section.sh_link >= sections.size()) continue;
    const Elf64_Shdr& text_section = sections[section.sh_link];
    const auto symbols = file.read_array<Elf64_Sym>(section.sh_offset, section.sh_size / sizeof(Elf64_Sym));
    const auto text = file.read_array<char>(text_section.sh_offset, text_section.sh_size);
    for (const Elf64_Sym& symbol : symbols) {
      if (symbol.st_shndx == SHN_UNDEF || symbol.st_name + wanted.size() >= text.size()) continue;
      if (std::memcmp(text.data() + symbol.st_name, wanted.c_str(), wanted.size() + 1) == 0) return symbol;
    }
  }
  return std::nullopt;
}

shoal_stamp read_stamp_at(const File& file, const std::vector<Elf64_Phdr>& segments,
                          const Elf64_Sym& symbol) {
  shoal_stamp stamp{};
  for (const Elf64_Phdr& segment : segments) {
    if (segment.p_type != PT_LOAD || symbol.st_value < segment.p_vaddr) continue;
    const std::uint64_t offset = symbol.st_value - segment.p_vaddr;
    if (offset >= segment.p_filesz) continue;
    std::uint64_t bytes = std::min<std::uint64_t>(sizeof(stamp), segment.p_filesz - offset);
    if (symbol.st_size > 0) bytes = std::min<std::uint64_t>(bytes, symbol.st_size);
    file.read(segment.p_offset + offset, bytes, &stamp);
    // The maker's stamp may be shorter than ours; what follows it in the file is not ours to read.
    const std::uint64_t known = std::min<std::uint64_t>(stamp.size, bytes);
    const std::uint64_t head = offsetof(shoal_stamp, abi_major);
    if (known >= head) std::memset(reinterpret_cast<char*>(&stamp) + known, 0, sizeof(stamp) - known);
    break;
  }
  return stamp;
}

}  // namespace

StampReading read_stamp(const std::filesystem::path& path) {
  try {
    const File file(path);
    const Elf64_Ehdr header = read_header(file);
    const auto segments = file.read_array<Elf64_Phdr>(header.e_phoff, header.e_phnum);
    for (const Elf64_Phdr& segment : segments)
      if (segment.p_type == PT_LOAD &&
          (segment.p_offset > file.size() || segment.p_filesz > file.size() - segment.p_offset))
        throw truncated;
    const auto symbol = find_symbol(file, header, SHOAL_STAMP_SYMBOL);
    if (!symbol)
      return {std::nullopt, LoadProblem::no_stamp,
              "is no Shoal plugin: it has no symbol " SHOAL_STAMP_SYMBOL
              " (a plugin has one SHOAL_PLUGIN(...), and its file keeps its section headers)"};
    return {read_stamp_at(file, segments, *symbol), LoadProblem::no_stamp, {}};
  } catch (const Refusal& refusal) {
    return {std::nullopt, refusal.problem, refusal.text};
  }
}

}  // namespace shoal::kernel
