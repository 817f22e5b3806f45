// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What a checkpoint holds: time and counters, each body's particles with their ids and state fields, and what
// operators save of their own. Neighbour lists and images are found anew: they follow from the positions.
#include <algorithm>
#include <istream>
#include <ostream>

#include "kernel/schedule/block_file.hpp"
#include "kernel/schedule/resolve.hpp"
#include "kernel/schedule/simulation_implementation.hpp"

namespace shoal::kernel {

namespace {

std::string key_of(const OperatorRun& op) {
  return op.attachment.name + " on " + op.body->name() + " in " + op.loop + "." + op.stage;
}

shoal_status write_bytes(void* context, const void* data, std::uint64_t bytes) {
  static_cast<BlockBuffer*>(context)->put_bytes(data, bytes);
  return SHOAL_OK;
}

shoal_status read_bytes(void* context, void* data, std::uint64_t bytes) {
  auto* cursor = static_cast<BlockCursor*>(context);
  if (bytes > cursor->left()) return SHOAL_ERROR;
  cursor->get_bytes(data, bytes);
  return SHOAL_OK;
}

bool is_state(const Field& field) { return !field.derived; }

// What pass one found; nothing is applied before all of it is there.
struct StoredField {
  std::string name;
  std::uint32_t rank = 0, data_type = 0, components = 0;
  const Block* data = nullptr;
};

struct StoredBody {
  std::string name;
  std::uint64_t n = 0;
  std::int64_t next_id = 0;
  bool position_changed = true;
  const Block* ids = nullptr;
  std::vector<StoredField> fields;
};

struct StoredLoop {
  std::string name;
  std::uint64_t steps = 0;
  double time = 0.0, last_dt = 0.0, smallest_dt = 0.0, largest_dt = 0.0;
};

struct StoredOperator {
  std::string key;
  const Block* state = nullptr;
};

struct StoredRun {
  int dimensions = 0;
  double time = 0.0, last_dt = 0.0;
  std::uint64_t outer_steps = 0, renewals = 0, sorts = 0, list_builds = 0;
  std::vector<StoredLoop> loops;
  std::vector<StoredBody> bodies;
  std::vector<StoredOperator> operators;
};

void write_run(BlockWriter& writer, const Stepper& stepper, const Neighbourhood& neighbourhood,
               int dimensions) {
  BlockBuffer buffer;
  buffer.put(static_cast<std::int32_t>(dimensions));
  buffer.put(stepper.time);
  buffer.put(stepper.last_dt);
  buffer.put(stepper.outer_steps);
  buffer.put(neighbourhood.renewals);
  buffer.put(neighbourhood.sorts);
  buffer.put(neighbourhood.list_builds);
  writer.block("run", buffer);
}

void write_loop(BlockWriter& writer, const LoopRun& loop) {
  BlockBuffer buffer;
  buffer.put(loop.name);
  buffer.put(loop.steps);
  for (const double value : {loop.time, loop.last_dt, loop.smallest_dt, loop.largest_dt}) buffer.put(value);
  writer.block("loop", buffer);
}

void write_body(BlockWriter& writer, const Body& body) {
  BlockBuffer buffer;
  buffer.put(body.name());
  buffer.put(body.n_owned());
  buffer.put(body.next_id);
  buffer.put(static_cast<std::uint8_t>(body.position_changed));
  writer.block("body", buffer);
  writer.block("data", body.ids().data(), body.n_owned() * body.ids().bytes_per_particle());
  for (const auto& field : body.fields()) {
    if (!is_state(*field)) continue;
    BlockBuffer head;
    head.put(field->name());
    head.put(static_cast<std::uint32_t>(field->specification().rank));
    head.put(static_cast<std::uint32_t>(field->specification().data_type));
    head.put(field->components());
    writer.block("field", head);
    writer.block("data", field->data(), body.n_owned() * field->bytes_per_particle());
  }
}

const Block* data_after(const std::vector<Block>& blocks, std::size_t k, std::uint64_t bytes) {
  if (k + 1 >= blocks.size() || blocks[k + 1].kind != "data" || blocks[k + 1].size != bytes)
    throw CheckpointError("the checkpoint is damaged: a block of data is missing or has the wrong size");
  return &blocks[k + 1];
}

StoredLoop parse_loop(const Block& block) {
  BlockCursor cursor(block);
  StoredLoop loop;
  loop.name = cursor.get_text();
  loop.steps = cursor.get<std::uint64_t>();
  for (double* value : {&loop.time, &loop.last_dt, &loop.smallest_dt, &loop.largest_dt})
    *value = cursor.get<double>();
  return loop;
}

StoredBody parse_body(const std::vector<Block>& blocks, std::size_t k) {
  BlockCursor cursor(blocks[k]);
  StoredBody body;
  body.name = cursor.get_text();
  body.n = cursor.get<std::uint64_t>();
  body.next_id = cursor.get<std::int64_t>();
  body.position_changed = cursor.get<std::uint8_t>() != 0;
  if (body.n >= std::uint64_t{1} << 31)
    throw CheckpointError("the checkpoint is damaged: a body is impossibly large");
  body.ids = data_after(blocks, k, body.n * sizeof(std::int64_t));
  return body;
}

StoredField parse_field(const std::vector<Block>& blocks, std::size_t k, std::uint64_t n) {
  BlockCursor cursor(blocks[k]);
  StoredField field;
  field.name = cursor.get_text();
  field.rank = cursor.get<std::uint32_t>();
  field.data_type = cursor.get<std::uint32_t>();
  field.components = cursor.get<std::uint32_t>();
  if (field.components == 0 || field.components > 9)
    throw CheckpointError("the checkpoint is damaged: a field has an impossible number of components");
  field.data = data_after(blocks, k, n * field.components * 8);
  return field;
}

StoredRun parse(const std::vector<Block>& blocks) {
  StoredRun run;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const Block& block = blocks[k];
    BlockCursor cursor(block);
    if (block.kind == "run") {
      run.dimensions = cursor.get<std::int32_t>();
      run.time = cursor.get<double>();
      run.last_dt = cursor.get<double>();
      for (std::uint64_t* value : {&run.outer_steps, &run.renewals, &run.sorts, &run.list_builds})
        *value = cursor.get<std::uint64_t>();
    } else if (block.kind == "loop") {
      run.loops.push_back(parse_loop(block));
    } else if (block.kind == "body") {
      run.bodies.push_back(parse_body(blocks, k));
    } else if (block.kind == "field") {
      if (run.bodies.empty()) throw CheckpointError("the checkpoint is damaged: a field without a body");
      run.bodies.back().fields.push_back(parse_field(blocks, k, run.bodies.back().n));
    } else if (block.kind == "operator") {
      run.operators.push_back({cursor.get_text(), &block});
    } else if (block.kind != "data") {
      throw CheckpointError("the checkpoint holds a block '" + block.kind +
                            "', which this Shoal does not know");
    }
  }
  return run;
}

template <class Stored>
const Stored* find_named(const std::vector<Stored>& list, const std::string& name) {
  for (const Stored& item : list)
    if (item.name == name) return &item;
  return nullptr;
}

[[noreturn]] void other_case(const std::string& why) {
  throw CheckpointError("the checkpoint belongs to another case: " + why);
}

void check_body(const StoredBody& stored, const Body& body) {
  for (const auto& field : body.fields()) {
    if (!is_state(*field)) continue;
    const StoredField* found = find_named(stored.fields, field->name());
    if (found == nullptr)
      other_case("body '" + body.name() + "' needs field '" + field->name() + "', which it does not hold");
    if (found->rank != static_cast<std::uint32_t>(field->specification().rank) ||
        found->data_type != static_cast<std::uint32_t>(field->specification().data_type) ||
        found->components != field->components())
      other_case("field '" + field->name() + "' of body '" + body.name() + "' has another type in it");
  }
}

void check_compatible(const StoredRun& stored, const std::vector<std::unique_ptr<Body>>& bodies,
                      const Schedule& schedule, int dimensions) {
  if (stored.dimensions != dimensions)
    other_case("it has " + std::to_string(stored.dimensions) + " dimensions, not " +
               std::to_string(dimensions));
  std::vector<std::string> here, there;
  for (const auto& body : bodies) here.push_back(body->name());
  for (const StoredBody& body : stored.bodies) there.push_back(body.name);
  if (here != there) other_case("its bodies are " + quoted_list(there) + ", not " + quoted_list(here));
  for (std::size_t b = 0; b < bodies.size(); ++b) check_body(stored.bodies[b], *bodies[b]);
  for (const auto& loop : schedule.loops)
    if (find_named(stored.loops, loop->name) == nullptr) other_case("it has no loop '" + loop->name + "'");
}

}  // namespace

