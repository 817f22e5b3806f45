// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// One operator, one stage at a time.
#include "kernel/schedule/executor.hpp"

#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>

#include "kernel/particles/parallel.hpp"

namespace shoal::kernel {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double identity(std::uint32_t reduction) {
  switch (reduction) {
    case SHOAL_MINIMUM: return infinity;
    case SHOAL_MAXIMUM: return -infinity;
    default: return 0.0;
  }
}

// NaN wins, so that it is seen.
double combine(std::uint32_t reduction, double a, double b) {
  switch (reduction) {
    case SHOAL_MINIMUM: return b < a || b != b ? b : a;
    case SHOAL_MAXIMUM: return b > a || b != b ? b : a;
    default: return a + b;
  }
}

// Why a callback failed: of several chunks the first one counts, whichever thread came first.
class Failure {
 public:
  bool happened() const { return happened_.load(std::memory_order_relaxed); }
  void note(std::uint64_t chunk, shoal_status status, std::string text) {
    const std::lock_guard lock(mutex_);
    if (happened() && chunk > chunk_) return;
    chunk_ = chunk;
    status_ = status;
    text_ = std::move(text);
    happened_.store(true, std::memory_order_relaxed);
  }
  shoal_status status() const { return status_; }
  const std::string& text() const { return text_; }

 private:
  std::atomic<bool> happened_ = false;
  std::mutex mutex_;
  std::uint64_t chunk_ = 0;
  shoal_status status_ = SHOAL_OK;
  std::string text_;
};

// Plugins may not throw; one that does is stopped here and not at std::terminate.
template <class Call>
shoal_status protect(std::string& thrown, const Call& call) {
  try {
    return call();
  } catch (const std::exception& error) {
    thrown = std::string("an exception left the plugin, which its contract forbids: ") + error.what();
  } catch (...) {
    thrown = "an exception of unknown type left the plugin, which its contract forbids";
  }
  return SHOAL_ERROR;
}

// Whether all threads run it. This depends on the clock, its results do not.
bool pays_on_threads(const OperatorRun& op, std::uint64_t n) {
  return n >= serial_below || (op.calls > 0 && op.ticks / op.calls >= worth_threads);
}

enum class Threads { one, all, all_shared };
// Sums over pairs take unequal times; where little is done with each particle, it costs more to fetch those of other
// threads than to wait.
Threads threads_for(const OperatorRun& op, std::uint64_t n, bool pairs) {
  if (!pays_on_threads(op, n)) return Threads::one;
  return pairs ? Threads::all_shared : Threads::all;
}

// function(chunk) for chunks of 128 particles.
template <class Function>
void for_each_chunk(std::uint64_t n, Threads threads, double* partials, std::size_t stride,
                    const Function& function) {
  const auto one = [&](std::uint64_t number) {
    shoal_chunk chunk;
    chunk.size = sizeof chunk;
    chunk.number = static_cast<std::uint32_t>(number);
    chunk.begin = number * chunk_size;
    chunk.end = std::min(n, chunk.begin + chunk_size);
    chunk.partial = partials + number * stride;
    function(chunk);
  };
  const std::uint64_t chunks = n_chunks(n);
  if (threads == Threads::one) {
    for (std::uint64_t k = 0; k < chunks; ++k) one(k);
    return;
  }
  if (threads == Threads::all_shared) return for_each_piece(chunks, one);
  tbb::parallel_for(
      tbb::blocked_range<std::uint64_t>(0, chunks),
      [&](const tbb::blocked_range<std::uint64_t>& range) {
        for (std::uint64_t k = range.begin(); k < range.end(); ++k) one(k);
      },
      tbb::static_partitioner{});
}

}  // namespace

std::string Executor::take_text() const {
  std::string text = failures_.take != nullptr ? failures_.take() : std::string();
  return text.empty() ? "it gave no reason" : text;
}

