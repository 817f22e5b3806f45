// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The value at a point, interpolated with the smoothing kernel of each body (Shepard 1968):
//
//   f(x) = sum_j V_j f_j W(|x - x_j|) / sum_j V_j W(|x - x_j|)
//
// which is exact for constant fields also where particles are on one side only, as at a wall or a free surface. With
// `linear` it is the value at x of the straight line, plane or space fitted with the same weights w_j = V_j W,
//
//   f(x) = sum_j w_j (1 - m . C^-1 (d_j - m)) f_j / sum_j w_j,   d_j = x_j - x,   m, C their mean and covariance
//
// exact for linear fields, so that it reaches the surface half a spacing beyond the last particles; where particles do
// not span all directions it is the plain one.
// V_j is the field `volume`, else mass / density, else spacing^dimensions. A gauge is the mean over a disc.
#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "kernel/case/scalars.hpp"
#include "kernel/output/particle_expression.hpp"
#include "kernel/output/probes/own_probes.hpp"
#include "kernel/particles/errors.hpp"
#include "kernel/plugins/host.hpp"
#include "shoal/smoothing_kernel.hpp"
#include "shoal/vec.hpp"

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

// Where a value is taken, from the probe's point, and its share.
struct Spot {
  Place offset{};
  double weight = 1.0;
};

