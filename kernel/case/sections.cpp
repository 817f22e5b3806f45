// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The tables of the sections. Names, units, defaults and bounds stand here and nowhere else.
#include "kernel/case/sections.hpp"

#include <array>
#include <initializer_list>

#include "shoal/smoothing_kernel.hpp"

namespace shoal::kernel {
namespace {

constexpr std::uint32_t required = SHOAL_PARAMETER_REQUIRED;
constexpr std::uint32_t list = SHOAL_PARAMETER_LIST;
constexpr std::uint32_t positive = SHOAL_PARAMETER_HAS_MINIMUM | SHOAL_PARAMETER_MINIMUM_EXCLUDED;
constexpr std::uint32_t not_negative = SHOAL_PARAMETER_HAS_MINIMUM;

shoal_parameter row(std::uint32_t kind, const char* key, const char* unit, std::uint32_t flags,
                    const char* default_text, const char* doc, const char* example) {
  shoal_parameter p{};
  p.size = sizeof(shoal_parameter);
  p.kind = kind;
  p.flags = flags;
  p.key = key;
  p.unit = unit;
  p.default_text = default_text;
  p.doc = doc;
  p.example = example;
  return p;
}

shoal_parameter with_objects(shoal_parameter p, shoal_type_kind kind) {
  p.object_kind = kind;
  return p;
}

shoal_parameter with_choices(shoal_parameter p, const std::vector<const char*>& words) {
  p.choices = words.data();
  p.n_choices = static_cast<std::uint32_t>(words.size());
  return p;
}

shoal_parameter with_bounds(shoal_parameter p, double minimum, double maximum) {
  p.flags |= SHOAL_PARAMETER_HAS_MINIMUM | SHOAL_PARAMETER_HAS_MAXIMUM;
  p.minimum = minimum;
  p.maximum = maximum;
  return p;
}

shoal_type table(const char* name, const char* doc, const std::vector<shoal_parameter>& rows) {
  shoal_type type{};
  type.size = sizeof(shoal_type);
  type.name = name;
  type.doc = doc;
  type.n_parameters = static_cast<std::uint32_t>(rows.size());
  type.parameters = rows.data();
  return type;
}

const std::vector<const char*>& kernel_names() {
  static const std::vector<const char*> names = [] {
    std::vector<const char*> words;
    for (const std::string_view name : smoothing_kernel_names) words.push_back(name.data());
    return words;
  }();
  return names;
}

const shoal_type& smoothing_table() {
  static const std::vector<shoal_parameter> rows{
      with_choices(row(SHOAL_CHOICE, "kernel", nullptr, 0, "wendland_c2",
                       "Smoothing kernel W of all bodies that do not choose another.", "wendland_c4"),
                   kernel_names()),
      with_bounds(
          row(SHOAL_REAL, "ratio", "1", 0, "1.3",
              "Smoothing length over the distance of the particles; more is smoother and slower.", "1.5"),
          0.8, 4.0),
  };
  static const shoal_type type = table("smoothing", "Smoothing kernel and smoothing length.", rows);
  return type;
}

const shoal_type& domain_table() {
  static const std::vector<const char*> axes{"x", "y", "z"};
  static const std::vector<const char*> faces{"lower_x", "upper_x", "lower_y",
                                              "upper_y", "lower_z", "upper_z"};
  static const std::vector<shoal_parameter> rows{
      row(SHOAL_VECTOR, "lower", "m", 0, "[-inf, -inf, -inf]",
          "Lower corner of the box that particles must not leave; -inf where it is open.", "[0, 0]"),
      row(SHOAL_VECTOR, "upper", "m", 0, "[inf, inf, inf]", "Upper corner of that box; inf where it is open.",
          "[1 m, 1 m]"),
      with_choices(
          row(SHOAL_CHOICE, "periodic", nullptr, list, "[]",
              "Axes along which the domain repeats; what leaves through one face enters through the other.",
              "[x, y]"),
          axes),
      with_choices(
          row(SHOAL_CHOICE, "mirror", nullptr, list, "[]",
              "Faces that are planes of symmetry: particles see their own images behind them.", "[lower_x]"),
          faces),
  };
  static const shoal_type type =
      table("domain",
            "The box that the case takes place in, and what its faces are. Open without this section.", rows);
  return type;
}

const shoal_type& body_table() {
  static const std::vector<const char*> arrangements{"cubic", "hexagonal", "relaxed"};
  static const std::vector<shoal_parameter> rows{
      with_objects(row(SHOAL_OBJECT, "shape", nullptr, required, nullptr, "Where the body is at the start.",
                       "{box: {lower: [0, 0], upper: [2, 1]}}"),
                   SHOAL_TYPE_SHAPE),
      with_objects(row(SHOAL_OBJECT, "material", nullptr, 0, nullptr, "What it is made of.",
                       "{fluid.liquid: {density: 1000}}"),
                   SHOAL_TYPE_MATERIAL),
      row(SHOAL_REAL, "resolution", "m", positive, nullptr,
          "Initial distance of its particles, where it is not the resolution of the case.", "$dx/2"),
      with_choices(
          row(SHOAL_CHOICE, "arrangement", nullptr, 0, "cubic",
              "How its particles are laid out: on a cubic or hexagonal lattice, or disordered but uniform "
              "(relaxed), which sheared flows without walls should start from.",
              "relaxed"),
          arrangements),
      with_choices(row(SHOAL_CHOICE, "smoothing_kernel", nullptr, 0, nullptr,
                       "Smoothing kernel, where it is not that of the case.", "cubic_spline"),
                   kernel_names()),
      with_bounds(
          row(SHOAL_REAL, "smoothing_ratio", "1", 0, nullptr,
              "Smoothing length over the distance of its particles, where it is not that of the case.",
              "1.5"),
          0.8, 4.0),
      row(kind_field_map, "initial", nullptr, 0, nullptr,
          "Fields at the start: numbers or expressions of x, y, z; a list for the components of a vector.",
          "{velocity: [\"U*y/H\", 0]}"),
  };
  static const shoal_type type = table("body", "A set of particles of one material.", rows);
  return type;
}

const shoal_type& run_table() {
  static const std::vector<shoal_parameter> rows{
      row(SHOAL_REAL, "end", "s", required | positive, nullptr, "Time at which the run ends.", "2 s"),
      row(kind_number_map, "time_step_factors", "1", positive, nullptr,
          "Factors on the largest stable time steps of loops, by their names (see shoal plan).",
          "{acoustic: 0.5}"),
      row(SHOAL_REAL, "checkpoint_every", "s", positive, nullptr,
          "Time between checkpoints; without it there is one when the run is interrupted or ends.", "0.5 s"),
  };
  static const shoal_type type = table("run", "How long the case runs.", rows);
  return type;
}

const shoal_type& probe_table() {
  static const std::vector<shoal_parameter> rows{
      row(SHOAL_REAL, "every", "s", required | positive, nullptr, "Time between two values.", "5 ms"),
  };
  static const shoal_type type = table(
      "probe", "Numbers that are watched during the run and written to a table: one probe type and 'every'.",
      rows);
  return type;
}

const shoal_type& reference_table() {
  static const std::vector<const char*> measures{"rms",  "relative_rms", "max",    "peak",     "final",
                                                 "mean", "arrival",      "period", "amplitude"};
  static const std::vector<shoal_parameter> rows{
      row(SHOAL_TEXT, "probe", nullptr, required, nullptr, "Name of the probe that is compared.", "front"),
      row(SHOAL_TEXT, "column", nullptr, 0, nullptr, "Column of the probe; its first without this key.",
          "value"),
      row(SHOAL_FILE, "data", nullptr, 0, nullptr, "Table (CSV) of times and values to compare with.",
          "reference/martin_moyce_1952.csv"),
      row(SHOAL_EXPRESSION, "exact", nullptr, 0, nullptr,
          "Exact value as an expression of t, instead of data.", "\"exp(-2*t)\""),
      row(SHOAL_TEXT, "time_column", nullptr, 0, "1",
          "Column of the times in the data, by name or number from 1.", "t"),
      row(SHOAL_TEXT, "value_column", nullptr, 0, "2",
          "Column of the values in the data, by name or number from 1.", "pressure"),
      row(SHOAL_REAL, "time_scale", "s", positive, "1", "What 1 in the column of times means.", "1 ms"),
      row(SHOAL_REAL, "time_shift", "s", 0, "0", "Added to the times of the data.", "0.1 s"),
      row(SHOAL_REAL, "value_scale", nullptr, 0, "1", "Factor from the values of the data to SI units.",
          "1000"),
      row(SHOAL_REAL, "value_shift", nullptr, 0, "0", "Added to the values of the data, in SI units.", "0"),
      with_choices(
          row(SHOAL_CHOICE, "error", nullptr, 0, "rms",
              "rms: root of the mean square difference over the largest value; relative_rms: over "
              "the root of "
              "the mean square value; max: largest difference over the largest value; peak: "
              "difference of the "
              "largest values; final: difference at the last time; mean: mean magnitude of the difference; "
              "arrival: of the times at which half the reference's largest value is reached; period: of "
              "the mean times between rises through the mean; amplitude: of half the differences between "
              "largest and least value.",
              "max"),
          measures),
      row(SHOAL_REAL, "tolerance", "1", required | positive, nullptr,
          "Largest error with which the case passes.", "5 %"),
      row(SHOAL_REAL, "mean_tolerance", "1", positive, nullptr,
          "The same for the mean over the runs of an ensemble; 'tolerance' without this key.", "2 %"),
      row(SHOAL_REAL, "scale", nullptr, positive, nullptr,
          "What differences are divided by instead, in SI units.", "1000"),
      row(SHOAL_REAL, "average", "s", positive, nullptr,
          "Window about each time over which the probe is averaged, where the data are means of such "
          "windows.",
          "20 ms"),
      row(SHOAL_REAL, "from", "s", not_negative, "0", "Times before are not compared.", "0.1 s"),
      row(SHOAL_REAL, "to", "s", positive, nullptr, "Times after are not compared.", "1 s"),
  };
  static const shoal_type type =
      table("reference", "What is known of the case: a probe against data or an exact value.", rows);
  return type;
}

const std::vector<shoal_parameter>& case_rows() {
  static const std::vector<shoal_parameter> rows{
      row(SHOAL_INTEGER, "shoal", nullptr, required, nullptr, "Version of the format of cases; it is 1.",
          "1"),
      row(SHOAL_TEXT, "title", nullptr, 0, "\"\"", "One line about the case.",
          "Dam break against a wall, 2D"),
      row(SHOAL_TEXT, "plugins", nullptr, list, "[]", "Plugins that the case needs; no other is loaded.",
          "[fluid, vtk]"),
      row(SHOAL_TEXT, "plugin_paths", nullptr, list, "[]",
          "Folders to look for plugins in, relative to the case. Their code runs with your rights, so they "
          "count only "
          "with --allow-plugin-paths.",
          "[../build/plugins]"),
      with_bounds(row(SHOAL_INTEGER, "dimensions", nullptr, required, nullptr, "2 or 3.", "2"), 2, 3),
      row(kind_parameters, "parameters", nullptr, 0, nullptr,
          "Numbers with names, for expressions and --set; they may refer to one another.",
          "{H: 1 m, dx: $H/40}"),
      row(SHOAL_REAL, "resolution", "m", required | positive, nullptr, "Initial distance of the particles.",
          "$dx"),
      row(kind_section, "smoothing", nullptr, 0, nullptr, "Smoothing kernel and smoothing length.",
          "{kernel: wendland_c2, ratio: 1.3}"),
      row(SHOAL_VECTOR, "gravity", "m/s2", 0, "[0, 0, 0]", "Acceleration of gravity.", "[0, -9.81]"),
      row(kind_section, "domain", nullptr, 0, nullptr, "The box that the case takes place in.",
          "{lower: [0, 0], upper: [1, 1], periodic: [x, y]}"),
      row(kind_named_items, "bodies", nullptr, required, nullptr, "Bodies by name.",
          "{water: {shape: {box: {lower: [0, 0], upper: [2, 1]}}, material: {fluid.liquid: {density: "
          "1000}}}}"),
      with_objects(row(SHOAL_OBJECT, "physics", nullptr, list, "[]", "What happens to the bodies.",
                       "[fluid.wcsph: {bodies: [water], walls: [tank]}]"),
                   SHOAL_TYPE_PHYSICS),
      row(kind_section, "run", nullptr, required, nullptr, "How long the case runs.", "{end: 2 s}"),
      with_objects(row(SHOAL_OBJECT, "output", nullptr, list, "[]", "What is written.",
                       "[vtk: {every: 50 ms, fields: [velocity, pressure]}]"),
                   SHOAL_TYPE_OUTPUT),
      row(kind_named_items, "probes", nullptr, 0, nullptr, "Numbers that are watched, by name.",
          "{front: {maximum: {of: position.x, body: water}, every: 5 ms}}"),
      row(kind_listed_items, "reference", nullptr, 0, nullptr, "What probes are compared with.",
          "[{probe: front, data: front.csv, tolerance: 5 %}]"),
      row(SHOAL_TEXT, "study", nullptr, list, "[]",
          "What `shoal study` and `shoal report` vary where the command line does not: KEY=VALUE,VALUE,...",
          "[\"dx=$H/20,$H/40,$H/80\"]"),
      row(SHOAL_TEXT, "ensemble", nullptr, 0, nullptr,
          "Runs of `shoal study` and `shoal report` that differ by chance alone, KEY=VALUE,VALUE,...: where "
          "no two runs of a flow are the same, references are compared with their mean.",
          "\"physics.0.fluid.wcsph.acoustic_cfl=0.88,0.87,0.86\""),
      row(SHOAL_TEXT, "limits", nullptr, list, "[]",
          "Other values, KEY=VALUE, with which `--limits` of `shoal study` and `shoal report` looks for the "
          "longest "
          "stable time steps, so that it does not take long.",
          "[run.end=0.5 s]"),
  };
  return rows;
}

}  // namespace

const shoal_type& case_table() {
  static const shoal_type type =
      table("case", "A case: what there is, what happens to it, and what is written.", case_rows());
  return type;
}

const shoal_type* section_table(std::string_view key) {
  if (key == "smoothing") return &smoothing_table();
  if (key == "domain") return &domain_table();
  if (key == "bodies") return &body_table();
  if (key == "run") return &run_table();
  if (key == "probes") return &probe_table();
  if (key == "reference") return &reference_table();
  return nullptr;
}

std::vector<const shoal_type*> section_tables() {
  return {&case_table(), &smoothing_table(), &domain_table(),   &body_table(),
          &run_table(),  &probe_table(),     &reference_table()};
}

std::vector<std::string> section_keys() {
  std::vector<std::string> keys;
  for (const shoal_parameter& parameter : case_rows()) keys.emplace_back(parameter.key);
  return keys;
}

}  // namespace shoal::kernel
