// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// From the tree to the model: sections against their tables, then what only several values together can violate.
#include "kernel/case/model.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "kernel/case/overrides.hpp"
#include "kernel/case/scalars.hpp"
#include "kernel/case/sections.hpp"

namespace shoal::kernel {
namespace {

constexpr const char* axis_names = "xyz";

// Typed access to the values of the kernel's own tables.
class Values {
 public:
  Values(const shoal_object& object, const shoal_type& table) : object_(object), table_(table) {}

  bool is_set(const char* key) const { return value(key).n > 0; }
  double real(const char* key) const { return is_set(key) ? value(key).reals[0] : 0.0; }
  std::optional<double> optional_real(const char* key) const {
    return is_set(key) ? std::optional<double>(value(key).reals[0]) : std::nullopt;
  }
  std::string text(const char* key) const { return is_set(key) ? value(key).texts[0] : std::string(); }
  std::optional<std::string> optional_text(const char* key) const {
    return is_set(key) ? std::optional<std::string>(value(key).texts[0]) : std::nullopt;
  }
  const shoal_object* object(const char* key) const { return is_set(key) ? value(key).objects[0] : nullptr; }
  std::vector<std::string> texts(const char* key) const {
    const shoal_value& v = value(key);
    return v.texts == nullptr ? std::vector<std::string>() : std::vector<std::string>(v.texts, v.texts + v.n);
  }
  std::vector<const shoal_object*> objects(const char* key) const {
    const shoal_value& v = value(key);
    return v.objects == nullptr ? std::vector<const shoal_object*>()
                                : std::vector<const shoal_object*>(v.objects, v.objects + v.n);
  }
  void vector(const char* key, int dimensions, std::array<double, 3>& out) const {
    if (is_set(key)) std::copy_n(value(key).reals, dimensions, out.begin());
  }
  const shoal_value& value(const char* key) const { return *find_value(object_, table_, key); }

 private:
  const shoal_object& object_;
  const shoal_type& table_;
};

const Node& child(const Node& map, const char* key) {
  static const Node nothing;
  const Node* found = map.is_map() ? map.find(key) : nullptr;
  return found != nullptr ? *found : nothing;
}

Place key_place(const Node& map, std::string_view key) {
  for (const Node::Entry& entry : map.entries()) {
    if (entry.key == key) return entry.key_place;
  }
  return map.place();
}

bool is_name(const std::string& name) {
  return !name.empty() && (std::isalpha(static_cast<unsigned char>(name[0])) != 0 || name[0] == '_') &&
         std::all_of(name.begin(), name.end(), [](char c) {
           return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
         });
}

// ------------------------------------------------------------------------------------------------------------

class CaseReader {
 public:
  CaseReader(const CaseFile& file, const TypeCatalogue& types, Diagnostics& diagnostics)
      : file_(file),
        root_(file.root()),
        diagnostics_(diagnostics),
        model_(std::make_unique<CaseModel>()),
        context_{read_dimensions(), model_->parameters, types,      body_names(),
                 file.folder(),     model_->store,      diagnostics} {}

  std::unique_ptr<CaseModel> read() {
    CaseModel& model = *model_;
    model.name = file_.name();
    model.plugins = file_.plugins();
    model.dimensions = context_.dimensions;
    model.parameters = Parameters(child(root_, "parameters"), diagnostics_);
    model.values = read_object(root_, entry(case_table()), Place{root_.place().source, 0, 0, 0}, context_);
    check_format();
    const Values values(*model.values, case_table());
    model.title = values.text("title");
    model.resolution = values.real("resolution");
    values.vector("gravity", context_.dimensions, model.gravity);
    model.physics = values.objects("physics");
    model.outputs = values.objects("output");
    model.study = values.texts("study");
    model.ensemble = values.optional_text("ensemble");
    model.limits = values.texts("limits");
    model.smoothing = section("smoothing");
    read_domain();
    read_bodies();
    read_run();
    read_probes();
    read_references();
    return std::move(model_);
  }

 private:
  static TypeEntry entry(const shoal_type& table) { return {&table, &table}; }

  // Before anything else, silently: the top level is read with everything else, and complains then.
  int read_dimensions() const {
    Diagnostics silent;
    const Node& node = child(root_, "dimensions");
    const Parameters parameters(child(root_, "parameters"), silent);
    const std::optional<double> value = read_number(node, {}, parameters, silent);
    return value == 2.0 ? 2 : value == 3.0 ? 3 : 0;
  }

  std::vector<std::string> body_names() const {
    std::vector<std::string> names;
    const Node& bodies = child(root_, "bodies");
    for (const Node::Entry& body : bodies.entries()) {
      if (!is_note(body.key)) names.push_back(body.key);
    }
    return names;
  }

