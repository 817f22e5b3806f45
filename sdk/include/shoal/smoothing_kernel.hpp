// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Smoothing kernels W(r, h) in two and three dimensions, for double and Pack.
//
// Each kernel is a small value made from h. With q = r / h it gives
//   w(r)          W, in 1/m^D
//   dw(r)         dW/dr, in 1/m^(D+1); gradient with respect to x_i is dw(r) (x_i - x_j) / r
//   dw_over_r(r)  (dW/dr) / r, without a division by r where the kernel allows it, finite at r = 0
//   cutoff()      radius beyond which all three are exactly zero
// All are free of branches, so that lanes beyond the cut-off cost nothing extra; a NaN distance gives NaN.
// Every kernel integrates to 1, and the first moment of its gradient is minus the identity.
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include "shoal/pack.hpp"

namespace shoal {
inline namespace SHOAL_ISA_NAMESPACE {

namespace detail {
/// 1 / h^D
template <int D>
constexpr double per_volume(double h) {
  static_assert(D == 2 || D == 3, "smoothing kernels exist in two and three dimensions");
  return D == 2 ? 1.0 / (h * h) : 1.0 / (h * h * h);
}
}  // namespace detail

/// Wendland C2 (Wendland 1995, Dehnen and Aly 2012), the default: no pairing instability.
///   W = a (1 - q/2)^4 (1 + 2q),  q < 2,   a = 7 / (4 pi h^2) in 2D, 21 / (16 pi h^3) in 3D
template <int D>
class WendlandC2 {
 public:
  static constexpr double support = 2.0;  // cut-off over h
  constexpr explicit WendlandC2(double h)
      : h_(h),
        per_cutoff_(0.5 / h),
        w_factor_((D == 2 ? 7.0 / 4.0 : 21.0 / 16.0) * std::numbers::inv_pi * detail::per_volume<D>(h)),
        dw_factor_(-5.0 * w_factor_ / (h * h)) {}

  constexpr double h() const { return h_; }
  constexpr double cutoff() const { return support * h_; }

  template <Real R>
  R w(R r) const {
    const R t = max(0.0, 1.0 - r * per_cutoff_);
    const R t2 = t * t;
    return w_factor_ * (t2 * t2) * (5.0 - 4.0 * t);  // 1 + 2q = 5 - 4t
  }
  template <Real R>
  R dw_over_r(R r) const {
    const R t = max(0.0, 1.0 - r * per_cutoff_);
    return dw_factor_ * (t * t * t);
  }
  template <Real R>
  R dw(R r) const {
    return r * dw_over_r(r);
  }

 private:
  double h_, per_cutoff_, w_factor_, dw_factor_;
};

/// Wendland C4 (Wendland 1995, Dehnen and Aly 2012): smoother, wants more neighbours.
///   W = a (1 - q/2)^6 (35/12 q^2 + 3q + 1),  q < 2,   a = 9 / (4 pi h^2) in 2D, 495 / (256 pi h^3) in 3D
template <int D>
class WendlandC4 {
 public:
  static constexpr double support = 2.0;
  constexpr explicit WendlandC4(double h)
      : h_(h),
        per_h_(1.0 / h),
        w_factor_((D == 2 ? 9.0 / 4.0 : 495.0 / 256.0) * std::numbers::inv_pi * detail::per_volume<D>(h)),
        dw_factor_(-14.0 / 3.0 * w_factor_ / (h * h)) {}

  constexpr double h() const { return h_; }
  constexpr double cutoff() const { return support * h_; }

  template <Real R>
  R w(R r) const {
    const R q = r * per_h_;
    const R t = max(0.0, 1.0 - 0.5 * q);
    const R t2 = t * t;
    return w_factor_ * (t2 * t2 * t2) * (1.0 + q * (3.0 + 35.0 / 12.0 * q));
  }
  template <Real R>
  R dw_over_r(R r) const {
    const R q = r * per_h_;
    const R t = max(0.0, 1.0 - 0.5 * q);
    const R t2 = t * t;
    return dw_factor_ * (t2 * t2 * t) * (1.0 + 2.5 * q);
  }
  template <Real R>
  R dw(R r) const {
    return r * dw_over_r(r);
  }

 private:
  double h_, per_h_, w_factor_, dw_factor_;
};

/// Wendland C6 (Wendland 1995, Dehnen and Aly 2012). Not among the names of a case: its narrow peak serves as the
/// weight of least-squares fits (shoal/fit.hpp). With s = q / 2:
///   W = a (1 - s)^8 (1 + 8s + 25 s^2 + 32 s^3),  s < 1,   a = 39 / (14 pi h^2) in 2D, 1365 / (512 pi h^3) in 3D
template <int D>
class WendlandC6 {
 public:
  static constexpr double support = 2.0;
  constexpr explicit WendlandC6(double h)
      : h_(h),
        per_cutoff_(0.5 / h),
        w_factor_((D == 2 ? 39.0 / 14.0 : 1365.0 / 512.0) * std::numbers::inv_pi * detail::per_volume<D>(h)),
        dw_factor_(-22.0 * w_factor_ / (4.0 * h * h)) {}

  constexpr double h() const { return h_; }
  constexpr double cutoff() const { return support * h_; }

  template <Real R>
  R w(R r) const {
    const R s = r * per_cutoff_;
    const R t = max(0.0, 1.0 - s);
    const R t2 = t * t, t4 = t2 * t2;
    return w_factor_ * (t4 * t4) * (1.0 + s * (8.0 + s * (25.0 + 32.0 * s)));
  }
  template <Real R>
  R dw_over_r(R r) const {
    const R s = r * per_cutoff_;
    const R t = max(0.0, 1.0 - s);
    const R t2 = t * t;
    return dw_factor_ * (t2 * t2 * t2 * t) * (1.0 + s * (7.0 + 16.0 * s));
  }
  template <Real R>
  R dw(R r) const {
    return r * dw_over_r(r);
  }

 private:
  double h_, per_cutoff_, w_factor_, dw_factor_;
};

/// Cubic B-spline M4 (Monaghan and Lattanzio 1985). With (x)+ = max(0, x):
///   W = a [(2 - q)+^3 / 4 - (1 - q)+^3],   a = 10 / (7 pi h^2) in 2D, 1 / (pi h^3) in 3D
template <int D>
class CubicSpline {
 public:
  static constexpr double support = 2.0;
  constexpr explicit CubicSpline(double h)
      : h_(h),
        per_h_(1.0 / h),
        w_factor_((D == 2 ? 10.0 / 7.0 : 1.0) * std::numbers::inv_pi * detail::per_volume<D>(h)),
        dw_factor_(w_factor_ / (h * h)) {}

  constexpr double h() const { return h_; }
  constexpr double cutoff() const { return support * h_; }

  template <Real R>
  R w(R r) const {
    const R q = r * per_h_;
    const R s = max(0.0, 2.0 - q), t = max(0.0, 1.0 - q);
    return w_factor_ * (0.25 * (s * s * s) - t * t * t);
  }
  template <Real R>
  R dw_over_r(R r) const {
    const R q = r * per_h_;
    const R s = max(0.0, 2.0 - q);
    // The inner branch divided by q in closed form: near q = 0 the difference of the two powers cancels.
    return dw_factor_ * select(q < 1.0, -3.0 + 2.25 * q, -0.75 * (s * s) / max(1.0, q));
  }
  template <Real R>
  R dw(R r) const {
    return r * dw_over_r(r);
  }

 private:
  double h_, per_h_, w_factor_, dw_factor_;
};

/// Quintic B-spline M6 (Morris, Fox and Zhu 1997), support 3h. With (x)+ = max(0, x):
///   W = a [(3 - q)+^5 - 6 (2 - q)+^5 + 15 (1 - q)+^5],   a = 7 / (478 pi h^2) in 2D, 1 / (120 pi h^3) in 3D
template <int D>
class QuinticSpline {
 public:
  static constexpr double support = 3.0;
  constexpr explicit QuinticSpline(double h)
      : h_(h),
        per_h_(1.0 / h),
        w_factor_((D == 2 ? 7.0 / 478.0 : 1.0 / 120.0) * std::numbers::inv_pi * detail::per_volume<D>(h)),
        dw_factor_(-5.0 * w_factor_ / (h * h)) {}

  constexpr double h() const { return h_; }
  constexpr double cutoff() const { return support * h_; }

  template <Real R>
  R w(R r) const {
    const R q = r * per_h_;
    const R a = max(0.0, 3.0 - q), b = max(0.0, 2.0 - q), c = max(0.0, 1.0 - q);
    return w_factor_ * (fourth(a) * a - 6.0 * (fourth(b) * b) + 15.0 * (fourth(c) * c));
  }
  template <Real R>
  R dw_over_r(R r) const {
    const R q = r * per_h_;
    const R a = max(0.0, 3.0 - q), b = max(0.0, 2.0 - q);
    // Inside q < 1 the three powers add up to q (24 - 24 q^2 + 10 q^3), which needs no division by q.
    const R inner = 24.0 + q * q * (10.0 * q - 24.0);
    const R outer = (fourth(a) - 6.0 * fourth(b)) / max(1.0, q);
    return dw_factor_ * select(q < 1.0, inner, outer);
  }
  template <Real R>
  R dw(R r) const {
    return r * dw_over_r(r);
  }

 private:
  template <Real R>
  static R fourth(R x) {
    const R x2 = x * x;
    return x2 * x2;
  }
  double h_, per_h_, w_factor_, dw_factor_;
};

/// Hyperbolic-shaped kernel (Yang, Liu and Peng, Eng. Anal. Bound. Elem. 2014). Its gradient does not vanish at
/// r = 0, which keeps particles apart under compression (no pairing, weaker tensile instability).
///   W = a (q^3 - 6q + 6), q < 1;  a (2 - q)^3, 1 <= q < 2;   a = 1 / (3 pi h^2) in 2D, 15 / (62 pi h^3) in 3D
/// which is a [(2 - q)+^3 - 2 (1 - q)+^3]. dw_over_r is limited at r = 1e-9 h.
template <int D>
class Hyperbolic {
 public:
  static constexpr double support = 2.0;
  constexpr explicit Hyperbolic(double h)
      : h_(h),
        per_h_(1.0 / h),
        w_factor_((D == 2 ? 1.0 / 3.0 : 15.0 / 62.0) * std::numbers::inv_pi * detail::per_volume<D>(h)),
        dw_factor_(-3.0 * w_factor_ / h) {}

  constexpr double h() const { return h_; }
  constexpr double cutoff() const { return support * h_; }

  template <Real R>
  R w(R r) const {
    const R q = r * per_h_;
    const R s = max(0.0, 2.0 - q), t = max(0.0, 1.0 - q);
    return w_factor_ * (s * s * s - 2.0 * (t * t * t));
  }
  template <Real R>
  R dw(R r) const {
    const R q = r * per_h_;
    const R s = max(0.0, 2.0 - q), t = max(0.0, 1.0 - q);
    return dw_factor_ * (s * s - 2.0 * (t * t));
  }
  template <Real R>
  R dw_over_r(R r) const {
    return dw(r) / max(1e-9 * h_, r);
  }

 private:
  double h_, per_h_, w_factor_, dw_factor_;
};

/// Laguerre-Gauss kernel of fourth order (Wang, Zhang, Haidn and Hu 2023, arXiv:2309.01581), cut at 2h.
///   W = (a + b q^2 + c q^4) exp(-q^2) / h^D,  q < 2
/// The paper's coefficients, 3/pi (2D) or 8/pi^(3/2) (3D) times (1, -1, 1/6), are those of infinite support. Cut at
/// 2h they integrate to 0.982 in 2D and 0.844 in 3D and leave a step at the cut-off. Here a, b, c satisfy instead
///   int W dV = 1,   int q^2 W dV = 0 (fourth order),   W(2h) = 0,
/// three linear equations in the moments int_0^2 q^k exp(-q^2) dq, solved with 40 digits.
/// W is negative, and its slope positive, in an outer ring; the slope has a small step at the cut-off.
template <int D>
class LaguerreGauss {
 public:
  static constexpr double support = 2.0;
  constexpr explicit LaguerreGauss(double h)
      : h_(h),
        per_h_(1.0 / h),
        a_((D == 2 ? 0.93133936295277326953 : 0.82688108202713239488) * detail::per_volume<D>(h)),
        b_((D == 2 ? -0.96170403561563245615 : -0.74990510752744317529) * detail::per_volume<D>(h)),
        c_((D == 2 ? 0.18221729871935978469 : 0.13579620925516501914) * detail::per_volume<D>(h)),
        dw_factor_(2.0 / (h * h)) {}

  constexpr double h() const { return h_; }
  constexpr double cutoff() const { return support * h_; }

  template <Real R>
  R w(R r) const {
    const R q = r * per_h_;
    const R q2 = q * q;
    return select(q >= support, R(0.0), (a_ + q2 * (b_ + q2 * c_)) * exp(-q2));
  }
  template <Real R>
  R dw_over_r(R r) const {
    const R q = r * per_h_;
    const R q2 = q * q;
    const R slope = (b_ - a_) + q2 * ((2.0 * c_ - b_) - q2 * c_);
    return select(q >= support, R(0.0), dw_factor_ * slope * exp(-q2));
  }
  template <Real R>
  R dw(R r) const {
    return r * dw_over_r(r);
  }

 private:
  double h_, per_h_, a_, b_, c_, dw_factor_;
};

enum class SmoothingKernel {
  wendland_c2,
  wendland_c4,
  cubic_spline,
  quintic_spline,
  hyperbolic,
  laguerre_gauss
};

/// The names by which a case chooses, in the order of the enumeration.
inline constexpr std::array<std::string_view, 6> smoothing_kernel_names = {
    "wendland_c2", "wendland_c4", "cubic_spline", "quintic_spline", "hyperbolic", "laguerre_gauss"};

/// Nothing if there is no kernel of that name.
constexpr std::optional<SmoothingKernel> smoothing_kernel_from_name(std::string_view name) {
  for (std::size_t k = 0; k < smoothing_kernel_names.size(); ++k)
    if (smoothing_kernel_names[k] == name) return static_cast<SmoothingKernel>(k);
  return std::nullopt;
}

constexpr std::string_view to_string(SmoothingKernel kind) {
  return smoothing_kernel_names[static_cast<std::size_t>(kind)];
}

/// The kernels other than Wendland C2 as one type, which looks at each call which of them it is.
template <int D>
class OtherKernel {
 public:
  OtherKernel(SmoothingKernel kind, double h)
      : kind_(kind),
        wendland_c4_(h),
        cubic_spline_(h),
        quintic_spline_(h),
        hyperbolic_(h),
        laguerre_gauss_(h) {}

  double h() const { return wendland_c4_.h(); }
  double cutoff() const {
    return visit([](const auto& kernel) { return kernel.cutoff(); });
  }
  template <Real R>
  R w(R r) const {
    return visit([&](const auto& kernel) { return kernel.w(r); });
  }
  template <Real R>
  R dw(R r) const {
    return visit([&](const auto& kernel) { return kernel.dw(r); });
  }
  template <Real R>
  R dw_over_r(R r) const {
    return visit([&](const auto& kernel) { return kernel.dw_over_r(r); });
  }

 private:
  template <class F>
  auto visit(const F& f) const {
    switch (kind_) {
      case SmoothingKernel::cubic_spline: return f(cubic_spline_);
      case SmoothingKernel::quintic_spline: return f(quintic_spline_);
      case SmoothingKernel::hyperbolic: return f(hyperbolic_);
      case SmoothingKernel::laguerre_gauss: return f(laguerre_gauss_);
      default: return f(wendland_c4_);
    }
  }

  SmoothingKernel kind_;
  WendlandC4<D> wendland_c4_;
  CubicSpline<D> cubic_spline_;
  QuinticSpline<D> quintic_spline_;
  Hyperbolic<D> hyperbolic_;
  LaguerreGauss<D> laguerre_gauss_;
};

/// Calls f with the kernel of that kind and smoothing length, and returns what f returns. Call it once per chunk of
/// particles, outside the loops. f is compiled for the default, Wendland C2, of which the compiler then knows all, and
/// once for all others together: loops compile in a third of the time and space, at the cost of a branch that always
/// goes the same way.
template <int D, class F>
decltype(auto) with_kernel(SmoothingKernel kind, double h, F&& f) {
  if (kind == SmoothingKernel::wendland_c2) return std::forward<F>(f)(WendlandC2<D>(h));
  return std::forward<F>(f)(OtherKernel<D>(kind, h));
}

/// Cut-off radius of a kernel of that kind, in m.
inline double cutoff_radius(SmoothingKernel kind, double h) {
  return with_kernel<2>(kind, h, [](auto kernel) { return kernel.cutoff(); });
}

}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
