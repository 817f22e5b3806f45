// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Made for a later version of the same interface: its structs are longer, and it has a kind of type and a kind
// of parameter that this one does not know.
#define PLUGIN_ID "newer_minor"
#define STAMP_MINOR (SHOAL_ABI_MINOR + 5)
#define WITHOUT_TYPES
#define OWN_ENTRY
#include "base.h"

// Members that a later version might add stand behind those of today.
struct longer_parameter {
  shoal_parameter today;
  double step;
  const char* symbol;
};
struct longer_type {
  shoal_type today;
  uint64_t revision;
};
struct longer_requirement {
  shoal_requirement today;
  const char* reason;
};
struct longer_plugin {
  shoal_plugin today;
  const char* address;
};
struct longer_api {
  shoal_physics_api today;
  void (*more)(void);
};

static shoal_status build(const shoal_object* object, const shoal_builder* builder) {
  (void)object;
  (void)builder;
  return SHOAL_OK;
}
static const struct longer_api api = {{.size = sizeof(struct longer_api), .build = build}, NULL};

static const struct longer_parameter parameters[] = {
    {{.size = sizeof(struct longer_parameter),
      .kind = SHOAL_REAL,
      .key = "first",
      .unit = "m",
      .default_text = "1",
      .doc = "The first."},
     0.1,
     "a"},
    {{.size = sizeof(struct longer_parameter),
      .kind = SHOAL_INTEGER,
      .key = "second",
      .default_text = "2",
      .doc = "The second."},
     1.0,
     "b"},
    {{.size = sizeof(struct longer_parameter),
      .kind = SHOAL_TEXT,
      .key = "third",
      .default_text = "three",
      .doc = "The third."},
     0.0,
     "c"},
};
static const struct longer_parameter later_parameters[] = {
    {{.size = sizeof(struct longer_parameter), .kind = 40, .key = "tensor", .doc = "Of a later kind."},
     0.0,
     "T"},
};
#define TYPE(kind_, name_, parameters_)                            \
  {                                                                \
    {.size = sizeof(struct longer_type),                           \
     .kind = kind_,                                                \
     .name = name_,                                                \
     .doc = "Nothing, to be loaded.",                              \
     .n_parameters = sizeof(parameters_) / sizeof(parameters_[0]), \
     .parameters = &parameters_[0].today,                          \
     .api = &api},                                                 \
        7                                                          \
  }
static const struct longer_type type = TYPE(SHOAL_TYPE_PHYSICS, "newer_minor.type", parameters);
static const struct longer_type later_kind = TYPE(60, "newer_minor.later_kind", parameters);
static const struct longer_type later_value =
    TYPE(SHOAL_TYPE_PHYSICS, "newer_minor.later_value", later_parameters);
static const shoal_type* const types[] = {&type.today, &later_kind.today, &later_value.today};

static const struct longer_requirement requirements[] = {
    {{.size = sizeof(struct longer_requirement), .id = "good", .minimum_version = "1.0.0"}, "types"},
    {{.size = sizeof(struct longer_requirement), .id = "another", .below_version = "3.0.0"}, "company"},
};
static const struct longer_plugin plugin = {{.size = sizeof(struct longer_plugin),
                                             .n_requirements = 2,
                                             .id = PLUGIN_ID,
                                             .version = "1.0.0",
                                             .licence = "Apache-2.0",
                                             .summary = "A plugin of the tests.",
                                             .requirements = &requirements[0].today,
                                             .n_types = 3,
                                             .types = types},
                                            "somewhere"};

extern EXPORT const shoal_plugin* shoal_plugin_entry(const shoal_host* host);
const shoal_plugin* shoal_plugin_entry(const shoal_host* host) {
  // A plugin of a later version sees that this host lacks what it might use.
  if (host->abi_minor >= STAMP_MINOR) return NULL;
  return &plugin.today;
}
