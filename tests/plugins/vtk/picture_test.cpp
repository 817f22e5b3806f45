// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What VTK reads back is what was in the snapshot, for every rank, dimension, precision and compression.
#include "picture.hpp"

#include <doctest/doctest.h>
#include <vtkCell.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkPointData.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>

#include <array>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>

#include "picture_file.hpp"
#include "pictures.hpp"
#include "sample.hpp"

using namespace shoal::vtk;
using namespace shoal::vtk::test;

namespace {

struct Setting {
  int dimensions;
  std::uint64_t n;
  Precision precision;
  Compression compression;
};

std::vector<Setting> all_settings() {
  std::vector<Setting> settings;
  for (const int dimensions : {1, 2, 3})
    for (const std::uint64_t n : {0u, 1u, 5000u})
      for (const Precision precision : {Precision::single, Precision::full})
        for (const Compression compression : {Compression::fast, Compression::small, Compression::none})
          settings.push_back({dimensions, n, precision, compression});
  return settings;
}

vtkSmartPointer<vtkPolyData> write_and_read(const Body& body, const Setting& setting, double time = 0.1) {
  const auto folder = scratch("picture");
  const std::vector bodies{body.c()};
  Pictures pictures(folder, 0, setting.precision, setting.compression);
  pictures.write(snapshot_of(bodies, setting.dimensions, time, 0));
  return read_picture(folder / "water_00000.vtp");
}

double rounded(double value, Precision precision) {
  return precision == Precision::single ? static_cast<double>(static_cast<float>(value)) : value;
}

// Counts instead of thousands of CHECKs: how many numbers differ from `expected(particle, component)`.
template <class Expected>
std::uint64_t differences(vtkDataArray* array, std::uint64_t n, int components, Expected&& expected) {
  std::uint64_t count = 0;
  for (std::uint64_t i = 0; i < n; ++i)
    for (int c = 0; c < components; ++c)
      if (array->GetComponent(static_cast<vtkIdType>(i), c) != expected(i, c)) ++count;
  return count;
}

void check_array(vtkDataArray* array, std::uint64_t n, int components, Precision precision) {
  REQUIRE(array != nullptr);
  CHECK(array->GetNumberOfTuples() == static_cast<vtkIdType>(n));
  CHECK(array->GetNumberOfComponents() == components);
  CHECK(array->GetDataType() == (precision == Precision::single ? VTK_FLOAT : VTK_DOUBLE));
}

// The place of a component in the rows of the upper triangle, found by counting.
std::optional<int> place_in_symmetric(std::array<int, 2> component, int d) {
  int place = 0;
  for (int row = 0; row < d; ++row)
    for (int column = row; column < d; ++column, ++place)
      if (row == component[0] && column == component[1]) return place;
  return {};
}

}  // namespace

TEST_CASE("all arrays come back from the file") {
  for (const Setting& setting : all_settings()) {
    const int d = setting.dimensions;
    const std::uint64_t n = setting.n;
    CAPTURE(d);
    CAPTURE(n);
    CAPTURE(static_cast<int>(setting.compression));
    const Body body = sample_body("water", d, n);
    const auto picture = write_and_read(body, setting);
    REQUIRE(picture != nullptr);
    REQUIRE(picture->GetNumberOfPoints() == static_cast<vtkIdType>(n));
    CHECK(picture->GetPointData()->GetNumberOfArrays() == 7);

    // `expected(particle, component)` is the number in the snapshot, or nothing where the picture has zero.
    const auto check = [&](vtkDataArray* array, int components, auto&& expected) {
      check_array(array, n, components, setting.precision);
      CHECK(differences(array, n, components, [&](std::uint64_t i, int c) {
              const std::optional<double> value = expected(i, c);
              return rounded(value.value_or(0.0), setting.precision);
            }) == 0);
    };
    const auto array = [&](const char* name) { return picture->GetPointData()->GetArray(name); };
    // `component` of field number `field` of the sample.
    const auto sample = [](std::uint64_t i, int component, double field) {
      return std::optional(sample_value(i, static_cast<std::uint32_t>(component), field));
    };

    // A reader of no points is free to choose their type.
    if (n > 0)
      check(picture->GetPoints()->GetData(), 3,
            [&](std::uint64_t i, int c) { return c < d ? sample(i, c, 0) : std::nullopt; });
    check(array("pressure"), 1, [&](std::uint64_t i, int) { return sample(i, 0, 1); });
    check(array("velocity"), 3,
          [&](std::uint64_t i, int c) { return c < d ? sample(i, c, 2) : std::nullopt; });
    check(array("stress"), 6, [&](std::uint64_t i, int c) {
      constexpr std::array<std::array<int, 2>, 6> order{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};
      const auto place = place_in_symmetric(order[static_cast<std::size_t>(c)], d);
      return place ? sample(i, *place, 3) : std::nullopt;
    });
    check(array("deformation_gradient"), 9, [&](std::uint64_t i, int c) {
      const int row = c / 3, column = c % 3;
      return row < d && column < d ? sample(i, row * d + column, 4) : std::nullopt;
    });
    check(array("gates"), 11, [&](std::uint64_t i, int c) { return sample(i, c, 5); });
  }
}

