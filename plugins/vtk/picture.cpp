// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Copies a snapshot's fields into VTK arrays, component by component.
#include "picture.hpp"

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTypeInt32Array.h>
#include <vtkTypeInt64Array.h>

#include <array>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>

#include "shoal/snapshot.hpp"

namespace shoal::vtk {

namespace {

// Where the components of an array come from: `source[c]` is the place of component c among those of the field,
// or -1 for one that is zero in this number of dimensions.
struct Layout {
  int field_components = 1;
  int array_components = 1;
  std::array<int, 9> source{};
  std::array<const char*, 9> names{};
  bool is_array = false;  // any number of components, as they stand, without names
};

constexpr std::array<const char*, 3> vector_names{"X", "Y", "Z"};

const char* matrix_name(int row, int column) {
  constexpr std::array<std::array<const char*, 3>, 3> names{
      {{"XX", "XY", "XZ"}, {"YX", "YY", "YZ"}, {"ZX", "ZY", "ZZ"}}};
  return names[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
}

void add_component(Layout& layout, const char* name, bool exists, int source) {
  const auto c = static_cast<std::size_t>(layout.array_components++);
  layout.source[c] = exists ? source : -1;
  layout.names[c] = name;
}

Layout make_layout(std::uint32_t rank, int d, std::uint32_t components) {
  Layout layout;
  if (rank == SHOAL_SCALAR) return layout;
  if (rank == SHOAL_ARRAY) {
    layout.is_array = true;
    layout.field_components = layout.array_components = static_cast<int>(components);
    return layout;
  }
  layout.array_components = 0;
  if (rank == SHOAL_RANK_VECTOR) {
    layout.field_components = d;
    for (int a = 0; a < 3; ++a) add_component(layout, vector_names[static_cast<std::size_t>(a)], a < d, a);
  } else if (rank == SHOAL_SYMMETRIC) {
    layout.field_components = d * (d + 1) / 2;
    // VTK's order; the field holds the upper triangle row by row.
    constexpr std::array<std::array<int, 2>, 6> order{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};
    for (const auto& [a, b] : order)
      add_component(layout, matrix_name(a, b), b < d, a * d - a * (a - 1) / 2 + b - a);
  } else if (rank == SHOAL_RANK_MATRIX) {
    layout.field_components = d * d;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) add_component(layout, matrix_name(a, b), a < d && b < d, a * d + b);
  } else {
    throw std::invalid_argument("fields of rank " + std::to_string(rank) +
                                " are not known to the vtk plugin");
  }
  return layout;
}

template <class Array, class In>
vtkSmartPointer<vtkDataArray> copy(const Layout& layout, std::uint64_t n, const In* in) {
  using Out = typename Array::ValueType;
  auto array = vtkSmartPointer<Array>::New();
  const int components = layout.array_components;
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(n));
  if (components > 1 && !layout.is_array)
    for (int c = 0; c < components; ++c)
      array->SetComponentName(c, layout.names[static_cast<std::size_t>(c)]);
  Out* out = array->GetPointer(0);
  for (std::uint64_t i = 0; i < n; ++i, in += layout.field_components)
    for (int c = 0; c < components; ++c) {
      const int source = layout.is_array ? c : layout.source[static_cast<std::size_t>(c)];
      *out++ = source < 0 ? Out{} : static_cast<Out>(in[source]);
    }
  return array;
}

vtkSmartPointer<vtkDataArray> copy_reals(const Layout& layout, std::uint64_t n, const void* data,
                                         Precision precision) {
  const auto* in = static_cast<const double*>(data);
  return precision == Precision::single ? copy<vtkFloatArray>(layout, n, in)
                                        : copy<vtkDoubleArray>(layout, n, in);
}

vtkSmartPointer<vtkDataArray> copy_integers(const Layout& layout, std::uint64_t n, const void* data) {
  return copy<vtkTypeInt64Array>(layout, n, static_cast<const std::int64_t*>(data));
}

vtkSmartPointer<vtkDataArray> make_array(const shoal_snapshot_body& body, const shoal_snapshot_field& field,
                                         int dimensions, Precision precision) {
  const Layout layout = make_layout(field.rank, dimensions, field.components);
  const std::string place = std::string("field '") + field.name + "' of body '" + body.name + "'";
  if (static_cast<int>(field.components) != layout.field_components)
    throw std::invalid_argument(place + " has " + std::to_string(field.components) +
                                " components instead of " + std::to_string(layout.field_components));
  if (body.n_particles > 0 && !field.data) throw std::invalid_argument(place + " has no data");
  auto array = field.data_type == SHOAL_INT64 ? copy_integers(layout, body.n_particles, field.data)
                                              : copy_reals(layout, body.n_particles, field.data, precision);
  array->SetName(field.name);
  if (field.unit) array->GetInformation()->Set(vtkDataArray::UNITS_LABEL(), field.unit);
  return array;
}

// One vertex per particle: cell i is point i. 32 bits where they suffice, since this is a sixth of a file.
vtkSmartPointer<vtkCellArray> make_vertices(std::uint64_t n) {
  auto vertices = vtkSmartPointer<vtkCellArray>::New();
  const auto fill = [&]<class Array>(vtkSmartPointer<Array> offsets, vtkSmartPointer<Array> points) {
    using Value = typename Array::ValueType;
    const auto count = static_cast<vtkIdType>(n);
    offsets->SetNumberOfValues(count + 1);
    points->SetNumberOfValues(count);
    for (vtkIdType i = 0; i <= count; ++i) offsets->SetValue(i, static_cast<Value>(i));
    for (vtkIdType i = 0; i < count; ++i) points->SetValue(i, static_cast<Value>(i));
    vertices->SetData(offsets, points);
  };
  if (n < static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max()))
    fill(vtkSmartPointer<vtkTypeInt32Array>::New(), vtkSmartPointer<vtkTypeInt32Array>::New());
  else
    fill(vtkSmartPointer<vtkTypeInt64Array>::New(), vtkSmartPointer<vtkTypeInt64Array>::New());
  return vertices;
}

