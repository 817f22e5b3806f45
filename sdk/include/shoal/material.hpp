// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A material: parameters that a case gives to a body, and the C interfaces (shoal/interfaces/) through which solvers
// of other plugins call it. A material without behaviour of its own needs only its parameters.
#pragma once

#include <memory>
#include <string_view>
#include <utility>

#include "shoal/abi.h"
#include "shoal/host.hpp"
#include "shoal/parameters.hpp"

namespace shoal {

class Material : public Parameterised {
 public:
  static constexpr shoal_type_kind type_kind = SHOAL_TYPE_MATERIAL;
  virtual ~Material() = default;

  // The table of functions of an interface; they are called with the material as `self`, so they cast it with
  // `material_of<Derived>(self)`. Null if the material does not offer it.
  virtual const void* interface(std::string_view /*name*/, std::uint32_t /*revision*/) const {
    return nullptr;
  }

  // Called when the parameters are read: throws CaseError if they do not fit together.
  virtual void check() {}

  int dimensions() const { return dimensions_; }

  template <class Derived>
  static const void* api() {
    static const shoal_material_api table{sizeof(shoal_material_api), 0,
                                          [](const shoal_object* object, int32_t dimensions, void** self) {
                                            return guarded([&] {
                                              auto material = std::make_unique<Derived>();
                                              material->read(*object, dimensions);
                                              static_cast<Material&>(*material).dimensions_ = dimensions;
                                              material->check();
                                              *self = static_cast<Material*>(material.release());
                                            });
                                          },
                                          [](void* self) { delete static_cast<Material*>(self); },
                                          [](void* self, const char* name, uint32_t revision) -> const void* {
                                            return static_cast<Material*>(self)->interface(name, revision);
                                          }};
    return &table;
  }

 private:
  int dimensions_ = 0;
};

template <class Derived>
Derived& material_of(void* self) {
  return static_cast<Derived&>(*static_cast<Material*>(self));
}

// Parameters that take a material, which this one wraps:
//     Param<ObjectHandle> passive{"passive", nullptr, "Stress law of the tissue at rest.", materials_only};
inline constexpr ObjectsOf materials_only{SHOAL_TYPE_MATERIAL};

// A material of any plugin, made from such a parameter and owned by whoever wraps it.
class OwnedMaterial {
 public:
  OwnedMaterial() = default;
  OwnedMaterial(const ObjectHandle& handle, int dimensions)
      : api_(static_cast<const shoal_material_api*>(handle.object->type->api)) {
    check_host(api_->create(handle.object, dimensions, &self_));
  }
  OwnedMaterial(OwnedMaterial&& other) noexcept
      : api_(std::exchange(other.api_, nullptr)), self_(std::exchange(other.self_, nullptr)) {}
  OwnedMaterial& operator=(OwnedMaterial&& other) noexcept {
    std::swap(api_, other.api_);
    std::swap(self_, other.self_);
    return *this;
  }
  ~OwnedMaterial() {
    if (api_ != nullptr) api_->destroy(self_);
  }

  explicit operator bool() const { return api_ != nullptr; }
  void* self() const { return self_; }
  // Null if the material does not offer the interface.
  template <class Api>
  const Api* interface(const char* name, std::uint32_t revision) const {
    return static_cast<const Api*>(api_->interface(self_, name, revision));
  }

 private:
  const shoal_material_api* api_ = nullptr;
  void* self_ = nullptr;
};

}  // namespace shoal
