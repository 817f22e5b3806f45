// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A material: parameters that a case gives to a body, and the C interfaces (shoal/interfaces/) through which solvers
// of other plugins call it. A material without behaviour of its own needs only its parameters.
#pragma once

#include <memory>
#include <string_view>

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

  int dimensions() const { return dimensions_; }

  template <class Derived>
  static const void* api() {
    static const shoal_material_api table{sizeof(shoal_material_api), 0,
                                          [](const shoal_object* object, int32_t dimensions, void** self) {
                                            return guarded([&] {
                                              auto material = std::make_unique<Derived>();
                                              material->read(*object, dimensions);
                                              static_cast<Material&>(*material).dimensions_ = dimensions;
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

}  // namespace shoal
