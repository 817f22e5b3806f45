// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The reaction model that an object of a case describes.
#pragma once

#include <string>

#include "shoal/host.hpp"
#include "shoal/interfaces/reaction_model.h"
#include "shoal/physics.hpp"

namespace shoal::diffusion {

class Model {
 public:
  // Throws CaseError if the object is no reaction model.
  Model(const shoal_object& object, int dimensions)
      : api_(static_cast<const shoal_material_api*>(object.type->api)) {
    check_host(api_->create(&object, dimensions, &self_));
    interface_.api = static_cast<const shoal_reaction_model*>(
        api_->interface(self_, SHOAL_REACTION_MODEL, SHOAL_REACTION_MODEL_REVISION));
    interface_.self = self_;
    if (interface_) return;
    api_->destroy(self_);
    throw CaseError(std::string(object.place) + ": " + object.type->name +
                    " is no reaction model; take one that offers '" SHOAL_REACTION_MODEL
                    "', e.g. diffusion.aliev_panfilov");
  }
  ~Model() { api_->destroy(self_); }
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  const Interface<shoal_reaction_model>& interface() const { return interface_; }
  double largest_step() const { return interface_.api->largest_step(self_); }

 private:
  const shoal_material_api* api_;
  void* self_ = nullptr;
  Interface<shoal_reaction_model> interface_;
};

}  // namespace shoal::diffusion