void Executor::fail(const OperatorRun& op, const char* callback, shoal_status status, const std::string& text,
                    const shoal_step* step) const {
  const std::string what = "operator " + op.attachment.name + " on body '" + op.body->name() +
                           "' failed in " + callback + ": " + text;
  if (status == SHOAL_CASE_ERROR) throw ModelError(what);
  if (status == SHOAL_PHYSICS_FAILED) {
    PhysicsFailure::Report report;
    report.cause = what;
    report.loop = op.loop;
    if (step != nullptr) {
      report.step = step->number;
      report.time = step->time;
    }
    throw PhysicsFailure(std::move(report));
  }
  throw OperatorFailure(what);
}

void Executor::save_or_load(const OperatorRun& op, const shoal_stream& stream, const char* what) const {
  const bool saves = stream.write != nullptr;
  std::string thrown;
  const shoal_status status = protect(
      thrown, [&] { return saves ? op.c().save(op.c().self, &stream) : op.c().load(op.c().self, &stream); });
  if (status != SHOAL_OK) fail(op, what, status, thrown.empty() ? take_text() : thrown, nullptr);
}

void Executor::clear(const BodyField& what) {
  what.field->clear(what.body->n_owned());
  what.body->mark_written(*what.field, poison_);
  clear_ticks += stopwatch.lap();
}

void Executor::bind(OperatorRun& op) {
  if (op.bound_generation == generation()) return;
  const auto view = [&](const Field* field, const Body& body, const Access& access) {
    shoal_field c;
    c.size = sizeof c;
    c.components = components_of(static_cast<shoal_rank>(access.rank), dimensions_, access.array_components);
    c.data = field != nullptr ? const_cast<void*>(field->data()) : nullptr;
    c.n_owned = body.n_owned();
    c.n_total = body.n_total();
    c.changes = field != nullptr ? &field->changes : nullptr;
    return c;
  };
  const std::vector<Access>& accesses = op.attachment.accesses;
  op.own.clear();
  op.of_neighbours.clear();
  op.neighbours.clear();
  op.pairs_per_call = 0;
  for (std::size_t a = 0; a < accesses.size(); ++a)
    op.own.push_back(view(op.own_fields[a], *op.body, accesses[a]));
  for (std::size_t r = 0; r < op.relations.size(); ++r) {
    const Relation& relation = neighbourhood_.relations()[op.relations[r]];
    op.neighbours.push_back(neighbourhood_.view(op.relations[r]));
    op.pairs_per_call += relation.list.n_pairs();
    const Body& other = neighbourhood_.body(relation.neighbours);
    for (std::size_t a = 0; a < accesses.size(); ++a)
      op.of_neighbours.push_back(view(op.fields_of_neighbours[r * accesses.size() + a], other, accesses[a]));
  }
  prepare_partials(op, n_chunks(op.body->n_owned()));
  op.bound_generation = generation();
  if (op.c().bind == nullptr) return;
  shoal_binding binding;
  binding.size = sizeof binding;
  binding.dimensions = dimensions_;
  binding.n_owned = op.body->n_owned();
  binding.own = op.own.data();
  binding.neighbours = op.neighbours.data();
  binding.of_neighbours = op.of_neighbours.data();
  std::string thrown;
  const shoal_status status = protect(thrown, [&] { return op.c().bind(op.c().self, &binding); });
  if (status != SHOAL_OK) fail(op, "bind", status, thrown.empty() ? take_text() : thrown, nullptr);
}

void Executor::prepare_partials(OperatorRun& op, std::uint64_t chunks) {
  const std::size_t width = std::max<std::size_t>(op.attachment.reductions.size(), 1);
  op.partials.resize(std::max<std::uint64_t>(chunks, 1) * width);
}

