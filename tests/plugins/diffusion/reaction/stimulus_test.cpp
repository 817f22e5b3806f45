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
  once.add(2, 2, points, 2.5, 4.5, source);
  CHECK(source[0] == doctest::Approx(3.5));
  CHECK(source[1] == doctest::Approx(4.5));
}
