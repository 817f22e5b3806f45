// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/output/probes/probe.hpp"

#include <string_view>

#include "kernel/case/own_type.hpp"
#include "kernel/output/probes/own_probes.hpp"
#include "kernel/plugins/host.hpp"

namespace shoal::kernel {
namespace {

// The registry holds every type to the table of functions; own probes need more of a run than a snapshot holds and
// are made by make_probe() alone.
shoal_status refuse() {
  plugin_host().fail("this probe is the kernel's own");
  return SHOAL_ERROR;
}
const shoal_probe_api own_api{
    sizeof(shoal_probe_api),
    0,
    [](const shoal_object*, int32_t, void**) { return refuse(); },
    [](void*) {},
    [](void*, const char* const**, const char* const**) { return std::uint32_t{0}; },
    [](void*, const char* const**, const char* const**) { return std::uint32_t{0}; },
    [](void*, const shoal_snapshot*, double*) { return refuse(); }};

struct MaximumParameters : ReductionParameters {};
struct MinimumParameters : ReductionParameters {};
struct SumParameters : ReductionParameters {};
struct MeanParameters : ReductionParameters {};

}  // namespace

const std::vector<const shoal_type*>& own_probe_types() {
  static const std::vector<const shoal_type*> types{
      own_type<PointParameters>(SHOAL_TYPE_PROBE, "point",
                                "The value at a point, interpolated from the particles around it.", &own_api),
      own_type<MaximumParameters>(SHOAL_TYPE_PROBE, "maximum", "The largest value over particles.", &own_api),
      own_type<MinimumParameters>(SHOAL_TYPE_PROBE, "minimum", "The smallest value over particles.",
                                  &own_api),
      own_type<SumParameters>(SHOAL_TYPE_PROBE, "sum",
                              "The sum over particles, e.g. an energy, or a force on a body (of: force.x).",
                              &own_api),
      own_type<MeanParameters>(SHOAL_TYPE_PROBE, "mean", "The mean over particles.", &own_api),
  };
  return types;
}

std::unique_ptr<Probe> make_probe(const shoal_object& object, const ProbeContext& context) {
  // Coordinates that are expressions are evaluated through the host, as in plugins.
  shoal::impl::host_table = &plugin_host();
  const std::string_view type = object.type->name;
  if (type == "point") return make_point(object, context);
  if (type == "maximum") return make_reduction(Reduce::maximum, object, context);
  if (type == "minimum") return make_reduction(Reduce::minimum, object, context);
  if (type == "sum") return make_reduction(Reduce::sum, object, context);
  if (type == "mean") return make_reduction(Reduce::mean, object, context);
  return make_plugin_probe(object, context);
}

}  // namespace shoal::kernel