// Data behind the XML's end, which VTK calls appended, keep many installations of ParaView from opening a file.
TEST_CASE("a picture is XML from its first byte to its last") {
  const Body body = sample_body("water", 3, 1000);
  for (const Compression compression : {Compression::fast, Compression::small, Compression::none}) {
    const auto folder = scratch("xml");
    Pictures pictures(folder, 0, Precision::single, compression);
    const std::vector bodies{body.c()};
    pictures.write(snapshot_of(bodies, 3, 0.1, 0));
    const auto file = folder / "water_00000.vtp";
    const auto root =
        vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(file.c_str()));
    REQUIRE(root != nullptr);
    CHECK(root->GetNumberOfNestedElements() == 1);
    CHECK(root->FindNestedElementWithName("AppendedData") == nullptr);
  }
}

TEST_CASE("ids and integer fields keep all 64 bits") {
  const Body body = sample_body("water", 2, 1000);
  const auto picture = write_and_read(body, {2, 1000, Precision::single, Compression::fast});
  REQUIRE(picture != nullptr);
  auto* id = picture->GetPointData()->GetArray("id");
  auto* inlet = picture->GetPointData()->GetArray("inlet");
  REQUIRE(id != nullptr);
  REQUIRE(inlet != nullptr);
  REQUIRE(id->GetDataTypeSize() == 8);
  REQUIRE(inlet->GetDataTypeSize() == 8);
  for (vtkIdType i = 0; i < 1000; ++i) {
    REQUIRE(static_cast<std::int64_t*>(id->GetVoidPointer(i))[0] == body.id()[static_cast<std::size_t>(i)]);
    REQUIRE(static_cast<std::int64_t*>(inlet->GetVoidPointer(i))[0] == i - (1ll << 55));
  }
}

