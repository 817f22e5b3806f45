// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks what can be checked at once (indices, empty names, contradictions); names are resolved later.
#include "kernel/schedule/builder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/plugins/abi_reading.hpp"

namespace shoal::kernel {

template <class Call>
shoal_status Builder::guarded(const Call& call) {
  try {
    call();
    return SHOAL_OK;
  } catch (const ModelError& error) {
    failure_ = error.what();
    if (failures_.put != nullptr) failures_.put(failure_.c_str());
    return SHOAL_CASE_ERROR;
  } catch (const std::exception& error) {
    failure_ = error.what();
    if (failures_.put != nullptr) failures_.put(failure_.c_str());
    return SHOAL_ERROR;
  }
}

namespace {

// shoal_context is opaque to plugins: behind it stands the builder.
Builder& builder_of(shoal_context* context) { return *reinterpret_cast<Builder*>(context); }

shoal_status c_loop(shoal_context* context, const char* name, const char* parent, const char* parent_stage,
                    std::uint32_t n_stages, const char* const* stages) {
  Builder& builder = builder_of(context);
  return builder.guarded([&] { builder.loop(name, parent, parent_stage, n_stages, stages); });
}
shoal_status c_renew(shoal_context* context, const char* loop) {
  Builder& builder = builder_of(context);
  return builder.guarded([&] { builder.renew_neighbours_in(loop); });
}
shoal_status c_attach(shoal_context* context, const char* loop, const char* stage, const shoal_operator* op) {
  Builder& builder = builder_of(context);
  return builder.guarded([&] { builder.attach(loop, stage, op); });
}
shoal_status c_own(shoal_context* context, std::uint32_t body, const char* field, const char* loop,
                   const char* stage) {
  Builder& builder = builder_of(context);
  return builder.guarded([&] { builder.own_field(body, field, loop, stage); });
}
shoal_status c_guard(shoal_context* context, std::uint32_t body, const char* field, double minimum,
                     double maximum) {
  Builder& builder = builder_of(context);
  return builder.guarded([&] { builder.guard(body, field, minimum, maximum); });
}
shoal_status c_material(shoal_context* context, std::uint32_t body, const char* name, std::uint32_t revision,
                        const void** api, void** self) {
  Builder& builder = builder_of(context);
  return builder.guarded([&] { builder.material_interface(body, name, revision, api, self); });
}
shoal_status c_moves(shoal_context* context, std::uint32_t body, std::uint32_t moves) {
  Builder& builder = builder_of(context);
  return builder.guarded([&] { builder.body_moves(body, moves != 0); });
}
void c_note(shoal_context* context, const char* text) {
  Builder& builder = builder_of(context);
  builder.guarded([&] { builder.note(text); });
}

std::string text_of(const char* text, const char* what) {
  if (text == nullptr || *text == '\0') throw ModelError(std::string(what) + " has no name");
  return text;
}

}  // namespace

Builder::Builder(const SimulationSettings& settings, const Domain& domain,
                 const std::vector<std::unique_ptr<Body>>& bodies, Declarations& declarations)
    : bodies_(bodies), declarations_(declarations), failures_(settings.failures) {
  describe_bodies();
  c_.size = sizeof c_;
  c_.dimensions = settings.dimensions;
  c_.context = reinterpret_cast<shoal_context*>(this);
  c_.n_bodies = static_cast<std::uint32_t>(descriptions_.size());
  c_.bodies = descriptions_.data();
  c_.end_time = settings.end_time;
  for (int axis = 0; axis < 3; ++axis) {
    c_.gravity[axis] = axis < settings.dimensions ? settings.gravity[axis] : 0.0;
    c_.lower[axis] = domain.lower[axis];
    c_.upper[axis] = domain.upper[axis];
    c_.periodic[axis] = axis < settings.dimensions && domain.periodic(axis) ? 1 : 0;
  }
  c_.loop = c_loop;
  c_.renew_neighbours_in = c_renew;
  c_.attach = c_attach;
  c_.own_field = c_own;
  c_.guard = c_guard;
  c_.material_interface = c_material;
  c_.body_moves = c_moves;
  c_.note = c_note;
}

void Builder::describe_bodies() {
  for (const auto& body : bodies_) {
    shoal_body description{};
    description.size = sizeof description;
    description.index = body->index();
    description.name = body->name().c_str();
    description.n_particles = body->n_owned();
    description.spacing = body->spacing;
    description.smoothing_length = body->smoothing_length;
    description.cutoff = body->cutoff;
    description.smoothing_kernel = body->smoothing_kernel.c_str();
    description.material = body->material;
    const double* position = body->position().reals();
    const int d = body->dimensions();
    for (std::uint64_t i = 0; i < body->n_owned(); ++i)
      for (int axis = 0; axis < d; ++axis) {
        const double x = position[i * static_cast<std::uint64_t>(d) + static_cast<std::uint64_t>(axis)];
        description.lower[axis] = i == 0 ? x : std::min(description.lower[axis], x);
        description.upper[axis] = i == 0 ? x : std::max(description.upper[axis], x);
      }
    descriptions_.push_back(description);
  }
}

Body& Builder::body_of(std::uint32_t index, const char* what) const {
  if (index >= bodies_.size())
    throw ModelError(declarer_ + ": " + what + " names body " + std::to_string(index) +
                     ", but there are only " + std::to_string(bodies_.size()));
  return *bodies_[index];
}

namespace {

// New stages come behind the one that precedes them in the list; without one, before the first known one that
// follows; else at the end.
void merge_stages(std::vector<std::string>& known, const std::vector<std::string>& wanted) {
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    if (std::find(known.begin(), known.end(), wanted[k]) != known.end()) continue;
    auto place = known.end();
    if (k > 0) {
      place = std::find(known.begin(), known.end(), wanted[k - 1]) + 1;
    } else {
      for (const std::string& later : wanted) {
        const auto found = std::find(known.begin(), known.end(), later);
        if (found == known.end()) continue;
        place = found;
        break;
      }
    }
    known.insert(place, wanted[k]);
  }
}

}  // namespace

