// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Sums over pairs in single precision, twice as many lanes at a time. An operator that names a member `single` runs so
// where that is set (pair_operator.hpp):
//
//     std::shared_ptr<SinglePrecision> single;
//     auto neighbour_fields() const { return std::tie(pressure, acceleration); }
//
// and no other change: fields and `particle` stay in double precision, and of sums over lanes all but four. What `pair`
// returns has an error of some 1e-7 of its largest terms, whatever the size of the domain and of the particles; what
// pairs exchange stays opposite to the last bit. `neighbour_fields` lists what `pair` reads of neighbours besides their
// positions and volumes: each pass rounds it once to records that are read at a fraction of the cost of fields. What
// it does not list is read as ever.
//
// In three dimensions distances are those of the positions as they are. In two, where the geometry of all pairs takes
// little memory, they are those that FreezeGeometry (freeze_geometry.hpp) has frozen for the outer step.
#pragma once

#include "shoal/detail/frozen_geometry.hpp"
#include "shoal/detail/single_records.hpp"

namespace shoal {
inline namespace SHOAL_ISA_NAMESPACE {

// What operators in single precision share, if they run one after the other.
struct SinglePrecision {
  FrozenGeometry frozen;
  SingleRecords records;
};

}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
