// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The value at a point, interpolated with the smoothing kernel of each body (Shepard 1968):
//
//   f(x) = sum_j V_j f_j W(|x - x_j|) / sum_j V_j W(|x - x_j|)
//
// which is exact for constant fields also where particles are on one side only, as at a wall or a free surface.
// V_j is the field `volume`, else mass / density, else spacing^dimensions.
#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "kernel/case/scalars.hpp"
#include "kernel/output/particle_expression.hpp"
#include "kernel/output/probes/own_probes.hpp"
#include "kernel/plugins/host.hpp"
#include "shoal/smoothing_kernel.hpp"

namespace shoal::kernel {
namespace {

constexpr std::uint64_t chunk = 16384;
using Place = std::array<double, 3>;

// A map of a particle to one of its images: x -> sign x + shift along each axis.
struct Image {
  Place sign{1.0, 1.0, 1.0}, shift{};
};

// The domain's images that may matter near its faces, the particles themselves first.
std::vector<Image> images_of(const Domain& domain) {
  std::vector<Image> images{Image{}};
  for (int axis = 0; axis < domain.dimensions; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    std::vector<std::pair<double, double>> maps;
    if (domain.periodic(axis)) {
      maps = {{1.0, domain.length(axis)}, {1.0, -domain.length(axis)}};
    } else {
      if (domain.boundary[axis].lower == BoundaryKind::mirror)
        maps.emplace_back(-1.0, 2.0 * domain.lower[axis]);
      if (domain.boundary[axis].upper == BoundaryKind::mirror)
        maps.emplace_back(-1.0, 2.0 * domain.upper[axis]);
    }
    const std::size_t n = images.size();
    for (const auto& [sign, shift] : maps) {
      for (std::size_t k = 0; k < n; ++k) {
        Image image = images[k];
        image.sign[a] = sign;
        image.shift[a] = shift;
        images.push_back(image);
      }
    }
  }
  return images;
}

struct BodyOfProbe {
  std::uint32_t index;
  double spacing, smoothing_length, cutoff;
  SmoothingKernel kernel;
};

class Point final : public Probe {
 public:
  Point(const shoal_object& object, const ProbeContext& context)
      : name_(context.name), dimensions_(context.dimensions), images_(images_of(context.domain)) {
    parameters_.read(object, context.dimensions);
    for (const std::string& text : parameters_.of.value())
      of_.emplace_back(text, context.parameters, context.dimensions, parameters_.of.place());
    for (const BodyIndex index : parameters_.body.value()) {
      const shoal_body& body = context.bodies[index.value];
      const auto kernel = smoothing_kernel_from_name(body.smoothing_kernel);
      bodies_.push_back({index.value, body.spacing, body.smoothing_length, body.cutoff,
                         kernel.value_or(SmoothingKernel::wendland_c2)});
    }
  }

  std::vector<FieldOfBody> demands() const override {
    std::vector<FieldOfBody> all;
    for (const BodyOfProbe& body : bodies_)
      for (const ParticleExpression& expression : of_)
        for (const std::string& field : expression.fields())
          all.push_back({body.index, field, expression.place()});
    return all;
  }

  void bind(const Simulation& run) override {
    for (const BodyOfProbe& body : bodies_)
      for (ParticleExpression& expression : of_) expression.bind(run, body.index);
    for (const ParticleExpression& expression : of_) {
      const std::string unit =
          parameters_.unit.is_set() ? parameters_.unit.value() : expression.unit(run, bodies_[0].index);
      columns_.push_back({of_.size() == 1 ? name_ : expression.text(), unit});
    }
  }

  std::vector<Column> columns() const override { return columns_; }

