// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// PVD files are a few lines of XML, written here and read with VTK's parser.
#include "time_series.hpp"

#include <vtkSmartPointer.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>

#include <array>
#include <charconv>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "atomic_file.hpp"
#include "vtk_setup.hpp"

namespace shoal::vtk {

namespace {

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

// The shortest text that reads back as the same number, in any locale.
std::string to_text(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

// The sequence number of a picture of this body, if `file` is the name of one.
std::optional<std::uint64_t> sequence_of(std::string_view file, std::string_view body) {
  constexpr std::string_view extension = ".vtp";
  if (!file.starts_with(body) || !file.ends_with(extension)) return {};
  file.remove_prefix(body.size());
  file.remove_suffix(extension.size());
  if (file.size() < 6 || file.front() != '_') return {};
  file.remove_prefix(1);
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(file.data(), file.data() + file.size(), number);
  if (error != std::errc{} || end != file.data() + file.size()) return {};
  return number;
}

}  // namespace

std::string picture_name(const std::string& body, std::uint64_t sequence) {
  std::string digits = std::to_string(sequence);
  if (digits.size() < 5) digits.insert(0, 5 - digits.size(), '0');
  return body + "_" + digits + ".vtp";
}

TimeSeries::TimeSeries(const std::filesystem::path& folder, std::string body, std::uint64_t resumed_sequence)
    : folder_(folder), body_(std::move(body)), resumed_sequence_(resumed_sequence) {
  if (resumed_sequence_ > 0) read(resumed_sequence_);
}

void TimeSeries::read(std::uint64_t resumed_sequence) {
  const std::filesystem::path file = folder_ / (body_ + ".pvd");
  if (!std::filesystem::exists(file)) return;
  set_up_vtk();
  const auto root =
      vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(file.c_str()));
  auto* collection = root ? root->FindNestedElementWithName("Collection") : nullptr;
  if (!collection)
    throw std::runtime_error("cannot continue the list of pictures '" + file.string() +
                             "', since it is not a PVD file; move it away to start a new one");
  for (int k = 0; k < collection->GetNumberOfNestedElements(); ++k) {
    auto* entry = collection->GetNestedElement(k);
    const char* name = entry->GetAttribute("file");
    const char* time = entry->GetAttribute("timestep");
    const auto sequence = name && time ? sequence_of(name, body_) : std::nullopt;
    if (sequence && *sequence < resumed_sequence && std::filesystem::exists(folder_ / name))
      times_[*sequence] = time;
  }
}

void TimeSeries::add(std::uint64_t sequence, double time) {
  times_[sequence] = to_text(time);
  std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "  <Collection>\n";
  for (const auto& [number, written_time] : times_)
    text += "    <DataSet timestep=\"" + escaped(written_time) + "\" part=\"0\" file=\"" +
            escaped(picture_name(body_, number)) + "\"/>\n";
  text += "  </Collection>\n</VTKFile>\n";
  write_atomically(folder_ / (body_ + ".pvd"), "." + body_ + ".pvd.tmp", text);
}

void TimeSeries::remove_forgotten() const {
  std::error_code ignored;  // a leftover that stays does no harm to what is listed
  std::filesystem::directory_iterator entry(folder_, ignored);
  for (; entry != std::filesystem::directory_iterator(); entry.increment(ignored)) {
    const auto sequence = sequence_of(entry->path().filename().string(), body_);
    if (sequence && *sequence >= resumed_sequence_ && !times_.contains(*sequence))
      std::filesystem::remove(entry->path(), ignored);
  }
}

}  // namespace shoal::vtk
