// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The built plugin as the kernel meets it: through dlopen and the C contract alone.
#include <dlfcn.h>
#include <doctest/doctest.h>
#include <unistd.h>
#include <vtkPointData.h>

#include <cstring>
#include <fstream>
#include <map>

#include "sample.hpp"

using namespace shoal::vtk::test;

namespace {

std::string failure_text;

const shoal_host& test_host() {
  static const shoal_host host = [] {
    shoal_host h{};
    h.size = sizeof(shoal_host);
    h.abi_major = SHOAL_ABI_MAJOR;
    h.abi_minor = SHOAL_ABI_MINOR;
    h.version = "test";
    h.log = [](std::uint32_t, const char*) {};
    h.fail = [](const char* text) { failure_text = text; };
    return h;
  }();
  return host;
}

const shoal_plugin& plugin() {
  static const shoal_plugin* const loaded = [] {
    void* library = dlopen(SHOAL_PLUGINS_FOLDER "/vtk.so", RTLD_NOW | RTLD_LOCAL);
    INFO(std::string(library ? "" : dlerror()));
    REQUIRE(library != nullptr);
    const auto* stamp = static_cast<const shoal_stamp*>(dlsym(library, SHOAL_STAMP_SYMBOL));
    REQUIRE(stamp != nullptr);
    CHECK(stamp->magic == SHOAL_ABI_MAGIC);
    CHECK(stamp->abi_major == SHOAL_ABI_MAJOR);
    const auto entry = reinterpret_cast<shoal_plugin_entry_function>(dlsym(library, SHOAL_ENTRY_SYMBOL));
    REQUIRE((entry != nullptr));
    return entry(&test_host());
  }();
  REQUIRE(loaded != nullptr);
  return *loaded;
}

// An object of type `vtk` with the words given and the defaults of the parameter table for the others.
class Object {
 public:
  explicit Object(const shoal_type& type, const std::map<std::string, const char*>& words = {})
      : values_(type.n_parameters), words_(type.n_parameters) {
    for (std::uint32_t k = 0; k < type.n_parameters; ++k) {
      const shoal_parameter& parameter = type.parameters[k];
      const auto found = words.find(parameter.key);
      words_[k] = found != words.end() ? found->second : parameter.default_text;
      values_[k] = {};
      values_[k].size = sizeof(shoal_value);
      values_[k].kind = parameter.kind;
      values_[k].n = words_[k] ? 1 : 0;
      values_[k].texts = &words_[k];
      values_[k].place = "test.yaml:1:1";
    }
    object_ = {sizeof(shoal_object), type.n_parameters, &type, values_.data(), "test.yaml:1:1"};
  }
  const shoal_object* c() const { return &object_; }

 private:
  std::vector<shoal_value> values_;
  std::vector<const char*> words_;
  shoal_object object_{};
};

const shoal_output_api& api() { return *static_cast<const shoal_output_api*>(plugin().types[0]->api); }

int threads_of_this_process() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("Threads:")) return std::stoi(line.substr(8));
  return 0;
}

// What this process writes to its standard output and error as long as this lives.
class Capture {
 public:
  Capture() : out_(dup(1)), error_(dup(2)) {
    fflush(nullptr);
    FILE* file = fopen("captured", "w");
    dup2(fileno(file), 1);
    dup2(fileno(file), 2);
    fclose(file);
  }
  ~Capture() { restore(); }
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;
  std::uintmax_t bytes() {
    restore();
    return std::filesystem::file_size("captured");
  }

 private:
  void restore() {
    fflush(nullptr);
    dup2(out_, 1);
    dup2(error_, 2);
  }
  int out_, error_;
};

}  // namespace

TEST_CASE("the plugin registers one output with its parameters") {
  CHECK(std::string(plugin().id) == "vtk");
  REQUIRE(plugin().n_types == 1);
  const shoal_type& type = *plugin().types[0];
  CHECK(std::string(type.name) == "vtk");
  CHECK(type.kind == SHOAL_TYPE_OUTPUT);
  std::map<std::string, const shoal_parameter*> parameters;
  for (std::uint32_t k = 0; k < type.n_parameters; ++k) {
    parameters[type.parameters[k].key] = &type.parameters[k];
    CHECK((type.parameters[k].flags & SHOAL_PARAMETER_REQUIRED) == 0);
    CHECK(std::strlen(type.parameters[k].doc) > 10);
    CHECK(type.parameters[k].example != nullptr);
  }
  REQUIRE(parameters.size() == 6);
  REQUIRE(parameters.contains("every"));
  CHECK(parameters["every"]->kind == SHOAL_REAL);
  CHECK(std::string(parameters["every"]->unit) == "s");
  CHECK((parameters["every"]->flags & SHOAL_PARAMETER_MINIMUM_EXCLUDED) > 0);
  REQUIRE(parameters.contains("at"));
  CHECK((parameters["at"]->flags & SHOAL_PARAMETER_LIST) != 0);
  REQUIRE(parameters.contains("bodies"));
  CHECK(parameters["bodies"]->kind == SHOAL_BODY);
  REQUIRE(parameters.contains("fields"));
  CHECK(parameters["fields"]->kind == SHOAL_FIELD);
  REQUIRE(parameters.contains("precision"));
  CHECK(std::string(parameters["precision"]->default_text) == "single");
  REQUIRE(parameters.contains("compression"));
  CHECK(parameters["compression"]->n_choices == 3);
  CHECK(std::string(parameters["compression"]->default_text) == "fast");
}

