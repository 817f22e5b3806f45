// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Strict reading of numbers and booleans.
#include "kernel/case/scalars.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace shoal::kernel {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string lower_case(std::string_view s) {
  std::string out(s);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
  return out;
}

std::size_t skip_digits(std::string_view s, std::size_t i) {
  while (i < s.size() && is_digit(s[i])) ++i;
  return i;
}

NumberText refused(std::string remedy) { return {NumberText::Status::refused, 0, 0, std::move(remedy)}; }

// Words for infinity and NaN, with an optional sign and YAML's leading dot.
NumberText special_word(std::string_view text, bool allow_infinite) {
  std::string word = lower_case(text);
  const bool negative = !word.empty() && word[0] == '-';
  if (!word.empty() && (word[0] == '-' || word[0] == '+')) word.erase(0, 1);
  if (word.size() > 3 && word[0] == '.') word.erase(0, 1);
  if (word == "nan") return refused("is not a number; leave the key out if the value is unknown");
  if (word != "inf" && word != "infinity") return {};
  if (!allow_infinite) return refused("is not allowed here; write a finite number");
  const double infinity = std::numeric_limits<double>::infinity();
  return {NumberText::Status::number, negative ? -infinity : infinity, text.size(), {}};
}

// Decimal commas, thousands separators and other bases, which people write and readers take apart.
NumberText foreign_notation(std::string_view text, std::size_t digits_begin, std::size_t end) {
  const char next = end < text.size() ? text[end] : '\0';
  const char after = end + 1 < text.size() ? text[end + 1] : '\0';
  if (next == '_' && is_digit(after)) return refused("has underscores; write the digits without them");
  if (next == ',' && is_digit(after)) return refused("has a comma; the decimal separator is a point");
  if (end == digits_begin + 1 && text[digits_begin] == '0' && (next == 'x' || next == 'o' || next == 'b') &&
      std::isxdigit(static_cast<unsigned char>(after)) != 0)
    return refused("is not in decimal notation; write it in decimal digits");
  return {};
}

}  // namespace

NumberText parse_number(std::string_view text, bool allow_infinite) {
  std::size_t i = !text.empty() && (text[0] == '+' || text[0] == '-') ? 1 : 0;
  const std::size_t digits_begin = i;
  const std::size_t integer_end = skip_digits(text, i);
  i = integer_end;
  std::size_t n_digits = integer_end - digits_begin;
  if (i < text.size() && text[i] == '.') {
    const std::size_t fraction_end = skip_digits(text, i + 1);
    n_digits += fraction_end - i - 1;
    if (n_digits > 0) i = fraction_end;
  }
  if (n_digits == 0) return special_word(text, allow_infinite);
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    std::size_t exponent = i + 1;
    if (exponent < text.size() && (text[exponent] == '+' || text[exponent] == '-')) ++exponent;
    const std::size_t exponent_end = skip_digits(text, exponent);
    if (exponent_end > exponent) i = exponent_end;
  }
  if (NumberText foreign = foreign_notation(text, digits_begin, i);
      foreign.status == NumberText::Status::refused)
    return foreign;
  if (integer_end - digits_begin > 1 && text[digits_begin] == '0') {
    std::size_t significant = digits_begin;
    while (significant + 1 < integer_end && text[significant] == '0') ++significant;
    return refused("has a leading zero, which other YAML readers take for octal; write " +
                   std::string(text.substr(0, digits_begin)) +
                   std::string(text.substr(significant, i - significant)));
  }
  NumberText result;
  const std::string_view digits = text.substr(text[0] == '+' ? 1 : 0, i - (text[0] == '+' ? 1 : 0));
  const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), result.value);
  if (problem == std::errc::result_out_of_range)
    return refused("is beyond what a double precision number can hold (about 1e-308 to 1e308)");
  result.end = i;
  result.status = i == text.size() ? NumberText::Status::number : NumberText::Status::prefix;
  return result;
}

BooleanText parse_boolean(std::string_view text) {
  if (text == "true") return BooleanText::yes;
  if (text == "false") return BooleanText::no;
  const std::string word = lower_case(text);
  for (const char* other : {"true", "false", "yes", "no", "on", "off", "y", "n"}) {
    if (word == other) return BooleanText::other_word;
  }
  return BooleanText::not_boolean;
}

std::string format_number(double value) {
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  if (std::isnan(value)) return "nan";
  std::array<char, 64> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

}  // namespace shoal::kernel