TEST_CASE("every particle is a vertex of its own") {
  for (const std::uint64_t n : {0u, 1u, 5000u}) {
    const auto picture =
        write_and_read(sample_body("water", 3, n), {3, n, Precision::single, Compression::fast});
    REQUIRE(picture != nullptr);
    REQUIRE(picture->GetNumberOfVerts() == static_cast<vtkIdType>(n));
    REQUIRE(picture->GetNumberOfCells() == static_cast<vtkIdType>(n));
    vtkIdType wrong = 0;
    for (vtkIdType i = 0; i < picture->GetNumberOfCells(); ++i) {
      vtkCell* cell = picture->GetCell(i);
      if (cell->GetNumberOfPoints() != 1 || cell->GetPointId(0) != i) ++wrong;
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("components, units, time and defaults for colouring are named") {
  const double time = 0.1 + 0.2;  // must come back with its last bit
  const auto picture =
      write_and_read(sample_body("water", 2, 3), {2, 3, Precision::single, Compression::fast}, time);
  REQUIRE(picture != nullptr);
  auto* arrays = picture->GetPointData();
  const auto names = [&](const char* array) {
    std::string all;
    for (int c = 0; c < arrays->GetArray(array)->GetNumberOfComponents(); ++c)
      all += std::string(arrays->GetArray(array)->GetComponentName(c)) + " ";
    return all;
  };
  CHECK(names("velocity") == "X Y Z ");
  CHECK(names("stress") == "XX YY ZZ XY YZ XZ ");
  CHECK(names("deformation_gradient") == "XX XY XZ YX YY YZ ZX ZY ZZ ");
  auto* information = arrays->GetArray("pressure")->GetInformation();
  REQUIRE(information->Has(vtkDataArray::UNITS_LABEL()));
  CHECK(std::string(information->Get(vtkDataArray::UNITS_LABEL())) == "Pa");
  auto* time_value = picture->GetFieldData()->GetArray("TimeValue");
  REQUIRE(time_value != nullptr);
  CHECK(time_value->GetNumberOfTuples() == 1);
  CHECK(time_value->GetComponent(0, 0) == time);
  REQUIRE(arrays->GetScalars() != nullptr);
  CHECK(std::string(arrays->GetScalars()->GetName()) == "pressure");
  REQUIRE(arrays->GetVectors() != nullptr);
  CHECK(std::string(arrays->GetVectors()->GetName()) == "velocity");
}

TEST_CASE("NaN, infinity and numbers beyond single precision are written as they are") {
  Body body("water", 2, 4);
  std::vector<double> values{std::nan(""), INFINITY, -1e300, 1e-300};
  body.fields().push_back(
      {sizeof(shoal_snapshot_field), SHOAL_SCALAR, SHOAL_DOUBLE, 1, "pressure", "Pa", values.data()});
  for (const Precision precision : {Precision::single, Precision::full}) {
    const auto picture = write_and_read(body, {2, 4, precision, Compression::fast});
    REQUIRE(picture != nullptr);
    auto* array = picture->GetPointData()->GetArray("pressure");
    REQUIRE(array != nullptr);
    CHECK(std::isnan(array->GetComponent(0, 0)));
    CHECK(array->GetComponent(1, 0) == INFINITY);
    CHECK(array->GetComponent(2, 0) == (precision == Precision::single ? -INFINITY : -1e300));
    CHECK(array->GetComponent(3, 0) == (precision == Precision::single ? 0.0 : 1e-300));
  }
}

TEST_CASE("fields named position or id are not written twice") {
  Body body = sample_body("water", 2, 10);
  body.add("position", SHOAL_RANK_VECTOR, "m");
  body.add_integers("id");
  const auto picture = write_and_read(body, {2, 10, Precision::single, Compression::fast});
  REQUIRE(picture != nullptr);
  CHECK(picture->GetPointData()->GetNumberOfArrays() == 7);
  CHECK(picture->GetPointData()->GetArray("position") == nullptr);
  CHECK(static_cast<std::int64_t*>(picture->GetPointData()->GetArray("id")->GetVoidPointer(0))[0] ==
        body.id()[0]);
}

TEST_CASE("the file's compression is what was asked for") {
  const auto folder = scratch("compression");
  const Body body = sample_body("water", 3, 5000);
  const std::vector bodies{body.c()};
  const auto header = [&](Compression compression) {
    Pictures(folder, 0, Precision::single, compression).write(snapshot_of(bodies, 3, 0, 0));
    std::ifstream file(folder / "water_00000.vtp", std::ios::binary);
    std::string line;
    while (std::getline(file, line) && line.find("<VTKFile") == std::string::npos) {
    }
    return line;
  };
  CHECK(header(Compression::fast).find("compressor=\"vtkZLibDataCompressor\"") != std::string::npos);
  const auto fast = std::filesystem::file_size(folder / "water_00000.vtp");
  CHECK(header(Compression::small).find("compressor=\"vtkLZMADataCompressor\"") != std::string::npos);
  const auto small = std::filesystem::file_size(folder / "water_00000.vtp");
  CHECK(header(Compression::none).find("compressor") == std::string::npos);
  const auto none = std::filesystem::file_size(folder / "water_00000.vtp");
  CHECK(small < fast);
  CHECK(fast < none);
}

TEST_CASE("a field that contradicts its rank is refused") {
  Body body = sample_body("water", 2, 10);
  body.fields()[1].components = 3;
  const std::vector bodies{body.c()};
  Pictures pictures(scratch("contradiction"), 0, Precision::single, Compression::fast);
  CHECK_THROWS_WITH_AS(pictures.write(snapshot_of(bodies, 2, 0, 0)),
                       "field 'velocity' of body 'water' has 3 components instead of 2",
                       std::invalid_argument);
  body.fields()[1].components = 2;
  body.fields()[1].data = nullptr;
  CHECK_THROWS_WITH_AS(pictures.write(snapshot_of(bodies, 2, 0, 0)),
                       "field 'velocity' of body 'water' has no data", std::invalid_argument);
}
