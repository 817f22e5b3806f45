// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Probes of plugins: they name the fields that they need and get a snapshot that holds them.
#include <algorithm>
#include <string_view>

#include "kernel/output/probes/own_probes.hpp"
#include "kernel/output/snapshot.hpp"
#include "kernel/particles/errors.hpp"
#include "kernel/plugins/abi_reading.hpp"
#include "kernel/plugins/host.hpp"

namespace shoal::kernel {
namespace {

class PluginProbe final : public Probe {
 public:
  PluginProbe(const shoal_object& object, const ProbeContext& context)
      : name_(context.name),
        type_(object.type->name),
        plugin_(type_.substr(0, type_.find('.'))),
        api_(abi_copy(static_cast<const shoal_probe_api*>(object.type->api))) {
    call_plugin(plugin_, type_, [&] { return api_.create(&object, context.dimensions, &self_); });
    const char* const* bodies = nullptr;
    const char* const* fields = nullptr;
    const std::uint32_t n = api_.fields(self_, &bodies, &fields);
    for (std::uint32_t k = 0; k < n; ++k) request(bodies[k], fields[k], object.place, context);
  }
  ~PluginProbe() override {
    if (api_.destroy != nullptr) api_.destroy(self_);
  }

  std::vector<FieldOfBody> demands() const override {
    std::vector<FieldOfBody> all;
    for (const SnapshotRequest::BodyFields& body : request_.bodies)
      for (const std::string& name : body.fields) all.push_back({body.body, field_of(name), body.place});
    return all;
  }

  void bind(const Simulation&) override {
    const char* const* names = nullptr;
    const char* const* units = nullptr;
    const std::uint32_t n = api_.columns(self_, &names, &units);
    for (std::uint32_t k = 0; k < n; ++k)
      columns_.push_back({names[k], units != nullptr && units[k] ? units[k] : ""});
    if (columns_.empty()) throw ModelError("probe '" + name_ + "' (" + type_ + ") has no columns");
  }

  std::vector<Column> columns() const override { return columns_; }

  std::vector<double> sample(const Simulation& run) override {
    const Snapshot snapshot(run, request_, sequence_++);
    std::vector<double> values(columns_.size());
    call_plugin(plugin_, type_, [&] { return api_.sample(self_, snapshot.c(), values.data()); });
    return values;
  }

 private:
  void request(const char* body, const char* field, const char* place, const ProbeContext& context) {
    for (std::uint32_t k = 0; k < context.n_bodies; ++k) {
      if (std::string_view(context.bodies[k].name) != body) continue;
      auto found = std::find_if(request_.bodies.begin(), request_.bodies.end(),
                                [&](const SnapshotRequest::BodyFields& one) { return one.body == k; });
      if (found == request_.bodies.end()) {
        request_.bodies.push_back({k, {}, place});
        found = request_.bodies.end() - 1;
      }
      // The position is in every snapshot.
      if (std::string_view(field) != "position") found->fields.emplace_back(field);
      return;
    }
    throw ModelError("probe '" + name_ + "' (" + type_ + ") asks for a body '" + body + "' that is not there",
                     place);
  }

  std::string name_, type_, plugin_;
  shoal_probe_api api_;
  void* self_ = nullptr;
  SnapshotRequest request_;
  std::vector<Column> columns_;
  std::uint64_t sequence_ = 0;
};

}  // namespace

std::unique_ptr<Probe> make_plugin_probe(const shoal_object& object, const ProbeContext& context) {
  return std::make_unique<PluginProbe>(object, context);
}

}  // namespace shoal::kernel
