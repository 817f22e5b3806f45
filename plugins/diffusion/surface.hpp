// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What holds at the surface of a body: for one part of it after the other, chosen by an expression,
//   A c + B n . K grad c = g,   n outward
//   value       c = g                                       A = 1, B = 0
//   flux        g enters through the surface                A = 0, B = 1     1/(m2 s) times the unit of c, or W/m2
//   convection  h (ambient - c) enters                      A = h, B = 1, g = h ambient
//   insulated   nothing enters: all that no condition names, and what faces no other body of the physics
// Particles nearer to the surface than one spacing carry its points: x_b = x - signed distance * normal.
#pragma once

#include <memory>
#include <vector>

#include "integrator.hpp"
#include "shoal/physics.hpp"
#include "species.hpp"
#include "stencil.hpp"

namespace shoal::diffusion {

// One condition as the physics hands it to the operators.
struct Condition {
  Expression where;        // holds where it is not zero; empty: everywhere
  double a = 0, b = 1;     // of A c + B n . K grad c = g
  Expression data;         // g, or the ambient value
  double data_factor = 1;  // g = data_factor * data
};

// The kinds of conditions are physics, so that a case can list them under `boundaries`; alone they are none.
struct ConditionOfCase : Physics {
  Param<Expression> where{"where", "1",
                          "Holds at points of the surface where this is not zero; without it at all that no "
                          "condition before it names.",
                          optional, example("x < 1e-6")};

  virtual ~ConditionOfCase() = default;
  virtual Condition condition() const = 0;
  void build(const Builder&) const {
    throw CaseError("conditions at surfaces stand under 'boundaries' of diffusion.diffusion");
  }

 protected:
  Condition at_place() const {
    Condition c;
    if (where.is_set()) c.where = where;
    return c;
  }
};

struct FixedValue final : ConditionOfCase {
  Param<Expression> value{"value", "1", "Value at the surface, an expression of x, y, z, t.", example("293")};
  Condition condition() const override {
    Condition c = at_place();
    c.a = 1, c.b = 0, c.data = value;
    return c;
  }
};

struct Flux final : ConditionOfCase {
  Param<Expression> flux{"flux", "1", "What enters: W/m2 of heat, or unit of the field times m/s.",
                         example("1000")};
  Condition condition() const override {
    Condition c = at_place();
    c.data = flux;
    return c;
  }
};

struct Convection final : ConditionOfCase {
  Param<double> coefficient{"coefficient", "1", "Coefficient of transfer: W/(m2 K) of heat, m/s of species.",
                            positive, example("25")};
  Param<Expression> ambient{"ambient", "1", "Value of what surrounds the body.", example("293")};
  Condition condition() const override {
    Condition c = at_place();
    c.a = coefficient, c.data = ambient, c.data_factor = coefficient;
    return c;
  }
};

// The surface points of particles, for those who compute weights.
struct SurfacePoints {
  static constexpr const char* normal_field = "surface_normal";
  static constexpr int interface = -1;  // number of the points where another body of the physics begins

  explicit SurfacePoints(const char* field) : surface(field) {}

  In<Vector> normal{normal_field, unit("1")};
  In<Scalar> distance{"signed_distance"};
  In<Scalar> surface;
  std::vector<Condition> conditions;

