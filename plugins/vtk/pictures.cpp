// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The order of writing: picture, list, then what an interrupted run left is removed. Whenever the run is killed,
// all that the list names is there.
#include "pictures.hpp"

#include <vtkPolyData.h>

#include <stdexcept>
#include <system_error>
#include <utility>

#include "atomic_file.hpp"
#include "shoal/snapshot.hpp"

namespace shoal::vtk {

namespace {

void check_file_name(const std::string& body) {
  if (body.empty() || body.front() == '.' || body.find('/') != std::string::npos)
    throw std::invalid_argument(
        "the name of body '" + body +
        "' cannot be the name of its pictures: it must not be empty, begin with '.' or "
        "contain '/'");
}

}  // namespace

Pictures::Pictures(std::filesystem::path folder, std::uint64_t resumed_sequence, Precision precision,
                   Compression compression)
    : folder_(std::move(folder)),
      resumed_sequence_(resumed_sequence),
      precision_(precision),
      compression_(compression) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw WriteFailed(folder_, error.value());
}

void Pictures::write(const shoal_snapshot& snapshot) {
  for (const shoal_snapshot_body& body : bodies_of(snapshot)) write(snapshot, body);
}

void Pictures::write(const shoal_snapshot& snapshot, const shoal_snapshot_body& body) {
  const std::string name = body.name;
  auto series = series_.find(name);
  const bool first = series == series_.end();
  if (first) {
    check_file_name(name);
    series = series_.emplace(name, TimeSeries(folder_, name, resumed_sequence_)).first;
  }
  const auto picture = make_picture(body, snapshot.dimensions, snapshot.time, precision_);
  write_picture(picture, folder_ / picture_name(name, snapshot.sequence), "." + name + ".vtp.tmp",
                compression_);
  series->second.add(snapshot.sequence, snapshot.time);
  if (first) series->second.remove_forgotten();
}

}  // namespace shoal::vtk
