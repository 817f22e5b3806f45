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
#include <ctime>
#include <random>

#include "pictures.hpp"
#include "sample.hpp"

using namespace shoal::vtk;
using namespace shoal::vtk::test;

namespace {

struct Cost {
  double wall = 1e300, processor = 1e300;  // ms
};

// Processor time is what remains comparable on a busy machine.
template <class Work>
Cost best_of(int times, Work&& work) {
  Cost best;
  for (int k = 0; k < times; ++k) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t processor_start = std::clock();
    work();
    const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start;
    best.wall = std::min(best.wall, wall.count());
    best.processor =
        std::min(best.processor, 1e3 * static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC);
  }
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
  const auto print = [](const std::string& what, const Cost& cost, double bytes) {
    std::printf("%-24s %7.1f ms, %7.1f ms of the processor, %5.2f MB\n", what.c_str(), cost.wall,
                cost.processor, 1e-6 * bytes);
  };
  print("copy into arrays", best_of(5, [&] { make_picture(bodies[0], 3, 0, Precision::single); }), 0);
  const std::array<std::pair<const char*, Compression>, 3> kinds{
      {{"fast", Compression::fast}, {"small", Compression::small}, {"none", Compression::none}}};
  for (const auto& [name, compression] : kinds)
    for (const Precision precision : {Precision::single, Precision::full}) {
      Pictures pictures(folder, 0, precision, compression);
      std::uint64_t k = 0;
      const Cost cost = best_of(5, [&] {
        pictures.write(snapshot_of(bodies, 3, static_cast<double>(k), k));
        ++k;
      });
      print(std::string(name) + (precision == Precision::single ? " single" : " double"), cost,
            static_cast<double>(std::filesystem::file_size(folder / "flow_00000.vtp")));
      if (compression != Compression::small) CHECK(cost.processor < 1000);
    }
}
