// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/case/assemble.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "kernel/case/arrange.hpp"
#include "kernel/case/shapes.hpp"
#include "kernel/plugins/abi_reading.hpp"
#include "kernel/plugins/host.hpp"
#include "shoal/smoothing_kernel.hpp"

namespace shoal::kernel {

/// The materials of the bodies, made by their plugins when a physics first asks for one.
class Materials {
 public:
  explicit Materials(int dimensions) : dimensions_(dimensions) {}
  Materials(const Materials&) = delete;
  Materials& operator=(const Materials&) = delete;
  ~Materials() {
    for (auto& [object, made] : made_)
      if (made.api.destroy != nullptr) made.api.destroy(made.self);
  }

  void find(const shoal_object* material, const char* name, std::uint32_t revision, const void** api,
            void** self) {
    *api = nullptr;
    *self = nullptr;
    if (material == nullptr) return;
    auto found = made_.find(material);
    if (found == made_.end()) found = made_.emplace(material, make(*material)).first;
    const std::string type = material->type->name;
    call_plugin(type.substr(0, type.find('.')), type,
                [&] { *api = found->second.api.interface(found->second.self, name, revision); });
    *self = found->second.self;
  }

 private:
  struct Made {
    shoal_material_api api;
    void* self = nullptr;
  };

  Made make(const shoal_object& material) const {
    const std::string type = material.type->name;
    Made made{abi_copy(static_cast<const shoal_material_api*>(material.type->api))};
    try {
      call_plugin(type.substr(0, type.find('.')), type,
                  [&] { return made.api.create(&material, dimensions_, &made.self); });
    } catch (const PluginFailure& failure) {
      // The physics that asked for the material must not turn what is wrong in the case into a fault of its own.
      if (failure.status() != SHOAL_CASE_ERROR) throw;
      throw ModelError(failure.what());
    }
    return made;
  }

