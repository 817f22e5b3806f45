// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The kernel's side of shoal_builder: collects what physics say, and turns exceptions into statuses.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kernel/particles/body.hpp"
#include "kernel/schedule/declarations.hpp"
#include "kernel/schedule/simulation.hpp"

namespace shoal::kernel {

class Builder {
 public:
  /// `bodies` hold the initial particles; `declarations` outlive the builder.
  Builder(const SimulationSettings& settings, const Domain& domain,
          const std::vector<std::unique_ptr<Body>>& bodies, Declarations& declarations);
  Builder(const Builder&) = delete;
  Builder& operator=(const Builder&) = delete;

  const shoal_builder* c() const { return &c_; }
  void set_material_interface_lookup(MaterialInterfaceLookup lookup) { lookup_ = std::move(lookup); }
  void set_declarer(std::string text) { declarer_ = std::move(text); }
  const std::string& failure() const { return failure_; }

  void loop(const char* name, const char* parent, const char* parent_stage, std::uint32_t n_stages,
            const char* const* stages);
  void renew_neighbours_in(const char* loop);
  void attach(const char* loop, const char* stage, const shoal_operator* op);
  void own_field(std::uint32_t body, const char* field, const char* loop, const char* stage);
  void guard(std::uint32_t body, const char* field, double minimum, double maximum);
  void material_interface(std::uint32_t body, const char* name, std::uint32_t revision, const void** api,
                          void** self);
  void body_moves(std::uint32_t body, bool moves);
  void note(const char* text);

  /// Runs a call of a plugin; a ModelError becomes a status and the text of failure().
  template <class Call>
  shoal_status guarded(const Call& call);

 private:
  Body& body_of(std::uint32_t index, const char* what) const;
  void describe_bodies();

  const std::vector<std::unique_ptr<Body>>& bodies_;
  Declarations& declarations_;
  FailureChannel failures_;
  MaterialInterfaceLookup lookup_;
  std::string declarer_ = "a plugin";
  std::string failure_;
  std::vector<shoal_body> descriptions_;
  shoal_builder c_{};
};

}  // namespace shoal::kernel
