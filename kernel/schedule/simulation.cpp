// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Building, initialising and driving a run.
#include "kernel/schedule/simulation.hpp"

#include <tbb/info.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kernel/schedule/resolve.hpp"
#include "kernel/schedule/simulation_implementation.hpp"

namespace shoal::kernel {

namespace {

int threads_of(int wanted) { return wanted > 0 ? wanted : tbb::task_arena::automatic; }

}  // namespace

Simulation::Implementation::Implementation(const SimulationSettings& what)
    : settings(what),
      neighbourhood(domain, bodies, what.poison),
      executor(neighbourhood, what.dimensions, what.failures, what.poison),
      stepper(schedule, executor, neighbourhood, health, what.dimensions),
      arena(threads_of(what.threads)) {
  if (what.threads > tbb::info::default_concurrency())
    more_threads.emplace(tbb::global_control::max_allowed_parallelism,
                         static_cast<std::size_t>(what.threads));
  if (what.take_finish != nullptr) what.take_finish();  // nobody of this run has spoken yet
  make_domain();
  if (what.sort_interval > 0) neighbourhood.set_sort_interval(what.sort_interval);
}

void Simulation::Implementation::make_domain() {
  if (settings.dimensions < 2 || settings.dimensions > 3)
    throw ModelError("a run has 2 or 3 dimensions, not " + std::to_string(settings.dimensions));
  domain.dimensions = settings.dimensions;
  for (int axis = 0; axis < settings.dimensions; ++axis) {
    const std::string name(1, "xyz"[axis]);
    const AxisBoundary& boundary = settings.boundaries[axis];
    if ((boundary.lower == BoundaryKind::periodic) != (boundary.upper == BoundaryKind::periodic))
      throw ModelError("the domain is periodic at one face of axis " + name + " only; it must be at both");
    if (boundary.lower != BoundaryKind::open && !settings.lower[axis])
      throw ModelError("the domain's lower face along " + name + " is not open, so it needs a place");
    if (boundary.upper != BoundaryKind::open && !settings.upper[axis])
      throw ModelError("the domain's upper face along " + name + " is not open, so it needs a place");
    domain.boundary[axis] = boundary;
    if (settings.lower[axis]) domain.lower[axis] = *settings.lower[axis];
    if (settings.upper[axis]) domain.upper[axis] = *settings.upper[axis];
    if (!(domain.lower[axis] < domain.upper[axis]))
      throw ModelError("the domain's lower face along " + name + " is not below its upper face");
  }
}

void Simulation::Implementation::need(Phase wanted, const char* what) const {
  if (phase != wanted)
    throw std::logic_error(std::string("Simulation::") + what + " is called at the wrong time");
}

std::uint32_t Simulation::Implementation::add_body(BodySpecification specification) {
  need(Phase::bodies, "add_body");
  const std::string quoted = "body '" + specification.name + "'";
  for (const auto& body : bodies)
    if (body->name() == specification.name)
      throw ModelError("there are two bodies '" + specification.name + "'", specification.place);
  const auto d = static_cast<std::size_t>(settings.dimensions);
  if (specification.positions.size() % d != 0) throw std::logic_error(quoted + " has an incomplete position");
  const std::uint64_t n = specification.positions.size() / d;
  if (!specification.volumes.empty() && specification.volumes.size() != n)
    throw std::logic_error(quoted + " has not as many volumes as particles");
  const auto index = static_cast<std::uint32_t>(bodies.size());
  auto body = std::make_unique<Body>(specification.name, index, settings.dimensions);
  body->spacing = specification.spacing;
  body->smoothing_length = specification.smoothing_length;
  body->cutoff = specification.cutoff;
  body->smoothing_kernel = specification.smoothing_kernel;
  body->material = specification.material;
  body->resize(n);
  std::copy(specification.positions.begin(), specification.positions.end(), body->position().reals());
  specification.positions = {};
  bodies.push_back(std::move(body));
  specifications.push_back(std::move(specification));
  return index;
}

Builder& Simulation::Implementation::the_builder() {
  if (builder == nullptr) {
    need(Phase::bodies, "builder");
    builder = std::make_unique<Builder>(settings, domain, bodies, declarations);
    phase = Phase::building;
  }
  return *builder;
}

void Simulation::Implementation::finalise() {
  the_builder();
  need(Phase::building, "finalise");
  on_threads([&] {
    schedule = resolve(declarations, bodies, neighbourhood, settings.time_step_factors);
    declare_initial_fields();
    declare_reference_positions();
    health.watch(domain, bodies);
    for (const GuardDeclaration& guard : declarations.guards) {
      Field* field = bodies[guard.body]->find(guard.field);
      if (field == nullptr) continue;
      if (field->specification().data_type != SHOAL_DOUBLE)
        throw ModelError(guard.declarer + " guards field '" + guard.field + "', which holds integers");
      health.guard(*bodies[guard.body], *field, guard.minimum, guard.maximum);
    }
  });
  executor.fill_initial = [this](Body& body, std::uint64_t begin, std::uint64_t end,
                                 const std::vector<Field*>& written) {
    set_initial_fields(body, begin, end, written);
  };
  phase = Phase::finalised;
}

void Simulation::Implementation::declare_initial_fields() {
  for (std::uint32_t b = 0; b < bodies.size(); ++b) {
    for (const InitialField& initial : specifications[b].initial_fields) {
      const Field* field = bodies[b]->find(initial.name);
      if (field == nullptr && initial.only_if_declared) continue;
      if (field == nullptr) {
        std::vector<std::string> names;
        for (const auto& candidate : bodies[b]->fields()) names.push_back(candidate->name());
        throw ModelError("body '" + bodies[b]->name() + "' has no field '" + initial.name +
                             "' that could be given a value; its fields: " + quoted_list(names),
                         initial.place);
      }
      const FieldSpecification& known = field->specification();
      if (known.rank != initial.rank || known.data_type != SHOAL_DOUBLE)
        throw ModelError("field '" + initial.name + "' of body '" + bodies[b]->name() + "' is a " +
                             name_of(known.data_type) + " " + name_of(known.rank) + ", but is given a real " +
                             name_of(initial.rank),
                         initial.place);
    }
  }
}

void Simulation::Implementation::declare_reference_positions() {
  const std::string declarer = "neighbours in the reference configuration";
  for (const auto& body : bodies)
    if (neighbourhood.in_reference_relation(body->index()))
      body->declare(
          specify("reference_position", SHOAL_RANK_VECTOR, SHOAL_DOUBLE, nullptr, nullptr, declarer),
          declarer);
}

void Simulation::Implementation::set_initial_fields(Body& body, std::uint64_t begin, std::uint64_t end,
                                                    const std::vector<Field*>& except) const {
  const auto d = static_cast<std::uint64_t>(body.dimensions());
  const double* position = body.position().reals() + begin * d;
  if (Field* reference = body.find("reference_position"))
    std::copy(position, position + (end - begin) * d, reference->reals() + begin * d);
  for (const InitialField& initial : specifications[body.index()].initial_fields) {
    Field* field = body.find(initial.name);
    if (field == nullptr || std::find(except.begin(), except.end(), field) != except.end()) continue;
    initial.evaluate(end - begin, position, field->reals() + begin * field->components());
  }
}

void Simulation::Implementation::set_initial_values() {
  for (std::uint32_t b = 0; b < bodies.size(); ++b) {
    Body& body = *bodies[b];
    const std::uint64_t n = body.n_owned();
    if (Field* volume = body.find("volume")) {
      const std::vector<double>& given = specifications[b].volumes;
      if (given.empty())
        std::fill(volume->reals(), volume->reals() + n, std::pow(body.spacing, settings.dimensions));
      else
        std::copy(given.begin(), given.end(), volume->reals());
    }
    set_initial_fields(body, 0, n, {});
    specifications[b].volumes = {};
  }
}

void Simulation::Implementation::initialise() {
  need(Phase::finalised, "initialise");
  on_threads([&] {
    set_initial_values();
    try {
      stepper.renew();
    } catch (const PhysicsFailure& failure) {
      throw ModelError(std::string("before the first step: ") + failure.what());
    }
    stepper.run_outside(schedule.initial);
    stepper.check_health();
    stepper.start_timing();
  });
  renewal_ticks_before_steps = stepper.renewal_ticks;
  phase = Phase::running;
}

// -- the interface ------------------------------------------------------------------------------------------------

Simulation::Simulation(const SimulationSettings& settings)
    : implementation_(std::make_unique<Implementation>(settings)) {}
Simulation::~Simulation() = default;

std::uint32_t Simulation::add_body(BodySpecification specification) {
  return implementation_->add_body(std::move(specification));
}

void Simulation::set_material_interface_lookup(MaterialInterfaceLookup lookup) {
  implementation_->the_builder().set_material_interface_lookup(std::move(lookup));
}

const shoal_builder* Simulation::builder() { return implementation_->the_builder().c(); }

void Simulation::set_declarer(std::string text) {
  implementation_->the_builder().set_declarer(std::move(text));
}

const std::string& Simulation::builder_failure() const { return implementation_->the_builder().failure(); }

void Simulation::demand_field(std::string_view body, std::string_view field, std::string place) {
  const auto index = find_body(body);
  if (!index) {
    std::vector<std::string> names;
    for (const auto& known : implementation_->bodies) names.push_back(known->name());
    throw ModelError("there is no body '" + std::string(body) + "'; bodies: " + quoted_list(names), place);
  }
  implementation_->declarations.demands.push_back({*index, std::string(field), std::move(place)});
}

bool Simulation::is_declared(std::string_view body, std::string_view field) const {
  const std::optional<std::uint32_t> index = find_body(body);
  if (!index) return false;
  if (implementation_->bodies[*index]->find(field) != nullptr) return true;
  const auto names_it = [&](const Attachment& attachment, const Access& access) {
    if (access.field != field || access.has(SHOAL_OPTIONAL)) return false;
    if (attachment.on_demand() && !access.changes()) return false;
    if (!access.has(SHOAL_NOT_OWN) && attachment.body() == *index) return true;
    return access.has(SHOAL_OF_NEIGHBOURS) &&
           std::any_of(attachment.relations.begin(), attachment.relations.end(),
                       [&](const shoal_relation_request& relation) { return relation.body == *index; });
  };
  const std::vector<Attachment>& all = implementation_->declarations.attachments;
  return std::any_of(all.begin(), all.end(), [&](const Attachment& attachment) {
    return std::any_of(attachment.accesses.begin(), attachment.accesses.end(),
                       [&](const Access& access) { return names_it(attachment, access); });
  });
}

void Simulation::finalise() { implementation_->finalise(); }
void Simulation::initialise() { implementation_->initialise(); }

void Simulation::step(double no_later_than) {
  implementation_->need(Implementation::Phase::running, "step");
  implementation_->on_threads([&] {
    const double end = implementation_->settings.end_time;
    implementation_->stepper.step(std::min(end, no_later_than), end);
  });
  if (implementation_->settings.take_finish != nullptr)
    if (std::string reason = implementation_->settings.take_finish(); !reason.empty())
      implementation_->finish_reason = std::move(reason);
}

void Simulation::sample() {
  implementation_->need(Implementation::Phase::running, "sample");
  implementation_->on_threads(
      [&] { implementation_->stepper.run_outside(implementation_->schedule.sample); });
}

bool Simulation::finished() const { return !finish_reason().empty() || !(time() < end_time()); }
const std::string& Simulation::finish_reason() const { return implementation_->finish_reason; }
void Simulation::set_finish_reason(std::string reason) { implementation_->finish_reason = std::move(reason); }
double Simulation::time() const { return implementation_->stepper.time; }
double Simulation::end_time() const { return implementation_->settings.end_time; }
void Simulation::set_end_time(double end_time) { implementation_->settings.end_time = end_time; }
std::uint64_t Simulation::outer_steps() const { return implementation_->stepper.outer_steps; }
double Simulation::last_outer_dt() const { return implementation_->stepper.last_dt; }

namespace {

void add_names(const LoopRun& loop, std::vector<std::string>& names) {
  names.push_back(loop.name);
  for (const StageRun& stage : loop.stages)
    for (const LoopRun* child : stage.loops) add_names(*child, names);
}

const LoopRun& loop_of(const Schedule& schedule, std::string_view name) {
  const LoopRun* loop = schedule.find_loop(name);
  if (loop == nullptr) throw std::logic_error("there is no loop '" + std::string(name) + "'");
  return *loop;
}

}  // namespace

std::vector<std::string> Simulation::loop_names() const {
  std::vector<std::string> names;
  for (const LoopRun* loop : implementation_->schedule.top) add_names(*loop, names);
  return names;
}

std::uint64_t Simulation::loop_steps(std::string_view loop) const {
  return loop_of(implementation_->schedule, loop).steps;
}
double Simulation::last_dt(std::string_view loop) const {
  return loop_of(implementation_->schedule, loop).last_dt;
}

int Simulation::dimensions() const { return implementation_->settings.dimensions; }
std::uint32_t Simulation::n_bodies() const {
  return static_cast<std::uint32_t>(implementation_->bodies.size());
}
const std::string& Simulation::body_name(std::uint32_t body) const {
  return implementation_->bodies.at(body)->name();
}

std::optional<std::uint32_t> Simulation::find_body(std::string_view name) const {
  for (const auto& body : implementation_->bodies)
    if (body->name() == name) return body->index();
  return std::nullopt;
}

std::uint64_t Simulation::n_particles(std::uint32_t body) const {
  return implementation_->bodies.at(body)->n_owned();
}

std::uint64_t Simulation::n_particles() const {
  std::uint64_t sum = 0;
  for (const auto& body : implementation_->bodies) sum += body->n_owned();
  return sum;
}

const std::int64_t* Simulation::ids(std::uint32_t body) const {
  return implementation_->bodies.at(body)->ids().integers();
}

namespace {

FieldInfo info_of(const Field& field) {
  const FieldSpecification& known = field.specification();
  return {known.name, known.unit, known.doc, known.rank, known.data_type, field.components()};
}

}  // namespace

std::vector<FieldInfo> Simulation::fields(std::uint32_t body) const {
  std::vector<FieldInfo> list;
  for (const auto& field : implementation_->bodies.at(body)->fields()) list.push_back(info_of(*field));
  return list;
}

std::optional<FieldInfo> Simulation::field_info(std::uint32_t body, std::string_view field) const {
  const Field* found = implementation_->bodies.at(body)->find(field);
  if (found == nullptr) return std::nullopt;
  return info_of(*found);
}

shoal_field Simulation::field(std::uint32_t body, std::string_view name) const {
  Body& of = *implementation_->bodies.at(body);
  shoal_field view{};
  view.size = sizeof view;
  view.n_owned = of.n_owned();
  view.n_total = of.n_total();
  if (Field* found = of.find(name)) {
    view.components = found->components();
    view.data = found->data();
  }
  return view;
}

Plan Simulation::plan() const { return implementation_->plan(); }
Timings Simulation::timings() const { return implementation_->timings(); }

std::uint64_t Simulation::memory(std::uint32_t body) const {
  return implementation_->bodies.at(body)->bytes() + implementation_->neighbourhood.bytes(body);
}

void Simulation::save(std::ostream& stream) { implementation_->save(stream); }

void Simulation::load(std::istream& stream) {
  implementation_->on_threads([&] { implementation_->load(stream); });
}

}  // namespace shoal::kernel