  std::vector<double> sample(const Simulation& run) override {
    const Place at = point(run.time());
    std::vector<double> sums(of_.size(), 0.0);
    double total = 0.0;
    for (const BodyOfProbe& body : bodies_) {
      const std::vector<ParticleImage> near = neighbours(run, body, at);
      const std::vector<double> weights = this->weights(run, body, near, at);
      for (const double weight : weights) total += weight;
      for (std::size_t k = 0; k < of_.size(); ++k) {
        const std::vector<double> values = of_[k].evaluate(run, body.index, near);
        for (std::size_t j = 0; j < near.size(); ++j) sums[k] += weights[j] * values[j];
      }
    }
    if (total > 0.0 && total >= parameters_.support) {
      for (double& sum : sums) sum /= total;
    } else {
      warn_once(run.time());
      for (double& sum : sums) sum = std::numeric_limits<double>::quiet_NaN();
    }
    return sums;
  }

 private:
  Place point(double time) const {
    const Place origin{};
    Place at{};
    for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions_); ++k)
      at[k] = parameters_.at->component[k](dimensions_, origin.data(), time);
    return at;
  }

  // In the order of particles, then of images.
  std::vector<ParticleImage> neighbours(const Simulation& run, const BodyOfProbe& body,
                                        const Place& at) const {
    const auto* positions = static_cast<const double*>(run.field(body.index, "position").data);
    const auto dimensions = static_cast<std::size_t>(dimensions_);
    const std::uint64_t n = run.n_particles(body.index);
    std::vector<std::vector<ParticleImage>> found((n + chunk - 1) / chunk);
    tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t c) {
      for (std::uint64_t i = c * chunk; i < std::min(n, (c + 1) * chunk); ++i) {
        for (const Image& image : images_) {
          Place place{};
          double squared = 0.0;
          for (std::size_t k = 0; k < dimensions; ++k) {
            place[k] = image.sign[k] * positions[i * dimensions + k] + image.shift[k];
            squared += (place[k] - at[k]) * (place[k] - at[k]);
          }
          if (squared < body.cutoff * body.cutoff) found[c].push_back({i, place, image.sign});
        }
      }
    });
    std::vector<ParticleImage> all;
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    return all;
  }

  std::vector<double> weights(const Simulation& run, const BodyOfProbe& body,
                              const std::vector<ParticleImage>& near, const Place& at) const {
    const auto scalar = [&](const char* name) -> const double* {
      const std::optional<FieldInfo> info = run.field_info(body.index, name);
      return info && info->rank == SHOAL_SCALAR ? static_cast<const double*>(run.field(body.index, name).data)
                                                : nullptr;
    };
    const double *volume = scalar("volume"), *mass = scalar("mass"), *density = scalar("density");
    const double lattice = std::pow(body.spacing, dimensions_);
    std::vector<double> weights;
    for (const ParticleImage& j : near) {
      const double v = volume != nullptr                       ? volume[j.index]
                       : mass != nullptr && density != nullptr ? mass[j.index] / density[j.index]
                                                               : lattice;
      const double r = std::hypot(j.position[0] - at[0], j.position[1] - at[1], j.position[2] - at[2]);
      const auto w = [&](const auto& kernel) { return kernel.w(r); };
      weights.push_back(v * (dimensions_ == 2 ? with_kernel<2>(body.kernel, body.smoothing_length, w)
                                              : with_kernel<3>(body.kernel, body.smoothing_length, w)));
    }
    return weights;
  }

  void warn_once(double time) {
    if (!std::exchange(warned_, true))
      log(LogLevel::warning, "probe '" + name_ + "': too few particles near its point at " +
                                 format_number(time) + " s; its value is NaN while that is so");
  }

  std::string name_;
  int dimensions_;
  std::vector<Image> images_;
  PointParameters parameters_;
  std::vector<ParticleExpression> of_;
  std::vector<BodyOfProbe> bodies_;
  std::vector<Column> columns_;
  bool warned_ = false;
};

}  // namespace

std::unique_ptr<Probe> make_point(const shoal_object& object, const ProbeContext& context) {
  return std::make_unique<Point>(object, context);
}

}  // namespace shoal::kernel
