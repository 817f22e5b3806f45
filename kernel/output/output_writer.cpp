// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/output/output_writer.hpp"

#include <algorithm>
#include <utility>

#include "kernel/case/diagnostics.hpp"
#include "kernel/output/atomic_file.hpp"
#include "kernel/particles/errors.hpp"
#include "kernel/plugins/abi_reading.hpp"
#include "kernel/plugins/host.hpp"
#include "shoal/shared_fields.hpp"

namespace shoal::kernel {
namespace {

// Values of the parameters that the kernel acts on; not every output has them.
const shoal_value* value_of(const shoal_object& object, const shoal_type& table, std::string_view key) {
  const shoal_value* value = find_value(object, table, key);
  return value != nullptr && value->n > 0 ? value : nullptr;
}

Due due_of(const shoal_object& object, const shoal_type& table) {
  std::optional<double> every;
  std::vector<double> at;
  if (const shoal_value* value = value_of(object, table, "every")) every = value->reals[0];
  if (const shoal_value* value = value_of(object, table, "at"))
    at.assign(value->reals, value->reals + value->n);
  return {every, at};
}

}  // namespace

OutputWriter::OutputWriter(const shoal_object& object, const CaseModel& model, std::string name,
                           Simulation& run)
    : object_(object),
      table_(model.store.table(object)),
      api_(abi_copy(static_cast<const shoal_output_api*>(object.type->api))),
      name_(std::move(name)),
      type_(object.type->name),
      plugin_(type_.substr(0, type_.find('.'))),
      title_(model.title),
      due_(due_of(object, table_)) {
  choose_bodies(model);
  choose_fields(run);
}

OutputWriter::~OutputWriter() {
  if (self_ != nullptr && api_.destroy != nullptr) api_.destroy(self_);
}

void OutputWriter::choose_bodies(const CaseModel& model) {
  if (const shoal_value* bodies = value_of(object_, table_, "bodies")) {
    for (std::uint32_t k = 0; k < bodies->n; ++k)
      request_.bodies.push_back({static_cast<std::uint32_t>(bodies->integers[k]), {}, object_.place});
    return;
  }
  for (std::uint32_t k = 0; k < model.bodies.size(); ++k) request_.bodies.push_back({k, {}, object_.place});
}

// Each body gives those of the wanted fields that it has; a field that none has is an error.
void OutputWriter::choose_fields(Simulation& run) {
  const shoal_value* fields = value_of(object_, table_, "fields");
  if (fields == nullptr) return;
  fields_given_ = true;
  for (std::uint32_t k = 0; k < fields->n; ++k) {
    const std::string name = fields->texts[k];
    if (name == "position" || name == "id") continue;  // in every snapshot
    bool found = false;
    for (SnapshotRequest::BodyFields& body : request_.bodies) {
      body.place = fields->place;
      const std::string& body_name = run.body_name(body.body);
      if (!run.is_declared(body_name, field_of(name)) && field_of(name) != "position") continue;
      found = true;
      body.fields.push_back(name);
      run.demand_field(body_name, field_of(name), fields->place);
    }
    // Then the run says, when it is finalised, which fields there are.
    if (!found) run.demand_field(run.body_name(request_.bodies[0].body), field_of(name), fields->place);
  }
}

void OutputWriter::bind(const Simulation& run) {
  if (!fields_given_) {
    for (SnapshotRequest::BodyFields& body : request_.bodies) {
      for (const FieldInfo& field : run.fields(body.body))
        if (field.name != "position" && find_shared_field(field.name) != nullptr)
          body.fields.push_back(field.name);
    }
  }
  // What is wrong with a name is found now, not at the first picture.
  const Snapshot trial(run, request_, 0);
}

void* OutputWriter::create(const std::filesystem::path& folder, std::uint64_t sequence) const {
  make_folder(folder);
  void* self = nullptr;
  call_plugin(plugin_, type_,
              [&] { return api_.create(&object_, folder.c_str(), title_.c_str(), sequence, &self); });
  return self;
}

void OutputWriter::write(void* self, const Snapshot& snapshot) const {
  call_plugin(plugin_, type_, [&] { return api_.write(self, snapshot.c()); });
}

void OutputWriter::open(const std::filesystem::path& folder, std::uint64_t sequence) {
  sequence_ = sequence;
  self_ = create(folder / name_, sequence);
}

void OutputWriter::write(const Simulation& run) {
  write(self_, Snapshot(run, request_, sequence_));
  ++sequence_;
}

void OutputWriter::dump(const Simulation& run, const std::filesystem::path& folder) const {
  void* self = create(folder, 0);
  try {
    write(self, Snapshot(run, everything(run), 0));
  } catch (...) {
    if (api_.destroy != nullptr) api_.destroy(self);
    throw;
  }
  if (api_.destroy != nullptr) api_.destroy(self);
}

SnapshotRequest everything(const Simulation& run) {
  SnapshotRequest request;
  for (std::uint32_t body = 0; body < run.n_bodies(); ++body) {
    request.bodies.push_back({body, {}, {}});
    for (const FieldInfo& field : run.fields(body))
      if (field.name != "position") request.bodies.back().fields.push_back(field.name);
  }
  return request;
}

}  // namespace shoal::kernel
