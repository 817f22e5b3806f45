// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A case on its way from a file to a finalised simulation: what run, resume, check and plan have in common.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kernel/app/options.hpp"
#include "kernel/case/assemble.hpp"
#include "kernel/case/catalogue.hpp"
#include "kernel/case/model.hpp"
#include "kernel/output/recorder.hpp"
#include "kernel/plugins/loader.hpp"
#include "kernel/plugins/registry.hpp"

namespace shoal::kernel::app {

/// The plugins that can be found, and the types that are known so far: the kernel's own at first.
class Workshop {
 public:
  /// `of_case` are the folders that a case names.
  explicit Workshop(const Options& options, const std::vector<std::string>& of_case = {});
  Loader loader;
  Registry registry;
};

class Session {
 public:
  /// Reads and checks the case and builds everything. Throws UserError, and what assemble() throws. `quick` leaves out
  /// what takes long and changes nothing that is shown.
  Session(const Options& options, const std::string& case_file, bool quick);

  Workshop& workshop() { return *workshop_; }
  const CaseFile& file() const { return *file_; }
  const CaseModel& model() const { return *model_; }
  Simulation& run() { return *assembly_->run; }
  Recorder& recorder() { return *recorder_; }

 private:
  void read(Diagnostics& diagnostics);
  void build(const Options& options, bool quick);

  // In this order, since each refers to those before it.
  std::unique_ptr<CaseFile> file_;
  std::unique_ptr<Workshop> workshop_;
  std::unique_ptr<CaseModel> model_;
  std::unique_ptr<Assembly> assembly_;
  std::unique_ptr<Recorder> recorder_;
};

/// Where something on the command line stands, for messages: an option with its value, or a path.
Place option_place(const std::string& text);

/// A time such as "30 min" of the command line, in s. Throws UserError.
double read_time(const std::string& option, const std::string& text);

/// The name of a case: that of its file without folder and ending.
std::string case_name(const std::string& case_file);

}  // namespace shoal::kernel::app
