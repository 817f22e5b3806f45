// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Between the plugins and the reader of cases.
#include "kernel/case/catalogue.hpp"

#include <algorithm>

#include "kernel/plugins/errors.hpp"

namespace shoal::kernel {

TypeEntry RegistryCatalogue::find(shoal_type_kind kind, const std::string& name) const {
  const RegisteredType* type = registry_.find(kind, name);
  // A case lists an operator that stands for itself among its physics; both are built in the same way.
  if (type == nullptr && kind == SHOAL_TYPE_PHYSICS) type = registry_.find(SHOAL_TYPE_OPERATOR, name);
  return type != nullptr ? TypeEntry{&type->table, type->original} : TypeEntry{};
}

std::vector<std::string> RegistryCatalogue::names(shoal_type_kind kind) const {
  std::vector<std::string> all = registry_.names(kind);
  if (kind == SHOAL_TYPE_PHYSICS) {
    const std::vector<std::string> operators = registry_.names(SHOAL_TYPE_OPERATOR);
    all.insert(all.end(), operators.begin(), operators.end());
  }
  return all;
}

std::string RegistryCatalogue::explain_unknown(shoal_type_kind kind, const std::string& name) const {
  return registry_.explain_unknown(kind, name, available_).text;
}

bool RegistryCatalogue::is_excused(const std::string& name) const {
  return std::any_of(excused_.begin(), excused_.end(),
                     [&name](const std::string& id) { return name == id || name.rfind(id + ".", 0) == 0; });
}

RegistryCatalogue load_plugins(const CaseFile& file, Loader& loader, Registry& registry,
                               Diagnostics& diagnostics) {
  RegistryCatalogue catalogue(registry, loader.search_path().available());
  std::vector<std::string> registered;
  for (const PluginRequest& request : file.plugins()) {
    try {
      loader.load(request.id);
      // What it requires comes first.
      for (const LoadedPlugin* plugin : loader.loaded()) {
        if (std::find(registered.begin(), registered.end(), plugin->id) != registered.end()) continue;
        registered.push_back(plugin->id);
        registry.add(*plugin);
      }
    } catch (const LoadFailure& failure) {
      diagnostics.error(request.place, failure.what() + did_you_mean(request.id, failure.available()),
                        failure.notes());
      catalogue.excuse(request.id);
    } catch (const TableError& error) {
      diagnostics.error(request.place, error.what(), error.problems());
      catalogue.excuse(error.plugin());
    }
  }
  return catalogue;
}

}  // namespace shoal::kernel
