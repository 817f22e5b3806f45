// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "diffusion.hpp"

#include <cmath>
#include <string_view>

#include "conductivity.hpp"
#include "fit.hpp"
#include "integrator.hpp"
#include "limiter.hpp"
#include "line_weights.hpp"
#include "pairwise.hpp"
#include "source.hpp"
#include "stencil.hpp"
#include "step.hpp"
#include "surface.hpp"

namespace shoal::diffusion {
namespace {

constexpr At at_start{SHOAL_INITIAL, "state"};
constexpr At at_before{"diffusion", "before"};
constexpr At at_diffuse{"diffusion", "diffuse"};

// A body with its medium.
struct BodyOfMedium {
  BodyIndex index;
  std::unique_ptr<AnyMedium> medium;
  std::shared_ptr<Motion> motion = std::make_shared<Motion>();
};

std::unique_ptr<AnyMedium> medium_of(const Builder& b, const Diffusion& physics, BodyIndex index) {
  const shoal_body& body = b.body(index);
  std::unique_ptr<AnyMedium> medium;
  if (body.material != nullptr) medium = read_medium(*body.material, b.dimensions());
  if (!medium && physics.medium.is_set()) {
    medium = read_medium(*physics.medium->object, b.dimensions());
    if (!medium)
      throw CaseError(physics.medium.place() + ": " + physics.medium->object->type->name +
                      " is no medium for diffusion; there are diffusion.medium and diffusion.conductor");
  }
  if (!medium)
    throw CaseError(std::string("body '") + body.name +
                    "' needs a medium: material: {diffusion.medium: {diffusivity: ...}}, or, where its "
                    "material is of another plugin, medium: {diffusion.medium: ...} in diffusion.diffusion");
  return medium;
}

template <class Kind>
void read_condition(const shoal_object& object, int dimensions, std::string_view type,
                    std::vector<Condition>& to) {
  if (object.type->name != type) return;
  Kind kind;
  kind.read(object, dimensions);
  to.push_back(kind.condition());
}

std::vector<Condition> conditions_of(const Diffusion& physics, int dimensions) {
  std::vector<Condition> conditions;
  for (const ObjectHandle& handle : physics.boundaries.value()) {
    const std::size_t before = conditions.size();
    read_condition<FixedValue>(*handle.object, dimensions, "diffusion.fixed_value", conditions);
    read_condition<Flux>(*handle.object, dimensions, "diffusion.flux", conditions);
    read_condition<Convection>(*handle.object, dimensions, "diffusion.convection", conditions);
    if (conditions.size() == before)
      throw CaseError(std::string(handle.object->place) + ": " + handle.object->type->name +
                      " is no condition at a surface; there are diffusion.fixed_value, diffusion.flux and "
                      "diffusion.convection");
  }
  return conditions;
}

// What is attached for one field on all bodies.
class OneField {
 public:
  OneField(const Builder& b, const Diffusion& physics, const std::vector<BodyOfMedium>& bodies,
           const std::vector<BodyOfMedium>& walls, const std::vector<Condition>& conditions,
           std::string field, std::size_t number)
      : b_(b),
        physics_(physics),
        bodies_(bodies),
        walls_(walls),
        conditions_(conditions),
        field_(std::move(field)),
        number_(number),
        loop_("diffusion_of_" + field_ + "_in_" + b.body(bodies.front().index).name) {
    for (const BodyOfMedium& body : bodies_) {
      media_.push_back(body.medium->conductivity(number));
      isotropic_ = isotropic_ && media_.back().isotropic();
    }
  }

