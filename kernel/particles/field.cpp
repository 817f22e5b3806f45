// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Storage of fields, and the rule that one name has one meaning.
#include "kernel/particles/field.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <new>

#include "kernel/particles/errors.hpp"
#include "kernel/particles/parallel.hpp"
#include "shoal/shared_fields.hpp"

namespace shoal::kernel {

std::uint32_t components_of(shoal_rank rank, int dimensions, std::uint32_t array_components) {
  const auto d = static_cast<std::uint32_t>(dimensions);
  switch (rank) {
    case SHOAL_SCALAR: return 1;
    case SHOAL_RANK_VECTOR: return d;
    case SHOAL_SYMMETRIC: return d * (d + 1) / 2;
    case SHOAL_RANK_MATRIX: return d * d;
    case SHOAL_ARRAY: return array_components;
  }
  throw ModelError("unknown rank " + std::to_string(static_cast<int>(rank)) + " of a field");
}

const char* name_of(shoal_rank rank) {
  switch (rank) {
    case SHOAL_SCALAR: return "scalar";
    case SHOAL_RANK_VECTOR: return "vector";
    case SHOAL_SYMMETRIC: return "symmetric matrix";
    case SHOAL_RANK_MATRIX: return "matrix";
    case SHOAL_ARRAY: return "array";
  }
  return "unknown rank";
}

const char* name_of(shoal_data_type type) { return type == SHOAL_INT64 ? "integer" : "real"; }

namespace {

constexpr std::uint32_t max_array_components = 4096;

std::string describe(const FieldSpecification& field) {
  std::string text = field.data_type == SHOAL_INT64 ? "an integer " : "a real ";
  text += name_of(field.rank);
  if (field.rank == SHOAL_ARRAY) text += " of " + std::to_string(field.array_components) + " numbers";
  if (!field.unit.empty()) text += " in " + field.unit;
  return text;
}

bool same_kind(const FieldSpecification& a, const FieldSpecification& b) {
  return a.rank == b.rank && a.data_type == b.data_type && a.array_components == b.array_components &&
         (a.unit.empty() || b.unit.empty() || a.unit == b.unit);
}

[[noreturn]] void clash(const FieldSpecification& first, const std::string& first_declarer,
                        const FieldSpecification& second, const std::string& second_declarer) {
  throw ModelError("field '" + first.name + "' is " + describe(first) + " for " + first_declarer + ", but " +
                   describe(second) + " for " + second_declarer +
                   "; give one of them another name, or make them agree");
}

}  // namespace

FieldSpecification specify(std::string_view name, std::uint32_t rank, std::uint32_t data_type,
                           const char* unit, const char* doc, const std::string& declarer,
                           std::uint32_t array_components) {
  const std::string quoted = "'" + std::string(name) + "'";
  if (name.empty()) throw ModelError(declarer + " declares a field without a name");
  if (rank > SHOAL_ARRAY)
    throw ModelError(declarer + " declares field " + quoted + " with unknown rank " + std::to_string(rank));
  if (rank == SHOAL_ARRAY && (array_components == 0 || array_components > max_array_components))
    throw ModelError(declarer + " declares field " + quoted + " as an array of " +
                     std::to_string(array_components) + " numbers; an array has 1 to " +
                     std::to_string(max_array_components));
  if (data_type > SHOAL_INT64)
    throw ModelError(declarer + " declares field " + quoted + " with unknown data type " +
                     std::to_string(data_type));
  FieldSpecification asked{
      std::string(name),           static_cast<shoal_rank>(rank), static_cast<shoal_data_type>(data_type),
      unit != nullptr ? unit : "", doc != nullptr ? doc : "",     rank == SHOAL_ARRAY ? array_components : 0};
  const SharedField* shared = find_shared_field(name);
  if (shared == nullptr) return asked;
  FieldSpecification known{
      std::string(name), shared->rank, SHOAL_DOUBLE, std::string(shared->unit), std::string(shared->doc), 0};
  if (!same_kind(known, asked)) clash(known, "all plugins (shoal/shared_fields.hpp)", asked, declarer);
  return known;
}

void Field::Release::operator()(void* memory) const {
  ::operator delete (memory, std::align_val_t{SHOAL_ALIGNMENT});
}

Field::Field(FieldSpecification specification, int dimensions, std::string declarer)
    : specification_(std::move(specification)),
      components_(components_of(specification_.rank, dimensions, specification_.array_components)) {
  declarers_.push_back(std::move(declarer));
}

void Field::merge(const FieldSpecification& other, const std::string& declarer) {
  if (!same_kind(specification_, other)) clash(specification_, declarers_.front(), other, declarer);
  if (specification_.unit.empty()) specification_.unit = other.unit;
  if (specification_.doc.empty()) specification_.doc = other.doc;
  if (std::find(declarers_.begin(), declarers_.end(), declarer) == declarers_.end())
    declarers_.push_back(declarer);
}

bool Field::resize(std::uint64_t n, std::uint64_t kept) {
  const std::uint64_t padded = (n / SHOAL_PADDING + 1) * SHOAL_PADDING;
  const bool moves = padded > capacity_;
  ++changes;
  if (moves) {
    // A first allocation fits exactly; images and inlets then grow it by a quarter at a time.
    const std::uint64_t wanted = capacity_ == 0 ? padded : std::max(padded, capacity_ + capacity_ / 4);
    const std::uint64_t capacity = (wanted + SHOAL_PADDING - 1) / SHOAL_PADDING * SHOAL_PADDING;
    void* memory = ::operator new (capacity* bytes_per_particle(), std::align_val_t{SHOAL_ALIGNMENT});
    if (kept > 0) std::memcpy(memory, data_.get(), kept * bytes_per_particle());
    data_.reset(memory);
    capacity_ = capacity;
  }
  std::memset(static_cast<char*>(data()) + kept * bytes_per_particle(), 0,
              (padded - kept) * bytes_per_particle());
  return moves;
}

namespace {

template <std::size_t Bytes>
void gather(const char* from, char* to, const std::uint32_t* order, std::uint64_t begin, std::uint64_t end) {
  for (std::uint64_t k = begin; k < end; ++k) std::memcpy(to + k * Bytes, from + order[k] * Bytes, Bytes);
}

}  // namespace

void Field::permute(const std::uint32_t* order, std::uint64_t n, void* scratch) {
  ++changes;
  char* values = static_cast<char*>(data());
  char* copy = static_cast<char*>(scratch);
  const std::uint64_t bytes = bytes_per_particle();
  for_each_range(n, [&](std::uint64_t begin, std::uint64_t end) {
    switch (components_) {
      case 1: gather<8>(values, copy, order, begin, end); break;
      case 2: gather<16>(values, copy, order, begin, end); break;
      case 3: gather<24>(values, copy, order, begin, end); break;
      case 4: gather<32>(values, copy, order, begin, end); break;
      case 6: gather<48>(values, copy, order, begin, end); break;
      case 9: gather<72>(values, copy, order, begin, end); break;
      default:
        for (std::uint64_t k = begin; k < end; ++k)
          std::memcpy(copy + k * bytes, values + order[k] * bytes, bytes);
    }
  });
  // Back into the old array, so that views of it stay valid.
  for_each_range(n, [&](std::uint64_t begin, std::uint64_t end) {
    std::memcpy(values + begin * bytes, copy + begin * bytes, (end - begin) * bytes);
  });
}

void Field::clear(std::uint64_t n) {
  ++changes;
  for_each_range(n, [&](std::uint64_t begin, std::uint64_t end) {
    std::memset(static_cast<char*>(data()) + begin * bytes_per_particle(), 0,
                (end - begin) * bytes_per_particle());
  });
}

void Field::poison(std::uint64_t begin, std::uint64_t end) {
  ++changes;
  if (specification_.data_type == SHOAL_INT64)
    std::fill(integers() + begin * components_, integers() + end * components_,
              std::numeric_limits<std::int64_t>::min());
  else
    std::fill(reals() + begin * components_, reals() + end * components_,
              std::numeric_limits<double>::quiet_NaN());
}

}  // namespace shoal::kernel
