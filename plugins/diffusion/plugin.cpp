// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "shoal/plugin.hpp"
#include "diffusion.hpp"
#include "medium.hpp"
#include "surface.hpp"

SHOAL_PLUGIN(diffusion, "0.1.0") {
  using namespace shoal::diffusion;
  summary("Diffusion of heat and matter in bodies at rest and in moving ones.");
  add<Medium>("diffusion.medium", "A medium in which species diffuse, isotropic or along fibres.");
  add<Conductor>("diffusion.conductor", "A body that conducts heat, isotropic or along fibres.");
  add<Diffusion>("diffusion.diffusion",
                 "Diffusion of one or several fields: heat, species, potentials. Take it for bodies at rest, "
                 "alone or with reactions, and, with 'inside', for what a fluid carries along.",
                 "Cleary, Monaghan 1999, doi:10.1006/jcph.1998.6118; Meyer, Balsara, Aslam 2014, "
                 "doi:10.1016/j.jcp.2013.08.021");
  add<FixedValue>("diffusion.fixed_value",
                  "A given value at the surface; under 'boundaries' of diffusion.diffusion.");
  add<Flux>("diffusion.flux", "A given flux through the surface; under 'boundaries' of diffusion.diffusion.");
  add<Convection>("diffusion.convection",
                  "Transfer to what surrounds the body; under 'boundaries' of diffusion.diffusion.");
}
