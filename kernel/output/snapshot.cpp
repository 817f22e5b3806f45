// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/output/snapshot.hpp"

#include <optional>

#include "kernel/case/diagnostics.hpp"
#include "kernel/particles/errors.hpp"

namespace shoal::kernel {

Snapshot::Snapshot(const Simulation& run, const SnapshotRequest& request, std::uint64_t sequence) {
  for (const SnapshotRequest::BodyFields& wanted : request.bodies) {
    std::vector<shoal_snapshot_field>& fields = fields_.emplace_back();
    for (const std::string& name : wanted.fields) fields.push_back(field(run, wanted, name));
    shoal_snapshot_body body{};
    body.size = sizeof body;
    body.n_fields = static_cast<std::uint32_t>(fields.size());
    body.name = texts_.emplace_back(run.body_name(wanted.body)).c_str();
    body.n_particles = run.n_particles(wanted.body);
    body.position = static_cast<const double*>(run.field(wanted.body, "position").data);
    body.id = run.ids(wanted.body);
    body.fields = fields.data();
    bodies_.push_back(body);
  }
  snapshot_.size = sizeof snapshot_;
  snapshot_.dimensions = run.dimensions();
  snapshot_.time = run.time();
  snapshot_.step = run.outer_steps();
  snapshot_.sequence = sequence;
  snapshot_.n_bodies = static_cast<std::uint32_t>(bodies_.size());
  snapshot_.bodies = bodies_.data();
}

shoal_snapshot_field Snapshot::field(const Simulation& run, const SnapshotRequest::BodyFields& wanted,
                                     const std::string& name) {
  const std::optional<FieldInfo> info = run.field_info(wanted.body, field_of(name));
  if (!info) {
    std::vector<std::string> known;
    for (const FieldInfo& one : run.fields(wanted.body)) known.push_back(one.name);
    throw ModelError("body '" + run.body_name(wanted.body) + "' has no field '" + name + "'" +
                         did_you_mean(name, known) + " (its fields: " + join(known) + ")",
                     wanted.place);
  }
  const shoal_field array = run.field(wanted.body, info->name);
  shoal_snapshot_field view{};
  view.size = sizeof view;
  view.name = texts_.emplace_back(name).c_str();
  if (part_of(name).empty()) {
    view.rank = static_cast<std::uint32_t>(info->rank);
    view.data_type = static_cast<std::uint32_t>(info->data_type);
    view.components = info->components;
    view.unit = texts_.emplace_back(info->unit).c_str();
    view.data = array.data;
    return view;
  }
  const FieldPart part(*info, name, run.dimensions(), wanted.place);
  std::vector<double>& copy = copies_.emplace_back(run.n_particles(wanted.body));
  for (std::size_t i = 0; i < copy.size(); ++i) copy[i] = part.value(array, i, {1.0, 1.0, 1.0});
  view.rank = SHOAL_SCALAR;
  view.data_type = SHOAL_DOUBLE;
  view.components = 1;
  view.unit = texts_.emplace_back(part.unit()).c_str();
  view.data = copy.data();
  return view;
}

}  // namespace shoal::kernel