Place cross(const Place& a, const Place& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// A disc across `normal` in equal cells, of which those count whose middle is in it; in 2D its diameter, each place
// with the length of the chord there.
std::vector<Spot> disc(const Place& normal, double diameter, int dimensions) {
  constexpr int n = 10;
  const double length = std::hypot(normal[0], normal[1], normal[2]);
  const Place axis{normal[0] / length, normal[1] / length, normal[2] / length};
  const Place off = std::abs(axis[2]) < 0.5 ? Place{0.0, 0.0, 1.0} : Place{1.0, 0.0, 0.0};
  const Place b = cross(axis, off);
  const double b_length = std::hypot(b[0], b[1], b[2]);
  const Place t{b[0] / b_length, b[1] / b_length, b[2] / b_length}, u = cross(axis, t);
  std::vector<Spot> spots;
  for (int k = 0; k < n; ++k)
    for (int m = 0; m < (dimensions == 3 ? n : 1); ++m) {
      const double x = (2.0 * k + 1.0) / n - 1.0, y = dimensions == 3 ? (2.0 * m + 1.0) / n - 1.0 : 0.0;
      if (x * x + y * y > 1.0) continue;
      Spot spot{{}, dimensions == 3 ? 1.0 : std::sqrt(1.0 - x * x)};
      for (std::size_t a = 0; a < 3; ++a) spot.offset[a] = 0.5 * diameter * (x * t[a] + y * u[a]);
      spots.push_back(spot);
    }
  return spots;
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
    read_disc();
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
    const Place centre = point(run.time());
    const double reach = parameters_.diameter.is_set() ? 0.5 * parameters_.diameter : 0.0;
    const std::vector<Near> near = this->near(run, centre, reach);
    std::vector<double> sums(of_.size(), 0.0);
    double total = 0.0;
    for (const Spot& spot : spots_) {
      const Place at{centre[0] + spot.offset[0], centre[1] + spot.offset[1], centre[2] + spot.offset[2]};
      std::vector<double> values = interpolate(near, at);
      if (values.empty() && parameters_.empty.is_set())
        values.assign(of_.size(), static_cast<double>(parameters_.empty));
      if (values.empty()) continue;
      total += spot.weight;
      for (std::size_t k = 0; k < of_.size(); ++k) sums[k] += spot.weight * values[k];
    }
    if (total == 0.0) warn_once(run.time());
    for (double& sum : sums) sum = total > 0.0 ? sum / total : std::numeric_limits<double>::quiet_NaN();
    return sums;
  }

 private:
  void read_disc() {
    if (!parameters_.diameter.is_set()) {
      spots_ = {Spot{}};
      return;
    }
    if (!parameters_.normal.is_set() || parameters_.normal.value() == Place{})
      throw ModelError("the disc of probe '" + name_ + "' needs its axis, e.g. normal: [1, 0]",
                       parameters_.diameter.place());
    spots_ = disc(parameters_.normal, parameters_.diameter, dimensions_);
  }

  Place point(double time) const {
    const Place origin{};
    Place at{};
    for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions_); ++k)
      at[k] = parameters_.at->component[k](dimensions_, origin.data(), time);
    return at;
  }

  // Particles of one body near the point, with their volumes and values.
  struct Near {
    const BodyOfProbe* body;
    std::vector<ParticleImage> particles;
    std::vector<double> volumes;
    std::vector<std::vector<double>> values;  // of each expression
  };

  std::vector<Near> near(const Simulation& run, const Place& centre, double reach) {
    std::vector<Near> all;
    for (const BodyOfProbe& body : bodies_) {
      Near near{&body, neighbours(run, body, centre, body.cutoff + reach), {}, {}};
      near.volumes = volumes(run, body, near.particles);
      for (const ParticleExpression& expression : of_)
        near.values.push_back(expression.evaluate(run, body.index, near.particles));
      all.push_back(std::move(near));
    }
    return all;
  }

  // Nothing where there are too few particles.
  std::vector<double> interpolate(const std::vector<Near>& near, const Place& at) const {
    std::vector<double> sums(of_.size(), 0.0);
    const std::vector<double> weights = weights_of(near, at);
    double total = 0.0;
    for (const double weight : weights) total += weight;
    if (!(total > 0.0 && total >= parameters_.support)) return {};
    const auto fit = parameters_.linear ? fit_of(near, at, weights, total) : std::nullopt;
    std::size_t n = 0;
    for (const Near& body : near)
      for (std::size_t j = 0; j < body.particles.size(); ++j, ++n) {
        const double factor = fit ? fit->factor(body.particles[j].position, at) : 1.0;
        for (std::size_t k = 0; k < of_.size(); ++k) sums[k] += weights[n] * factor * body.values[k][j];
      }
    for (double& sum : sums) sum /= total;
    return sums;
  }

  std::vector<double> weights_of(const std::vector<Near>& near, const Place& at) const {
    std::vector<double> weights;
    for (const Near& body : near)
      for (std::size_t j = 0; j < body.particles.size(); ++j)
        weights.push_back(body.volumes[j] * w(*body.body, body.particles[j].position, at));
    return weights;
  }

  // m and C^-1 m
  struct LinearFit {
    Vec<3> mean{}, slope{};
    double factor(const Place& x, const Place& at) const { return 1.0 - dot(slope, offset(x, at) - mean); }
  };

  static Vec<3> offset(const Place& x, const Place& at) {
    Vec<3> d{};
    for (int a = 0; a < 3; ++a) d[a] = x[static_cast<std::size_t>(a)] - at[static_cast<std::size_t>(a)];
    return d;
  }

  std::optional<LinearFit> fit_of(const std::vector<Near>& near, const Place& at,
                                  const std::vector<double>& weights, double total) const {
    LinearFit fit;
    Mat<3> covariance{};
    std::size_t n = 0;
    for (const Near& body : near)
      for (const ParticleImage& j : body.particles) fit.mean += weights[n++] / total * offset(j.position, at);
    n = 0;
    for (const Near& body : near)
      for (const ParticleImage& j : body.particles) {
        const Vec<3> d = offset(j.position, at) - fit.mean;
        covariance += weights[n++] / total * outer(d, d);
      }
    const double scale = trace(covariance) / dimensions_;
    if (dimensions_ == 2) covariance(2, 2) = scale;
    if (!(determinant(covariance) > 1e-6 * scale * scale * scale)) return std::nullopt;
    fit.slope = inverse(covariance) * fit.mean;
    return fit;
  }

  double w(const BodyOfProbe& body, const Place& a, const Place& b) const {
    const double r = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    const auto value = [&](const auto& kernel) { return kernel.w(r); };
    return dimensions_ == 2 ? with_kernel<2>(body.kernel, body.smoothing_length, value)
                            : with_kernel<3>(body.kernel, body.smoothing_length, value);
  }

  // In the order of particles, then of images.
  std::vector<ParticleImage> neighbours(const Simulation& run, const BodyOfProbe& body, const Place& at,
                                        double radius) const {
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
          if (squared < radius * radius) found[c].push_back({i, place, image.sign});
        }
      }
    });
    std::vector<ParticleImage> all;
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    return all;
  }

  std::vector<double> volumes(const Simulation& run, const BodyOfProbe& body,
                              const std::vector<ParticleImage>& near) const {
    const auto scalar = [&](const char* name) -> const double* {
      const std::optional<FieldInfo> info = run.field_info(body.index, name);
      return info && info->rank == SHOAL_SCALAR ? static_cast<const double*>(run.field(body.index, name).data)
                                                : nullptr;
    };
    const double *volume = scalar("volume"), *mass = scalar("mass"), *density = scalar("density");
    const double lattice = std::pow(body.spacing, dimensions_);
    std::vector<double> all;
    for (const ParticleImage& j : near)
      all.push_back(volume != nullptr                       ? volume[j.index]
                    : mass != nullptr && density != nullptr ? mass[j.index] / density[j.index]
                                                            : lattice);
    return all;
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
  std::vector<Spot> spots_;
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