  int dimensions_;
  std::map<const shoal_object*, Made> made_;
};

Assembly::Assembly() = default;
Assembly::~Assembly() = default;
Assembly::Assembly(Assembly&&) noexcept = default;

namespace {

SimulationSettings settings_of(const CaseModel& model, const AssemblyOptions& options) {
  SimulationSettings settings;
  settings.dimensions = model.dimensions;
  settings.end_time = model.run.end;
  settings.threads = options.threads;
  settings.failures = {plugin_host().fail, take_failure_text};
  settings.take_finish = take_finish_reason;
  for (const auto& [loop, factor] : model.run.time_step_factors) settings.time_step_factors[loop] = factor;
  for (std::size_t k = 0; k < static_cast<std::size_t>(model.dimensions); ++k) {
    settings.gravity[k] = model.gravity[k];
    if (std::isfinite(model.domain.lower[k])) settings.lower[k] = model.domain.lower[k];
    if (std::isfinite(model.domain.upper[k])) settings.upper[k] = model.domain.upper[k];
    AxisBoundary& boundary = settings.boundaries[k];
    if (model.domain.periodic[k]) boundary = {BoundaryKind::periodic, BoundaryKind::periodic};
    if (model.domain.mirror_lower[k]) boundary.lower = BoundaryKind::mirror;
    if (model.domain.mirror_upper[k]) boundary.upper = BoundaryKind::mirror;
  }
  return settings;
}

shoal_rank rank_of(const InitialValue& value, int dimensions) {
  const auto n = static_cast<int>(value.components.size());
  if (n == 1) return SHOAL_SCALAR;
  if (n == dimensions) return SHOAL_RANK_VECTOR;
  if (n == dimensions * (dimensions + 1) / 2) return SHOAL_SYMMETRIC;
  if (n == dimensions * dimensions) return SHOAL_RANK_MATRIX;
  throw ModelError("'" + value.field + "' is given " + std::to_string(n) + " components; in " +
                       std::to_string(dimensions) + " dimensions a field has 1 (a number), " +
                       std::to_string(dimensions) + " (a vector), " +
                       std::to_string(dimensions * (dimensions + 1) / 2) + " (a symmetric matrix) or " +
                       std::to_string(dimensions * dimensions) + " (a matrix)",
                   value.place);
}

InitialField initial_field(const InitialValue& value, int dimensions) {
  const auto evaluate = [&value, dimensions](std::uint64_t n, const double* positions, double* out) {
    const std::size_t components = value.components.size();
    std::vector<double> column(n);
    for (std::size_t c = 0; c < components; ++c) {
      value.components[c].evaluate(dimensions, n, positions, 0.0, column.data());
      for (std::uint64_t i = 0; i < n; ++i) out[i * components + c] = column[i];
    }
  };
  return {value.field, rank_of(value, dimensions), evaluate, value.place, false};
}

// What the body's shape knows of its particles, for operators that ask. Of a shell it is the face that it turns to
// what it lines, also for the particles at its back.
void add_fields_of_shape(const BodyModel& body, int dimensions, std::vector<InitialField>& fields) {
  if (body.shape == nullptr) return;
  const ShapePtr shape = make_shape(*body.shape, dimensions);
  const auto for_each_point = [dimensions](std::uint64_t n, const double* positions, auto&& visit) {
    const auto d = static_cast<std::uint64_t>(dimensions);
    for (std::uint64_t i = 0; i < n; ++i) {
      Point point{};
      std::copy_n(positions + i * d, d, point.begin());
      visit(i, point);
    }
  };
  fields.push_back({"normal", SHOAL_RANK_VECTOR,
                    [=](std::uint64_t n, const double* positions, double* out) {
                      for_each_point(n, positions, [&](std::uint64_t i, const Point& point) {
                        const Point normal = shape->face(point).normal;
                        std::copy_n(normal.begin(), dimensions,
                                    out + i * static_cast<std::uint64_t>(dimensions));
                      });
                    },
                    body.place, true});
  fields.push_back({"signed_distance", SHOAL_SCALAR,
                    [=](std::uint64_t n, const double* positions, double* out) {
                      for_each_point(n, positions, [&](std::uint64_t i, const Point& point) {
                        out[i] = shape->face(point).distance;
                      });
                    },
                    body.place, true});
}

BodySpecification specification_of(const BodyModel& body, const std::vector<Point>& points, int dimensions) {
  BodySpecification specification;
  const std::optional<SmoothingKernel> kernel = smoothing_kernel_from_name(body.smoothing_kernel);
  if (!kernel) throw ModelError("there is no smoothing kernel '" + body.smoothing_kernel + "'", body.place);
  specification.name = body.name;
  specification.place = body.place;
  specification.spacing = body.resolution;
  specification.smoothing_length = body.smoothing_ratio * body.resolution;
  specification.cutoff = cutoff_radius(*kernel, specification.smoothing_length);
  specification.smoothing_kernel = body.smoothing_kernel;
  specification.material = body.material;
  specification.positions.reserve(points.size() * static_cast<std::size_t>(dimensions));
  for (const Point& point : points)
    specification.positions.insert(specification.positions.end(), point.begin(), point.begin() + dimensions);
  add_fields_of_shape(body, dimensions, specification.initial_fields);
  for (const InitialValue& value : body.initial)
    specification.initial_fields.push_back(initial_field(value, dimensions));
  return specification;
}

std::string plugin_of(const shoal_object& object) {
  const std::string type = object.type->name;
  return type.substr(0, type.find('.'));
}

// In the order of the case, but for physics of plugins that others require.
std::vector<const shoal_object*> in_order(std::vector<const shoal_object*> waiting,
                                          const AssemblyOptions& options) {
  if (!options.requires_plugin) return waiting;
  std::vector<const shoal_object*> ordered;
  while (!waiting.empty()) {
    auto next = std::find_if(waiting.begin(), waiting.end(), [&](const shoal_object* one) {
      return std::none_of(waiting.begin(), waiting.end(), [&](const shoal_object* other) {
        return plugin_of(*other) != plugin_of(*one) &&
               options.requires_plugin(plugin_of(*one), plugin_of(*other));
      });
    });
    if (next == waiting.end()) next = waiting.begin();
    ordered.push_back(*next);
    waiting.erase(next);
  }
  return ordered;
}

void build(const shoal_object& physics, Simulation& run) {
  const std::string type = physics.type->name;
  const auto api = abi_copy(static_cast<const shoal_physics_api*>(physics.type->api));
  run.set_declarer(type + " (" + physics.place + ")");
  try {
    call_plugin(plugin_of(physics), type, [&] { return api.build(&physics, run.builder()); });
  } catch (const PluginFailure& failure) {
    if (failure.status() == SHOAL_CASE_ERROR) throw ModelError(failure.text(), physics.place);
    throw;
  }
}

}  // namespace

Assembly assemble(const CaseModel& model, const AssemblyOptions& options) {
  const std::vector<std::vector<Point>> points = arrange_particles(model, options.skip_relaxation);
  Assembly assembly;
  assembly.materials = std::make_unique<Materials>(model.dimensions);
  assembly.run = std::make_unique<Simulation>(settings_of(model, options));
  for (std::size_t k = 0; k < model.bodies.size(); ++k)
    assembly.run->add_body(specification_of(model.bodies[k], points[k], model.dimensions));
  assembly.run->set_material_interface_lookup(
      [materials = assembly.materials.get()](const shoal_object* material, const char* name,
                                             std::uint32_t revision, const void** api, void** self) {
        materials->find(material, name, revision, api, self);
      });
  for (const shoal_object* physics : in_order(model.physics, options)) build(*physics, *assembly.run);
  return assembly;
}

}  // namespace shoal::kernel
