// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What a scalar of a case means as a number or a boolean: stricter than YAML 1.1, where 010 is eight and `no` is
// false. Nothing is guessed; what looks like a mistake is refused with a remedy.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace shoal::kernel {

struct NumberText {
  enum class Status {
    number,  ///< the whole text is a number
    prefix,  ///< a number stands at the beginning; `end` is where it ends
    none,    ///< does not begin like a number
    refused  ///< looks like a number that means something else elsewhere; `remedy` says what to write
  };
  Status status = Status::none;
  double value = 0;
  std::size_t end = 0;
  std::string remedy;  ///< "has a leading zero, which some read as octal; write 10"
};

/// Reads [+-] digits [. digits] [e [+-] digits]. Infinities ("inf", ".inf", "-inf") are numbers only if allowed;
/// NaN never is.
NumberText parse_number(std::string_view text, bool allow_infinite = false);

enum class BooleanText { no, yes, other_word, not_boolean };

/// `true` and `false` only. other_word: yes, no, on, off, True, ... which YAML readers disagree about.
BooleanText parse_boolean(std::string_view text);

/// As few digits as give the number back: 0.025, 1e-06, 1000.
std::string format_number(double value);

}  // namespace shoal::kernel
