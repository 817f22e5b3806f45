// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Write to a temporary file, fsync it, rename it. The folder is not synchronised: file systems keep the order of
// changes to it, so a list never names a picture that is not there, and a power failure costs at most the pictures
// of the last seconds. That halves the time of small pictures, which is waiting for the disk.
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
  return "cannot write '" + file.string() + "': " + std::system_category().message(system_error) +
         "; the pictures written before are complete";
}

// Some file systems do not offer fsync; there is nothing better to do then.
bool synchronise(int file) { return ::fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP; }

}  // namespace

WriteFailed::WriteFailed(const std::filesystem::path& file, int system_error)
    : std::runtime_error(describe(file, system_error)) {}

FileBuffer::FileBuffer(const std::filesystem::path& file)
    : file_(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)), buffer_(1 << 18) {
  setp(buffer_.data(), buffer_.data() + buffer_.size());
  if (file_ < 0) fail();
}

FileBuffer::~FileBuffer() {
  if (file_ >= 0) ::close(file_);
}

bool FileBuffer::fail() {
  if (error_ == 0) error_ = errno;
  return false;
}

void FileBuffer::flush() {
  for (const char* begin = pbase(); begin != pptr() && error_ == 0;) {
    const ssize_t written = ::write(file_, begin, static_cast<std::size_t>(pptr() - begin));
    if (written >= 0)
      begin += written;
    else if (errno != EINTR)
      fail();
  }
  setp(buffer_.data(), buffer_.data() + buffer_.size());
}

bool FileBuffer::finish() {
  flush();
  if (error_ != 0) return false;
  const bool synchronised = synchronise(file_) || fail();
  // Network file systems may report only now that data did not arrive.
  const bool closed = ::close(std::exchange(file_, -1)) == 0 || fail();
  return synchronised && closed;
}

FileBuffer::int_type FileBuffer::overflow(int_type character) {
  flush();
  if (!traits_type::eq_int_type(character, traits_type::eof())) sputc(traits_type::to_char_type(character));
  return traits_type::not_eof(character);
}

int FileBuffer::sync() {
  flush();
  return 0;
}

FileBuffer::pos_type FileBuffer::seekoff(off_type offset, std::ios_base::seekdir from,
                                         std::ios_base::openmode) {
  const int whence = from == std::ios_base::beg ? SEEK_SET : from == std::ios_base::cur ? SEEK_CUR : SEEK_END;
  flush();
  const off_t position = ::lseek(file_, offset, whence);
  if (position < 0) fail();
  return pos_type(position);
}

FileBuffer::pos_type FileBuffer::seekpos(pos_type position, std::ios_base::openmode which) {
  return seekoff(off_type(position), std::ios_base::beg, which);
}

AtomicFile::AtomicFile(std::filesystem::path target, const std::string& temporary_name)
    : target_(std::move(target)),
      temporary_(target_.parent_path() / temporary_name),
      buffer_(temporary_),
      stream_(&buffer_) {
  check();
}

AtomicFile::~AtomicFile() {
  if (!committed_) ::unlink(temporary_.c_str());
}

void AtomicFile::check() const {
  if (buffer_.error() != 0) throw WriteFailed(target_, buffer_.error());
}

void AtomicFile::commit() {
  if (!buffer_.finish()) throw WriteFailed(target_, buffer_.error());
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) throw WriteFailed(target_, errno);
  committed_ = true;
}

void write_atomically(const std::filesystem::path& target, const std::string& temporary_name,
                      std::string_view content) {
  AtomicFile file(target, temporary_name);
  file.stream() << content;
  file.commit();
}

}  // namespace shoal::vtk
