// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

#include <cmath>

#include "stimulus.hpp"

using shoal::diffusion::Stimulus;

TEST_CASE("a stimulus acts for the part of a step that it covers") {
  Stimulus once;
  once.rate = 10.0;
  once.start = 1.0;
  once.duration = 2.0;
  CHECK(once.share(0.0, 1.0) == 0.0);
  CHECK(once.share(0.0, 2.0) == doctest::Approx(0.5));
  CHECK(once.share(1.5, 2.5) == doctest::Approx(1.0));
  CHECK(once.share(2.5, 4.5) == doctest::Approx(0.25));
  CHECK(once.share(0.0, 10.0) == doctest::Approx(0.2));
  CHECK(once.share(3.0, 3.5) == 0.0);
  CHECK(once.share(1.0, 1.0) == 0.0);

  const double points[] = {0.0, 0.0, 5.0, -3.0};
  double source[] = {1.0, 2.0};
  once.add(2, 0.5, 2, points, 2.5, 4.5, source);
  CHECK(source[0] == doctest::Approx(3.5));
  CHECK(source[1] == doctest::Approx(4.5));
}

TEST_CASE("the length that is stimulated does not depend on how the box cuts the particles") {
  for (const double dx : {0.5, 0.2, 0.13}) {
    double whole = 0;
    for (double x = -20 * dx + 0.5 * dx; x < 20 * dx; x += dx) {
      const double part = Stimulus::overlap(x, dx, 0.35, 1.5);
      whole += part * dx;
      if (x - 0.5 * dx > 0.35 && x + 0.5 * dx < 1.5) CHECK(part == 1.0);
      if (x + 0.5 * dx < 0.35 || x - 0.5 * dx > 1.5) CHECK(part == 0.0);
    }
    CHECK(whole == doctest::Approx(1.15));
  }
  CHECK(Stimulus::overlap(1.5, 0.2, -HUGE_VAL, 1.5) == doctest::Approx(0.5));
}
