// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Names become pointers, on-demand operators that nobody needs are left out, fields and relations come into being.
#include "kernel/schedule/resolve.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "kernel/particles/errors.hpp"

namespace shoal::kernel {

std::string quoted_list(const std::vector<std::string>& words) {
  if (words.empty()) return "none";
  std::string text;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (k > 0) text += k + 1 == words.size() ? " and " : ", ";
    text += "'" + words[k] + "'";
  }
  return text;
}

namespace {

class Resolver {
 public:
  Resolver(Declarations& declarations, std::vector<std::unique_ptr<Body>>& bodies,
           Neighbourhood& neighbourhood, const std::map<std::string, double>& factors)
      : declarations_(declarations), bodies_(bodies), neighbourhood_(neighbourhood), factors_(factors) {}

  Schedule resolve() {
    make_loops();
    nest_loops();
    place_renewals();
    apply_factors();
    place_attachments();
    prune();
    declare_fields();
    place_clears();
    for (const auto& op : schedule_.operators) connect(*op);
    collect_exchanges();
    return std::move(schedule_);
  }

 private:
  using FieldName = std::pair<std::uint32_t, std::string>;

  std::vector<std::string> loop_names() const {
    std::vector<std::string> names;
    for (const auto& loop : schedule_.loops) names.push_back(loop->name);
    return names;
  }

  LoopRun& loop_of(const std::string& name, const std::string& who) const {
    LoopRun* loop = schedule_.find_loop(name);
    if (loop == nullptr)
      throw ModelError(who + " names loop '" + name +
                       "', which nobody declares; loops of this run: " + quoted_list(loop_names()));
    return *loop;
  }

  // The stage that a loop and a stage name mean, or one of the two outside the loops.
  StageRun& stage_of(const std::string& loop, const std::string& stage, const std::string& who) {
    if (loop == SHOAL_INITIAL) return schedule_.initial;
    if (loop == SHOAL_SAMPLE) return schedule_.sample;
    LoopRun& run = loop_of(loop, who);
    std::vector<std::string> names;
    for (StageRun& candidate : run.stages) {
      if (candidate.name == stage) return candidate;
      names.push_back(candidate.name);
    }
    throw ModelError(who + " names stage '" + stage + "' of loop '" + loop +
                     "', which has none of that name; its " + "stages: " + quoted_list(names));
  }

  void make_loops() {
    schedule_.initial.name = SHOAL_INITIAL;
    schedule_.sample.name = SHOAL_SAMPLE;
    for (const LoopDeclaration& declaration : declarations_.loops) {
      auto loop = std::make_unique<LoopRun>();
      loop->name = declaration.name;
      for (const std::string& stage : declaration.stages) {
        loop->stages.emplace_back();
        loop->stages.back().name = stage;
      }
      schedule_.loops.push_back(std::move(loop));
    }
  }

  void nest_loops() {
    for (std::size_t k = 0; k < declarations_.loops.size(); ++k) {
      const LoopDeclaration& declaration = declarations_.loops[k];
      LoopRun& loop = *schedule_.loops[k];
      if (declaration.parent.empty()) {
        schedule_.top.push_back(&loop);
        continue;
      }
      const std::string who = "loop '" + loop.name + "' (" + declaration.parent_declarer + ")";
      if (declaration.parent == SHOAL_INITIAL || declaration.parent == SHOAL_SAMPLE)
        throw ModelError(who + " cannot be inside '" + declaration.parent + "', which is outside the loops");
      loop.parent = &loop_of(declaration.parent, who);
      stage_of(declaration.parent, declaration.parent_stage, who).loops.push_back(&loop);
    }
    for (const auto& loop : schedule_.loops) {
      const LoopRun* ancestor = loop.get();
      for (std::size_t depth = 0; ancestor != nullptr; ++depth, ancestor = ancestor->parent)
        if (depth > schedule_.loops.size())
          throw ModelError("loop '" + loop->name +
                           "' is inside itself; loops of this run: " + quoted_list(loop_names()));
    }
  }