void Executor::run(OperatorRun& op, const shoal_step& step) {
  bool renewed = false;
  for (const BodyField& image : op.images) {
    if (!image.field->halo_stale) continue;
    if (image.body->n_halo() > 0) {
      image.body->renew_halo(*image.field);
      renewed = true;
    }
    image.field->halo_stale = false;
  }
  if (renewed) image_ticks += stopwatch.lap();

  bind(op);
  std::string thrown;
  if (op.c().begin != nullptr) {
    const shoal_status status = protect(thrown, [&] { return op.c().begin(op.c().self, &step); });
    if (status != SHOAL_OK) fail(op, "begin", status, thrown.empty() ? take_text() : thrown, &step);
  }
  run_chunks(op, step);
  if (op.c().end != nullptr) {
    const shoal_status status =
        protect(thrown, [&] { return op.c().end(op.c().self, &step, op.results.data()); });
    if (status != SHOAL_OK) fail(op, "end", status, thrown.empty() ? take_text() : thrown, &step);
  }
  for (Field* field : op.written) op.body->mark_written(*field, poison_);
  if (op.moves_particles) op.body->position_changed = true;
  ++op.calls;
  op.particles += op.body->n_owned();
  op.pairs += op.pairs_per_call;
  op.ticks += stopwatch.lap();
}

void Executor::check_exchange(const OperatorRun& op, const shoal_exchange& asked,
                              const shoal_step& step) const {
  const std::uint64_t n = op.body->n_owned();
  const auto refuse = [&](const std::string& what) { fail(op, "exchange", SHOAL_ERROR, what, &step); };
  for (std::uint64_t k = 0; k < asked.n_leaving; ++k) {
    if (asked.leaving[k] >= n)
      refuse("particle " + std::to_string(asked.leaving[k]) + " is to leave, of " + std::to_string(n));
    if (k > 0 && asked.leaving[k] <= asked.leaving[k - 1])
      refuse("the particles that leave are not in ascending order");
  }
  for (std::uint64_t k = 0; asked.sources != nullptr && k < asked.n_joining; ++k)
    if (asked.sources[k] >= n && asked.sources[k] != Body::no_source)
      refuse("particle " + std::to_string(asked.sources[k]) + " is to be copied, of " + std::to_string(n));
}

void Executor::fill(OperatorRun& op, const shoal_step& step, std::span<const std::uint64_t> sources) {
  const std::uint64_t end = op.body->n_owned(), begin = end - sources.size();
  if (Field* volume = op.body->find("volume"))
    for (std::uint64_t i = begin; i < end; ++i)
      if (sources[i - begin] == Body::no_source) volume->reals()[i] = std::pow(op.body->spacing, dimensions_);
  if (op.c().fill != nullptr) {
    std::string thrown;
    const shoal_status status = protect(thrown, [&] { return op.c().fill(op.c().self, &step, begin, end); });
    if (status != SHOAL_OK) fail(op, "fill", status, thrown.empty() ? take_text() : thrown, &step);
  }
  if (!fill_initial) return;
  for (std::uint64_t i = begin; i < end; ++i)
    if (sources[i - begin] == Body::no_source) fill_initial(*op.body, i, i + 1, op.written);
}

void Executor::exchange(OperatorRun& op, const shoal_step& step) {
  bind(op);
  shoal_exchange asked{};
  asked.size = sizeof asked;
  std::string thrown;
  const shoal_status status = protect(thrown, [&] { return op.c().exchange(op.c().self, &step, &asked); });
  if (status != SHOAL_OK) fail(op, "exchange", status, thrown.empty() ? take_text() : thrown, &step);
  if (asked.n_leaving > 0 || asked.n_joining > 0) {
    check_exchange(op, asked, step);
    std::vector<std::uint64_t> sources(asked.n_joining, Body::no_source);
    if (asked.sources != nullptr) sources.assign(asked.sources, asked.sources + asked.n_joining);
    op.body->exchange({asked.leaving, asked.n_leaving}, sources);
    neighbourhood_.particles_changed();
    bind(op);
    if (!sources.empty()) fill(op, step, sources);
  }
  op.ticks += stopwatch.lap();
}

