// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A case, read and checked as a whole before anything is built from it.
//
//   Diagnostics diagnostics;
//   CaseFile file("dam_break.yaml", {"H=0.5m"}, diagnostics);     // the text and --set
//   ... load file.plugins() and register their types ...
//   std::unique_ptr<CaseModel> model = check_case(file, types, diagnostics);
//   diagnostics.throw_if_errors();
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kernel/case/diagnostics.hpp"
#include "kernel/case/expression.hpp"
#include "kernel/case/parameters.hpp"
#include "kernel/case/schema.hpp"
#include "kernel/case/yaml_reader.hpp"
#include "shoal/abi.h"

namespace shoal::kernel {

struct PluginRequest {
  std::string id;
  Place place;
};

/// The file with the settings of the command line, before the types of its plugins are known.
class CaseFile {
 public:
  CaseFile(const std::string& path, const std::vector<std::string>& settings, Diagnostics& diagnostics);
  /// The same of a text; `folder` is where relative paths of files begin.
  CaseFile(const std::string& text, const std::string& name, const std::string& folder,
           const std::vector<std::string>& settings, Diagnostics& diagnostics);

  /// False if the text is not YAML; there is nothing more to check then.
  bool readable() const { return root_.is_map(); }
  const std::vector<PluginRequest>& plugins() const { return plugins_; }
  /// Folders of plugins, absolute.
  const std::vector<std::string>& plugin_paths() const { return plugin_paths_; }
  const Node& root() const { return root_; }
  const std::string& name() const { return name_; }
  const std::string& folder() const { return folder_; }

 private:
  void finish(const std::vector<std::string>& settings, Diagnostics& diagnostics);
  void read_plugin_paths();
  std::string name_;
  std::string folder_;
  Node root_;
  std::vector<PluginRequest> plugins_;
  std::vector<std::string> plugin_paths_;
};

struct InitialValue {
  std::string field;
  std::vector<Expression> components;
  std::string place;
};

struct BodyModel {
  std::string name;
  std::string place;
  const shoal_object* shape = nullptr;
  const shoal_object* material = nullptr;  ///< null: none
  double resolution = 0;                   ///< m
  std::string arrangement;                 ///< cubic, hexagonal, relaxed
  std::string smoothing_kernel;
  double smoothing_ratio = 0;
  std::vector<InitialValue> initial;
  const shoal_object* values = nullptr;  ///< of section_table("bodies")
};

struct ProbeModel {
  std::string name;
  std::string place;
  const shoal_object* object = nullptr;  ///< of a type of kind SHOAL_TYPE_PROBE
  double every = 0;                      ///< s
  const shoal_object* values = nullptr;  ///< of section_table("probes")
};

struct ReferenceModel {
  std::string place;
  std::string probe;
  std::optional<std::string> column;
  std::optional<std::string> data;  ///< absolute path; or
  std::optional<Expression> exact;  ///< of t
  std::string time_column, value_column;
  double time_scale = 1, time_shift = 0;  ///< s
  double value_scale = 1, value_shift = 0;
  std::string error;  ///< rms, relative_rms, max, peak, final
  double tolerance = 0;
  std::optional<double> mean_tolerance;  ///< of the mean over an ensemble
  std::optional<double> scale;
  std::optional<double> average;         ///< s
  double from = 0;                       ///< s
  std::optional<double> to;              ///< s
  const shoal_object* values = nullptr;  ///< of section_table("reference")
};

struct DomainModel {
  std::array<double, 3> lower{}, upper{};  ///< m; infinite where open
  std::array<bool, 3> periodic{};
  std::array<bool, 3> mirror_lower{}, mirror_upper{};
  const shoal_object* values = nullptr;  ///< of section_table("domain")
};

struct RunModel {
  double end = 0;  ///< s
  std::vector<std::pair<std::string, double>> time_step_factors;
  std::optional<double> checkpoint_every;  ///< s
  const shoal_object* values = nullptr;    ///< of section_table("run")
};

/// Everything that a case says, in SI units. Owns all that it points to.
struct CaseModel {
  std::string name;  ///< of the file, as given
  std::string title;
  std::vector<PluginRequest> plugins;
  int dimensions = 0;
  Parameters parameters;
  double resolution = 0;            ///< m
  std::array<double, 3> gravity{};  ///< m/s2
  DomainModel domain;
  std::vector<BodyModel> bodies;
  std::vector<const shoal_object*> physics;
  RunModel run;
  std::vector<const shoal_object*> outputs;
  std::vector<ProbeModel> probes;
  std::vector<ReferenceModel> references;
  std::vector<std::string> study;           ///< KEY=VALUE,VALUE,...
  std::optional<std::string> ensemble;      ///< KEY=VALUE,VALUE,...
  std::vector<std::string> limits;          ///< KEY=VALUE
  const shoal_object* smoothing = nullptr;  ///< of section_table("smoothing")
  const shoal_object* values = nullptr;     ///< of case_table()
  ObjectStore store;
};

/// Checks everything; what is wrong goes to `diagnostics`, and the model is good only if there is no error.
std::unique_ptr<CaseModel> check_case(const CaseFile& file, const TypeCatalogue& types,
                                      Diagnostics& diagnostics);

}  // namespace shoal::kernel