  void check_format() {
    const Node& node = child(root_, "shoal");
    if (!node.is_scalar() || parse_number(node.text()).status != NumberText::Status::number) return;
    if (parse_number(node.text()).value != 1.0)
      diagnostics_.error(node.place(), "this case is written in format " + node.text() +
                                           "; this version of Shoal reads format 1");
  }

  const shoal_object* section(const char* key) {
    const Node& node = child(root_, key);
    // A required section that is missing was reported with the top level.
    const bool missing = node.is_null() && root_.find(key) == nullptr;
    Diagnostics silent;
    const SchemaContext context{context_.dimensions,
                                context_.parameters,
                                context_.types,
                                context_.bodies,
                                context_.folder,
                                context_.store,
                                missing ? silent : diagnostics_};
    return read_object(node, entry(*section_table(key)), key_place(root_, key), context);
  }

  // The entries of a map of names that the user chose.
  std::vector<Node::Entry> named_items(const char* key, const std::string& what) {
    const Node& node = child(root_, key);
    std::vector<Node::Entry> items;
    if (!node.is_map()) {
      if (root_.find(key) != nullptr && !node.is_null())
        diagnostics_.error(node.place(), "expected a map of names, got " + node.described(),
                           {"write '" + std::string(key) + ":' and below it '  name:' for each " + what});
      return items;
    }
    for (const Node::Entry& item : node.entries()) {
      if (is_note(item.key)) continue;
      if (is_name(item.key)) {
        items.push_back(item);
      } else {
        diagnostics_.error(item.key_place, "'" + item.key + "' cannot be the name of a " + what,
                           {"a name has letters, digits, '_' and '-', and begins with a letter or '_'"});
      }
    }
    return items;
  }

  void read_domain() {
    DomainModel& domain = model_->domain;
    const double infinity = std::numeric_limits<double>::infinity();
    domain.lower = {-infinity, -infinity, -infinity};
    domain.upper = {infinity, infinity, infinity};
    domain.values = section("domain");
    const Values values(*domain.values, *section_table("domain"));
    values.vector("lower", context_.dimensions, domain.lower);
    values.vector("upper", context_.dimensions, domain.upper);
    for (const std::string& axis : values.texts("periodic")) domain.periodic[index_of_axis(axis[0])] = true;
    for (const std::string& face : values.texts("mirror"))
      (face[0] == 'l' ? domain.mirror_lower : domain.mirror_upper)[index_of_axis(face.back())] = true;
    check_domain();
  }

  static std::size_t index_of_axis(char axis) { return static_cast<std::size_t>(axis - 'x'); }

  void check_domain() {
    const DomainModel& domain = model_->domain;
    const Node& node = child(root_, "domain");
    if (!node.is_map()) return;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string axis(1, axis_names[k]);
      const bool mirror = domain.mirror_lower[k] || domain.mirror_upper[k];
      if (context_.dimensions == 2 && k == 2 && (domain.periodic[k] || mirror)) {
        diagnostics_.error(node.find(mirror ? "mirror" : "periodic")->place(),
                           "the case has two dimensions and no z");
        continue;
      }
      if (domain.periodic[k] && mirror)
        diagnostics_.error(node.find("mirror")->place(),
                           "a face of axis " + axis + " cannot be a mirror: the axis is periodic");
      if (domain.lower[k] >= domain.upper[k])
        diagnostics_.error((node.find("upper") != nullptr ? node.find("upper") : node.find("lower"))->place(),
                           "the domain is empty along " + axis + ": lower is " +
                               format_number(domain.lower[k]) + " m, upper is " +
                               format_number(domain.upper[k]) + " m");
      const bool open_lower = std::isinf(domain.lower[k]);
      const bool open_upper = std::isinf(domain.upper[k]);
      const bool wants_lower = domain.periodic[k] || domain.mirror_lower[k];
      const bool wants_upper = domain.periodic[k] || domain.mirror_upper[k];
      if ((wants_lower && open_lower) || (wants_upper && open_upper))
        diagnostics_.error(node.find(domain.periodic[k] ? "periodic" : "mirror")->place(),
                           "axis " + axis + " needs a finite '" +
                               (wants_lower && open_lower ? "lower" : "upper") + "' of the domain",
                           {"example: domain: {lower: [0, 0], upper: [1, 1], periodic: [x]}"});
    }
  }

