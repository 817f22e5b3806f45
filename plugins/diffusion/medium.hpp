// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What a body is for diffusion:  capacity dc/dt = div(K grad c) + source
//   diffusion.medium      capacity 1, K = diffusivity of the species times a tensor, m2/s
//   diffusion.conductor   capacity = density * specific heat, J/(m3 K); K = conductivity times a tensor, W/(m K)
// The tensor is the identity unless it is given: by numbers or expressions, by the direction of fibres and the ratio
// of K across them to that along them, or as a field of matrices that the case or another plugin fills.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "shoal/material.hpp"
#include "shoal/parameters.hpp"

namespace shoal::diffusion {

// How K varies over a body.
struct Conductivity {
  Expression factor;               // of the species, m2/s or W/(m K)
  std::vector<Expression> tensor;  // xx, xy, yy or xx, xy, xz, yy, yz, zz; empty: none
  std::vector<Expression> fibre;   // direction, of any length; empty: none
  Expression across;               // K across the fibres over K along them
  std::string tensor_field;        // empty: none

  bool isotropic() const { return tensor.empty() && fibre.empty() && tensor_field.empty(); }
};

struct AnyMedium : Material {
  // K of the species with this number; the last one serves all that follow.
  virtual Conductivity conductivity(std::size_t species) const = 0;
  virtual double capacity() const = 0;
  void read_in(const shoal_object& object, int dimensions) {
    dimensions_ = dimensions;
    read(object, dimensions);
  }

 protected:
  // Fills in the tensor and checks that it is given in one way only.
  inline void set_tensor(Conductivity& k) const;

  Param<std::vector<Expression>> tensor_{
      "tensor", "1",
      "Symmetric tensor that multiplies the coefficient: xx, xy, yy in 2D, xx, xy, xz, yy, yz, zz in 3D.",
      optional, example("[1, 0, 0.1]")};
  Param<VectorExpression> fibre_{"fibre", "1",
                                 "Direction along which the coefficient counts in full, of any length; with "
                                 "'across'.",
                                 optional, example("[cos(30*pi/180), sin(30*pi/180)]")};
  Param<Expression> across_{"across", "1", "Coefficient across the fibres over that along them.", optional,
                            example("0.1")};
  Param<FieldName> tensor_field_{"tensor_field", nullptr,
                                 "Field of matrices that multiplies the coefficient, filled by 'initial' or "
                                 "another plugin.",
                                 optional, example("fibre_tensor")};

 private:
  int dimensions_ = 0;
};

inline void AnyMedium::set_tensor(Conductivity& k) const {
  const int ways = int{tensor_.is_set()} + int{fibre_.is_set()} + int{tensor_field_.is_set()};
  if (ways > 1)
    throw CaseError((tensor_.is_set() ? tensor_.place() : fibre_.place()) +
                    ": give one of tensor, fibre and tensor_field, not several");
  if (fibre_.is_set() != across_.is_set())
    throw CaseError((fibre_.is_set() ? fibre_.place() : across_.place()) +
                    ": fibre and across belong together, e.g. fibre: [1, 0], across: 0.1");
  if (tensor_.is_set()) {
    const std::size_t n = dimensions_ == 2 ? 3 : 6;
    if (tensor_->size() != n)
      throw CaseError(tensor_.place() + ": a symmetric tensor has " +
                      (n == 3 ? "3 components (xx, xy, yy)" : "6 components (xx, xy, xz, yy, yz, zz)") +
                      ", not " + std::to_string(tensor_->size()));
    k.tensor = tensor_;
  }
  if (fibre_.is_set()) {
    for (int a = 0; a < dimensions_; ++a) k.fibre.push_back(fibre_->component[static_cast<std::size_t>(a)]);
    k.across = across_;
  }
  if (tensor_field_.is_set()) k.tensor_field = tensor_field_->name;
}

struct Medium final : AnyMedium {
  Param<std::vector<Expression>> diffusivity{
      "diffusivity", "m2/s",
      "Coefficient of diffusion, for all species or one for each, in the order of 'fields'.",
      example("1e-4")};

  double capacity() const override { return 1.0; }
  Conductivity conductivity(std::size_t species) const override {
    Conductivity k;
    k.factor = diffusivity.value()[std::min(species, diffusivity->size() - 1)];
    set_tensor(k);
    return k;
  }
};

struct Conductor final : AnyMedium {
  Param<Expression> conductivity_value{"conductivity", "W m-1 K-1", "Thermal conductivity.", example("45")};
  Param<double> density{"density", "kg/m3", "Density.", positive, example("7850")};
  Param<double> specific_heat{"specific_heat", "J kg-1 K-1", "Specific heat capacity.", positive,
                              example("470")};

  double capacity() const override { return density * specific_heat; }
  Conductivity conductivity(std::size_t) const override {
    Conductivity k;
    k.factor = conductivity_value;
    set_tensor(k);
    return k;
  }
};

// The medium that an object of a case describes; null if it is not one of the above.
inline std::unique_ptr<AnyMedium> read_medium(const shoal_object& object, int dimensions) {
  std::unique_ptr<AnyMedium> medium;
  const std::string type = object.type->name;
  if (type == "diffusion.medium") medium = std::make_unique<Medium>();
  if (type == "diffusion.conductor") medium = std::make_unique<Conductor>();
  if (medium) medium->read_in(object, dimensions);
  return medium;
}

}  // namespace shoal::diffusion
