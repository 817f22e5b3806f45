// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Full disks, forbidden folders and kill -9: a clear text, and nothing that was written before is harmed.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vtkPointData.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>

#include <chrono>
#include <fstream>
#include <random>
#include <thread>

#include "atomic_file.hpp"
#include "pictures.hpp"
#include "sample.hpp"

// VTK 9.1 loses two small objects when a write fails in the middle of the data; not ours to mend.
extern "C" __attribute__((visibility("default"))) const char* __lsan_default_suppressions() {
  return "leak:libvtkIOXML";
}

using namespace shoal::vtk;
using namespace shoal::vtk::test;

namespace {

// Files cannot grow beyond `bytes`, as on a full disk, as long as this lives.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &old_);
    old_handler_ = signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, old_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &old_);
    signal(SIGXFSZ, old_handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit old_{};
  void (*old_handler_)(int) = nullptr;
};

// An ordinary user as long as this lives, for whom permissions count.
class OrdinaryUser {
 public:
  OrdinaryUser() : was_root_(geteuid() == 0) {
    if (was_root_) REQUIRE(seteuid(65534) == 0);
  }
  ~OrdinaryUser() {
    if (was_root_) static_cast<void>(seteuid(0));
  }
  OrdinaryUser(const OrdinaryUser&) = delete;
  OrdinaryUser& operator=(const OrdinaryUser&) = delete;

 private:
  bool was_root_;
};

std::string failure(Pictures& pictures, const shoal_snapshot& snapshot) {
  try {
    pictures.write(snapshot);
  } catch (const WriteFailed& failed) {
    return failed.what();
  }
  return "no failure";
}

// Number of pictures that the list names, each of which must be whole; -1 if there is no list.
int whole_pictures(const std::filesystem::path& folder, const std::string& body, const Body& sample) {
  const auto file = folder / (body + ".pvd");
  if (!std::filesystem::exists(file)) return -1;
  const auto root =
      vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(file.c_str()));
  REQUIRE(root != nullptr);
  auto* collection = root->FindNestedElementWithName("Collection");
  REQUIRE(collection != nullptr);
  for (int k = 0; k < collection->GetNumberOfNestedElements(); ++k) {
    const auto picture = read_picture(folder / collection->GetNestedElement(k)->GetAttribute("file"));
    REQUIRE(picture != nullptr);
    REQUIRE(picture->GetNumberOfPoints() == static_cast<vtkIdType>(sample.id().size()));
    auto* id = picture->GetPointData()->GetArray("id");
    REQUIRE(id != nullptr);
    const auto* values = static_cast<const std::int64_t*>(id->GetVoidPointer(0));
    REQUIRE(std::equal(sample.id().begin(), sample.id().end(), values));
    REQUIRE(picture->GetNumberOfVerts() == picture->GetNumberOfPoints());
  }
  return collection->GetNumberOfNestedElements();
}

}  // namespace

TEST_CASE("a full disk is said, and harms nothing") {
  const Body body = sample_body("water", 3, 20000);
  const std::vector bodies{body.c()};
  for (const Compression compression : {Compression::fast, Compression::small, Compression::none}) {
    const auto folder = scratch("full_disk");
    Pictures pictures(folder, 0, Precision::single, compression);
    pictures.write(snapshot_of(bodies, 3, 0, 0));
    const auto before = files_in(folder);
    // In the XML header, in the binary data, and just before the end.
    const auto size = std::filesystem::file_size(folder / "water_00000.vtp");
    for (const std::uintmax_t limit : {std::uintmax_t{0}, std::uintmax_t{500}, size / 2, size - 1}) {
      CAPTURE(limit);
      std::string text;
      {
        const FileSizeLimit full(static_cast<rlim_t>(limit));
        text = failure(pictures, snapshot_of(bodies, 3, 1, 1));
      }
      CHECK(text == "cannot write '" + (folder / "water_00001.vtp").string() +
                        "': File too large; the pictures written before are complete");
      CHECK(files_in(folder) == before);
      CHECK(whole_pictures(folder, "water", body) == 1);
    }
    // The same output goes on when there is room again.
    pictures.write(snapshot_of(bodies, 3, 1, 1));
    CHECK(whole_pictures(folder, "water", body) == 2);
  }
}

TEST_CASE("a list that does not fit on the disk stays as it was, and catches up later") {
  const auto folder = scratch("full_list");
  const Body body("water", 3, 0);
  const std::vector bodies{body.c()};
  Pictures pictures(folder, 0, Precision::single, Compression::fast);
  std::uint64_t k = 0;
  for (; k < 100; ++k) pictures.write(snapshot_of(bodies, 3, static_cast<double>(k), k));
  const auto picture = std::filesystem::file_size(folder / "water_00000.vtp");
  REQUIRE(picture + 100 < std::filesystem::file_size(folder / "water.pvd"));
  std::string text;
  {
    const FileSizeLimit full(picture + 100);
    text = failure(pictures, snapshot_of(bodies, 3, static_cast<double>(k), k));
  }
  CHECK(text == "cannot write '" + (folder / "water.pvd").string() +
                    "': File too large; the pictures written before are complete");
  CHECK(whole_pictures(folder, "water", body) == 100);
  ++k;
  pictures.write(snapshot_of(bodies, 3, static_cast<double>(k), k));
  CHECK(whole_pictures(folder, "water", body) == 102);
}

