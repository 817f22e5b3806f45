// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "wave_speed.hpp"

#include <algorithm>
#include <cmath>

#include "model.hpp"
#include "shoal/host.hpp"

namespace shoal::diffusion {

// Plane waves of a model.
class WaveSpeedCorrection::Waves {
 public:
  Waves(const shoal_object& object, int dimensions)
      : model_(object, dimensions), reaction_(model_.interface()), step_(model_.largest_step()) {
    const double fine = resolved(300, 1.0), coarse = resolved(150, 2.0);
    if (!(fine > 0.0 && coarse > 0.0))
      throw CaseError(std::string(object.place) + ": " + object.type->name +
                      " has no waves that run from where it is excited; leave wave_speed_of out");
    // The error of the second difference is of second order.
    speed_ = fine + (fine - coarse) / 3.0;
  }

  // Speed for D = 1 m2/s, m/s.
  double speed() const { return speed_; }
  // Speed on a line with these weights, 0 if it stays below `slowest`.
  double on_line(std::vector<double> weights, double spacing, double slowest) const {
    const std::size_t nodes = 48;
    return wave_speed(reaction_, {std::move(weights), spacing, step_, nodes,
                                  static_cast<double>(nodes) * spacing / slowest});
  }

 private:
  // With a spacing that diffuses in half a step (times `width`), and quarters of the step.
  double resolved(std::size_t nodes, double width) const {
    const double dx = width * std::sqrt(0.5 * step_);
    return wave_speed(reaction_, {second_difference(1.0, dx), dx, 0.25 * step_, nodes, 1e4 * step_});
  }

  Model model_;
  ReactionIntegrator reaction_;
  double step_;
  double speed_ = 0;
};

WaveSpeedCorrection::WaveSpeedCorrection(const shoal_object& model, int dimensions, double spacing,
                                         LineWeights weights)
    : dimensions_(dimensions),
      spacing_(spacing),
      weights_(std::move(weights)),
      waves_(std::make_unique<const Waves>(model, dimensions)),
      place_(model.place) {}
WaveSpeedCorrection::~WaveSpeedCorrection() = default;

AxisValues WaveSpeedCorrection::operator()(const AxisValues& d) const {
  // Values that differ by rounding alone, e.g. after a rotation, are one.
  AxisValues key{};
  for (std::size_t a = 0; a < 3; ++a) {
    int exponent = 0;
    const double mantissa = std::frexp(d[a], &exponent);
    key[a] = std::ldexp(std::round(mantissa * 1e9) / 1e9, exponent);
  }
  const std::lock_guard lock(mutex_);
  const auto found = known_.find(key);
  if (found != known_.end()) return found->second;
  if (known_.size() >= 8)
    throw CaseError(
        place_ +
        ": wave_speed_of needs coefficients whose values along and across the fibres are the same "
        "everywhere (their directions may vary); it found more than 8 different ones");
  return known_[key] = corrected(key);
}

// The weights along one axis depend on the values on the others too, hence the rounds.
AxisValues WaveSpeedCorrection::corrected(const AxisValues& d) const {
  AxisValues result = d;
  for (double change = 1.0; change > 1e-3;) {
    const AxisValues last = result;
    change = 0.0;
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(dimensions_); ++axis) {
      const auto same = std::find(d.begin(), d.begin() + static_cast<std::ptrdiff_t>(axis), d[axis]);
      const auto twin = static_cast<std::size_t>(same - d.begin());
      result[axis] = twin < axis ? result[twin] : corrected(d, last, axis);
      change = std::max(change, std::abs(result[axis] / last[axis] - 1.0));
    }
  }
  return result;
}

// Root of log(c_dx(D') / target) over log D': secants within a bracket (Illinois), after steps of 1.5 to find one.
double WaveSpeedCorrection::corrected(const AxisValues& d, const AxisValues& guess, std::size_t axis) const {
  const double target = std::sqrt(d[axis]) * waves_->speed();
  const auto excess = [&](double value) {
    AxisValues trial = guess;
    // Axes with the same value change together.
    for (std::size_t a = 0; a < 3; ++a)
      if (d[a] == d[axis]) trial[a] = value;
    return std::log(std::max(0.1, waves_->on_line(weights_(trial, axis), spacing_, 0.1 * target) / target));
  };
  double low = guess[axis], at_low = excess(low);
  const double factor = at_low > 0.0 ? 1.0 / 1.5 : 1.5;
  double high = low, at_high = at_low;
  while (at_low * at_high > 0.0) {
    low = high, at_low = at_high;
    at_high = excess(high *= factor);
    if (high > 1e3 * d[axis] || high < 1e-3 * d[axis])
      throw CaseError(place_ +
                      ": the spacing is too coarse for wave_speed_of: no coefficient gives the wave of "
                      "this reaction its speed; refine the resolution");
  }
  for (int k = 0; k < 40 && std::abs(std::log(high / low)) > 1e-4; ++k) {
    const double x = std::log(low) - at_low * std::log(high / low) / (at_high - at_low), middle = std::exp(x);
    const double at_middle = excess(middle);
    if (std::abs(at_middle) < 1e-4) return middle;
    if (at_middle * at_high < 0.0) {
      low = high, at_low = at_high;
    } else {
      at_low *= 0.5;
    }
    high = middle, at_high = at_middle;
  }
  return high;
}

namespace {

// Turns a symmetric tensor to its axes by Jacobi's rotations: tensor = axes^T diagonal axes, rows of `axes` the axes.
template <int D>
void to_axes(Mat<D>& tensor, Mat<D>& axes) {
  axes = identity<D>();
  for (int sweep = 0; sweep < 30; ++sweep)
    for (int a = 0; a < D; ++a)
      for (int b = a + 1; b < D; ++b) {
        if (std::abs(tensor(a, b)) <= 1e-16 * trace(tensor)) continue;
        const double angle = 0.5 * std::atan2(2.0 * tensor(a, b), tensor(a, a) - tensor(b, b));
        const double c = std::cos(angle), s = std::sin(angle);
        Mat<D> turn = identity<D>();
        turn(a, a) = turn(b, b) = c;
        turn(a, b) = s;
        turn(b, a) = -s;
        tensor = turn * tensor * transpose(turn);
        axes = turn * axes;
      }
}

}  // namespace

template <int D>
Mat<D> WaveSpeedCorrection::operator()(const Mat<D>& tensor) const {
  Mat<D> diagonal = tensor, axes;
  to_axes(diagonal, axes);
  AxisValues d{};
  for (int a = 0; a < D; ++a) d[static_cast<std::size_t>(a)] = diagonal(a, a);
  const AxisValues raised = (*this)(d);
  diagonal = Mat<D>{};
  for (int a = 0; a < D; ++a) diagonal(a, a) = raised[static_cast<std::size_t>(a)];
  return transpose(axes) * diagonal * axes;
}
template Mat<2> WaveSpeedCorrection::operator()<2>(const Mat<2>& tensor) const;
template Mat<3> WaveSpeedCorrection::operator()<3>(const Mat<3>& tensor) const;

}  // namespace shoal::diffusion
