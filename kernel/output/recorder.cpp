// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/output/recorder.hpp"

#include <algorithm>
#include <chrono>
#include <set>

#include "kernel/case/diagnostics.hpp"
#include "kernel/output/atomic_file.hpp"
#include "kernel/output/dump_table.hpp"
#include "kernel/particles/errors.hpp"

namespace shoal::kernel {
namespace {

Domain domain_of(const CaseModel& model) {
  Domain domain;
  domain.dimensions = model.dimensions;
  for (std::size_t k = 0; k < 3; ++k) {
    domain.lower[k] = model.domain.lower[k];
    domain.upper[k] = model.domain.upper[k];
    if (model.domain.periodic[k]) domain.boundary[k] = {BoundaryKind::periodic, BoundaryKind::periodic};
    if (model.domain.mirror_lower[k]) domain.boundary[k].lower = BoundaryKind::mirror;
    if (model.domain.mirror_upper[k]) domain.boundary[k].upper = BoundaryKind::mirror;
  }
  return domain;
}

ReferenceSpecification specification_of(const ReferenceModel& model) {
  ReferenceSpecification specification;
  specification.probe = model.probe;
  specification.column = model.column.value_or("");
  specification.data = model.data.value_or("");
  specification.time_column = model.time_column;
  specification.value_column = model.value_column;
  specification.time_scale = model.time_scale;
  specification.time_shift = model.time_shift;
  specification.value_scale = model.value_scale;
  specification.value_shift = model.value_shift;
  specification.average = model.average.value_or(0.0);
  if (model.exact) {
    specification.exact_text = model.exact->text();
    specification.exact = [exact = *model.exact](double t) {
      double value = 0.0;
      exact.evaluate(1, nullptr, nullptr, nullptr, t, &value);
      return value;
    };
  }
  specification.measure = error_measure(model.error).value_or(ErrorMeasure::rms);
  specification.tolerance = model.tolerance;
  specification.mean_tolerance = model.mean_tolerance;
  specification.scale = model.scale;
  specification.from = model.from;
  specification.to = model.to;
  return specification;
}

// Two outputs of one type write into folders of their own.
std::string free_name(const std::string& type, std::set<std::string>& taken) {
  std::string name = type;
  for (int k = 2; !taken.insert(name).second; ++k) name = type + "_" + std::to_string(k);
  return name;
}

class Stopwatch {
 public:
  explicit Stopwatch(double& total) : total_(total) {}
  ~Stopwatch() { total_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }

 private:
  double& total_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace

Recorder::Recorder(const CaseModel& model, Simulation& run) : model_(model) {
  std::set<std::string> taken{"probes", "checkpoints", "failure"};
  for (const shoal_object* object : model.outputs)
    outputs_.push_back(
        std::make_unique<OutputWriter>(*object, model, free_name(object->type->name, taken), run));
  const shoal_builder* builder = run.builder();
  for (const ProbeModel& probe : model.probes) {
    const ProbeContext context{probe.name,       model.dimensions, model.parameters.scope({}),
                               domain_of(model), builder->bodies,  builder->n_bodies};
    ProbeOfCase entry{&probe, make_probe(*probe.object, context), Due(probe.every, {}), nullptr};
    for (const Probe::FieldOfBody& field : entry.probe->demands())
      run.demand_field(run.body_name(field.body), field.field, field.place);
    probes_.push_back(std::move(entry));
  }
  for (const ReferenceModel& reference : model.references) {
    references_.push_back(specification_of(reference));
    try {
      check_reference(references_.back());
    } catch (const OutputError& error) {
      throw ModelError(error.what(), reference.place);
    }
  }
}

void Recorder::bind(const Simulation& run) {
  for (const auto& output : outputs_) output->bind(run);
  for (ProbeOfCase& probe : probes_) probe.probe->bind(run);
  for (std::size_t k = 0; k < references_.size(); ++k) {
    const std::string& column = references_[k].column;
    const auto probe = std::find_if(probes_.begin(), probes_.end(), [&](const ProbeOfCase& candidate) {
      return candidate.model->name == references_[k].probe;
    });
    if (column.empty() || probe == probes_.end()) continue;
    std::vector<std::string> names;
    for (const Column& known : probe->probe->columns()) names.push_back(known.name);
    if (std::find(names.begin(), names.end(), column) == names.end())
      throw ModelError("probe '" + references_[k].probe + "' has no column '" + column + "'" +
                           did_you_mean(column, names) + " (its columns: " + join(names) + ")",
                       model_.references[k].place);
  }
}

std::filesystem::path probe_table(const std::filesystem::path& results, const std::string& probe) {
  return results / "probes" / (probe + ".csv");
}

void Recorder::open(const std::filesystem::path& folder) { open(folder, RecorderState{}); }

void Recorder::open(const std::filesystem::path& folder, const RecorderState& state) {
  folder_ = folder;
  for (const auto& output : outputs_) {
    const auto known = std::find_if(state.outputs.begin(), state.outputs.end(),
                                    [&](const auto& candidate) { return candidate.name == output->name(); });
    output->open(folder, known == state.outputs.end() ? 0 : known->sequence);
  }
  if (!probes_.empty()) make_folder(folder / "probes");
  for (ProbeOfCase& probe : probes_) {
    const auto known = std::find_if(state.series.begin(), state.series.end(), [&](const auto& candidate) {
      return candidate.probe == probe.model->name;
    });
    const std::vector<Column> columns = probe.probe->columns();
    const std::filesystem::path path = probe_table(folder_, probe.model->name);
    probe.file = known == state.series.end() ? std::make_unique<SeriesFile>(path, columns)
                                             : std::make_unique<SeriesFile>(path, columns, known->bytes);
  }
}

void Recorder::start(Simulation& run) {
  record(run, true);
  last_time_ = run.time();
}

void Recorder::after_step(Simulation& run) {
  record(run, false);
  last_time_ = run.time();
}

void Recorder::record(Simulation& run, bool first) {
  const auto is_due = [&](const Due& due) {
    if (first) return due.at_start(run.time());
    return !run.finish_reason().empty() || due.between(last_time_, run.time());
  };
  std::vector<OutputWriter*> outputs;
  std::vector<ProbeOfCase*> probes;
  for (const auto& output : outputs_)
    if (is_due(output->due())) outputs.push_back(output.get());
  for (ProbeOfCase& probe : probes_)
    if (is_due(probe.due)) probes.push_back(&probe);
  if (outputs.empty() && probes.empty()) return;
  run.sample();
  const Stopwatch stopwatch(seconds_);
  for (ProbeOfCase* probe : probes) probe->file->append(run.time(), probe->probe->sample(run));
  for (OutputWriter* output : outputs) output->write(run);
}

RecorderState Recorder::state() {
  RecorderState state;
  for (const auto& output : outputs_) state.outputs.push_back({output->name(), output->sequence()});
  for (ProbeOfCase& probe : probes_) {
    probe.file->sync();
    state.series.push_back({probe.model->name, probe.file->bytes()});
  }
  return state;
}

std::vector<ReferenceResult> Recorder::compare_references(bool finished) const {
  std::vector<ReferenceResult> results;
  for (const ReferenceSpecification& reference : references_)
    results.push_back(compare_file(reference, probe_table(folder_, reference.probe), finished));
  return results;
}

void Recorder::dump(const Simulation& run, const std::filesystem::path& folder) const {
  if (outputs_.empty())
    dump_tables(run, folder);
  else
    outputs_.front()->dump(run, folder);
}

}  // namespace shoal::kernel