  static bool is_inside(const LoopRun* loop, const LoopRun* ancestor) {
    for (; loop != nullptr; loop = loop->parent)
      if (loop == ancestor) return true;
    return false;
  }

  // Lists are renewed in one place: the loop that holds all that were named, or else the outer step.
  void place_renewals() {
    LoopRun* place = nullptr;
    bool apart = false;
    for (const Renewal& renewal : declarations_.renewals) {
      LoopRun* loop = &loop_of(renewal.loop, renewal.declarer + " (renewal of neighbours)");
      if (place == nullptr) place = loop;
      while (place != nullptr && !is_inside(loop, place)) place = place->parent;
      apart = apart || place == nullptr;
      if (apart) break;
    }
    if (place != nullptr && !apart && !(place->parent == nullptr && schedule_.top.size() == 1)) {
      place->renews_neighbours = true;
    } else {
      // A lone loop at the top makes one step per outer step.
      schedule_.renews_in_outer_step = true;
      schedule_.outer_renewal = apart              ? "loops side by side renew their neighbours together"
                                : place != nullptr ? "loop '" + place->name + "' is the outer step"
                                                   : "no loop asked for it";
    }
  }

  void apply_factors() {
    for (const auto& [name, factor] : factors_) {
      if (!(factor > 0.0) || !std::isfinite(factor))
        throw ModelError("the time step factor of loop '" + name + "' is " + std::to_string(factor) +
                         "; it must be positive");
      loop_of(name, "the time step factor").factor = factor;
    }
  }

  std::string who(const Attachment& attachment) const {
    return "operator " + attachment.name + " on body '" + bodies_[attachment.body()]->name() + "'";
  }

  // An operator without a place goes where the field that it adds to is owned.
  void find_place(Attachment& attachment) const {
    if (!attachment.loop.empty()) return;
    const FieldOwner* place = nullptr;
    const Access* first = nullptr;
    for (const Access& access : attachment.accesses) {
      if (!access.has(SHOAL_ACCUMULATE)) continue;
      const FieldOwner* owner = declarations_.find_owner(attachment.body(), access.field);
      if (owner == nullptr) continue;
      if (place != nullptr && (owner->loop != place->loop || owner->stage != place->stage))
        throw ModelError(who(attachment) + " adds to '" + first->field + "', owned in " + place->loop + "." +
                         place->stage + ", and to '" + access.field + "', owned in " + owner->loop + "." +
                         owner->stage + "; say in which stage it is to run");
      place = owner;
      if (first == nullptr) first = &access;
    }
    if (place == nullptr) {
      std::vector<std::string> owned;
      for (const FieldOwner& owner : declarations_.owners)
        if (owner.body == attachment.body()) owned.push_back(owner.field);
      throw ModelError(who(attachment) +
                       " names no stage and adds to no field that anybody owns there; owned fields "
                       "of that body: " +
                       quoted_list(owned));
    }
    attachment.loop = place->loop;
    attachment.stage = place->stage;
  }

  void place_attachments() {
    for (Attachment& attachment : declarations_.attachments) {
      find_place(attachment);
      stage_of(attachment.loop, attachment.stage, who(attachment));
      for (const Access& access : attachment.accesses)
        if (access.has(SHOAL_ACCUMULATE) &&
            declarations_.find_owner(attachment.body(), access.field) == nullptr)
          throw ModelError(who(attachment) + " adds to field '" + access.field +
                           "', which nobody owns and clears on that body");
      check_race(attachment);
    }
  }