TEST_CASE("pictures through the C contract: no thread is started and nothing is printed") {
  const auto folder = scratch("plugin");
  const Body body = sample_body("water", 2, 30000);
  const std::vector bodies{body.c()};
  const int threads = threads_of_this_process();
  Capture capture;
  const Object object(*plugin().types[0]);
  void* self = nullptr;
  REQUIRE(api().create(object.c(), folder.c_str(), "A case", 0, &self) == SHOAL_OK);
  for (std::uint64_t k = 0; k < 3; ++k) {
    const shoal_snapshot snapshot = snapshot_of(bodies, 2, 0.5 * static_cast<double>(k), k);
    REQUIRE(api().write(self, &snapshot) == SHOAL_OK);
  }
  // A failure is told to the host, and to nobody else.
  std::filesystem::create_directory(folder / "water_00003.vtp");
  const shoal_snapshot snapshot = snapshot_of(bodies, 2, 1.5, 3);
  CHECK(api().write(self, &snapshot) == SHOAL_ERROR);
  api().destroy(self);
  CHECK(capture.bytes() == 0);
  CHECK(threads_of_this_process() == threads);
  CHECK(failure_text == "cannot write '" + (folder / "water_00003.vtp").string() +
                            "': Is a directory; the pictures written before are complete");
  const auto picture = read_picture(folder / "water_00002.vtp");
  REQUIRE(picture != nullptr);
  CHECK(picture->GetNumberOfPoints() == 30000);
}

TEST_CASE("parameters reach the files") {
  const Body body = sample_body("water", 3, 20000);
  const std::vector bodies{body.c()};
  const shoal_snapshot snapshot = snapshot_of(bodies, 3, 0, 0);
  const auto size_with = [&](const std::map<std::string, const char*>& words) {
    const auto folder = scratch("parameters");
    const Object object(*plugin().types[0], words);
    void* self = nullptr;
    REQUIRE(api().create(object.c(), folder.c_str(), "", 0, &self) == SHOAL_OK);
    CHECK(api().write(self, &snapshot) == SHOAL_OK);
    api().destroy(self);
    return std::filesystem::file_size(folder / "water_00000.vtp");
  };
  const auto fast = size_with({}), small = size_with({{"compression", "small"}});
  const auto none = size_with({{"compression", "none"}});
  const auto exact = size_with({{"compression", "none"}, {"precision", "double"}});
  CHECK(small < fast);
  CHECK(fast < none);
  // 4 bytes more for each of 33 components (points, 1 + 3 + 6 + 9 + 11), which base64 makes 4/3 as long, but for the
  // length of texts in the header.
  CHECK(std::abs(static_cast<double>(exact) - static_cast<double>(none) - 20000.0 * 4 * 33 * 4 / 3) < 1000);
}

TEST_CASE("a folder that cannot be made is an error of create") {
  const auto folder = scratch("no_folder");
  std::ofstream(folder / "file") << "";
  const Object object(*plugin().types[0]);
  void* self = nullptr;
  CHECK(api().create(object.c(), (folder / "file").c_str(), "", 0, &self) == SHOAL_ERROR);
  CHECK(self == nullptr);
  CHECK(failure_text.find("Not a directory") != std::string::npos);
}

TEST_CASE("a snapshot of a newer kernel, with longer structs, is understood") {
  struct NewerField : shoal_snapshot_field {
    double more[3]{1, 2, 3};
  };
  struct NewerBody : shoal_snapshot_body {
    double more[5]{1, 2, 3, 4, 5};
  };
  const auto folder = scratch("newer");
  const Body water = sample_body("water", 3, 100), tank = sample_body("tank", 3, 50);
  std::vector<std::vector<NewerField>> fields;
  std::vector<NewerBody> bodies;
  for (const Body* body : {&water, &tank}) {
    const shoal_snapshot_body plain = body->c();
    auto& list = fields.emplace_back();
    for (std::uint32_t f = 0; f < plain.n_fields; ++f) {
      list.push_back({plain.fields[f]});
      list.back().size = sizeof(NewerField);
    }
    bodies.push_back({plain});
    bodies.back().size = sizeof(NewerBody);
    bodies.back().fields = list.data();
  }
  const shoal_snapshot snapshot{sizeof(shoal_snapshot), 3, 0, 0, 0, 2, 0, bodies.data()};
  const Object object(*plugin().types[0]);
  void* self = nullptr;
  REQUIRE(api().create(object.c(), folder.c_str(), "", 0, &self) == SHOAL_OK);
  CHECK(api().write(self, &snapshot) == SHOAL_OK);
  api().destroy(self);
  for (const char* file : {"water_00000.vtp", "tank_00000.vtp"}) {
    const auto picture = read_picture(folder / file);
    REQUIRE(picture != nullptr);
    CHECK(picture->GetPointData()->GetNumberOfArrays() == 7);
  }
}
