// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A probe: numbers from the particles at one time, a row of a table each time they are wanted.
//
//     class Centre final : public shoal::Probe {
//       Param<BodyName> body{"body", nullptr, "Body whose centre is wanted.", example("water")};
//       std::vector<Column> columns() const override { return {{"x", "m"}, {"y", "m"}}; }
//       std::vector<Need> needs() const override { return {{body->name, "mass"}}; }
//       void sample(const shoal_snapshot& snapshot, double* values) override { ... }
//     };
//     SHOAL_PLUGIN(example, "1.0.0") { add<Centre>("example.centre", "Centre of mass."); }
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "shoal/abi.h"
#include "shoal/host.hpp"
#include "shoal/parameters.hpp"
#include "shoal/snapshot.hpp"

namespace shoal {

// A body of the case by its name, as snapshots know it.
struct BodyName {
  std::string name;
};

namespace impl {

template <>
struct ValueTraits<BodyName> {
  static constexpr std::uint32_t kind = SHOAL_BODY;
  static BodyName get(const shoal_value& v, std::uint32_t k, int) { return {v.texts[k]}; }
};

}  // namespace impl

// All calls are on the main thread.
class Probe : public Parameterised {
 public:
  static constexpr shoal_type_kind type_kind = SHOAL_TYPE_PROBE;

  struct Column {
    std::string name;
    std::string unit;  // UDUNITS-2; "1" without dimension
  };
  struct Need {
    std::string body;
    std::string field;  // or a part of one: velocity.x; positions and ids are always there
  };

  virtual ~Probe() = default;

  // The numbers, the same in every sample.
  virtual std::vector<Column> columns() const = 0;
  // What the snapshot must hold.
  virtual std::vector<Need> needs() const = 0;
  // Fills one value for each column; NaN where there is nothing to measure. The snapshot is valid during the call.
  virtual void sample(const shoal_snapshot& snapshot, double* values) = 0;

  int dimensions() const { return dimensions_; }

  template <class Derived>
  static const void* api() {
    static const shoal_probe_api table{
        sizeof(shoal_probe_api),
        0,
        [](const shoal_object* object, int32_t dimensions, void** self) {
          return guarded([&] {
            auto probe = std::make_unique<Derived>();
            probe->read(*object, dimensions);
            static_cast<Probe&>(*probe).describe(dimensions);
            *self = static_cast<Probe*>(probe.release());
          });
        },
        [](void* self) { delete static_cast<Probe*>(self); },
        [](void* self, const char* const** names, const char* const** units) {
          return static_cast<Probe*>(self)->columns_.give(names, units);
        },
        [](void* self, const char* const** bodies, const char* const** fields) {
          return static_cast<Probe*>(self)->needs_.give(bodies, fields);
        },
        [](void* self, const shoal_snapshot* snapshot, double* values) {
          return guarded([&] { static_cast<Probe*>(self)->sample(*snapshot, values); });
        }};
    return &table;
  }

 private:
  // Pairs of texts as the kernel reads them.
  class TextPairs {
   public:
    void add(const std::string& first, const std::string& second) {
      texts_.push_back(std::make_unique<std::string>(first));
      first_.push_back(texts_.back()->c_str());
      texts_.push_back(std::make_unique<std::string>(second));
      second_.push_back(texts_.back()->c_str());
    }
    std::uint32_t give(const char* const** first, const char* const** second) const {
      *first = first_.data();
      *second = second_.data();
      return static_cast<std::uint32_t>(first_.size());
    }

   private:
    std::vector<std::unique_ptr<std::string>> texts_;
    std::vector<const char*> first_, second_;
  };

  void describe(int dimensions) {
    dimensions_ = dimensions;
    for (const Column& column : columns()) columns_.add(column.name, column.unit);
    for (const Need& need : needs()) needs_.add(need.body, need.field);
  }

  int dimensions_ = 0;
  TextPairs columns_, needs_;
};

}  // namespace shoal