  template <int D>
  struct Point {
    int number;  // as FindSurface gives it
    Vec<D> place, normal;
  };
  // That of particle j of a relation, or of the body's own particle j if relation is -1.
  template <int D, class Op>
  Point<D> at(const Op& op, int relation, std::uint32_t j) const {
    const auto k = static_cast<std::size_t>(relation);
    const auto values = [&](const auto& field) {
      return relation < 0 ? field.data() : field.of_neighbours(k);
    };
    const Vec<D> n = gather_vec<D>(values(normal), j);
    const Vec<D> x = gather_vec<D>(values(op.position), j) - values(distance)[j] * n;
    return {static_cast<int>(values(surface)[j]), x, n};
  }
};

// The number of the condition at the surface point of each particle: 0 no surface point, -1 another body, 1 insulated, 2, 3, ... the
// conditions in their order. Once, before the first step.
// Where faces are equally near, as at the edges of a lattice, the normal points between them and to no point of the
// surface: such particles take that of one of the faces, from their nearest neighbour along it. They are told by the
// distance, which does not grow inwards as fast as the path. (Without surface points of their own the fit in 3D was
// unstable there.)
struct FindSurface : RowOperator {
  static constexpr double reach = 1.0;    // of a surface point from its particle, in spacings
  static constexpr double contact = 1.0;  // of a particle of another body from a surface point, in spacings

  In<Vector> position{"position"};
  In<Vector> normal{"normal"};
  In<Scalar> distance{"signed_distance"};
  Out<Vector> face{SurfacePoints::normal_field, unit("1"),
                   doc("Normal at the surface point of the particle.")};
  Out<Scalar> surface{"surface"};

  std::vector<Condition> conditions;
  Vector3 lower{}, upper{};  // of the domain where it is periodic, else infinite
  Names names;

  void set(const std::string& field) { surface.rename(names.keep(surface_of(field))); }

  template <int D>
  void run_chunk(const shoal_chunk& chunk) const {
    for (std::uint64_t i = chunk.begin; i < chunk.end; ++i)
      surface.data()[i] = number(Particle<D>{i, nullptr});
  }
  template <int D>
  void run_chunk_scalar(const shoal_chunk& chunk) const {
    run_chunk<D>(chunk);
  }

 private:
  template <int D>
  double number(Particle<D> i) const {
    face[i] = normal[i];
    if (distance[i] < -reach * spacing() * (1.0 + 1e-9)) return 0.0;
    if (between_faces(i) && !take_face_of_neighbour(i)) return 0.0;
    const Vec<D> x = position[i] - distance[i] * face[i];
    const double slack = 1e-6 * spacing();
    for (int a = 0; a < D; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      if (x[a] < lower[axis] + slack || x[a] > upper[axis] - slack) return 0.0;
    }
    if (touches_another(i, x)) return SurfacePoints::interface;
    for (std::size_t c = 0; c < conditions.size(); ++c)
      if (!conditions[c].where || conditions[c].where(D, x.e, 0.0) != 0.0) return static_cast<double>(c + 2);
    return 1.0;
  }

  // The neighbour straight inwards is deeper by 1/sqrt(2) (edges) or 1/sqrt(3) (corners) of its distance where faces
  // meet at right angles, by all of it where the normal is that of a face.
  template <int D>
  bool between_faces(Particle<D> i) const {
    double best = 0.9, depth_per_path = 1.0;
    for (std::uint32_t m = 0; m < neighbours(0).counts[i.index]; ++m) {
      const std::uint32_t j = neighbours(0).indices[neighbours(0).offsets[i.index] + m];
      const Vec<D> inwards = position[i] - gather_vec<D>(position.of_neighbours(0), j);
      const double r = norm(inwards), cosine = dot(inwards, normal[i]) / r;
      if (r > 1.9 * spacing() || cosine <= best) continue;
      best = cosine;
      depth_per_path = (distance[i] - distance.of_neighbours(0)[j]) / r;
    }
    return depth_per_path > 0.5 && depth_per_path < 0.85;
  }

  // The normal of the nearest neighbour that is as deep as the particle and looks to one of its faces.
  template <int D>
  bool take_face_of_neighbour(Particle<D> i) const {
    double nearest = HUGE_VAL;
    for (std::uint32_t m = 0; m < neighbours(0).counts[i.index]; ++m) {
      const std::uint32_t j = neighbours(0).indices[neighbours(0).offsets[i.index] + m];
      const Vec<D> n = gather_vec<D>(normal.of_neighbours(0), j);
      const double r = norm(position[i] - gather_vec<D>(position.of_neighbours(0), j));
      const double between =
          dot(n, normal[i]);  // 1 along the edge, less where the neighbour has a face of its own
      if (r >= nearest || between > 0.9 || between < 0.3) continue;
      if (std::abs(distance.of_neighbours(0)[j] - distance[i]) > 0.01 * spacing()) continue;
      nearest = r;
      face[i] = n;
    }
    return nearest < HUGE_VAL;
  }