  void read_bodies() {
    const Values smoothing(*model_->smoothing, *section_table("smoothing"));
    const std::vector<Node::Entry> items = named_items("bodies", "body");
    const Node& node = child(root_, "bodies");
    if (root_.find("bodies") != nullptr && (node.is_null() || (node.is_map() && items.empty())) &&
        node.entries().empty())
      diagnostics_.error(key_place(root_, "bodies"), "there is no body",
                         {"example: bodies: " + std::string(case_row("bodies").example)});
    for (const Node::Entry& item : items) {
      BodyModel body;
      body.name = item.key;
      body.place = item.key_place.text();
      body.values = read_object(item.value, entry(*section_table("bodies")), item.key_place, context_);
      const Values values(*body.values, *section_table("bodies"));
      body.shape = values.object("shape");
      body.material = values.object("material");
      body.resolution = values.optional_real("resolution").value_or(model_->resolution);
      body.arrangement = values.text("arrangement");
      body.smoothing_kernel = values.optional_text("smoothing_kernel").value_or(smoothing.text("kernel"));
      body.smoothing_ratio = values.optional_real("smoothing_ratio").value_or(smoothing.real("ratio"));
      body.initial = initial_values(values.value("initial"));
      model_->bodies.push_back(std::move(body));
    }
  }

  static const shoal_parameter& case_row(std::string_view key) {
    const shoal_type& table = case_table();
    return *std::find_if(table.parameters, table.parameters + table.n_parameters,
                         [key](const shoal_parameter& p) { return key == p.key; });
  }

  static std::vector<InitialValue> initial_values(const shoal_value& value) {
    std::vector<InitialValue> result;
    std::size_t next = 0;
    for (std::uint32_t k = 0; k < value.n; ++k) {
      InitialValue initial{value.texts[k], {}, value.place};
      for (std::int64_t c = 0; c < value.integers[k]; ++c)
        initial.components.push_back(Expression::from_handle(value.expressions[next++]));
      result.push_back(std::move(initial));
    }
    return result;
  }

  void read_run() {
    RunModel& run = model_->run;
    run.values = section("run");
    const Values values(*run.values, *section_table("run"));
    run.end = values.real("end");
    run.checkpoint_every = values.optional_real("checkpoint_every");
    const shoal_value& factors = values.value("time_step_factors");
    for (std::uint32_t k = 0; k < factors.n; ++k)
      run.time_step_factors.emplace_back(factors.texts[k], factors.reals[k]);
  }

  void read_probes() {
    for (const Node::Entry& item : named_items("probes", "probe")) {
      if (!item.value.is_map()) {
        diagnostics_.error(
            item.value.place(), "expected a map of one probe type and 'every', got " + item.value.described(),
            {"example: " + item.key + ": {maximum: {of: position.x, body: water}, every: 5 ms}"});
        continue;
      }
      read_probe(item);
    }
  }

  void read_probe(const Node::Entry& item) {
    const shoal_type& table = *section_table("probes");
    std::vector<Node::Entry> common;
    std::vector<Node::Entry> types;
    std::vector<Node::Entry> others;
    for (const Node::Entry& key : item.value.entries()) {
      const bool known = std::any_of(table.parameters, table.parameters + table.n_parameters,
                                     [&](const shoal_parameter& p) { return key.key == p.key; });
      const bool is_type = static_cast<bool>(context_.types.find(SHOAL_TYPE_PROBE, key.key));
      if (known || is_note(key.key)) {
        common.push_back(key);
      } else {
        (is_type ? types : others).push_back(key);
      }
    }
    // The one that is neither must be the type, misspelt; beside a type it is a misspelt key.
    if (types.empty() && others.size() == 1) {
      types = std::move(others);
      others.clear();
    }
    std::vector<std::string> known_keys;
    for (std::uint32_t k = 0; k < table.n_parameters; ++k) known_keys.emplace_back(table.parameters[k].key);
    if (types.size() != 1) {
      std::vector<std::string> got;
      for (const Node::Entry& key : item.value.entries()) got.push_back("'" + key.key + "'");
      diagnostics_.error(item.key_place,
                         "expected one type of probe beside 'every' in '" + item.key + "', got " +
                             (got.empty() ? "nothing" : join(got)),
                         {"probes: " + join(context_.types.names(SHOAL_TYPE_PROBE))});
      return;
    }
    report_unknown_keys(Node::map(others, item.value.place()), known_keys, "probe", diagnostics_);
    ProbeModel probe;
    probe.name = item.key;
    probe.place = item.key_place.text();
    probe.object =
        read_named_object(types[0].key, types[0].key_place, types[0].value, SHOAL_TYPE_PROBE, context_);
    probe.values = read_object(Node::map(common, item.value.place()), entry(table), item.key_place, context_);
    probe.every = Values(*probe.values, table).real("every");
    model_->probes.push_back(std::move(probe));
  }

  void read_references() {
    const Node& node = child(root_, "reference");
    if (node.is_null()) return;
    if (!node.is_sequence() && !node.is_map()) {
      diagnostics_.error(node.place(), "expected a list of references, got " + node.described(),
                         {"example: reference: " + std::string(case_row("reference").example)});
      return;
    }
    for (const Node& item : node.is_map() ? std::vector<Node>{node} : node.items()) read_reference(item);
  }

