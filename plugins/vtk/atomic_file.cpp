// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Write to a temporary file, fsync it, rename it, fsync the folder.
#include "atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

namespace shoal::vtk {

namespace {

std::string describe(const std::filesystem::path& file, int system_error) {
  std::string text = "cannot write '" + file.string() + "'";
  if (system_error != 0) text += ": " + std::system_category().message(system_error);
  return text + "; the pictures written before are complete";
}

// A file descriptor that is closed with its scope.
class Descriptor {
 public:
  Descriptor(const std::filesystem::path& path, int flags) : value_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  bool is_open() const { return value_ >= 0; }
  int get() const { return value_; }
  // False if the system reports only now that data did not reach the disk (network file systems do).
  bool close() { return ::close(std::exchange(value_, -1)) == 0; }

 private:
  int value_;
};

// Some file systems do not offer fsync; there is nothing better to do then.
bool synchronise(const Descriptor& file) { return ::fsync(file.get()) == 0 || errno == EINVAL || errno == ENOTSUP; }

}  // namespace

WriteFailed::WriteFailed(const std::filesystem::path& file, int system_error)
    : std::runtime_error(describe(file, system_error)) {}

AtomicFile::AtomicFile(std::filesystem::path target, const std::string& temporary_name)
    : target_(std::move(target)), temporary_(target_.parent_path() / temporary_name) {}

AtomicFile::~AtomicFile() {
  if (!committed_) ::unlink(temporary_.c_str());
}

void AtomicFile::commit() {
  Descriptor file(temporary_, O_RDONLY);
  if (!file.is_open() || !synchronise(file)) throw WriteFailed(target_, errno);
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) throw WriteFailed(target_, errno);
  committed_ = true;
  const Descriptor folder(target_.has_parent_path() ? target_.parent_path() : ".", O_RDONLY | O_DIRECTORY);
  if (!folder.is_open() || !synchronise(folder)) throw WriteFailed(target_, errno);
}

void write_atomically(const std::filesystem::path& target, const std::string& temporary_name,
                      std::string_view content) {
  AtomicFile file(target, temporary_name);
  Descriptor out(file.temporary(), O_WRONLY | O_CREAT | O_TRUNC);
  if (!out.is_open()) throw WriteFailed(target, errno);
  while (!content.empty()) {
    const ssize_t written = ::write(out.get(), content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw WriteFailed(target, errno);
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  if (!out.close()) throw WriteFailed(target, errno);
  file.commit();
}

}  // namespace shoal::vtk