void Builder::loop(const char* name, const char* parent, const char* parent_stage, std::uint32_t n_stages,
                   const char* const* stages) {
  const std::string loop_name = text_of(name, "a loop");
  if (loop_name == SHOAL_INITIAL || loop_name == SHOAL_SAMPLE)
    throw ModelError(declarer_ + ": no loop can be called '" + loop_name +
                     "'; that is a stage outside the loops");
  std::vector<std::string> wanted;
  for (std::uint32_t k = 0; k < n_stages; ++k) wanted.push_back(text_of(stages[k], "a stage"));

  auto known = std::find_if(declarations_.loops.begin(), declarations_.loops.end(),
                            [&](const LoopDeclaration& candidate) { return candidate.name == loop_name; });
  if (known == declarations_.loops.end()) {
    declarations_.loops.push_back({loop_name, "", "", {}, declarer_, ""});
    known = declarations_.loops.end() - 1;
  }
  merge_stages(known->stages, wanted);
  if (parent == nullptr) return;
  const std::string parent_name = text_of(parent, "a parent loop");
  const std::string stage_name = text_of(parent_stage, "a stage of the parent loop");
  if (!known->parent.empty() && (known->parent != parent_name || known->parent_stage != stage_name))
    throw ModelError("loop '" + loop_name + "' is inside " + known->parent + "." + known->parent_stage +
                     " for " + known->parent_declarer + ", but inside " + parent_name + "." + stage_name +
                     " for " + declarer_);
  known->parent = parent_name;
  known->parent_stage = stage_name;
  known->parent_declarer = declarer_;
}

void Builder::renew_neighbours_in(const char* loop) {
  declarations_.renewals.push_back({text_of(loop, "the loop that renews neighbours"), declarer_});
}

