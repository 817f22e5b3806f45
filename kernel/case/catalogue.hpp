// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Loads the plugins that a case asks for and offers their types to its reader.
#pragma once

#include <string>
#include <vector>

#include "kernel/case/diagnostics.hpp"
#include "kernel/case/model.hpp"
#include "kernel/case/schema.hpp"
#include "kernel/plugins/loader.hpp"
#include "kernel/plugins/registry.hpp"

namespace shoal::kernel {

/// The types of a registry, and what the plugins that are not loaded would add.
class RegistryCatalogue : public TypeCatalogue {
 public:
  RegistryCatalogue(const Registry& registry, std::vector<std::string> available)
      : registry_(registry), available_(std::move(available)) {}

  TypeEntry find(shoal_type_kind kind, const std::string& name) const override;
  std::vector<std::string> names(shoal_type_kind kind) const override;
  std::string explain_unknown(shoal_type_kind kind, const std::string& name) const override;
  bool is_excused(const std::string& name) const override;

  /// Its types are unknown because it could not be loaded, which was reported.
  void excuse(const std::string& plugin) { excused_.push_back(plugin); }

 private:
  const Registry& registry_;
  std::vector<std::string> available_;
  std::vector<std::string> excused_;
};

/// Loads each plugin of the case with what it requires and registers its types; failures are reported at the line
/// that asks for it. [main thread]
RegistryCatalogue load_plugins(const CaseFile& file, Loader& loader, Registry& registry,
                               Diagnostics& diagnostics);

}  // namespace shoal::kernel