// ParaView's readers take the time of a single file from this array.
void add_time(vtkPolyData* picture, double time) {
  const vtkNew<vtkDoubleArray> array;
  array->SetName("TimeValue");
  array->InsertNextValue(time);
  picture->GetFieldData()->AddArray(array);
}

}  // namespace

vtkSmartPointer<vtkPolyData> make_picture(const shoal_snapshot_body& body, int dimensions, double time,
                                          Precision precision) {
  auto picture = vtkSmartPointer<vtkPolyData>::New();
  const std::uint64_t n = body.n_particles;

  const vtkNew<vtkPoints> points;
  points->SetData(copy_reals(make_layout(SHOAL_RANK_VECTOR, dimensions, 1), n, body.position, precision));
  picture->SetPoints(points);
  picture->SetVerts(make_vertices(n));

  auto* arrays = picture->GetPointData();
  const auto id = copy_integers(make_layout(SHOAL_SCALAR, dimensions, 1), n, body.id);
  id->SetName("id");
  arrays->AddArray(id);
  for (const shoal_snapshot_field& field : fields_of(body)) {
    const std::string_view name = field.name;
    if (name == "position" || name == "id") continue;
    arrays->AddArray(make_array(body, field, dimensions, precision));
    // What a viewer colours by, and draws arrows of, when it opens the file: the first that the case names.
    if (field.rank == SHOAL_SCALAR && !arrays->GetScalars()) arrays->SetActiveScalars(field.name);
    if (field.rank == SHOAL_RANK_VECTOR && !arrays->GetVectors()) arrays->SetActiveVectors(field.name);
  }
  add_time(picture, time);
  return picture;
}

}  // namespace shoal::vtk