void Builder::attach(const char* loop, const char* stage, const shoal_operator* op) {
  if (op == nullptr) throw ModelError(declarer_ + " attaches no operator");
  Attachment attachment{loop != nullptr ? loop : "",
                        stage != nullptr ? stage : "",
                        op->name != nullptr ? op->name : "",
                        declarer_,
                        OwnedOperator(abi_copy(op)),
                        {},
                        {},
                        {}};
  const shoal_operator& c = attachment.op.c();
  if (attachment.name.empty()) throw ModelError(declarer_ + " attaches an operator without a name");
  const std::string what = "operator " + attachment.name;
  body_of(c.body, what.c_str());
  if (c.run == nullptr) throw ModelError(what + " has nothing to run");
  for (std::uint32_t k = 0; k < c.n_accesses; ++k) {
    const shoal_access access = abi_copy(abi_element(c.accesses, k));
    Access& copy = attachment.accesses.emplace_back();
    copy.field = text_of(access.field, ("a field of " + what).c_str());
    copy.mode = access.mode;
    copy.rank = access.rank;
    copy.data_type = access.data_type;
    copy.unit = access.unit;
    copy.doc = access.doc;
    copy.array_components = access.components;
    if (!copy.has(SHOAL_READ | SHOAL_WRITE | SHOAL_ACCUMULATE))
      throw ModelError(what + " neither reads nor writes nor accumulates its field '" + copy.field + "'");
    if (copy.has(SHOAL_NOT_OWN) && (copy.changes() || !copy.has(SHOAL_OF_NEIGHBOURS)))
      throw ModelError(what + ": field '" + copy.field +
                       "' of neighbours alone can only be read of neighbours");
  }
  for (std::uint32_t k = 0; k < c.n_relations; ++k) {
    const shoal_relation_request relation = abi_copy(abi_element(c.relations, k));
    body_of(relation.body, ("a relation of " + what).c_str());
    if (!(relation.cutoff > 0.0) || !std::isfinite(relation.cutoff))
      throw ModelError(what + " asks for neighbours within " + std::to_string(relation.cutoff) +
                       " m; a cut-off is positive");
    if (relation.configuration > SHOAL_REFERENCE)
      throw ModelError(what + " asks for neighbours in an unknown configuration");
    attachment.relations.push_back(relation);
  }
  for (std::uint32_t k = 0; k < c.n_reductions; ++k) {
    if (c.reductions[k] > SHOAL_MAXIMUM) throw ModelError(what + " asks for an unknown reduction");
    attachment.reductions.push_back(c.reductions[k]);
  }
  declarations_.attachments.push_back(std::move(attachment));
}

void Builder::own_field(std::uint32_t body, const char* field, const char* loop, const char* stage) {
  const Body& owner_body = body_of(body, "own_field");
  FieldOwner owner{body, text_of(field, "an owned field"), text_of(loop, "the loop of an owned field"),
                   stage != nullptr ? stage : "", declarer_};
  if (const FieldOwner* known = declarations_.find_owner(body, owner.field)) {
    if (known->loop == owner.loop && known->stage == owner.stage) return;
    throw ModelError("field '" + owner.field + "' of body '" + owner_body.name() + "' is owned by " +
                     known->declarer + " in " + known->loop + "." + known->stage + ", and by " +
                     owner.declarer + " in " + owner.loop + "." + owner.stage +
                     "; only one of them can clear it");
  }
  declarations_.owners.push_back(std::move(owner));
}

void Builder::guard(std::uint32_t body, const char* field, double minimum, double maximum) {
  body_of(body, "guard");
  if (!(minimum <= maximum))
    throw ModelError(declarer_ + ": a guard from " + std::to_string(minimum) + " to " +
                     std::to_string(maximum) + " holds for nothing");
  declarations_.guards.push_back({body, text_of(field, "a guarded field"), minimum, maximum, declarer_});
}

void Builder::material_interface(std::uint32_t body, const char* name, std::uint32_t revision,
                                 const void** api, void** self) {
  const Body& of = body_of(body, "material_interface");
  *api = nullptr;
  *self = nullptr;
  if (of.material == nullptr) return;
  if (!lookup_) throw ModelError("materials cannot be looked up in this run");
  lookup_(of.material, text_of(name, "a material interface").c_str(), revision, api, self);
}

void Builder::body_moves(std::uint32_t body, bool moves) {
  body_of(body, "body_moves").sorted_as_it_moves = moves;
}

void Builder::note(const char* text) {
  if (text != nullptr) declarations_.notes.emplace_back(text);
}

}  // namespace shoal::kernel
