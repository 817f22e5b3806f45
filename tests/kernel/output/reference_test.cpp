// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Errors against numbers worked out by hand, and times at which things are due.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>

#include "kernel/output/atomic_file.hpp"
#include "kernel/output/due.hpp"
#include "kernel/output/reference.hpp"
#include "kernel/output/run_state.hpp"
#include "kernel/particles/errors.hpp"

using namespace shoal::kernel;

namespace {

ReferenceSpecification against(const std::string& text, ErrorMeasure measure) {
  std::ofstream("reference.csv") << text;
  ReferenceSpecification specification;
  specification.data = "reference.csv";
  specification.measure = measure;
  specification.tolerance = 0.2;
  return specification;
}

// 2 t, sampled every second from 0 to 4.
const Series line{{0, 1, 2, 3, 4}, {0, 2, 4, 6, 8}};

}  // namespace

TEST_CASE("errors between samples are linear, and ratios") {
  // At 0.5: 1, at 2: 4, at 3.5: 7; the reference says 2, 4 and 10.
  const std::string data = "t,x\n0.5,2\n2,4\n3.5,10\n";
  const auto error = [&](ErrorMeasure measure) { return compare(against(data, measure), line, true).error; };
  CHECK(error(ErrorMeasure::rms) == doctest::Approx(std::sqrt((1.0 + 0.0 + 9.0) / 3.0) / 10.0));
  CHECK(error(ErrorMeasure::relative_rms) == doctest::Approx(std::sqrt(10.0 / 120.0)));
  CHECK(error(ErrorMeasure::max) == doctest::Approx(0.3));
  CHECK(error(ErrorMeasure::last) == doctest::Approx(0.3));
  // The peak is that of all samples, 8, not of those at the reference's times.
  CHECK(error(ErrorMeasure::peak) == doctest::Approx(0.2));
  CHECK(error(ErrorMeasure::mean) == doctest::Approx((1.0 + 0.0 + 3.0) / 3.0 / 10.0));
  ReferenceSpecification absolute = against(data, ErrorMeasure::max);
  absolute.scale = 1.0;
  CHECK(compare(absolute, line, true).error == doctest::Approx(3.0));
}

TEST_CASE("arrival: when half of the reference's largest value is first reached") {
  // Half of the largest value is 5, which 2 t reaches at 2.5.
  CHECK(compare(against("0,0\n2,4\n3,6\n4,10\n", ErrorMeasure::arrival), line, true).error ==
        doctest::Approx(0.0).scale(1.0));
  CHECK(compare(against("0,0\n1,0\n2,10\n4,0\n", ErrorMeasure::arrival), line, true).error ==
        doctest::Approx((2.5 - 1.5) / 1.5));
  const ReferenceResult never = compare(against("0,0\n4,80\n", ErrorMeasure::arrival), line, true);
  CHECK(std::isnan(never.error));
  CHECK(never.verdict == Verdict::fail);
}

TEST_CASE("means of windows are compared with the probe's means over such windows") {
  // Noise of +-1 on 2 t: over windows of two seconds 1/3 of it is left in the middle, and nothing is known of a NaN.
  const Series noisy{{0, 1, 2, 3, 4, 5}, {1, 1, 5, 5, 9, std::nan("")}};
  ReferenceSpecification means = against("2,4\n", ErrorMeasure::max);
  means.scale = 1.0;
  CHECK(compare(means, noisy, true).error == doctest::Approx(1.0));
  means.average = 2.0;
  CHECK(compare(means, noisy, true).error == doctest::Approx(std::abs((1.0 + 5.0 + 5.0) / 3.0 - 4.0)));
  ReferenceSpecification at_end = against("4,9\n5,10\n", ErrorMeasure::max);
  at_end.average = 2.0;
  const ReferenceResult last = compare(at_end, noisy, true);
  CHECK(last.left_out == 1);
  CHECK(last.error == doctest::Approx(std::abs((5.0 + 9.0) / 2.0 - 9.0) / 9.0));
}

TEST_CASE("period: the mean time between rises through the mean") {
  const auto wave = [](double period, double offset) {
    Series series;
    for (int k = 0; k <= 1000; ++k) {
      const double t = 0.01 * k;
      series.times.push_back(t);
      series.values.push_back(offset + std::sin(2.0 * 3.14159265358979 * (t - 0.1) / period));
    }
    return series;
  };
  ReferenceSpecification specification;
  specification.measure = ErrorMeasure::period;
  specification.exact = [&](double t) { return std::cos(2.0 * 3.14159265358979 * t / 2.0); };
  CHECK(compare(specification, wave(2.0, 5.0), true).error < 1e-4);
  CHECK(compare(specification, wave(1.9, -5.0), true).error == doctest::Approx(0.05).epsilon(0.01));
  CHECK(std::isnan(compare(specification, wave(30.0, 0.0), true).error));
}

