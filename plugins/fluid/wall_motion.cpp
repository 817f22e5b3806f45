// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "wall_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <utility>

namespace shoal::fluid {
namespace {

// The numbers of a line, none if anything else stands in it.
std::vector<double> numbers(std::string line) {
  std::replace(line.begin(), line.end(), ',', ' ');
  std::vector<double> row;
  const char* rest = line.c_str();
  for (;;) {
    char* end = nullptr;
    const double value = std::strtod(rest, &end);
    if (end == rest) break;
    row.push_back(value);
    rest = end;
  }
  return line.find_first_not_of(" \t\r", static_cast<std::size_t>(rest - line.c_str())) == std::string::npos
             ? row
             : std::vector<double>{};
}

}  // namespace

MotionTable::MotionTable(const std::string& path) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const std::vector<double> row = numbers(line);
    if (row.empty()) continue;
    if (columns_.empty()) columns_.resize(row.size() - 1);
    if (row.size() != columns_.size() + 1)
      throw CaseError("'" + path + "': a row has " + std::to_string(row.size()) + " numbers, the first has " +
                      std::to_string(columns_.size() + 1));
    times_.push_back(row[0]);
    for (std::size_t k = 0; k < columns_.size(); ++k) columns_[k].push_back(row[k + 1]);
  }
  check(path);
}

MotionTable::MotionTable(std::vector<double> times, std::vector<std::vector<double>> columns)
    : times_(std::move(times)), columns_(std::move(columns)) {
  check("table");
}

void MotionTable::check(const std::string& path) const {
  if (times_.size() < 2) throw CaseError("'" + path + "' needs two rows of numbers at least");
  for (std::size_t k = 1; k < times_.size(); ++k)
    if (!(times_[k] > times_[k - 1])) throw CaseError("'" + path + "': times must rise");
}

double MotionTable::slope(std::size_t column, std::size_t row) const {
  const std::size_t before = row == 0 ? 0 : row - 1, after = std::min(row + 1, times_.size() - 1);
  return (columns_[column][after] - columns_[column][before]) / (times_[after] - times_[before]);
}

double MotionTable::value(std::size_t column, double time) const {
  const std::vector<double>& values = columns_[column];
  if (time <= times_.front()) return values.front();
  if (time >= times_.back()) return values.back();
  const auto after =
      static_cast<std::size_t>(std::upper_bound(times_.begin(), times_.end(), time) - times_.begin());
  const std::size_t k = after - 1;
  const double length = times_[after] - times_[k], s = (time - times_[k]) / length;
  return (1.0 + 2.0 * s) * (1.0 - s) * (1.0 - s) * values[k] + s * s * (3.0 - 2.0 * s) * values[after] +
         length * s * (1.0 - s) * ((1.0 - s) * slope(column, k) - s * slope(column, after));
}

Pose Motion::pose(double time) const {
  const std::array<double, 3> origin{};
  const auto d = static_cast<std::size_t>(dimensions);
  Pose pose;
  for (std::size_t a = 0; a < d; ++a) {
    if (table.n_columns() > a) pose.translation[a] = table.value(a, time);
    if (translation.component[a])
      pose.translation[a] = translation.component[a](dimensions, origin.data(), time);
  }
  if (table.n_columns() > d) pose.angle = table.value(d, time);
  if (rotation) pose.angle = rotation(dimensions, origin.data(), time);
  return pose;
}

void WallMotion::build(const Builder& b) {
  const auto motion = std::make_shared<Motion>();
  motion->dimensions = b.dimensions();
  if (translation.is_set()) motion->translation = translation;
  if (rotation.is_set()) motion->rotation = rotation;
  if (centre.is_set()) motion->centre = centre;
  if (table.is_set()) {
    if (translation.is_set() || rotation.is_set())
      throw CaseError(table.place() + ": fluid.wall_motion takes a table or expressions, not both");
    motion->table = MotionTable(table->path);
    if (motion->table.n_columns() != static_cast<std::size_t>(b.dimensions()) + 1)
      throw CaseError(table.place() + ": the table needs " + std::to_string(b.dimensions() + 2) +
                      " columns: time, a displacement along each axis, angle");
  } else if (!translation.is_set() && !rotation.is_set()) {
    throw CaseError("fluid.wall_motion needs translation, rotation or table");
  }
  if (b.dimensions() == 3 && (rotation.is_set() || table.is_set())) {
    if (!axis.is_set())
      throw CaseError("fluid.wall_motion needs the axis of its rotation, e.g. axis: [0, 1, 0]");
    const Vector3 a = axis;
    const double length = std::hypot(a[0], a[1], a[2]);
    if (length == 0.0) throw CaseError(axis.place() + ": the axis has no length");
    for (std::size_t k = 0; k < 3; ++k) motion->axis[k] = a[k] / length;
  }
  for (const BodyIndex body : bodies.value()) {
    b.body_moves(body);
    const auto move = [&](double share) {
      return [&motion, share](MoveWall& op) {
        op.motion = motion;
        op.share = share;
      };
    };
    b.attach<KeepNormals>("fluid.keep_normals", {SHOAL_INITIAL, "state"}, b.target(body));
    b.attach<MoveWall>("fluid.move_wall.half", {"acoustic", "predict"}, b.target(body), move(0.5));
    b.attach<MoveWall>("fluid.move_wall", {"acoustic", "kick"}, b.target(body), move(1.0));
  }
}

}  // namespace shoal::fluid
