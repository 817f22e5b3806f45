// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Files that appear under their names only when they are complete: neither a kill, a full disk nor a power failure
// leaves half a file, or harms the one that stood there before.
#pragma once

#include <filesystem>
#include <ostream>
#include <stdexcept>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

namespace shoal::vtk {

// A file could not be written. The text names it and the system's reason.
struct WriteFailed : std::runtime_error {
  WriteFailed(const std::filesystem::path& file, int system_error);
};

// std::filebuf, but one that knows why it failed, and whose file can be synchronised with the disk. Behind a failure it
// swallows what comes: VTK 9.1 crashes when its stream fails in the middle of an array.
class FileBuffer final : public std::streambuf {
 public:
  explicit FileBuffer(const std::filesystem::path& file);  // made anew; see error()
  ~FileBuffer() override;
  FileBuffer(const FileBuffer&) = delete;
  FileBuffer& operator=(const FileBuffer&) = delete;

  // errno of the first failure, or 0.
  int error() const { return error_; }
  // Waits until all is on the disk, and closes. Without it the destructor closes, and drops what is buffered.
  bool finish();

 protected:
  int_type overflow(int_type character) override;
  int sync() override;
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode which) override;
  pos_type seekpos(pos_type position, std::ios_base::openmode which) override;

 private:
  void flush();
  bool fail();

  int file_;
  int error_ = 0;
  std::vector<char> buffer_;
};

class AtomicFile {
 public:
  // The content goes to `temporary_name`, a hidden file in the target's folder. It should be the same for all files
  // of a series: then what a killed run left is overwritten by the next one. Throws WriteFailed.
  AtomicFile(std::filesystem::path target, const std::string& temporary_name);
  // Without commit, the temporary file is removed and the target stays as it was.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  std::ostream& stream() { return stream_; }

  // Throws WriteFailed if anything failed since the beginning.
  void check() const;
  // Waits until the content is on the disk, then puts the file in place. Throws WriteFailed as check() does.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  FileBuffer buffer_;
  std::ostream stream_;
  bool committed_ = false;
};

void write_atomically(const std::filesystem::path& target, const std::string& temporary_name,
                      std::string_view content);

}  // namespace shoal::vtk