void Executor::run_chunks(OperatorRun& op, const shoal_step& step) {
  const std::uint64_t n = op.body->n_owned();
  const std::size_t n_reductions = op.attachment.reductions.size();
  const bool serial = (op.c().flags & SHOAL_OPERATOR_SERIAL) != 0;
  const std::uint64_t chunks = serial ? 1 : n_chunks(n);
  for (std::uint64_t k = 0; k < std::max<std::uint64_t>(chunks, 1); ++k)
    for (std::size_t r = 0; r < n_reductions; ++r)
      op.partials[k * n_reductions + r] = identity(op.attachment.reductions[r]);

  const auto call_with_chunks = [&](const char* name, auto callback, bool pairs) {
    Failure failure;
    const auto one = [&](const shoal_chunk& chunk) {
      if (failure.happened()) return;
      std::string thrown;
      const shoal_status status = protect(thrown, [&] { return callback(op.c().self, &step, &chunk); });
      if (status != SHOAL_OK) failure.note(chunk.number, status, thrown.empty() ? take_text() : thrown);
    };
    if (serial) {
      shoal_chunk chunk{};
      chunk.size = sizeof chunk;
      chunk.end = n;
      chunk.partial = op.partials.data();
      one(chunk);
    } else {
      for_each_chunk(n, threads_for(op, n, pairs), op.partials.data(), n_reductions, one);
    }
    if (failure.happened()) fail(op, name, failure.status(), failure.text(), &step);
  };
  if (op.c().prepare != nullptr) call_with_chunks("prepare", op.c().prepare, false);
  call_with_chunks("run", op.c().run, op.pairs_per_call > 0);
  reduce(op, chunks);
}

// Neighbouring chunks in pairs, then pairs of pairs: the order of the sums depends on their number alone.
void Executor::reduce(OperatorRun& op, std::uint64_t chunks) {
  const std::size_t n = op.attachment.reductions.size();
  if (n == 0) return;
  double* partials = op.partials.data();
  for (std::uint64_t stride = 1; stride < chunks; stride *= 2)
    for (std::uint64_t k = 0; k + stride < chunks; k += 2 * stride)
      for (std::size_t r = 0; r < n; ++r)
        partials[k * n + r] =
            combine(op.attachment.reductions[r], partials[k * n + r], partials[(k + stride) * n + r]);
  for (std::size_t r = 0; r < n; ++r) op.results[r] = partials[r];
}

double Executor::time_step_of(const OperatorRun& op, const shoal_step& step, std::uint64_t begin,
                              std::uint64_t end) const {
  shoal_chunk chunk{};
  chunk.size = sizeof chunk;
  chunk.number = static_cast<std::uint32_t>(begin / chunk_size);
  chunk.begin = begin;
  chunk.end = end;
  std::vector<double> unused(std::max<std::size_t>(op.attachment.reductions.size(), 1));
  chunk.partial = unused.data();
  return op.c().time_step(op.c().self, &step, &chunk);
}

double Executor::time_step(OperatorRun& op, const shoal_step& step) {
  bind(op);
  double limit = infinity;
  if ((op.c().flags & SHOAL_OPERATOR_TIME_STEP_OF_PARTICLES) == 0) {
    shoal_chunk chunk{};
    chunk.size = sizeof chunk;
    chunk.partial = op.partials.data();
    limit = op.c().time_step(op.c().self, &step, &chunk);
  } else {
    const std::uint64_t n = op.body->n_owned();
    const std::size_t stride = std::max<std::size_t>(op.attachment.reductions.size(), 1);
    double* partials = op.partials.data();
    for_each_chunk(n, n >= serial_below ? Threads::all : Threads::one, partials, stride,
                   [&](const shoal_chunk& chunk) {
                     const double limit_here = op.c().time_step(op.c().self, &step, &chunk);
                     chunk.partial[0] = limit_here;
                   });
    // A minimum does not depend on its order, but for NaN, which must win.
    for (std::uint64_t k = 0; k < n_chunks(n); ++k)
      limit = combine(SHOAL_MINIMUM, limit, partials[k * stride]);
  }
  op.ticks += stopwatch.lap();
  return limit;
}

}  // namespace shoal::kernel
