// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Everything that a case wants written while it runs: its outputs, its probes, and what they are compared with.
//
//   Recorder recorder(model, run);    // demands the fields that it will read
//   run.finalise();
//   recorder.bind(run);
//   recorder.open(folder);            // or open(folder, state) to go on
//   recorder.start(run);              // or go_on(run)
//   while (...) { run.step(); recorder.after_step(run); }
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "kernel/case/model.hpp"
#include "kernel/output/due.hpp"
#include "kernel/output/output_writer.hpp"
#include "kernel/output/probes/probe.hpp"
#include "kernel/output/reference.hpp"
#include "kernel/output/series_file.hpp"
#include "kernel/schedule/simulation.hpp"

namespace shoal::kernel {

/// How far the files of a run have come at a checkpoint.
struct RecorderState {
  struct Output {
    std::string name;
    std::uint64_t sequence = 0;  ///< of the next snapshot
  };
  struct Series {
    std::string probe;
    std::uint64_t bytes = 0;
  };
  std::vector<Output> outputs;
  std::vector<Series> series;
};

/// Where the table of a probe is among the results of a run.
std::filesystem::path probe_table(const std::filesystem::path& results, const std::string& probe);

class Recorder {
 public:
  /// The model must outlive the recorder. Throws ModelError, OutputError (data that cannot be read).
  Recorder(const CaseModel& model, Simulation& run);

  /// Once the run is finalised. Throws ModelError.
  void bind(const Simulation& run);
  /// Makes the files. Throws OutputError, PluginFailure.
  void open(const std::filesystem::path& folder);
  /// Goes on with the files of an earlier run; what they hold beyond `state` is dropped.
  void open(const std::filesystem::path& folder, const RecorderState& state);

  /// What is due at the start.
  void start(Simulation& run);
  /// Instead of start(), when the run goes on from a checkpoint.
  void go_on(const Simulation& run) { last_time_ = run.time(); }
  /// What has become due since.
  void after_step(Simulation& run);

  /// With everything until now forced to the disk.
  RecorderState state();
  std::vector<ReferenceResult> compare_references(bool finished) const;
  const std::vector<ReferenceSpecification>& references() const { return references_; }
  /// Writes all bodies with all fields into `folder`, by the first output, else as CSV. For a run that has failed.
  void dump(const Simulation& run, const std::filesystem::path& folder) const;

  double seconds() const { return seconds_; }  ///< spent in writing and measuring
  std::size_t n_outputs() const { return outputs_.size(); }

 private:
  struct ProbeOfCase {
    const ProbeModel* model;
    std::unique_ptr<Probe> probe;
    Due due;
    std::unique_ptr<SeriesFile> file;
  };
  void record(Simulation& run, bool first);

  const CaseModel& model_;
  std::vector<std::unique_ptr<OutputWriter>> outputs_;
  std::vector<ProbeOfCase> probes_;
  std::vector<ReferenceSpecification> references_;
  std::filesystem::path folder_;
  double last_time_ = 0.0;
  double seconds_ = 0.0;
};

}  // namespace shoal::kernel
