// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Fields that are known only when a case is read: those that a material declares through one of its interfaces, as
// members of the operator that calls it.
//
//     struct Stress : ParticleOperator<Stress> {
//       DeclaredFields law_fields{*this};          // then, in the setup of attach: law_fields.declare(n, accesses)
//       void block(std::uint64_t begin, std::uint64_t end) const {
//         std::array<double*, DeclaredFields::most> fields;
//         law_fields.at(begin, fields.data());     // values of particle `begin`, in the order of the declaration
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "shoal/operator.hpp"

namespace shoal {

class DeclaredFields {
 public:
  static constexpr std::uint32_t most = 16;

  explicit DeclaredFields(OperatorBase& owner) : owner_(owner) {}

  // Once, before the operator is attached. Whoever only looks (a probe, say) declares with `writes` false.
  void declare(std::uint32_t n, const shoal_access* accesses, bool writes = true) {
    if (n > most) throw CaseError("a material with more than " + std::to_string(most) + " fields");
    for (std::uint32_t k = 0; k < n; ++k) {
      shoal_access access = copy_of(*SHOAL_AT(shoal_access, accesses, k));
      if (access.rank == SHOAL_ARRAY)
        throw CaseError(std::string("field '") + access.field +
                        "' of a material is an array, which none may be");
      if (!writes) access.mode = SHOAL_READ;
      members_.emplace_back(owner_, access);
    }
  }

  std::size_t size() const { return members_.size(); }

  // Pointers to the values of an owned particle; blocks go on from there.
  void at(std::uint64_t particle, double** fields) const {
    for (const Member& member : members_) *fields++ = member.at(particle, owner_.dimensions());
  }

 private:
  class Member final : public impl::FieldMember {
   public:
    Member(OperatorBase& owner, const shoal_access& access)
        : FieldMember(owner, access), rank_(access.rank) {}
    double* at(std::uint64_t particle, int dimensions) const {
      return static_cast<double*>(own_) +
             particle * components(rank_, static_cast<std::uint64_t>(dimensions));
    }

   private:
    static std::uint64_t components(std::uint32_t rank, std::uint64_t d) {
      switch (rank) {
        case SHOAL_SCALAR: return 1;
        case SHOAL_RANK_VECTOR: return d;
        case SHOAL_SYMMETRIC: return d * (d + 1) / 2;
        default: return d * d;
      }
    }
    std::uint32_t rank_;
  };

  OperatorBase& owner_;
  std::deque<Member> members_;
};

}  // namespace shoal
