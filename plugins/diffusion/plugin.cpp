// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "shoal/plugin.hpp"
#include "diffusion.hpp"
#include "medium.hpp"
#include "reaction/aliev_panfilov.hpp"
#include "reaction/allen_cahn.hpp"
#include "reaction/fitzhugh_nagumo.hpp"
#include "reaction/formula.hpp"
#include "reaction/reaction.hpp"
#include "reaction/stimulus.hpp"
#include "reaction/ten_tusscher_panfilov.hpp"
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
  add<Reaction>(
      "diffusion.reaction",
      "Reactions between diffusing fields, or of fields that stay in place: excitable tissue, chemistry, "
      "separating phases. Split from the diffusion with second order.",
      "Strang 1968, doi:10.1137/0705041");
  add<Stimulus>("diffusion.stimulus",
                "A stimulus of a reaction's first variable, in a region and for a time.");
  add<AllenCahn>("diffusion.allen_cahn", "Separation of two phases.", "Allen, Cahn 1979");
  add<FitzHughNagumo>("diffusion.fitzhugh_nagumo",
                      "Excitable medium of two variables, for waves and spirals.",
                      "FitzHugh 1961; Nagumo, Arimoto, Yoshizawa 1962");
  add<AlievPanfilov>("diffusion.aliev_panfilov",
                     "Heart muscle in two variables, with the restitution of its action potential.",
                     "Aliev, Panfilov 1996, doi:10.1016/0960-0779(95)00089-5");
  add<Formula>("diffusion.formula", "A reaction written in the case, as expressions of its variables.");
  add<TenTusscherPanfilov>("diffusion.ten_tusscher_panfilov",
                           "Human ventricular cell, 19 variables: epicardium, endocardium and M cells.",
                           "ten Tusscher, Panfilov 2006, doi:10.1152/ajpheart.00109.2006");
}