  void attach() {
    b_.loop(loop_.c_str(), at_diffuse, {"rate", "update"});
    const At at_rate{loop_.c_str(), "rate"}, at_update{loop_.c_str(), "update"};
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      attach_conductivity(k);
      if (has_surface() && !moving()) attach_surface(k, at_rate);
    }
    for (const BodyOfMedium& wall : walls_) attach_wall(wall);
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      const BodyIndex body = bodies_[k].index;
      b_.own_field(body, rate_of(field_).c_str(), at_rate);
      b_.guard(body, field_.c_str(), -HUGE_VAL, HUGE_VAL);  // NaN stops the run
      attach_stencil(k, at_rate);
    }
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      const BodyIndex body = bodies_[k].index;
      if (limited())  // after the limiters of all bodies
        b_.attach<ApplyLimited>("diffusion.rate", at_rate, target_of(k),
                                [&](auto& op) { op.set(field_, stencils_[k], !conditions_.empty()); });
      attach_source(k, at_rate);
      const auto setup = [&](auto& op) {
        op.set(field_);
        op.stages = stages_;
      };
      if (integrator() == Integrator::rk2)
        b_.attach<HeunStage>("diffusion.rk2", at_update, b_.target(body), setup);
      else
        b_.attach<SuperStage>("diffusion.stage", at_update, b_.target(body), setup);
    }
    b_.attach<InnerStep>("diffusion.stages", at_update, b_.target(bodies_.front().index),
                         [&](auto& op) { op.stages = stages_; });
    attach_step();
  }

 private:
  bool conservative() const { return physics_.scheme.value() == "conservative"; }
  bool moving() const { return physics_.inside.is_set(); }
  // Walls have no limiter of their own.
  bool limited() const { return physics_.scheme.value() == "monotone" && walls_.empty(); }

  void attach_conductivity(std::size_t k) const {
    attach_conductivity(bodies_[k].index, media_[k], wave_speed_correction(k));
  }
  void attach_conductivity(BodyIndex body, const Conductivity& medium,
                           const std::shared_ptr<const WaveSpeedCorrection>& correction = nullptr) const {
    const auto setup = [&](auto& op) {
      op.set(field_, medium);
      op.correction = correction;
    };
    const Target target = b_.target(body);
    if (isotropic_)
      b_.attach<ScalarConductivity>("diffusion.coefficient", at_start, target, setup);
    else
      b_.attach<TensorConductivity>("diffusion.coefficient", at_start, target, setup);
  }

  std::shared_ptr<const WaveSpeedCorrection> wave_speed_correction(std::size_t k) const {
    if (!physics_.wave_speed_of.is_set()) return nullptr;
    if (bodies_[k].medium->capacity() != 1.0)
      throw CaseError(physics_.wave_speed_of.place() +
                      ": wave_speed_of works on bodies of diffusion.medium, whose capacity is 1");
    if (physics_.scheme.value() == "monotone")
      throw CaseError(physics_.wave_speed_of.place() +
                      ": wave_speed_of knows the schemes accurate and conservative, not monotone");
    const Target target = b_.target(bodies_[k].index);
    const auto weights = [target, isotropic = isotropic_, dimensions = b_.dimensions(),
                          accurate = physics_.scheme.value() == "accurate"](const AxisValues& d,
                                                                            std::size_t axis) {
      std::vector<double> line;
      const auto fill = [&]<int D>() {
        with_kernel<D>(target.smoothing_kernel, target.smoothing_length, [&](const auto& kernel) {
          if (accurate) line = fit_line_weights<D>(kernel, target.spacing, d, axis);
          if (line.empty()) line = pairwise_line_weights<D>(kernel, target.spacing, isotropic, d, axis);
        });
      };
      dimensions == 2 ? fill.template operator()<2>() : fill.template operator()<3>();
      return line;
    };
    return std::make_shared<const WaveSpeedCorrection>(*physics_.wave_speed_of->object, b_.dimensions(),
                                                       target.spacing, weights);
  }

  // The body with all bodies of the physics as neighbours, itself first.
  Target target_of(std::size_t k) const {
    std::vector<BodyIndex> neighbours{bodies_[k].index};
    for (std::size_t other = 0; other < bodies_.size(); ++other)
      if (other != k) neighbours.push_back(bodies_[other].index);
    for (const BodyOfMedium& wall : walls_) neighbours.push_back(wall.index);
    Target target = b_.target(bodies_[k].index, neighbours);
    // Pairs are antisymmetric only if both bodies see them with one smoothing length.
    if (conservative())
      for (const BodyOfMedium& other : bodies_) {
        target.smoothing_length = std::max(target.smoothing_length, b_.body(other.index).smoothing_length);
        target.cutoff = std::max(target.cutoff, b_.body(other.index).cutoff);
      }
    return target;
  }

  Integrator integrator() const {
    const std::string& word = physics_.integrator->word;
    return word == "rk2" ? Integrator::rk2 : word == "rkl2" ? Integrator::rkl2 : Integrator::automatic;
  }

  void attach_step() const {
    const char* first = b_.body(bodies_.front().index).name;
    b_.attach<OuterStep>("diffusion.step", at_before, b_.target(bodies_.front().index), [&](auto& op) {
      op.stencils = stencils_;
      op.stages = stages_;
      op.integrator = integrator();
      op.cfl = physics_.cfl;
      op.accuracy = physics_.accuracy;
      op.duration = b_.end_time();
      op.what = field_ + " in " + first;
      for (const BodyOfMedium& body : bodies_)
        op.particles += static_cast<double>(b_.body(body.index).n_particles);
      op.expressions = int{!conditions_.empty()} + int{physics_.source.is_set()};
      op.others = OtherWork::of(b_);
    });
    if (integrator() == Integrator::automatic)
      b_.note(field_ + " in " + first +
              ": in each step rkl2 where it costs less than rk2 for the accuracy; the end of the run says "
              "which it was, and why");
  }

  void attach_stencil(std::size_t k, At at_rate) {
    const auto stencil = std::make_shared<Stencil>();
    stencils_.push_back(stencil);
    stencil->limited = limited();
    stencil->motions.push_back(bodies_[k].motion);
    for (std::size_t other = 0; other < bodies_.size(); ++other)
      if (other != k) stencil->motions.push_back(bodies_[other].motion);
    for (const BodyOfMedium& wall : walls_) stencil->motions.push_back(wall.motion);
    if (conservative())
      attach_weights<PairwiseWeights>(k, stencil);
    else
      attach_weights<FitWeights>(k, stencil);
    if (limited()) {
      b_.attach<LimiterBounds>("diffusion.limiter", at_rate, target_of(k),
                               [&](auto& op) { op.set(field_, stencil, !conditions_.empty()); });
      return;
    }
    b_.attach<ApplyStencil>("diffusion.rate", at_rate, target_of(k),
                            [&](auto& op) { op.set(field_, stencil); });
    if (!conditions_.empty())
      b_.attach<ApplySurface>("diffusion.rate.surface", at_rate, b_.target(bodies_[k].index),
                              [&](auto& op) { op.set(field_, stencil); });
  }

  void attach_source(std::size_t k, At at_rate) const {
    if (!physics_.source.is_set()) return;
    const std::vector<Expression>& sources = physics_.source;
    b_.attach<Source>("diffusion.source", at_rate, b_.target(bodies_[k].index), [&](auto& op) {
      op.set(field_);
      op.density = sources[std::min(number_, sources.size() - 1)];
      op.capacity = bodies_[k].medium->capacity();
      op.stages = stages_;
    });
  }

  template <class Weights>
  void attach_weights(std::size_t k, const std::shared_ptr<Stencil>& stencil) const {
    for (const At at : {at_start, at_before}) {
      if (conservative() && physics_.gradient_correction && (moving() || at.loop == at_start.loop))
        b_.attach<GradientCorrection>("diffusion.correction", at, target_of(k));
      b_.attach<Weights>("diffusion.weights", at, target_of(k), [&](auto& op) {
        op.set(field_, isotropic_, stencil);
        op.capacity = bodies_[k].medium->capacity();
        op.capacities.push_back(op.capacity);
        for (std::size_t other = 0; other < bodies_.size(); ++other)
          if (other != k) op.capacities.push_back(bodies_[other].medium->capacity());
        op.first_wall = bodies_.size();
        op.moving = moving();
        if (has_surface()) op.set_surface(field_, conditions_);
        if (conservative()) {
          for (const BodyOfMedium& other : bodies_)
            op.lattice_spacing = std::max(op.lattice_spacing, b_.body(other.index).spacing);
          if (physics_.gradient_correction) op.correct_gradient();
        }
        if constexpr (std::is_same_v<Weights, FitWeights>)
          op.monotone = physics_.scheme.value() == "monotone";
      });
    }
  }

  // Whether surface points are looked at: those of bodies at rest, and of walls.
  bool has_surface() const {
    if (moving()) return !walls_.empty();
    return !conservative() || !conditions_.empty();
  }

  // A wall needs a coefficient, for the means of pairs, and its surface points.
  void attach_wall(const BodyOfMedium& wall) const {
    attach_conductivity(wall.index, wall.medium->conductivity(number_));
    b_.attach<FindSurface>("diffusion.surface", at_start, b_.target(wall.index), [&](auto& op) {
      op.set(field_);
      set_periodic_faces(op);
    });
  }

  void set_periodic_faces(FindSurface& op) const {
    for (std::size_t a = 0; a < 3; ++a) {
      const bool periodic = b_.periodic(static_cast<int>(a));
      op.lower[a] = periodic ? b_.raw().lower[a] : -HUGE_VAL;
      op.upper[a] = periodic ? b_.raw().upper[a] : HUGE_VAL;
    }
  }

  void attach_surface(std::size_t k, At at_rate) const {
    b_.attach<FindSurface>("diffusion.surface", at_start, target_of(k), [&](auto& op) {
      op.set(field_);
      op.conditions = conditions_;
      set_periodic_faces(op);
    });
    if (conditions_.empty()) return;
    b_.attach<SurfaceData>("diffusion.surface_data", at_rate, b_.target(bodies_[k].index), [&](auto& op) {
      op.set(field_);
      op.conditions = conditions_;
      op.stages = stages_;
    });
  }

  const Builder& b_;
  const Diffusion& physics_;
  const std::vector<BodyOfMedium>& bodies_;
  const std::vector<BodyOfMedium>& walls_;
  const std::vector<Condition>& conditions_;
  std::string field_;
  std::size_t number_;
  std::string loop_;
  std::vector<Conductivity> media_;
  bool isotropic_ = true;
  std::vector<std::shared_ptr<const Stencil>> stencils_;
  std::shared_ptr<Stages> stages_ = std::make_shared<Stages>();
};

}  // namespace