  // What one particle writes while its neighbour reads it depends on who comes first.
  void check_race(const Attachment& attachment) const {
    if ((attachment.op.c().flags & SHOAL_OPERATOR_SERIAL) != 0) return;
    const bool looks_at_itself = std::any_of(
        attachment.relations.begin(), attachment.relations.end(),
        [&](const shoal_relation_request& relation) { return relation.body == attachment.body(); });
    if (!looks_at_itself) return;
    for (const Access& read : attachment.accesses)
      for (const Access& write : attachment.accesses)
        if (read.has(SHOAL_OF_NEIGHBOURS) && write.changes() && read.field == write.field)
          throw ModelError(
              who(attachment) + " changes field '" + read.field +
              "' while it reads it of neighbours in the same body; write to a field of its own and let "
              "another operator move the values");
  }

  template <class Function>
  void for_each_field(const Attachment& attachment, const Access& access, const Function& function) const {
    if (!access.has(SHOAL_NOT_OWN)) function(attachment.body());
    if (!access.has(SHOAL_OF_NEIGHBOURS)) return;
    for (const shoal_relation_request& relation : attachment.relations) function(relation.body);
  }

  // On-demand operators run only if something that runs, an output or a probe reads what they write.
  void prune() {
    std::set<FieldName> needed;
    for (const Demand& demand : declarations_.demands) needed.insert({demand.body, demand.field});
    std::vector<Attachment>& attachments = declarations_.attachments;
    std::vector<bool> scheduled(attachments.size(), false);
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t k = 0; k < attachments.size(); ++k) {
        if (scheduled[k] || !is_needed(attachments[k], needed)) continue;
        scheduled[k] = changed = true;
        for (const Access& access : attachments[k].accesses)
          if (access.has(SHOAL_READ) && !access.has(SHOAL_OPTIONAL))
            for_each_field(attachments[k], access, [&](std::uint32_t body) {
              needed.insert({body, access.field});
            });
      }
    }
    for (std::size_t k = 0; k < attachments.size(); ++k) {
      if (scheduled[k])
        schedule_.operators.push_back(std::make_unique<OperatorRun>(std::move(attachments[k])));
      else
        unscheduled_.push_back(std::move(attachments[k]));
    }
    declarations_.attachments.clear();
    for (const Attachment& attachment : unscheduled_)
      schedule_.unscheduled.push_back(attachment.name + " on " + bodies_[attachment.body()]->name());
  }

  static bool is_needed(const Attachment& attachment, const std::set<FieldName>& needed) {
    if (!attachment.on_demand()) return true;
    return std::any_of(attachment.accesses.begin(), attachment.accesses.end(), [&](const Access& access) {
      return access.changes() && needed.count({attachment.body(), access.field}) > 0;
    });
  }

  void declare(const Attachment& attachment, const Access& access, bool optional_ones) {
    const FieldSpecification specification = specify(access.field, access.rank, access.data_type, access.unit,
                                                     access.doc, attachment.name, access.array_components);
    for_each_field(attachment, access, [&](std::uint32_t body) {
      // An optional field does not come into being, but must fit the one that is there.
      if (optional_ones && bodies_[body]->find(access.field) == nullptr) return;
      bodies_[body]->declare(specification, attachment.name);
    });
  }

  void declare_fields() {
    for (const bool optional_ones : {false, true})
      for (const auto& op : schedule_.operators)
        for (const Access& access : op->attachment.accesses)
          if (access.has(SHOAL_OPTIONAL) == optional_ones) declare(op->attachment, access, optional_ones);
    mark_derived();
    for (const Demand& demand : declarations_.demands) {
      if (bodies_[demand.body]->find(demand.field) != nullptr) continue;
      std::vector<std::string> names;
      for (const auto& field : bodies_[demand.body]->fields()) names.push_back(field->name());
      for (const Attachment& attachment : unscheduled_)
        for (const Access& access : attachment.accesses)
          if (attachment.body() == demand.body && access.changes()) names.push_back(access.field);
      std::sort(names.begin(), names.end());
      names.erase(std::unique(names.begin(), names.end()), names.end());
      throw ModelError("body '" + bodies_[demand.body]->name() + "' has no field '" + demand.field +
                           "'; its fields: " + quoted_list(names),
                       demand.place);
    }
  }

  // A field is derived if an operator that changes it says so and none that overwrites it says otherwise.
  void mark_derived() {
    std::set<const Field*> state;
    std::set<Field*> derived;
    for (const auto& op : schedule_.operators)
      for (const Access& access : op->attachment.accesses) {
        Field* field = access.changes() ? bodies_[op->attachment.body()]->find(access.field) : nullptr;
        if (field == nullptr) continue;
        if (access.has(SHOAL_DERIVED))
          derived.insert(field);
        else if (access.has(SHOAL_WRITE))
          state.insert(field);
      }
    for (Field* field : derived) field->derived = state.count(field) == 0;
  }

  void place_clears() {
    for (const FieldOwner& owner : declarations_.owners) {
      const std::string owner_text = "the owner of field '" + owner.field + "' of body '" +
                                     bodies_[owner.body]->name() + "' (" + owner.declarer + ")";
      StageRun& stage = stage_of(owner.loop, owner.stage, owner_text);
      Field* field = bodies_[owner.body]->find(owner.field);
      if (field != nullptr) stage.clears.push_back({bodies_[owner.body].get(), field});
    }
  }

  void connect(OperatorRun& op) {
    const Attachment& attachment = op.attachment;
    op.loop = attachment.loop;
    op.stage = attachment.stage;
    op.body = bodies_[attachment.body()].get();
    for (const shoal_relation_request& relation : attachment.relations)
      op.relations.push_back(neighbourhood_.request(attachment.body(), relation));
    for (const Access& access : attachment.accesses) {
      Field* own = access.has(SHOAL_NOT_OWN) ? nullptr : op.body->find(access.field);
      op.own_fields.push_back(own);
      if (own == nullptr || !access.changes()) continue;
      if (std::find(op.written.begin(), op.written.end(), own) == op.written.end()) op.written.push_back(own);
      op.moves_particles = op.moves_particles || own == &op.body->position();
    }
    for (const shoal_relation_request& relation : attachment.relations)
      for (const Access& access : attachment.accesses) {
        Body& other = *bodies_[relation.body];
        Field* field = access.has(SHOAL_OF_NEIGHBOURS) ? other.find(access.field) : nullptr;
        op.fields_of_neighbours.push_back(field);
        if (field == nullptr) continue;
        field->halo_needed = true;
        const bool known = std::any_of(op.images.begin(), op.images.end(),
                                       [&](const BodyField& image) { return image.field == field; });
        if (!known) op.images.push_back({&other, field});
      }
    op.results.resize(attachment.reductions.size());
    stage_of(op.loop, op.stage, attachment.name).operators.push_back(&op);
    LoopRun* loop = schedule_.find_loop(op.loop);
    if (loop != nullptr && op.c().time_step != nullptr) loop->limiters.push_back(&op);
  }

  void collect_exchanges() {
    for (const auto& op : schedule_.operators) {
      if (op->c().exchange == nullptr) continue;
      if (neighbourhood_.in_reference_relation(op->body->index()))
        throw ModelError(who(op->attachment) +
                         " lets particles join or leave, but neighbours of that body are found once for the "
                         "whole run, in the reference configuration; it cannot have both");
      schedule_.exchanges.push_back(op.get());
    }
  }

  Declarations& declarations_;
  std::vector<std::unique_ptr<Body>>& bodies_;
  Neighbourhood& neighbourhood_;
  const std::map<std::string, double>& factors_;
  std::vector<Attachment> unscheduled_;
  Schedule schedule_;
};

}  // namespace

Schedule resolve(Declarations& declarations, std::vector<std::unique_ptr<Body>>& bodies,
                 Neighbourhood& neighbourhood, const std::map<std::string, double>& time_step_factors) {
  return Resolver(declarations, bodies, neighbourhood, time_step_factors).resolve();
}

}  // namespace shoal::kernel
