// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Each parameter of its table is wrong in another way.
#define PLUGIN_ID "bad_table"
#define P(...) \
  { .size = sizeof(shoal_parameter), __VA_ARGS__ }
#define PARAMETERS                                                                                           \
  P(.kind = SHOAL_REAL, .key = "Speed", .unit = "m/s", .doc = "Not in snake_case."),                         \
      P(.kind = SHOAL_REAL, .key = "twice", .unit = "1", .doc = "Once."),                                    \
      P(.kind = SHOAL_REAL, .key = "twice", .unit = "1", .doc = "Twice."),                                   \
      P(.kind = SHOAL_REAL, .key = "no_doc", .unit = "1"),                                                   \
      P(.kind = SHOAL_REAL, .key = "no_unit", .doc = "A number without a unit."),                            \
      P(.kind = SHOAL_TEXT, .key = "text_unit", .unit = "m", .doc = "A text in metres."),                    \
      P(.kind = 99, .key = "odd", .doc = "Of an unknown kind."),                                             \
      P(.kind = SHOAL_INTEGER, .key = "half", .default_text = "0.5", .doc = "An integer of a half."),        \
      P(.kind = SHOAL_REAL, .key = "outside", .unit = "1", .default_text = "0",                              \
        .flags = SHOAL_PARAMETER_HAS_MINIMUM | SHOAL_PARAMETER_MINIMUM_EXCLUDED, .doc = "Not positive."),    \
      P(.kind = SHOAL_REAL, .key = "crossed", .unit = "1", .minimum = 2, .maximum = 1,                       \
        .flags = SHOAL_PARAMETER_HAS_MINIMUM | SHOAL_PARAMETER_HAS_MAXIMUM, .doc = "Nothing is between."),   \
      P(.kind = SHOAL_CHOICE, .key = "no_choice", .doc = "Nothing to choose."),                              \
      P(.kind = SHOAL_CHOICE, .key = "other_choice", .n_choices = 2, .choices = words, .default_text = "up", \
        .doc = "The default is none of them."),                                                              \
      P(.kind = SHOAL_BOOLEAN, .key = "maybe", .default_text = "maybe", .doc = "Neither."),                  \
      P(.kind = SHOAL_REAL, .key = "both", .unit = "1", .default_text = "1",                                 \
        .flags = SHOAL_PARAMETER_REQUIRED, .doc = "Required, with a default."),                              \
      P(.kind = SHOAL_OBJECT, .key = "thing", .doc = "Of no kind."),                                         \
      P(.kind = SHOAL_REAL, .key = "fine", .unit = "m", .default_text = "2*H", .doc = "Nothing is wrong.")
static const char* const words[] = {"left", "right"};
#include "base.h"