void Simulation::Implementation::save(std::ostream& stream) {
  need(Phase::running, "save");
  BlockWriter writer(stream);
  write_run(writer, stepper, neighbourhood, settings.dimensions);
  for (const auto& loop : schedule.loops) write_loop(writer, *loop);
  for (const auto& body : bodies) write_body(writer, *body);
  for (const auto& op : schedule.operators) {
    if (op->c().save == nullptr) continue;
    BlockBuffer buffer;
    buffer.put(key_of(*op));
    const shoal_stream c{sizeof(shoal_stream), 0, &buffer, write_bytes, nullptr};
    executor.save_or_load(*op, c, "save");
    writer.block("operator", buffer);
  }
  writer.finish();
}

namespace {

void restore_body(BlockReader& reader, const StoredBody& stored, Body& body, bool poison) {
  body.resize(stored.n);
  body.next_id = stored.next_id;
  reader.read(*stored.ids, body.ids().data());
  for (const auto& field : body.fields()) {
    if (is_state(*field))
      reader.read(*find_named(stored.fields, field->name())->data, field->data());
    else if (poison)
      field->poison(0, body.n_owned());
    else
      field->clear(body.n_owned());
  }
}

}  // namespace

void Simulation::Implementation::load(std::istream& stream) {
  need(Phase::finalised, "load");
  BlockReader reader(stream);
  const StoredRun stored = parse(reader.blocks());
  check_compatible(stored, bodies, schedule, settings.dimensions);
  // Operators of the same name in the same place are told apart by their order.
  std::vector<std::pair<OperatorRun*, const Block*>> states;
  std::size_t next = 0;
  for (const auto& op : schedule.operators) {
    if (op->c().save == nullptr || op->c().load == nullptr) continue;
    while (next < stored.operators.size() && stored.operators[next].key != key_of(*op)) ++next;
    if (next == stored.operators.size()) other_case("it has no state of operator " + key_of(*op));
    states.emplace_back(op.get(), stored.operators[next++].state);
  }

  for (std::size_t b = 0; b < bodies.size(); ++b)
    restore_body(reader, stored.bodies[b], *bodies[b], settings.poison);
  for (const auto& loop : schedule.loops) {
    const StoredLoop& from = *find_named(stored.loops, loop->name);
    loop->steps = from.steps;
    loop->time = from.time;
    loop->last_dt = from.last_dt;
    loop->smallest_dt = from.smallest_dt;
    loop->largest_dt = from.largest_dt;
  }
  stepper.time = stored.time;
  stepper.last_dt = stored.last_dt;
  stepper.outer_steps = stored.outer_steps;
  stepper.check_health();
  neighbourhood.rebuild();
  neighbourhood.renewals = stored.renewals;
  neighbourhood.sorts = stored.sorts;
  neighbourhood.list_builds = stored.list_builds;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    bodies[b]->position_changed = stored.bodies[b].position_changed;
  for (const auto& [op, block] : states) {
    BlockCursor cursor(*block);
    cursor.get_text();
    const shoal_stream c{sizeof(shoal_stream), 0, &cursor, nullptr, read_bytes};
    executor.save_or_load(*op, c, "load");
    if (cursor.left() > 0)
      throw CheckpointError("operator " + key_of(*op) + " left " + std::to_string(cursor.left()) +
                            " bytes of its state unread; was it saved by another version of its plugin?");
  }
  executor.forget_bindings();
  stepper.start_timing();
  phase = Phase::running;
}

}  // namespace shoal::kernel
