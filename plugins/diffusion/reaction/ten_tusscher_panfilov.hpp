// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Human ventricular cell, ten Tusscher and Panfilov, Am. J. Physiol. Heart Circ. Physiol. 291 (2006) H1088:
//   dV/dt = -(I_Na + I_K1 + I_to + I_Kr + I_Ks + I_CaL + I_NaCa + I_NaK + I_pCa + I_pK + I_bNa + I_bCa) / C
// with 12 gates dy/dt = (y_inf(V) - y) / tau_y(V) (Rush and Larsen 1978: exact for constant V), calcium in the
// cytoplasm, in the subspace at the channels and in the sarcoplasmic reticulum, sodium and potassium.
//
// Inside the model: mV, ms, mmol/l, and currents in pA/pF, as the paper prints them. Its fields are SI: the potential
// in V, concentrations in mol/m3, rates in 1/s.
//
// The rates as q - p y: gates by y_inf and tau; V by the conductances g (V - E) of the currents that have one; calcium
// by its leaks and releases, which are stiff in the subspace. The paper prints k4 = 1.5e-5 / ms; its authors' program
// has 5e-3, with which the figures of the paper come out, and so has this.
#pragma once

#include <cmath>

#include "shoal/reaction_model.hpp"

namespace shoal::diffusion {

namespace tt06 {

enum Variable {
  V,
  m,
  h,
  j,
  xr1,
  xr2,
  xs,
  r,
  s,
  d,
  f,
  f2,
  fCass,
  R_bar,
  Ca_i,
  Ca_ss,
  Ca_sr,
  Na_i,
  K_i,
  n_variables
};

// mJ/(mol K), K, C/mol
inline constexpr double gas_constant = 8314.472, temperature = 310.0, faraday = 96485.3415;
inline constexpr double RT_F = gas_constant * temperature / faraday;  // mV
// uF per cell and nl (the paper's 16404 um3 and so on, over 1e6)
inline constexpr double capacitance = 0.185, V_c = 0.016404, V_sr = 0.001094, V_ss = 5.468e-5;
inline constexpr double K_o = 5.4, Na_o = 140.0, Ca_o = 2.0;  // mmol/l

// e^(V/k) for the slopes k that are parts of 600 or of 14, as powers of e^(V/600) and e^(V/14): a multiplication each
// instead of an exponential. e^(V/5), the 120th power, has 120 times the relative error, 1.5e-14.
template <Real R>
struct Exponentials {
  explicit Exponentials(R v) : by14(fast_exp(v * R(1.0 / 14))) {
    const R by600 = fast_exp(v * R(1.0 / 600)), by300 = by600 * by600;
    by200 = by300 * by600;
    const R by120 = by200 * by300, by60 = by120 * by120, by30 = by60 * by60;
    by24 = by60 * by60 * by120;
    by20 = by60 * by30;
    by15 = by30 * by30;
    by10 = by20 * by20;
    by7 = by14 * by14;
    by5 = by10 * by10;
    const R by12 = by24 * by24;
    by6_inverse = reciprocal(by12 * by12);
    by20_inverse = reciprocal(by20);
    by10_inverse = by20_inverse * by20_inverse;
    by5_inverse = by10_inverse * by10_inverse;
  }
  R by200, by24, by20, by15, by14, by10, by7, by5, by6_inverse, by20_inverse, by10_inverse, by5_inverse;
};

template <Real R>
[[gnu::always_inline]] inline R square(R x) {
  return x * x;
}
// 1 + e^(shift/slope) e, the denominator of a sigmoid of which the exponential e is known.
template <Real R>
[[gnu::always_inline]] inline R one_and(R exponential, double shift_over_slope) {
  return R(1.0) + exponential * R(std::exp(shift_over_slope));
}
// 1 + e^((v - centre) / slope)
template <Real R>
[[gnu::always_inline]] inline R one_and_exp(R v, double centre, double slope) {
  return R(1.0) + fast_exp((v - R(centre)) * R(1.0 / slope));
}
template <Real R>
[[gnu::always_inline]] inline R gaussian(R v, double centre, double width) {
  return fast_exp(square(v - R(centre)) * R(-1.0 / width));
}

// A gate with y_inf = target / target_below and tau = time / time_below, by one reciprocal.
template <Real R>
[[gnu::always_inline]] inline void set_gate(Rates<R, n_variables>& out, Variable which, R target,
                                            R target_below, R time, R time_below) {
  const R scale = time_below * reciprocal(time * target_below);
  out.p[which] = scale * target_below;
  out.q[which] = scale * target;
}

}  // namespace tt06

struct TenTusscherPanfilov final : ReactionModel<TenTusscherPanfilov, tt06::n_variables> {
  Param<Choice> cell{
      "cell", nullptr,
      "Layer of the ventricle's wall that the cell is from: epicardium, endocardium, or M cells "
      "between.",
      one_of("epi", "endo", "mid"), default_to("epi")};