void Diffusion::build(const Builder& b) {
  if (inside.is_set()) {
    const std::string at = inside;
    const std::size_t slash = at.find('/');
    if (slash == std::string::npos)
      throw CaseError(inside.place() + ": expected loop/stage, e.g. advection/forces, got '" + at + "'");
    const std::string loop = at.substr(0, slash), stage = at.substr(slash + 1);
    b.loop("diffusion", At{loop.c_str(), stage.c_str()}, {"before", "diffuse", "after"});
  } else {
    b.loop("diffusion", {"before", "diffuse", "after"});
  }
  std::vector<BodyOfMedium> with_media, kept;
  for (const BodyIndex body : bodies.value()) with_media.push_back({body, medium_of(b, *this, body)});
  for (const BodyIndex wall : walls.value()) kept.push_back({wall, medium_of(b, *this, wall)});
  for (const At at : {at_start, at_before})
    for (const auto* some : {&with_media, &kept})
      for (const BodyOfMedium& body : *some)
        b.attach<WatchMotion>("diffusion.watch", at, b.target(body.index),
                              [&](auto& op) { op.motion = body.motion; });
  const std::vector<Condition> conditions = conditions_of(*this, b.dimensions());
  if (gradient_correction && (!conditions.empty() || scheme.value() != "conservative"))
    throw CaseError(
        gradient_correction.place() +
        ": gradient_correction is for scheme: conservative without boundaries; scheme: accurate needs none");
  for (std::size_t k = 0; k < fields->size(); ++k)
    OneField(b, *this, with_media, kept, conditions, fields.value()[k].name, k).attach();
}

}  // namespace shoal::diffusion