TEST_CASE("amplitude: half the difference between the largest and the least value within the window") {
  ReferenceSpecification specification = against("0,-3\n1,1\n2,99\n", ErrorMeasure::amplitude);  // 2
  specification.to = 1.0;
  const Series sampled{{0, 0.3, 0.6, 1, 1.5}, {5, 9.2, 4.8, std::nan(""), 100}};  // 2.2
  CHECK(compare(specification, sampled, true).error == doctest::Approx(0.1));
  CHECK(std::isnan(compare(specification, Series{}, true).error));
}

TEST_CASE("an ensemble: the mean over runs, point by point, and how far one run is from it") {
  // At 2 and 4: 3 and 9, and 7 and 11; in the mean 5 and 10.
  const std::vector<Series> runs{{{0, 2, 4}, {0, 3, 9}}, {{0, 1, 2, 4}, {0, 1, 7, 11}}};
  ReferenceSpecification specification = against("2,4\n4,10\n", ErrorMeasure::rms);
  specification.tolerance = 0.05;
  const EnsembleResult strict = compare_ensemble(specification, runs);
  CHECK(strict.error == doctest::Approx(std::sqrt(1.0 / 2.0) / 10.0));
  CHECK(strict.deviation == doctest::Approx(std::sqrt((4.0 + 4.0 + 1.0 + 1.0) / 2.0) / 10.0));
  CHECK(strict.verdict == Verdict::fail);
  specification.mean_tolerance = 0.08;
  CHECK(compare_ensemble(specification, runs).verdict == Verdict::pass);
  CHECK(compare_ensemble(specification, runs).tolerance == 0.08);
  CHECK(compare(specification, runs[0], true).tolerance == 0.05);
  // A value that one run lacks is left out, and one run alone has no deviation.
  const std::vector<Series> short_run{runs[0], {{0, 2}, {0, 7}}};
  CHECK(compare_ensemble(specification, short_run).error == doctest::Approx(1.0 / 4.0));
  CHECK(std::isnan(compare_ensemble(specification, {runs[0]}).deviation));
  CHECK(compare_ensemble(specification, {}).verdict == Verdict::fail);
  CHECK(compare_ensemble_files(specification, {"no_such.csv"}).remark != "");
  // Errors of single runs do not cancel in their mean; what they measure does: peaks of 9 and 11 against 10.
  const EnsembleResult peaks = compare_ensemble(against("0,10\n", ErrorMeasure::peak), runs);
  CHECK(peaks.error == doctest::Approx(0.0));
  CHECK(peaks.deviation == doctest::Approx(std::sqrt(2.0) / 10.0));
}

TEST_CASE("names of measures") {
  CHECK(error_measure("final") == ErrorMeasure::last);
  CHECK(error_measure("relative_rms") == ErrorMeasure::relative_rms);
  CHECK_FALSE(error_measure("average"));
  CHECK(name_of(ErrorMeasure::last) == "final");
  CHECK(name_of(ErrorMeasure::amplitude) == "amplitude");
}

TEST_CASE("columns, scales and the window of a reference") {
  ReferenceSpecification specification =
      against("time [ms],a,b [cm]\n0,9,0\n1000,9,200\n2000,9,400\n5000,9,77\n", ErrorMeasure::max);
  specification.time_column = "time";
  specification.value_column = "b";
  specification.time_scale = 1e-3;
  specification.value_scale = 1e-2;
  specification.to = 2.0;
  const ReferenceResult good = compare(specification, line, true);
  CHECK(good.error == doctest::Approx(0.0));
  CHECK(good.points == 3);
  CHECK(good.verdict == Verdict::pass);
  specification.value_column = "3";
  specification.value_shift = 1.0;
  specification.time_shift = 0.5;  // values 1 and 3 at 0.5 and 1.5: right again
  CHECK(compare(specification, line, true).error == doctest::Approx(0.0));
  specification.from = 1.0;
  CHECK(compare(specification, line, true).points == 1);
  specification.value_column = "c";
  CHECK_THROWS_WITH_AS(check_reference(specification),
                       "'reference.csv' has no column 'c'; it has time [ms], a, b [cm]", OutputError);
  specification.value_column = "4";
  CHECK_THROWS_AS(check_reference(specification), OutputError);
  specification.value_column = "2";
  specification.from = 1.9;
  CHECK_THROWS_WITH_AS(check_reference(specification), doctest::Contains("no point between the times"),
                       OutputError);
}