  std::vector<ReactionVariable> variables() const;
  double largest_step() const { return 5e-5; }
  void check() override {
    layer_ = cell.value() == "endo" ? Layer::endo : cell.value() == "mid" ? Layer::mid : Layer::epi;
  }

  template <Real R>
  Rates<R, tt06::n_variables> rates(const std::array<R, tt06::n_variables>& y) const;

 private:
  enum class Layer { epi, endo, mid };

  template <Real R>
  using State = std::array<R, tt06::n_variables>;
  template <Real R>
  using CellRates = Rates<R, tt06::n_variables>;

  // Currents that calcium, sodium and potassium feel, pA/pF.
  template <Real R>
  struct Currents {
    R sodium, potassium, calcium, l_type;
  };
  template <Real R>
  static void sodium_gates(R v, const tt06::Exponentials<R>& e, CellRates<R>& out);
  template <Real R>
  void potassium_gates(R v, const tt06::Exponentials<R>& e, CellRates<R>& out) const;
  template <Real R>
  static void calcium_gates(R v, R ca_ss, const tt06::Exponentials<R>& e, CellRates<R>& out);
  template <Real R>
  Currents<R> currents(R v, const State<R>& y, CellRates<R>& out) const;
  template <Real R>
  static void calcium(const State<R>& y, const Currents<R>& current, CellRates<R>& out);

