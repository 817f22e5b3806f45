// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The end of a plugin's source: what it is and what it registers.
//
//     SHOAL_PLUGIN(example, "1.0.0") {
//       summary("Viscosity, to show how a plugin is made.");
//       add<ViscousForce>("example.viscous_force", "Viscous acceleration of a Newtonian fluid.",
//                         "Morris, Fox, Zhu 1997");
//     }
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "shoal/abi.h"
#include "shoal/host.hpp"
#include "shoal/operator.hpp"
#include "shoal/parameters.hpp"
#include "shoal/physics.hpp"

#define SHOAL_SDK_VERSION "0.1.0"
#define SHOAL_EXPORT __attribute__((visibility("default")))

namespace shoal {

namespace impl {

constexpr std::uint32_t isa_of_this_code() {
  std::uint32_t isa = 0;
#ifdef __AVX2__
  isa |= SHOAL_ISA_AVX2;
#endif
#ifdef __FMA__
  isa |= SHOAL_ISA_FMA;
#endif
#ifdef __AVX512F__
  isa |= SHOAL_ISA_AVX512F;
#endif
#ifdef __AVX512DQ__
  isa |= SHOAL_ISA_AVX512DQ;
#endif
#ifdef __AVX512VL__
  isa |= SHOAL_ISA_AVX512VL;
#endif
#ifdef __AVX512BW__
  isa |= SHOAL_ISA_AVX512BW;
#endif
  return isa;
}

template <std::size_t N>
constexpr void copy_text(char (&to)[N], std::string_view from) {
  for (std::size_t k = 0; k + 1 < N && k < from.size(); ++k) to[k] = from[k];
}

constexpr shoal_stamp make_stamp() {
  shoal_stamp stamp{};
  stamp.magic = SHOAL_ABI_MAGIC;
  stamp.size = sizeof(shoal_stamp);
  stamp.abi_major = SHOAL_ABI_MAJOR;
  stamp.abi_minor = SHOAL_ABI_MINOR;
  stamp.real_bytes = sizeof(double);
  stamp.index_bytes = sizeof(std::uint32_t);
  stamp.isa = isa_of_this_code();
  copy_text(stamp.sdk_version, SHOAL_SDK_VERSION);
#ifdef __clang__
  copy_text(stamp.compiler, "clang " __clang_version__);
#else
  copy_text(stamp.compiler, "gcc " __VERSION__);
#endif
  return stamp;
}

// A registered type with everything that its C description borrows.
struct RegisteredType {
  virtual ~RegisteredType() = default;
  shoal_type c{};
  std::vector<shoal_parameter> table;
};
template <class T>
struct RegisteredTypeOf final : RegisteredType {
  T prototype;  // owns the texts of the parameter table
};

}  // namespace impl

class Plugin {
 public:
  Plugin(const char* id, const char* version) {
    c_.size = sizeof(shoal_plugin);
    c_.id = id;
    c_.version = version;
    c_.licence = "Apache-2.0";
    c_.summary = "";
  }
  virtual ~Plugin() = default;
  Plugin(const Plugin&) = delete;
  Plugin& operator=(const Plugin&) = delete;

  virtual void describe() = 0;

  const shoal_plugin* c() {
    for (const auto& type : types_) type_pointers_.push_back(&type->c);
    c_.n_types = static_cast<std::uint32_t>(type_pointers_.size());
    c_.types = type_pointers_.data();
    c_.n_requirements = static_cast<std::uint32_t>(requirements_.size());
    c_.requirements = requirements_.data();
    return &c_;
  }

 protected:
  // All texts are borrowed: string literals.
  void licence(const char* spdx) { c_.licence = spdx; }
  void summary(const char* line) { c_.summary = line; }
  void citation(const char* text) { c_.citation = text; }
  void requires_plugin(const char* id, const char* minimum_version = nullptr,
                       const char* below_version = nullptr) {
    requirements_.push_back({sizeof(shoal_requirement), 0, id, minimum_version, below_version});
  }

  // Registers an operator, material, physics, shape, output or probe.
  template <class T>
  void add(const char* name, const char* doc, const char* source = nullptr) {
    if constexpr (std::is_base_of_v<OperatorBase, T>)
      enter<OperatorPhysics<T>, OperatorPhysics<T>>(name, doc, source);
    else
      enter<T, T>(name, doc, source);
  }

 private:
  template <class Described, class Implementation>
  void enter(const char* name, const char* doc, const char* source) {
    auto type = std::make_unique<impl::RegisteredTypeOf<Described>>();
    type->table = type->prototype.parameter_table();
    type->c.size = sizeof(shoal_type);
    type->c.kind = Described::type_kind;
    type->c.name = name;
    type->c.doc = doc;
    type->c.source = source;
    type->c.n_parameters = static_cast<std::uint32_t>(type->table.size());
    type->c.parameters = type->table.data();
    type->c.api = Described::template api<Implementation>();
    types_.push_back(std::move(type));
  }

  shoal_plugin c_{};
  std::deque<std::unique_ptr<impl::RegisteredType>> types_;
  std::vector<const shoal_type*> type_pointers_;
  std::vector<shoal_requirement> requirements_;
};

namespace impl {

inline const shoal_plugin* enter_plugin(const shoal_host* host, Plugin& plugin) {
  host_table = host;
  const shoal_status status = guarded([&] { plugin.describe(); });
  return status == SHOAL_OK ? plugin.c() : nullptr;
}

}  // namespace impl
}  // namespace shoal

#define SHOAL_PLUGIN(plugin_id, plugin_version)                                            \
  namespace {                                                                              \
  struct ShoalPlugin final : shoal::Plugin {                                               \
    ShoalPlugin() : shoal::Plugin(#plugin_id, plugin_version) {}                           \
    void describe() override;                                                              \
  };                                                                                       \
  }                                                                                        \
  extern "C" SHOAL_EXPORT const shoal_stamp shoal_plugin_stamp;                            \
  extern "C" constexpr shoal_stamp shoal_plugin_stamp = shoal::impl::make_stamp();         \
  extern "C" SHOAL_EXPORT const shoal_plugin* shoal_plugin_entry(const shoal_host* host) { \
    static ShoalPlugin plugin;                                                             \
    return shoal::impl::enter_plugin(host, plugin);                                        \
  }                                                                                        \
  void ShoalPlugin::describe()