TEST_CASE("what has no value is left out and counted, and nothing at all is a failure") {
  Series holes = line;
  holes.values[0] = holes.values[1] = std::nan("");
  ReferenceSpecification specification = against("t,x\n0,0\n0.5,1\n1.5,3\n2,4\n9,1\n", ErrorMeasure::rms);
  const ReferenceResult result = compare(specification, holes, true);
  CHECK(result.points == 1);
  CHECK(result.left_out == 4);
  CHECK(result.error == doctest::Approx(0.0));
  CHECK(result.remark == "4 points without a value left out");
  const ReferenceResult none = compare(specification, Series{}, true);
  CHECK(std::isnan(none.error));
  CHECK(none.verdict == Verdict::fail);
  ReferenceSpecification zero = against("t,x\n0,0\n1,0\n", ErrorMeasure::rms);
  CHECK(compare(zero, line, true).verdict == Verdict::fail);
  CHECK(compare(zero, line, true).remark.find("scale") != std::string::npos);
}

TEST_CASE("exact solutions are compared at the samples") {
  ReferenceSpecification specification;
  specification.exact = [](double t) { return t * t; };
  specification.measure = ErrorMeasure::max;
  specification.tolerance = 0.5;
  // 2 t against t^2 at 0 .. 4: at most 8 of 16
  CHECK(compare(specification, line, true).error == doctest::Approx(0.5));
  CHECK(compare(specification, line, true).verdict == Verdict::pass);
  specification.to = 3.0;
  CHECK(compare(specification, line, true).error == doctest::Approx(3.0 / 9.0));
}

TEST_CASE("a run that stopped early gets no verdict unless the window is behind it") {
  ReferenceSpecification specification = against("t,x\n0,0\n3,5\n", ErrorMeasure::rms);
  CHECK(compare(specification, line, false).verdict == Verdict::incomplete);
  specification.to = 3.5;
  CHECK(compare(specification, line, false).verdict == Verdict::pass);
  specification.to = 4.5;
  CHECK(compare(specification, line, false).verdict == Verdict::incomplete);
}

TEST_CASE("due times: multiples, single times, rounding") {
  const Due every(0.1, {});
  CHECK(every.at_start(0.0));
  CHECK_FALSE(every.between(0.0, 0.0999));
  CHECK(every.between(0.0999, 0.1));
  CHECK_FALSE(every.between(0.1, 0.15));
  CHECK(every.between(0.15, 0.95));
  double time = 0.0;
  int n = 0;
  for (int k = 0; k < 1000; ++k) {
    n += every.between(time, time + 0.01) ? 1 : 0;
    time += 0.01;  // misses the multiples by rounding
  }
  CHECK(n == 100);
  const Due at(std::nullopt, {0.5, 0.0, 0.2});
  CHECK(at.at_start(0.0));
  CHECK(at.between(0.1, 0.2));
  CHECK_FALSE(at.between(0.2, 0.4));
  CHECK(at.between(0.4, 0.7));
  CHECK_FALSE(at.between(0.7, 1e9));
  CHECK_FALSE(Due().at_start(0.0));
  CHECK_FALSE(Due(std::nullopt, {0.3}).at_start(0.0));
}

TEST_CASE("the state of a run survives its text") {
  const RunState state{"0.1.0", "shoal: 1\n",    0.1,
                       12.5,    "it is at rest", {{{"vtk", 7}}, {{"front", 1234567890123}}}};
  const RunState copy = state_from_text(to_text(state));
  CHECK(copy.version == state.version);
  CHECK(copy.effective_case == state.effective_case);
  CHECK(copy.finish_reason == state.finish_reason);
  CHECK(copy.time == state.time);
  CHECK(copy.recorder.outputs[0].name == "vtk");
  CHECK(copy.recorder.outputs[0].sequence == 7);
  CHECK(copy.recorder.series[0].bytes == 1234567890123);
  CHECK_THROWS_AS(state_from_text("{}"), CheckpointError);
  CHECK_THROWS_AS(state_from_text("{"), CheckpointError);
}

TEST_CASE("what makes another computation of a case") {
  const std::string before =
      "shoal: 1\ntitle: A  # x:1\nrun: {end: 1}\nresolution: 0.1\nbodies: {a: {arrangement: cubic}}\n"
      "output: [vtk: {every: 1}]\nprobes: {p: {sum: {of: mass, body: a}, every: 1}}\n";
  const std::string now =
      "shoal: 1\ntitle: B\nrun: {end: 2, checkpoint_every: 1}\nresolution: 0.2\nbodies: {b: {arrangement: "
      "cubic}}\n"
      "output: []\n";
  CHECK(differing_physics(before, before).empty());
  CHECK(differences(before, before + "# a comment\n").empty());
  CHECK(differing_physics(before, now) == std::vector<std::string>{"bodies.a.arrangement: cubic -> (none)",
                                                                   "resolution: 0.1 -> 0.2",
                                                                   "bodies.b.arrangement: (none) -> cubic"});
  CHECK(differences(before, now).size() > 5);
}