  Layer layer_ = Layer::epi;
};

inline std::vector<ReactionVariable> TenTusscherPanfilov::variables() const {
  // The state of rest that Niederer et al. 2011 prescribe.
  return {{"potential", "V", "Transmembrane potential.", -0.08523, 5e-4, 0.02},
          {"gate_m", "1", "Activation of the fast sodium current.", 0.00172, 0.0},
          {"gate_h", "1", "Fast inactivation of the fast sodium current.", 0.7444, 0.0},
          {"gate_j", "1", "Slow inactivation of the fast sodium current.", 0.7045, 0.0},
          {"gate_xr1", "1", "Activation of the rapid delayed rectifier.", 0.00621, 0.0},
          {"gate_xr2", "1", "Inactivation of the rapid delayed rectifier.", 0.4712, 0.0},
          {"gate_xs", "1", "Activation of the slow delayed rectifier.", 0.0095, 0.0},
          {"gate_r", "1", "Activation of the transient outward current.", 2.42e-8, 0.0},
          {"gate_s", "1", "Inactivation of the transient outward current.", 0.999998, 0.0},
          {"gate_d", "1", "Activation of the L-type calcium current.", 3.373e-5, 0.0},
          {"gate_f", "1", "Slow inactivation of the L-type calcium current.", 0.7888, 0.0},
          {"gate_f2", "1", "Fast inactivation of the L-type calcium current.", 0.9755, 0.0},
          {"gate_fcass", "1", "Inactivation of the L-type current by subspace calcium.", 0.9953, 0.0},
          {"ryanodine_open", "1", "Share of ryanodine receptors that are not inactivated.", 0.9073, 0.0},
          {"calcium", "mol/m3", "Free calcium in the cytoplasm.", 0.000126, 0.0},
          {"calcium_subspace", "mol/m3", "Free calcium in the subspace.", 0.00036, 0.0},
          {"calcium_reticulum", "mol/m3", "Free calcium in the sarcoplasmic reticulum.", 3.64, 0.0},
          {"sodium", "mol/m3", "Sodium in the cell.", 8.604, 0.0},
          {"potassium", "mol/m3", "Potassium in the cell.", 136.89, 0.0}};
}

template <Real R>
Rates<R, tt06::n_variables> TenTusscherPanfilov::rates(const State<R>& y) const {
  const R v = y[tt06::V] * R(1e3);
  const tt06::Exponentials<R> e(v);
  CellRates<R> out;
  sodium_gates(v, e, out);
  potassium_gates(v, e, out);
  calcium_gates(v, y[tt06::Ca_ss], e, out);
  const Currents<R> current = currents(v, y, out);
  calcium(y, current, out);
  const double per_charge = tt06::capacitance / (tt06::V_c * tt06::faraday);
  out.q[tt06::Na_i] = R(-per_charge) * current.sodium;
  out.q[tt06::K_i] = R(-per_charge) * current.potassium;
  // From 1/ms to 1/s; the potential's mV/ms is V/s already.
  for (std::size_t v_index = 0; v_index < tt06::n_variables; ++v_index) {
    out.p[v_index] = out.p[v_index] * R(1e3);
    if (v_index != tt06::V) out.q[v_index] = out.q[v_index] * R(1e3);
  }
  return out;
}

template <Real R>
[[gnu::always_inline]] inline void TenTusscherPanfilov::sodium_gates(R v, const tt06::Exponentials<R>& e,
                                                                     CellRates<R>& out) {
  using namespace tt06;
  const R one(1.0);
  // tau_m = 1 / (1 + e^(-(V+60)/5)) (0.1 / (1 + e^((V+35)/5)) + 0.1 / (1 + e^((V-50)/200)))
  const R below = one_and(e.by5_inverse, -12.0), b1 = one_and(e.by5, 7.0), b2 = one_and(e.by200, -0.25);
  set_gate(out, m, one, square(one_and_exp(v, -56.86, -9.03)), R(0.1) * (b1 + b2), below * b1 * b2);

  // The rates of h and j have two branches, which meet at -40 mV; most packs need one of them.
  const auto excited = v >= R(-40.0);
  R rate_h(0.0), rate_j(0.0);
  if (any(excited)) {
    rate_h = R(0.77 / 0.13) * reciprocal(one_and_exp(v, -10.66, -11.1));
    rate_j = R(0.6) * fast_exp(R(0.057) * v) * reciprocal(one_and(e.by10_inverse, -3.2));
  }
  if (!all(excited)) {
    const R at_rest_h = R(0.057) * fast_exp((v + R(80.0)) * R(-1.0 / 6.8)) + R(2.7) * fast_exp(R(0.079) * v) +
                        R(3.1e5) * fast_exp(R(0.3485) * v);
    const R alpha =
        (R(-2.5428e4) * fast_exp(R(0.2444) * v) - R(6.948e-6) * fast_exp(R(-0.04391) * v)) * (v + R(37.78));
    const R alpha_below = one_and_exp(v, -79.23, 1 / 0.311), beta_below = one_and_exp(v, -40.14, -1 / 0.1378);
    const R beta = R(0.02424) * fast_exp(R(-0.01052) * v);
    rate_h = select(excited, rate_h, at_rest_h);
    const R at_rest_j = (alpha * beta_below + beta * alpha_below) * reciprocal(alpha_below * beta_below);
    rate_j = select(excited, rate_j, at_rest_j);
  }
  const R h_inf = reciprocal(square(one_and_exp(v, -71.55, 7.43)));
  out.p[h] = rate_h;
  out.q[h] = h_inf * rate_h;
  out.p[j] = rate_j;
  out.q[j] = h_inf * rate_j;
}

template <Real R>
[[gnu::always_inline]] inline void TenTusscherPanfilov::potassium_gates(R v, const tt06::Exponentials<R>& e,
                                                                        CellRates<R>& out) const {
  using namespace tt06;
  const R one(1.0);
  set_gate(out, xr1, e.by7, e.by7 + R(std::exp(-26.0 / 7)), R(450.0 * 6.0),
           one_and(e.by10_inverse, -4.5) * one_and_exp(v, -30.0, 11.5));
  set_gate(out, xr2, one, one_and(e.by24, 88.0 / 24), R(3.0 * 1.12),
           one_and(e.by20_inverse, -3.0) * one_and(e.by20, -3.0));
  // tau_xs = 1400 / sqrt(1 + e^((5-V)/6)) / (1 + e^((V-35)/15)) + 80
  const R below = sqrt(one_and(e.by6_inverse, 5.0 / 6)) * one_and(e.by15, -35.0 / 15);
  set_gate(out, xs, e.by14, e.by14 + R(std::exp(-5.0 / 14)), R(1400.0) + R(80.0) * below, below);

  set_gate(out, r, one, one_and(e.by6_inverse, 20.0 / 6), R(9.5) * gaussian(v, -40.0, 1800.0) + R(0.8), one);
  if (layer_ == Layer::endo) {
    set_gate(out, s, one, one_and(e.by5, 28.0 / 5), R(1000.0) * gaussian(v, -67.0, 1000.0) + R(8.0), one);
  } else {
    // tau_s = 85 e^(-(V+45)^2/320) + 5 / (1 + e^((V-20)/5)) + 3
    const R rising = one_and(e.by5, -4.0);
    set_gate(out, s, one, one_and(e.by5, 4.0),
             (R(85.0) * gaussian(v, -45.0, 320.0) + R(3.0)) * rising + R(5.0), rising);
  }
}

template <Real R>
[[gnu::always_inline]] inline void TenTusscherPanfilov::calcium_gates(R v, R ca_ss,
                                                                      const tt06::Exponentials<R>& e,
                                                                      CellRates<R>& out) {
  using namespace tt06;
  const R one(1.0);
  // tau_d = (1.4 / (1 + e^((-35-V)/13)) + 0.25) 1.4 / (1 + e^((V+5)/5)) + 1 / (1 + e^((50-V)/20))
  const R a = one_and_exp(v, -35.0, -13.0), b = one_and(e.by5, 1.0), c = one_and(e.by20_inverse, 2.5);
  const R by7_5 = square(e.by15);
  set_gate(out, d, by7_5, by7_5 + R(std::exp(-8.0 / 7.5)), R(1.4) * (R(1.4) + R(0.25) * a) * c + a * b,
           a * b * c);

  // tau_f = 1102.5 e^(-(V+27)^2/225) + 200 / (1 + e^((13-V)/10)) + 180 / (1 + e^((V+30)/10)) + 20, and f2 alike
  const R up = one_and(e.by10, 3.0), down = one_and(e.by10_inverse, 1.3),
          down2 = one_and(e.by10_inverse, 2.5);
  set_gate(out, f, one, one_and(e.by7, 20.0 / 7),
           (R(1102.5) * gaussian(v, -27.0, 225.0) + R(20.0)) * down * up + R(200.0) * up + R(180.0) * down,
           down * up);
  const R f2_below = one_and(e.by7, 5.0);
  set_gate(out, f2, R(0.67) + R(0.33) * f2_below, f2_below,
           R(600.0) * gaussian(v, -25.0, 170.0) * down2 * up + R(31.0) * up + R(16.0) * down2, down2 * up);
  // f_inf = 0.6 / b + 0.4, tau = 80 / b + 2, b = 1 + (Ca_ss / 0.05)^2
  const R bound = one + square(ca_ss * R(1.0 / 0.05));
  set_gate(out, fCass, R(0.6) + R(0.4) * bound, bound, R(80.0) + R(2.0) * bound, bound);
}

template <Real R>
[[gnu::always_inline]] inline TenTusscherPanfilov::Currents<R> TenTusscherPanfilov::currents(
    R v, const State<R>& y, CellRates<R>& out) const {
  using namespace tt06;
  const R one(1.0);
  const double G_to = layer_ == Layer::endo ? 0.073 : 0.294, G_Ks = layer_ == Layer::mid ? 0.098 : 0.392;
  const auto nernst = [](double outside, R inside) {
    return R(RT_F) * (R(std::log(outside)) - fast_log(inside));
  };
  const R E_Na = nernst(Na_o, y[Na_i]), E_K = nernst(K_o, y[K_i]), E_Ca = R(0.5) * nernst(Ca_o, y[Ca_i]);
  const R E_Ks = nernst(K_o + 0.03 * Na_o, y[K_i] + R(0.03) * y[Na_i]);

  // Conductances, nS/pF
  const R g_Na = R(14.838) * y[m] * y[m] * y[m] * y[h] * y[j], g_bNa(0.00029), g_bCa(0.000592);
  const R g_to = R(G_to) * y[r] * y[s], g_Kr = R(0.153 * std::sqrt(K_o / 5.4)) * y[xr1] * y[xr2];
  const R g_Ks = R(G_Ks) * square(y[xs]);
  const R g_pK = R(0.0146) * reciprocal(one_and_exp(v, 25.0, -5.98));
  // alpha = 0.1 / a, a = 1 + e^(0.06 (u - 200)), beta = b / (1 + e^(-u/2)), x = alpha / (alpha + beta)
  const R u = v - E_K;
  const R w = fast_exp(R(0.02) * u), w2 = w * w, w5 = w2 * w2 * w, w10 = w5 * w5;
  const R a = one_and(w2 * w, -12.0), below_c = w10 * w10 * w5, c_times = below_c + one;
  const R b = R(3.0) * fast_exp(R(0.0002) * (u + R(100.0))) + R(std::exp(-1.0)) * w5;
  const R g_K1 =
      R(5.405 * std::sqrt(K_o / 5.4) * 0.1) * c_times * reciprocal(R(0.1) * c_times + b * a * below_c);

  // Goldman-Hodgkin-Katz, with the limit of (e^x - 1) / x at x = 0, V = 15 mV
  const R x = R(2.0 / RT_F) * (v - R(15.0));
  const Relaxation<R> open = relaxation(R(0.0) - x);  // e^x, (e^x - 1) / x
  const R I_CaL = R(2.0 * 3.98e-5 * faraday) * y[d] * y[f] * y[f2] * y[fCass] *
                  (R(0.25) * y[Ca_ss] * open.decay - R(Ca_o)) * reciprocal(open.mean);

  const R root = fast_exp(v * R(-0.05 / RT_F)), z = root * root;  // e^(-0.1 V F / (R T))
  const R z2 = z * z, z3 = z2 * z, z5 = z3 * z2, z10 = z5 * z5;
  const R I_NaK = R(2.724 * K_o / (K_o + 1.0)) * y[Na_i] *
                  reciprocal((y[Na_i] + R(40.0)) * (one + R(0.1245) * z + R(0.0353) * z10));
  const R up = reciprocal(z3 * root), down = up * z10;  // e^(0.35 VF/RT), e^(-0.65 VF/RT)
  const double sodium_site = 87.5 * 87.5 * 87.5 + Na_o * Na_o * Na_o;
  const R I_NaCa = R(1000.0 / (sodium_site * (1.38 + Ca_o))) *
                   (up * square(y[Na_i]) * y[Na_i] * R(Ca_o) - down * y[Ca_i] * R(2.5 * Na_o * Na_o * Na_o)) *
                   reciprocal(one + R(0.1) * down);
  const R I_pCa = R(0.1238) * y[Ca_i] * reciprocal(y[Ca_i] + R(0.0005));

  const R g_at_K = g_K1 + g_to + g_Kr + g_pK;
  out.p[V] = g_Na + g_bNa + g_at_K + g_Ks + g_bCa;
  out.q[V] =
      (g_Na + g_bNa) * E_Na + g_at_K * E_K + g_Ks * E_Ks + g_bCa * E_Ca - I_CaL - I_NaCa - I_NaK - I_pCa;
  const R I_bCa = g_bCa * (v - E_Ca);
  return {(g_Na + g_bNa) * (v - E_Na) + R(3.0) * (I_NaK + I_NaCa),
          g_at_K * u + g_Ks * (v - E_Ks) - R(2.0) * I_NaK, I_bCa + I_pCa - R(2.0) * I_NaCa, I_CaL};
}

template <Real R>
[[gnu::always_inline]] inline void TenTusscherPanfilov::calcium(const State<R>& y, const Currents<R>& current,
                                                                CellRates<R>& out) {
  using namespace tt06;
  // k_casr = 2.5 - 1.5 / (1 + (1.5 / Ca_sr)^2) = n / b; k1 = 0.15 / k_casr, k2 = 0.045 k_casr
  const R ca2 = square(y[Ca_sr]), b = ca2 + R(2.25), n = R(2.5) * b - R(1.5) * ca2,
          per_nb = reciprocal(n * b);
  const R k1 = R(0.15) * b * b * per_nb, k2 = R(0.045) * n * n * per_nb, k4(0.005);
  out.p[R_bar] = k2 * y[Ca_ss] + k4;
  out.q[R_bar] = k4;
  const R k1_ca2 = k1 * square(y[Ca_ss]);
  const R release = R(0.102) * k1_ca2 * y[R_bar] * reciprocal(R(0.060) + k1_ca2);  // V_rel O, 1/ms

  // Share of the calcium that stays free of the buffer: 1 / (1 + B K / (Ca + K)^2)
  const auto free = [](R ca, double buffer, double k) {
    const R sum2 = square(ca + R(k));
    return sum2 * reciprocal(sum2 + R(buffer * k));
  };
  const double V_leak = 0.00036, V_xfer = 0.0038;
  const R cai2 = square(y[Ca_i]);
  const R uptake = R(0.006375) * cai2 * reciprocal(cai2 + R(0.00025 * 0.00025));
  const R free_c = free(y[Ca_i], 0.2, 0.001), free_ss = free(y[Ca_ss], 0.4, 0.00025),
          free_sr = free(y[Ca_sr], 10.0, 0.3);
  const double per_charge = capacitance / (2.0 * V_c * faraday);
  out.p[Ca_i] = free_c * R(V_leak * V_sr / V_c + V_xfer);
  out.q[Ca_i] = free_c * (R(V_sr / V_c) * (R(V_leak) * y[Ca_sr] - uptake) + R(V_xfer) * y[Ca_ss] -
                          R(per_charge) * current.calcium);
  out.p[Ca_sr] = free_sr * (release + R(V_leak));
  out.q[Ca_sr] = free_sr * (uptake + release * y[Ca_ss] + R(V_leak) * y[Ca_i]);
  const R from_sr = R(V_sr / V_ss) * release;
  out.p[Ca_ss] = free_ss * (R(V_xfer * V_c / V_ss) + from_sr);
  out.q[Ca_ss] = free_ss * (R(V_xfer * V_c / V_ss) * y[Ca_i] + from_sr * y[Ca_sr] -
                            R(per_charge * V_c / V_ss) * current.l_type);
}

}  // namespace shoal::diffusion