  template <int D>
  bool touches_another(Particle<D> i, const Vec<D>& x) const {
    for (std::size_t k = 1; k < n_relations(); ++k)
      for (std::uint32_t m = 0; m < neighbours(k).counts[i.index]; ++m) {
        const std::uint32_t j = neighbours(k).indices[neighbours(k).offsets[i.index] + m];
        if (norm(gather_vec<D>(position.of_neighbours(k), j) - x) < contact * spacing()) return true;
      }
    return false;
  }
};

// The data g at the surface points, at the time of the stage.
struct SurfaceData : ParticleOperator<SurfaceData> {
  In<Vector> position{"position"};
  In<Vector> normal{SurfacePoints::normal_field, unit("1")};
  In<Scalar> distance{"signed_distance"};
  In<Scalar> surface{"surface"};
  Out<Scalar> data{"data", derived};

  std::vector<Condition> conditions;
  std::shared_ptr<const Stages> stages;
  Names names;

  void set(const std::string& field) {
    surface.rename(names.keep(surface_of(field)));
    data.rename(names.keep(surface_data_of(field)));
  }
  void begin() { stage_time_ = stages->time_of(step()); }
  void block(std::uint64_t begin, std::uint64_t end) const {
    std::fill(data.data() + begin, data.data() + end, 0.0);
    for (std::size_t c = 0; c < conditions.size(); ++c) fill(begin, end, c);
  }

 private:
  void fill(std::uint64_t begin, std::uint64_t end, std::size_t c) const {
    const auto d = static_cast<std::uint64_t>(dimensions());
    std::vector<double> points, values;
    std::vector<std::uint64_t> who;
    for (std::uint64_t i = begin; i < end; ++i) {
      if (surface.data()[i] != static_cast<double>(c + 2)) continue;
      who.push_back(i);
      for (std::uint64_t a = 0; a < d; ++a)
        points.push_back(position.data()[i * d + a] - distance.data()[i] * normal.data()[i * d + a]);
    }
    if (who.empty()) return;
    values.resize(who.size());
    conditions[c].data.evaluate(dimensions(), who.size(), points.data(), stage_time_, values.data());
    for (std::size_t k = 0; k < who.size(); ++k) data.data()[who[k]] = conditions[c].data_factor * values[k];
  }

  double stage_time_ = 0;
};

// Adds sum_b l_ib (g_b - A_b c_i) to the rate of c.
struct ApplySurface : RowOperator {
  In<Scalar> value{"value", own_only};
  In<Scalar> data{"data"};
  Accumulate<Scalar> rate{"rate", derived};

  std::shared_ptr<const Stencil> stencil;
  Names names;

  void set(const std::string& field, std::shared_ptr<const Stencil> weights) {
    value.rename(names.keep(field));
    data.rename(names.keep(surface_data_of(field)));
    rate.rename(names.keep(rate_of(field)));
    stencil = std::move(weights);
  }

  template <int D>
  void run_chunk(const shoal_chunk& chunk) const {
    for (const SurfaceWeight& w : stencil->surface[chunk.number]) {
      const double g =
          w.relation < 0 ? data.data()[w.j] : data.of_neighbours(static_cast<std::size_t>(w.relation))[w.j];
      rate.data()[w.i] += w.per_data * g - w.per_value * value.data()[w.i];
    }
  }
  template <int D>
  void run_chunk_scalar(const shoal_chunk& chunk) const {
    run_chunk<D>(chunk);
  }
};

}  // namespace shoal::diffusion
