// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Snapshots with known content, and what a reader finds in the files.
#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "shoal/abi.h"

namespace shoal::vtk::test {

inline std::uint32_t components_of(shoal_rank rank, int d) {
  if (rank == SHOAL_SCALAR) return 1;
  if (rank == SHOAL_ARRAY) return 11;
  if (rank == SHOAL_RANK_VECTOR) return static_cast<std::uint32_t>(d);
  if (rank == SHOAL_SYMMETRIC) return static_cast<std::uint32_t>(d * (d + 1) / 2);
  return static_cast<std::uint32_t>(d * d);
}

// A number that tells particle, component and field, and does not fit into single precision.
inline double sample_value(std::uint64_t particle, std::uint32_t component, double field) {
  return std::sin(0.1 + static_cast<double>(particle) + 0.37 * component + 10.0 * field) *
         std::pow(10.0, field);
}

// A body that owns the arrays that its C description borrows.
class Body {
 public:
  Body(std::string name, int dimensions, std::uint64_t n)
      : name_(std::move(name)), dimensions_(dimensions), n_(n) {
    position_.resize(n * static_cast<std::uint64_t>(dimensions));
    for (std::size_t k = 0; k < position_.size(); ++k)
      position_[k] = sample_value(k / static_cast<std::uint64_t>(dimensions),
                                  static_cast<std::uint32_t>(k % static_cast<std::uint64_t>(dimensions)), 0);
    for (std::uint64_t i = 0; i < n; ++i) id_.push_back(static_cast<std::int64_t>((n - i) + (1ull << 60)));
  }

  void add(const char* field, shoal_rank rank, const char* unit) {
    const std::uint32_t components = components_of(rank, dimensions_);
    auto& values = reals_.emplace_back();
    const auto number = static_cast<double>(fields_.size() + 1);
    for (std::uint64_t i = 0; i < n_; ++i)
      for (std::uint32_t c = 0; c < components; ++c) values.push_back(sample_value(i, c, number));
    fields_.push_back({sizeof(shoal_snapshot_field), static_cast<std::uint32_t>(rank), SHOAL_DOUBLE,
                       components, field, unit, values.data()});
  }
  void add_integers(const char* field) {
    auto& values = integers_.emplace_back();
    for (std::uint64_t i = 0; i < n_; ++i) values.push_back(static_cast<std::int64_t>(i) - (1ll << 55));
    fields_.push_back(
        {sizeof(shoal_snapshot_field), SHOAL_SCALAR, SHOAL_INT64, 1, field, "1", values.data()});
  }

  shoal_snapshot_body c() const {
    return {sizeof(shoal_snapshot_body),
            static_cast<std::uint32_t>(fields_.size()),
            name_.c_str(),
            n_,
            position_.data(),
            id_.data(),
            fields_.data()};
  }
  const std::vector<double>& position() const { return position_; }
  const std::vector<std::int64_t>& id() const { return id_; }
  std::vector<shoal_snapshot_field>& fields() { return fields_; }

 private:
  std::string name_;
  int dimensions_;
  std::uint64_t n_;
  std::vector<double> position_;
  std::vector<std::int64_t> id_;
  std::deque<std::vector<double>> reals_;
  std::deque<std::vector<std::int64_t>> integers_;
  std::vector<shoal_snapshot_field> fields_;
};

// One field of each kind.
inline Body sample_body(const std::string& name, int dimensions, std::uint64_t n) {
  Body body(name, dimensions, n);
  body.add("pressure", SHOAL_SCALAR, "Pa");
  body.add("velocity", SHOAL_RANK_VECTOR, "m/s");
  body.add("stress", SHOAL_SYMMETRIC, "Pa");
  body.add("deformation_gradient", SHOAL_RANK_MATRIX, "1");
  body.add("gates", SHOAL_ARRAY, "1");
  body.add_integers("inlet");
  return body;
}

inline shoal_snapshot snapshot_of(const std::vector<shoal_snapshot_body>& bodies, int dimensions, double time,
                                  std::uint64_t sequence) {
  return {sizeof(shoal_snapshot),
          dimensions,
          time,
          10 * sequence,
          sequence,
          static_cast<std::uint32_t>(bodies.size()),
          0,
          bodies.data()};
}

inline vtkSmartPointer<vtkPolyData> read_picture(const std::filesystem::path& file) {
  const auto reader = vtkSmartPointer<vtkXMLPolyDataReader>::New();
  if (!reader->CanReadFile(file.c_str())) return nullptr;
  reader->SetFileName(file.c_str());
  reader->Update();
  if (reader->GetErrorCode() != 0) return nullptr;
  return reader->GetOutput();
}

// An empty folder in the test's working folder.
inline std::filesystem::path scratch(const std::string& name) {
  std::filesystem::path folder = std::filesystem::absolute(name);
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

inline std::vector<std::string> files_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace shoal::vtk::test
