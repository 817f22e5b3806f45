// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include <doctest/doctest.h>

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

TEST_CASE("the volume that is stimulated does not depend on how the box cuts the particles") {
  Stimulus box;
  box.rate = 3.0;
  box.duration = 1.0;
  box.lower = {0.0, 0.35, 0.0};
  box.upper = {1.1, 1.5, 0.0};
  for (const double dx : {0.5, 0.2, 0.13}) {
    double total = 0;
    for (double x = 0.5 * dx; x < 3.0; x += dx)
      for (double y = 0.5 * dx; y < 3.0; y += dx) {
        const double point[] = {x, y};
        double source = 0;
        box.add(2, dx, 1, point, 0.0, 1.0, &source);
        total += source * dx * dx;
        const bool inside = x + 0.5 * dx < 1.1 && y - 0.5 * dx > 0.35 && y + 0.5 * dx < 1.5;
        const bool outside = x - 0.5 * dx > 1.1 || y + 0.5 * dx < 0.35 || y - 0.5 * dx > 1.5;
        if (inside) CHECK(source == doctest::Approx(3.0));
        if (outside) CHECK(source == 0.0);
      }
    CHECK(total == doctest::Approx(3.0 * 1.1 * 1.15));
  }
}