  void read_reference(const Node& node) {
    const shoal_type& table = *section_table("reference");
    const std::size_t errors = diagnostics_.n_errors();
    ReferenceModel reference;
    reference.place = node.place().text();
    reference.values = read_object(node, entry(table), node.place(), context_);
    if (diagnostics_.n_errors() > errors) return;
    const Values values(*reference.values, table);
    reference.probe = values.text("probe");
    reference.column = values.optional_text("column");
    reference.data = values.optional_text("data");
    if (values.is_set("exact"))
      reference.exact = Expression::from_handle(values.value("exact").expressions[0]);
    reference.time_column = values.text("time_column");
    reference.value_column = values.text("value_column");
    reference.time_scale = values.real("time_scale");
    reference.time_shift = values.real("time_shift");
    reference.value_scale = values.real("value_scale");
    reference.value_shift = values.real("value_shift");
    reference.error = values.text("error");
    reference.tolerance = values.real("tolerance");
    reference.mean_tolerance = values.optional_real("mean_tolerance");
    reference.scale = values.optional_real("scale");
    reference.average = values.optional_real("average");
    reference.from = values.real("from");
    reference.to = values.optional_real("to");
    check_reference(reference, node);
    model_->references.push_back(std::move(reference));
  }

  void check_reference(const ReferenceModel& reference, const Node& node) {
    std::vector<std::string> probes;
    const Node& section = child(root_, "probes");
    for (const Node::Entry& probe : section.entries()) probes.push_back(probe.key);
    if (std::find(probes.begin(), probes.end(), reference.probe) == probes.end())
      diagnostics_.error(
          node.find("probe")->place(),
          "there is no probe '" + reference.probe + "'" + did_you_mean(reference.probe, probes),
          {probes.empty() ? "the case has no section 'probes'" : "probes: " + join(probes)});
    if (reference.data.has_value() == reference.exact.has_value())
      diagnostics_.error(node.place(),
                         reference.data ? "a reference has 'data' or 'exact', not both"
                                        : "a reference needs 'data' or 'exact'",
                         {"example: data: reference/martin_moyce_1952.csv", "example: exact: \"exp(-2*t)\""});
    if (reference.to && *reference.to <= reference.from)
      diagnostics_.error(node.find("to")->place(),
                         "'to' must be later than 'from' (" + format_number(reference.from) + " s)");
  }

  const CaseFile& file_;
  const Node& root_;
  Diagnostics& diagnostics_;
  std::unique_ptr<CaseModel> model_;
  SchemaContext context_;
};

}  // namespace

CaseFile::CaseFile(const std::string& path, const std::vector<std::string>& settings,
                   Diagnostics& diagnostics)
    : name_(path),
      folder_(std::filesystem::path(path).parent_path().string()),
      root_(read_yaml_file(path, diagnostics)) {
  finish(settings, diagnostics);
}

CaseFile::CaseFile(const std::string& text, const std::string& name, const std::string& folder,
                   const std::vector<std::string>& settings, Diagnostics& diagnostics)
    : name_(name), folder_(folder), root_(read_yaml_text(text, name, diagnostics)) {
  finish(settings, diagnostics);
}

void CaseFile::finish(const std::vector<std::string>& settings, Diagnostics& diagnostics) {
  if (folder_.empty()) folder_ = ".";
  if (!root_.is_map()) return;
  root_ = apply_overrides(root_, settings, section_keys(), diagnostics);
  const Node& plugins = child(root_, "plugins");
  for (const Node& plugin : plugins.is_sequence() ? plugins.items() : std::vector<Node>{plugins}) {
    if (plugin.is_scalar()) plugins_.push_back({plugin.text(), plugin.place()});
  }
  read_plugin_paths();
}

// Made absolute in the tree itself: the effective case, which stands elsewhere, must name the same folders.
void CaseFile::read_plugin_paths() {
  std::vector<Node::Entry> entries = root_.entries();
  for (Node::Entry& entry : entries) {
    if (entry.key != "plugin_paths") continue;
    const Node& value = entry.value;
    std::vector<Node> items = value.is_sequence() ? value.items() : std::vector<Node>{value};
    for (Node& item : items) {
      if (!item.is_scalar()) return;  // reported with everything else
      const std::filesystem::path path = std::filesystem::path(folder_) / item.text();
      plugin_paths_.push_back(std::filesystem::absolute(path).lexically_normal().string());
      item = Node::scalar(plugin_paths_.back(), true, item.place());
    }
    entry.value = Node::sequence(std::move(items), value.place());
  }
  root_ = Node::map(std::move(entries), root_.place());
}

std::unique_ptr<CaseModel> check_case(const CaseFile& file, const TypeCatalogue& types,
                                      Diagnostics& diagnostics) {
  return CaseReader(file, types, diagnostics).read();
}

}  // namespace shoal::kernel
