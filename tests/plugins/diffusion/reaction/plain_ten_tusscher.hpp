// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The ventricular cell as the paper prints it, in plain numbers: slow, obvious, and what the fast one is compared with.
#pragma once

#include <array>
#include <cmath>
#include <string>

#include "ten_tusscher_panfilov.hpp"

namespace shoal::diffusion::test {

using PlainState = std::array<double, tt06::n_variables>;

// The equations as the paper has them (mV, ms, mmol/l); in the order of tt06::Variable.
inline PlainState plain_rates(const PlainState& y, const std::string& cell) {
  using std::exp;
  using std::log;
  using std::pow;
  using std::sqrt;
  const double R = 8314.472, T = 310, F = 96485.3415, RTONF = R * T / F;
  const double Ko = 5.4, Cao = 2, Nao = 140, Vc = 0.016404, Vsr = 0.001094, Vss = 0.00005468, C = 0.185;
  const double V = 1e3 * y[0], m = y[1], h = y[2], j = y[3], xr1 = y[4], xr2 = y[5], xs = y[6], r = y[7],
               s = y[8], d = y[9], f = y[10], f2 = y[11], fcass = y[12], rr = y[13], cai = y[14],
               cass = y[15], casr = y[16], nai = y[17], ki = y[18];
  const double ena = RTONF * log(Nao / nai), ek = RTONF * log(Ko / ki), eca = 0.5 * RTONF * log(Cao / cai),
               eks = RTONF * log((Ko + 0.03 * Nao) / (ki + 0.03 * nai));
  const double ina = 14.838 * m * m * m * h * j * (V - ena);
  const double ical = 3.98e-5 * d * f * f2 * fcass * 4 * (V - 15) * F * F / (R * T) *
                      (0.25 * exp(2 * (V - 15) * F / (R * T)) * cass - Cao) /
                      (exp(2 * (V - 15) * F / (R * T)) - 1);
  const double ito = (cell == "endo" ? 0.073 : 0.294) * r * s * (V - ek);
  const double ikr = 0.153 * sqrt(Ko / 5.4) * xr1 * xr2 * (V - ek);
  const double iks = (cell == "mid" ? 0.098 : 0.392) * xs * xs * (V - eks);
  const double ak1 = 0.1 / (1 + exp(0.06 * (V - ek - 200)));
  const double bk1 =
      (3 * exp(0.0002 * (V - ek + 100)) + exp(0.1 * (V - ek - 10))) / (1 + exp(-0.5 * (V - ek)));
  const double ik1 = 5.405 * sqrt(Ko / 5.4) * ak1 / (ak1 + bk1) * (V - ek);
  const double inaca =
      1000 * (exp(0.35 * V / RTONF) * pow(nai, 3) * Cao - exp(-0.65 * V / RTONF) * pow(Nao, 3) * cai * 2.5) /
      ((pow(87.5, 3) + pow(Nao, 3)) * (1.38 + Cao) * (1 + 0.1 * exp(-0.65 * V / RTONF)));
  const double inak =
      2.724 * Ko * nai /
      ((Ko + 1) * (nai + 40) * (1 + 0.1245 * exp(-0.1 * V / RTONF) + 0.0353 * exp(-V / RTONF)));
  const double ipca = 0.1238 * cai / (0.0005 + cai), ipk = 0.0146 * (V - ek) / (1 + exp((25 - V) / 5.98));
  const double ibna = 0.00029 * (V - ena), ibca = 0.000592 * (V - eca);

  PlainState rate{};
  rate[0] = -(ina + ik1 + ito + ikr + iks + ical + inaca + inak + ipca + ipk + ibna + ibca);
  const auto gate = [&](std::size_t v, double target, double tau) { rate[v] = (target - y[v]) / tau; };
  gate(1, 1 / pow(1 + exp((-56.86 - V) / 9.03), 2),
       1 / (1 + exp((-60 - V) / 5)) * (0.1 / (1 + exp((V + 35) / 5)) + 0.1 / (1 + exp((V - 50) / 200))));
  const double hinf = 1 / pow(1 + exp((V + 71.55) / 7.43), 2);
  const bool up = V >= -40;
  const double ah = up ? 0 : 0.057 * exp(-(V + 80) / 6.8);
  const double bh =
      up ? 0.77 / (0.13 * (1 + exp(-(V + 10.66) / 11.1))) : 2.7 * exp(0.079 * V) + 3.1e5 * exp(0.3485 * V);
  gate(2, hinf, 1 / (ah + bh));
  const double aj = up ? 0
                       : (-2.5428e4 * exp(0.2444 * V) - 6.948e-6 * exp(-0.04391 * V)) * (V + 37.78) /
                             (1 + exp(0.311 * (V + 79.23)));
  const double bj = up ? 0.6 * exp(0.057 * V) / (1 + exp(-0.1 * (V + 32)))
                       : 0.02424 * exp(-0.01052 * V) / (1 + exp(-0.1378 * (V + 40.14)));
  gate(3, hinf, 1 / (aj + bj));
  gate(4, 1 / (1 + exp((-26 - V) / 7)), 450 / (1 + exp((-45 - V) / 10)) * 6 / (1 + exp((V + 30) / 11.5)));
  gate(5, 1 / (1 + exp((V + 88) / 24)), 3 / (1 + exp((-60 - V) / 20)) * 1.12 / (1 + exp((V - 60) / 20)));
  gate(6, 1 / (1 + exp((-5 - V) / 14)), 1400 / sqrt(1 + exp((5 - V) / 6)) / (1 + exp((V - 35) / 15)) + 80);
  gate(7, 1 / (1 + exp((20 - V) / 6)), 9.5 * exp(-pow(V + 40, 2) / 1800) + 0.8);
  if (cell == "endo")
    gate(8, 1 / (1 + exp((V + 28) / 5)), 1000 * exp(-pow(V + 67, 2) / 1000) + 8);
  else
    gate(8, 1 / (1 + exp((V + 20) / 5)), 85 * exp(-pow(V + 45, 2) / 320) + 5 / (1 + exp((V - 20) / 5)) + 3);
  gate(
      9, 1 / (1 + exp((-8 - V) / 7.5)),
      (1.4 / (1 + exp((-35 - V) / 13)) + 0.25) * 1.4 / (1 + exp((V + 5) / 5)) + 1 / (1 + exp((50 - V) / 20)));
  gate(10, 1 / (1 + exp((V + 20) / 7)),
       1102.5 * exp(-pow(V + 27, 2) / 225) + 200 / (1 + exp((13 - V) / 10)) + 180 / (1 + exp((V + 30) / 10)) +
           20);
  gate(11, 0.67 / (1 + exp((V + 35) / 7)) + 0.33,
       600 * exp(-pow(V + 25, 2) / 170) + 31 / (1 + exp((25 - V) / 10)) + 16 / (1 + exp((V + 30) / 10)));
  gate(12, 0.6 / (1 + pow(cass / 0.05, 2)) + 0.4, 80 / (1 + pow(cass / 0.05, 2)) + 2);

  const double kcasr = 2.5 - 1.5 / (1 + pow(1.5 / casr, 2)), k1 = 0.15 / kcasr, k2 = 0.045 * kcasr;
  rate[13] = -k2 * cass * rr + 0.005 * (1 - rr);
  const double open = k1 * cass * cass * rr / (0.06 + k1 * cass * cass);
  const double irel = 0.102 * open * (casr - cass), ileak = 0.00036 * (casr - cai),
               iup = 0.006375 / (1 + pow(0.00025 / cai, 2)), ixfer = 0.0038 * (cass - cai);
  rate[14] = ((ileak - iup) * Vsr / Vc + ixfer - (ibca + ipca - 2 * inaca) * C / (2 * Vc * F)) /
             (1 + 0.2 * 0.001 / pow(cai + 0.001, 2));
  rate[15] = (-ixfer * Vc / Vss + irel * Vsr / Vss - ical * C / (2 * Vss * F)) /
             (1 + 0.4 * 0.00025 / pow(cass + 0.00025, 2));
  rate[16] = (iup - irel - ileak) / (1 + 10 * 0.3 / pow(casr + 0.3, 2));
  rate[17] = -(ina + ibna + 3 * inak + 3 * inaca) * C / (Vc * F);
  rate[18] = -(ik1 + ito + ikr + iks - 2 * inak + ipk) * C / (Vc * F);
  for (std::size_t v = 1; v < rate.size(); ++v) rate[v] *= 1e3;  // 1/s; mV/ms is V/s
  return rate;
}

}  // namespace shoal::diffusion::test