TEST_CASE("missing permission is said") {
  const auto folder = scratch("forbidden");
  const Body body = sample_body("water", 2, 10);
  const std::vector bodies{body.c()};
  Pictures pictures(folder, 0, Precision::single, Compression::fast);
  pictures.write(snapshot_of(bodies, 2, 0, 0));
  chmod(folder.c_str(), 0555);
  {
    const OrdinaryUser user;
    CHECK(failure(pictures, snapshot_of(bodies, 2, 1, 1)) ==
          "cannot write '" + (folder / "water_00001.vtp").string() +
              "': Permission denied; the pictures written before are complete");
    CHECK_THROWS_AS(Pictures(folder / "below", 0, Precision::single, Compression::fast), WriteFailed);
  }
  chmod(folder.c_str(), 0755);
  CHECK(whole_pictures(folder, "water", body) == 1);
}

TEST_CASE("a folder that vanishes, and a file in the place of a folder, are said") {
  const auto folder = scratch("vanished");
  const Body body = sample_body("water", 2, 10);
  const std::vector bodies{body.c()};
  Pictures pictures(folder / "results", 0, Precision::single, Compression::fast);
  std::filesystem::remove(folder / "results");
  CHECK(failure(pictures, snapshot_of(bodies, 2, 0, 0)) ==
        "cannot write '" + (folder / "results/water_00000.vtp").string() +
            "': No such file or directory; the pictures written before are complete");
  std::ofstream(folder / "file") << "";
  CHECK_THROWS_WITH_AS(Pictures(folder / "file", 0, Precision::single, Compression::fast),
                       ("cannot write '" + (folder / "file").string() +
                        "': Not a directory; the pictures written before are complete")
                           .c_str(),
                       WriteFailed);
}

TEST_CASE("write_atomically replaces a file as a whole or not at all") {
  const auto folder = scratch("atomic");
  const auto file = folder / "file";
  write_atomically(file, ".tmp", "first");
  {
    const FileSizeLimit full(3);
    CHECK_THROWS_AS(write_atomically(file, ".tmp", "second"), WriteFailed);
  }
  std::string text;
  std::ifstream(file) >> text;
  CHECK(text == "first");
  CHECK(files_in(folder) == std::vector<std::string>{"file"});
  write_atomically(file, ".tmp", "third");
  std::ifstream(file) >> text;
  CHECK(text == "third");
}

namespace {

// Writes pictures from `first` on until it is killed, and a byte to `done` after each.
[[noreturn]] void write_for_ever(const std::filesystem::path& folder, const shoal_snapshot_body& body,
                                 std::uint64_t first, int done) {
  try {
    const std::vector bodies{body};
    Pictures pictures(folder, first, Precision::single, Compression::fast);
    for (std::uint64_t k = first;; ++k) {
      pictures.write(snapshot_of(bodies, 3, static_cast<double>(k), k));
      if (write(done, "+", 1) != 1) _exit(1);
    }
  } catch (...) {
    _exit(1);
  }
}

}  // namespace

TEST_CASE("kill -9 at any moment leaves readable pictures, and the next run cleans up") {
  const auto folder = scratch("killed");
  const Body body = sample_body("water", 3, 2000);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> fraction(0, 2);
  int killed_while_writing = 0;
  for (int round = 0; round < 40; ++round) {
    int done[2];
    REQUIRE(pipe(done) == 0);
    const auto start = std::chrono::steady_clock::now();
    const pid_t child = fork();
    REQUIRE(child >= 0);
    // Each resumes where the list has entries already, as after a checkpoint.
    if (child == 0) write_for_ever(folder, body.c(), static_cast<std::uint64_t>(round % 7), done[1]);
    char byte = 0;
    REQUIRE(read(done[0], &byte, 1) == 1);
    // Somewhere in the next two pictures.
    std::this_thread::sleep_for(fraction(random) * (std::chrono::steady_clock::now() - start));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    close(done[0]);
    close(done[1]);
    REQUIRE(WIFSIGNALED(status));
    REQUIRE(WTERMSIG(status) == SIGKILL);
    const auto files = files_in(folder);
    if (files.front().front() == '.') ++killed_while_writing;
    REQUIRE(whole_pictures(folder, "water", body) >= 1);
  }
  // Else the test has not tested anything.
  CHECK(killed_while_writing > 0);

  const std::vector bodies{body.c()};
  Pictures(folder, 0, Precision::single, Compression::fast).write(snapshot_of(bodies, 3, 0, 0));
  CHECK(files_in(folder) == std::vector<std::string>{"water.pvd", "water_00000.vtp"});
}
