// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A sound plugin in C. Each of the others defines what it does wrong before it includes this.
#pragma once

#include <stddef.h>

#include "shoal/abi.h"

#define EXPORT __attribute__((visibility("default")))

#ifndef PLUGIN_ID
#error "a test plugin names itself"
#endif
#ifndef PLUGIN_VERSION
#define PLUGIN_VERSION "1.0.0"
#endif
#ifndef PLUGIN_TYPE
#define PLUGIN_TYPE PLUGIN_ID ".type"
#endif
#ifndef STAMP_MAGIC
#define STAMP_MAGIC SHOAL_ABI_MAGIC
#endif
#ifndef STAMP_SIZE
#define STAMP_SIZE sizeof(shoal_stamp)
#endif
#ifndef STAMP_MAJOR
#define STAMP_MAJOR SHOAL_ABI_MAJOR
#endif
#ifndef STAMP_MINOR
#define STAMP_MINOR SHOAL_ABI_MINOR
#endif
#ifndef STAMP_REAL
#define STAMP_REAL 8
#endif
#ifndef STAMP_ISA
#define STAMP_ISA 0
#endif

#ifndef WITHOUT_STAMP
extern EXPORT const shoal_stamp shoal_plugin_stamp;
const shoal_stamp shoal_plugin_stamp = {
    .magic = STAMP_MAGIC,
    .size = STAMP_SIZE,
    .abi_major = STAMP_MAJOR,
    .abi_minor = STAMP_MINOR,
    .real_bytes = STAMP_REAL,
    .index_bytes = 4,
    .isa = STAMP_ISA,
    .sdk_version = "9.8.7",
    .compiler = "test compiler 1",
};
#endif

#ifndef WITHOUT_TYPES
static shoal_status build(const shoal_object* object, const shoal_builder* builder) {
  (void)object;
  (void)builder;
  return SHOAL_OK;
}
static const shoal_physics_api physics_api = {.size = sizeof(shoal_physics_api), .build = build};

#ifndef PARAMETERS
#define PARAMETERS                                                                           \
  {                                                                                          \
    .size = sizeof(shoal_parameter), .kind = SHOAL_REAL, .key = "viscosity", .unit = "m2/s", \
    .default_text = "1e-6", .doc = "Kinematic viscosity.", .example = "1e-6 m2/s"            \
  }
#endif
static const shoal_parameter parameters[] = {PARAMETERS};

#ifndef TYPE_KIND
#define TYPE_KIND SHOAL_TYPE_PHYSICS
#endif
#ifndef TYPE_SIZE
#define TYPE_SIZE sizeof(shoal_type)
#endif
static const shoal_type type = {
    .size = TYPE_SIZE,
    .kind = TYPE_KIND,
    .name = PLUGIN_TYPE,
    .doc = "Nothing, to be loaded.",
    .n_parameters = sizeof(parameters) / sizeof(parameters[0]),
    .parameters = parameters,
    .api = &physics_api,
};
#ifndef TYPES
#define TYPES &type
#endif
static const shoal_type* const types[] = {TYPES};
#endif

#ifndef OWN_ENTRY
#ifndef REQUIREMENTS
#define N_REQUIREMENTS 0
#define REQUIREMENTS NULL
#endif
static const shoal_plugin plugin = {
    .size = sizeof(shoal_plugin),
    .n_requirements = N_REQUIREMENTS,
    .id = PLUGIN_ID,
    .version = PLUGIN_VERSION,
    .licence = "Apache-2.0",
    .summary = "A plugin of the tests.",
    .requirements = REQUIREMENTS,
    .n_types = sizeof(types) / sizeof(types[0]),
    .types = types,
};

extern EXPORT const shoal_plugin* shoal_plugin_entry(const shoal_host* host);
const shoal_plugin* shoal_plugin_entry(const shoal_host* host) {
  (void)host;
  return &plugin;
}
#endif
