// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What a picture of 100 000 particles costs in time and on disk. Run it to renew the numbers in
// plugins/vtk/picture_file.hpp and README.md.
#include <doctest/doctest.h>
#include <vtkPolyData.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <random>

#include "pictures.hpp"
#include "sample.hpp"

using namespace shoal::vtk;
using namespace shoal::vtk::test;

namespace {

template <class Work>
double seconds(Work&& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

template <class Work>
double best_of(int times, Work&& work) {
  double best = seconds(work);
  for (int k = 1; k < times; ++k) best = std::min(best, seconds(work));
  return best;
}

// Disordered particles of a smooth flow, as in a run that has gone on for a while.
struct Flow {
  static constexpr std::uint64_t n = 100000;
  std::vector<double> position, velocity, pressure, density;
  std::vector<std::int64_t> id;
  std::vector<shoal_snapshot_field> fields;

  Flow() {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> noise(-1, 1);
    const auto add = [](std::vector<double>& to, std::initializer_list<double> values) {
      to.insert(to.end(), values);
    };
    for (std::uint64_t i = 0; i < n; ++i) {
      const double x = 0.01 * static_cast<double>(i % 47) + 0.003 * noise(random);
      const double y = 0.01 * static_cast<double>(i / 47 % 47) + 0.003 * noise(random);
      const double z = 0.01 * static_cast<double>(i / 47 / 47) + 0.003 * noise(random);
      add(position, {x, y, z});
      add(velocity, {std::sin(3 * x) + 0.01 * noise(random), std::cos(4 * y) + 0.01 * noise(random), x * y});
      pressure.push_back(9810 * (0.5 - z) + 50 * noise(random));
      density.push_back(1000 + pressure.back() / 400);
      id.push_back(static_cast<std::int64_t>(i * 7919 % n));
    }
    constexpr std::uint32_t size = sizeof(shoal_snapshot_field);
    fields = {{size, SHOAL_RANK_VECTOR, SHOAL_DOUBLE, 3, "velocity", "m/s", velocity.data()},
              {size, SHOAL_SCALAR, SHOAL_DOUBLE, 1, "pressure", "Pa", pressure.data()},
              {size, SHOAL_SCALAR, SHOAL_DOUBLE, 1, "density", "kg/m3", density.data()}};
  }
  shoal_snapshot_body c() const {
    return {sizeof(shoal_snapshot_body),
            static_cast<std::uint32_t>(fields.size()),
            "flow",
            n,
            position.data(),
            id.data(),
            fields.data()};
  }
};

}  // namespace

TEST_CASE("a picture of 100 000 particles") {
  const Flow flow;
  const std::vector bodies{flow.c()};
  const auto folder = scratch("bench");
  const std::array<std::pair<const char*, Compression>, 3> kinds{
      {{"fast", Compression::fast}, {"small", Compression::small}, {"none", Compression::none}}};
  const double copying = best_of(5, [&] { make_picture(bodies[0], 3, 0, Precision::single); });
  std::printf("copy into arrays   %6.1f ms\n", 1e3 * copying);
  for (const auto& [name, compression] : kinds)
    for (const Precision precision : {Precision::single, Precision::full}) {
      Pictures pictures(folder, 0, precision, compression);
      std::uint64_t k = 0;
      const double whole = best_of(5, [&] {
        pictures.write(snapshot_of(bodies, 3, static_cast<double>(k), k));
        ++k;
      });
      const double size = static_cast<double>(std::filesystem::file_size(folder / "flow_00000.vtp"));
      std::printf("%-5s %s   %6.1f ms with list and disk, %.2f MB\n", name,
                  precision == Precision::single ? "single" : "double", 1e3 * whole, 1e-6 * size);
      if (compression != Compression::small) CHECK(whole < 1.0);
    }
}
