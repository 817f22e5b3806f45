// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// All that a plugin needs, in one include.
#pragma once

#include "shoal/abi.h"
#include "shoal/declared_fields.hpp"
#include "shoal/fit.hpp"
#include "shoal/host.hpp"
#include "shoal/material.hpp"
#include "shoal/operator.hpp"
#include "shoal/output.hpp"
#include "shoal/pack.hpp"
#include "shoal/pair_operator.hpp"
#include "shoal/parameters.hpp"
#include "shoal/particle_operator.hpp"
#include "shoal/physics.hpp"
#include "shoal/plugin.hpp"
#include "shoal/probe.hpp"
#include "shoal/shared_fields.hpp"
#include "shoal/smoothing_kernel.hpp"
#include "shoal/vec.hpp"
