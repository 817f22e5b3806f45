// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "diffusion.hpp"

#include <algorithm>
#include <cstdio>

#include "conductivity.hpp"
#include "integrator.hpp"
#include "pairwise.hpp"
#include "stencil.hpp"
#include "step.hpp"

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

// What is attached for one field on all bodies.
class OneField {
 public:
  OneField(const Builder& b, const Diffusion& physics, const std::vector<BodyOfMedium>& bodies,
           std::string field, std::size_t number)
      : b_(b), physics_(physics), bodies_(bodies), field_(std::move(field)), loop_("diffusion_of_" + field_) {
    for (const BodyOfMedium& body : bodies_) {
      media_.push_back(body.medium->conductivity(number));
      isotropic_ = isotropic_ && media_.back().isotropic();
    }
  }

  void attach() const {
    b_.loop(loop_.c_str(), at_diffuse, {"rate", "update"});
    const At at_rate{loop_.c_str(), "rate"}, at_update{loop_.c_str(), "update"};
    for (std::size_t k = 0; k < bodies_.size(); ++k) attach_conductivity(k);
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      const BodyIndex body = bodies_[k].index;
      b_.own_field(body, rate_of(field_).c_str(), at_rate);
      attach_stencil(k, at_rate);
      b_.attach<HeunStage>("diffusion.heun", at_update, b_.target(body), [&](auto& op) {
        op.set(field_);
        op.stages = stages_;
      });
      b_.attach<InnerStep>("diffusion.stage", at_update, b_.target(body),
                           [&](auto& op) { op.stages = stages_; });
    }
  }

 private:
  void attach_conductivity(std::size_t k) const {
    const auto setup = [&](auto& op) { op.set(field_, media_[k]); };
    const Target target = b_.target(bodies_[k].index);
    if (isotropic_)
      b_.attach<ScalarConductivity>("diffusion.coefficient", at_start, target, setup);
    else
      b_.attach<TensorConductivity>("diffusion.coefficient", at_start, target, setup);
  }

  // The body with all bodies of the physics as neighbours, itself first.
  Target target_of(std::size_t k) const {
    std::vector<BodyIndex> neighbours{bodies_[k].index};
    for (std::size_t other = 0; other < bodies_.size(); ++other)
      if (other != k) neighbours.push_back(bodies_[other].index);
    return b_.target(bodies_[k].index, neighbours);
  }

  void attach_stencil(std::size_t k, At at_rate) const {
    const auto stencil = std::make_shared<Stencil>();
    stencil->motions.push_back(bodies_[k].motion);
    for (std::size_t other = 0; other < bodies_.size(); ++other)
      if (other != k) stencil->motions.push_back(bodies_[other].motion);
    const auto weights = [&](auto& op) {
      op.set(field_, isotropic_, stencil);
      op.capacity = bodies_[k].medium->capacity();
    };
    b_.attach<PairwiseWeights>("diffusion.weights", at_start, target_of(k), weights);
    b_.attach<PairwiseWeights>("diffusion.weights", at_before, target_of(k), weights);
    b_.attach<OuterStep>("diffusion.step", at_before, b_.target(bodies_[k].index), [&](auto& op) {
      op.stencil = stencil;
      op.stages = stages_;
      op.cfl = physics_.cfl;
    });
    b_.attach<ApplyStencil>("diffusion.rate", at_rate, target_of(k),
                            [&](auto& op) { op.set(field_, stencil); });
  }

  const Builder& b_;
  const Diffusion& physics_;
  const std::vector<BodyOfMedium>& bodies_;
  std::string field_, loop_;
  std::vector<Conductivity> media_;
  bool isotropic_ = true;
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
  std::vector<BodyOfMedium> with_media;
  for (const BodyIndex body : bodies.value()) with_media.push_back({body, medium_of(b, *this, body)});
  for (const At at : {at_start, at_before})
    for (const BodyOfMedium& body : with_media)
      b.attach<WatchMotion>("diffusion.watch", at, b.target(body.index),
                            [&](auto& op) { op.motion = body.motion; });
  for (std::size_t k = 0; k < fields->size(); ++k)
    OneField(b, *this, with_media, fields.value()[k].name, k).attach();
}

}  // namespace shoal::diffusion
