// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/output/dump_table.hpp"

#include <limits>
#include <ostream>

#include "kernel/output/atomic_file.hpp"
#include "kernel/output/field_part.hpp"

namespace shoal::kernel {
namespace {

void write_headers(std::ostream& stream, const Simulation& run, std::uint32_t body) {
  stream << "id";
  for (const FieldInfo& field : run.fields(body)) {
    const std::vector<std::string> parts = part_names(field.rank, run.dimensions(), field.components);
    for (std::uint32_t c = 0; c < field.components; ++c)
      stream << ',' << field.name << (field.components == 1 ? "" : "." + parts[c]) << " [" << field.unit
             << ']';
  }
  stream << '\n';
}

void write_rows(std::ostream& stream, const Simulation& run, std::uint32_t body) {
  const std::vector<FieldInfo> fields = run.fields(body);
  for (std::uint64_t i = 0; i < run.n_particles(body); ++i) {
    stream << run.ids(body)[i];
    for (const FieldInfo& info : fields) {
      const shoal_field field = run.field(body, info.name);
      for (std::uint32_t c = 0; c < info.components; ++c) {
        const std::uint64_t k = i * info.components + c;
        stream << ',';
        if (info.data_type == SHOAL_INT64)
          stream << static_cast<const std::int64_t*>(field.data)[k];
        else
          stream << static_cast<const double*>(field.data)[k];
      }
    }
    stream << '\n';
  }
}

}  // namespace

void dump_tables(const Simulation& run, const std::filesystem::path& folder) {
  make_folder(folder);
  for (std::uint32_t body = 0; body < run.n_bodies(); ++body) {
    AtomicFile file(folder / (run.body_name(body) + ".csv"));
    file.stream().precision(std::numeric_limits<double>::max_digits10);
    write_headers(file.stream(), run, body);
    write_rows(file.stream(), run, body);
    file.commit();
  }
}

}  // namespace shoal::kernel
