// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The contract between the Shoal kernel and its plugins, in C.
//
// Only plain data and pointers to functions cross this boundary: never a C++ type, an exception, or memory that
// the other side frees. Plugin authors normally do not use this file but the C++ layer above it (shoal/shoal.hpp).
//
// Rules of growth
// - A struct grows only at its end. Its first member is its size in bytes as its maker knew it, and a reader uses
//   no member beyond that size (SHOAL_HAS). Enumerators never change meaning.
// - So the elements of an array of structs lie as far apart as `size` of its first element says, which need not be
//   what sizeof says here (SHOAL_AT).
// - Binaries of the same ABI major work together whatever their minors. A changed meaning is a new major.
// - All texts are UTF-8, end in a zero byte, and are borrowed: the maker keeps them alive for as long as the object
//   that they describe. Whoever allocates, frees.
// - No callback of a plugin and no function of the host throws. A callback that fails calls host->fail with a
//   sentence for the user and returns a status other than SHOAL_OK.
// Threads: every function is marked with the thread that may call it. [main]: the thread that drives the run, one
// call at a time. [worker]: any thread, many at once, on disjoint chunks of particles. [any]: both.
// A plugin starts no threads.
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define SHOAL_ABI_MAJOR 1u
#define SHOAL_ABI_MINOR 3u
#define SHOAL_ABI_MAGIC UINT64_C(0x494241204c414f48) /* the bytes "HOAL ABI" */

// Whether the object that `pointer` points to is large enough to hold `member`.
#define SHOAL_HAS(type, pointer, member) \
  ((pointer)->size >= offsetof(type, member) + sizeof((pointer)->member))

// Pointer to element `index` of an array of structs that the other side made.
#define SHOAL_AT(type, array, index) \
  ((const type*)((const char*)(array) + (size_t)(index) * (size_t)(array)->size))

// Rows of neighbour lists and all field arrays are padded to this many entries, so that a plugin may use any
// number of SIMD lanes up to it.
#define SHOAL_PADDING 8u
// Field arrays start at multiples of this many bytes.
#define SHOAL_ALIGNMENT 64u

typedef enum shoal_status {
  SHOAL_OK = 0,
  SHOAL_ERROR = 1,          // the plugin or the kernel failed
  SHOAL_CASE_ERROR = 2,     // what the user asked for cannot be done; the text says how to mend it
  SHOAL_PHYSICS_FAILED = 3  // the run left what the model can describe (NaN, collapse, range)
} shoal_status;

// ---------------------------------------------------------------------------------------------------------------
// The stamp: read before anything of the plugin is called.

enum {
  SHOAL_ISA_AVX2 = 1u << 0,
  SHOAL_ISA_FMA = 1u << 1,
  SHOAL_ISA_AVX512F = 1u << 2,
  SHOAL_ISA_AVX512DQ = 1u << 3,
  SHOAL_ISA_AVX512VL = 1u << 4,
  SHOAL_ISA_AVX512BW = 1u << 5
};

// Exported by each plugin as the constant `shoal_plugin_stamp`.
typedef struct shoal_stamp {
  uint64_t magic;  // SHOAL_ABI_MAGIC
  uint32_t size;   // sizeof(shoal_stamp)
  uint32_t abi_major;
  uint32_t abi_minor;
  uint32_t real_bytes;   // 8: fields are double precision
  uint32_t index_bytes;  // 4: neighbours are named by 32-bit indices
  uint32_t isa;          // instruction sets that the code needs, SHOAL_ISA_*
  char sdk_version[16];  // text, for messages
  char compiler[64];     // text, for messages
} shoal_stamp;

// ---------------------------------------------------------------------------------------------------------------
// Parameters: one table drives reading, validation, `shoal describe`, the documentation and the JSON schema.

typedef enum shoal_value_kind {
  SHOAL_BOOLEAN = 1,
  SHOAL_INTEGER = 2,
  SHOAL_REAL = 3,
  SHOAL_VECTOR = 4,  // as many numbers as the case has dimensions
  SHOAL_MATRIX = 5,  // dimensions x dimensions numbers, a list of rows
  SHOAL_TEXT = 6,
  SHOAL_CHOICE = 7,             // one of `choices`
  SHOAL_EXPRESSION = 8,         // a number or an expression of x, y, z, t and the case's parameters
  SHOAL_VECTOR_EXPRESSION = 9,  // a list of as many numbers or expressions as the case has dimensions
  SHOAL_BODY = 10,              // the name of a body of the case
  SHOAL_FIELD = 11,             // the name of a field, e.g. velocity, or of a component, e.g. velocity.x
  SHOAL_FILE = 12,              // path of a file that must exist; handed over as an absolute path
  SHOAL_OBJECT = 13  // an object of a registered type of `object_kind`: name, or {name: {key: value}}
} shoal_value_kind;

typedef enum shoal_type_kind {
  SHOAL_TYPE_OPERATOR = 1,
  SHOAL_TYPE_MATERIAL = 2,
  SHOAL_TYPE_PHYSICS = 3,
  SHOAL_TYPE_SHAPE = 4,
  SHOAL_TYPE_OUTPUT = 5,
  SHOAL_TYPE_PROBE = 6
} shoal_type_kind;

enum {
  SHOAL_PARAMETER_REQUIRED = 1u << 0,
  SHOAL_PARAMETER_LIST = 1u << 1,  // a sequence of values of the kind; a single one counts as a list of one
  SHOAL_PARAMETER_HAS_MINIMUM = 1u << 2,
  SHOAL_PARAMETER_HAS_MAXIMUM = 1u << 3,
  SHOAL_PARAMETER_MINIMUM_EXCLUDED = 1u << 4,  // value > minimum, else value >= minimum
  SHOAL_PARAMETER_MAXIMUM_EXCLUDED = 1u << 5,
  SHOAL_PARAMETER_NAMES =
      1u << 6,  // an expression may use names that the case does not know: the plugin's own
  // A number in proportion to which time steps grow, and which makes the scheme fail beyond some value: what
  // `shoal study --limits` raises (since 1.3)
  SHOAL_PARAMETER_STEP_FACTOR = 1u << 7
};

typedef struct shoal_parameter {
  uint32_t size;
  uint32_t kind;         // shoal_value_kind
  uint32_t flags;        // SHOAL_PARAMETER_*
  uint32_t object_kind;  // SHOAL_OBJECT: shoal_type_kind of the objects that fit; else 0
  const char* key;       // snake_case, as written in a case
  const char* unit;      // in UDUNITS-2 syntax, "1" without dimension; NULL where a unit makes no sense
  const char*
      default_text;  // as it would stand in a case; NULL: none (then an optional value is simply not set)
  double minimum, maximum;  // bounds of numbers, or of each component
  uint32_t n_choices;
  uint32_t reserved;
  const char* const* choices;
  const char* doc;      // one or a few sentences
  const char* example;  // as it would stand in a case
} shoal_parameter;

typedef struct shoal_expression shoal_expression;  // opaque; evaluated through the host
typedef struct shoal_object shoal_object;

enum { SHOAL_ORIGIN_DEFAULT = 0, SHOAL_ORIGIN_CASE = 1, SHOAL_ORIGIN_COMMAND_LINE = 2 };

// A checked value, in SI units. `n` is the number of elements: 1, or the length of a list; 0 if it is not set.
typedef struct shoal_value {
  uint32_t size;
  uint32_t kind;  // shoal_value_kind
  uint32_t n;
  uint32_t origin;                             // SHOAL_ORIGIN_*
  const double* reals;                         // REAL: n, VECTOR: n * D, MATRIX: n * D * D row by row
  const int64_t* integers;                     // BOOLEAN (0 or 1), INTEGER, CHOICE (index), BODY (index): n
  const char* const* texts;                    // TEXT, CHOICE, BODY, FIELD, FILE: n
  const shoal_expression* const* expressions;  // EXPRESSION: n, VECTOR_EXPRESSION: n * D
  const shoal_object* const* objects;          // OBJECT: n
  const char* place;                           // "dam_break.yaml:12:51", for messages
} shoal_value;

typedef struct shoal_type shoal_type;

// A type with its values, in the order of the type's parameter table.
struct shoal_object {
  uint32_t size;
  uint32_t n_values;
  const shoal_type* type;
  const shoal_value* values;
  const char* place;
};

// ---------------------------------------------------------------------------------------------------------------
// Fields

typedef enum shoal_rank {
  SHOAL_SCALAR = 0,       // 1 component
  SHOAL_RANK_VECTOR = 1,  // D components, interleaved
  SHOAL_SYMMETRIC = 2,    // D (D + 1) / 2 components: xx, xy, yy  or  xx, xy, xz, yy, yz, zz
  SHOAL_RANK_MATRIX = 3,  // D x D components, row by row
  SHOAL_ARRAY = 4  // as many independent numbers as the access says; images copy them as they are (since 1.1)
} shoal_rank;

typedef enum shoal_data_type { SHOAL_DOUBLE = 0, SHOAL_INT64 = 1 } shoal_data_type;

enum {
  SHOAL_READ = 1u << 0,
  SHOAL_WRITE = 1u << 1,
  SHOAL_ACCUMULATE = 1u << 2,     // adds to a field that its owner clears (shoal_builder::own_field)
  SHOAL_OF_NEIGHBOURS = 1u << 3,  // read of the neighbours too: their halo is renewed first
  SHOAL_NOT_OWN = 1u << 4,        // not of the operator's own body, only of its neighbours'
  SHOAL_DERIVED = 1u << 5,        // need not survive a restart: written anew in each step before it is read
  SHOAL_OPTIONAL = 1u << 6  // may be absent: the view's data is then NULL (only if nobody else declares it)
};

// What an operator does with a field. Shared fields (position, velocity, mass, ...; see shoal/shared_fields.hpp)
// have their rank, unit and meaning from one table; a clash is an error.
typedef struct shoal_access {
  uint32_t size;
  uint32_t mode;       // SHOAL_READ | ...
  uint32_t rank;       // shoal_rank
  uint32_t data_type;  // shoal_data_type
  const char* field;   // snake_case
  const char* unit;    // NULL for shared fields
  const char* doc;     // NULL for shared fields
  // Since 1.1
  uint32_t components;  // of a SHOAL_ARRAY, else 0
  uint32_t reserved;
} shoal_access;

// A view of a field: valid in the call it is handed to and, if handed to bind, until the next bind.
// Arrays hold the owned particles first, then their images (halo), then padding.
typedef struct shoal_field {
  uint32_t size;
  uint32_t components;
  void* data;  // components interleaved
  uint64_t n_owned;
  uint64_t n_total;  // owned and halo
  // Since 1.3
  const uint64_t*
      changes;  // a number that grows whenever values change, whoever changes them; NULL: not counted
} shoal_field;

// Neighbours of the owned particles of a body among the particles (owned and halo) of another, or of itself.
// Row i: indices[offsets[i]] ... counts[i] of them; each row is padded to SHOAL_PADDING entries with its last
// neighbour, so every index of a row may be read.
typedef struct shoal_neighbours {
  uint32_t size;
  uint32_t body;  // the neighbours' body
  const uint64_t* offsets;
  const uint32_t* counts;
  const uint32_t* indices;
  uint64_t n_rows;
  double cutoff;
  // Since 1.1
  uint64_t generation;  // changes whenever the list is built anew
} shoal_neighbours;

// ---------------------------------------------------------------------------------------------------------------
// Operators

// Where a run stands. `time` is the loop's own time at the beginning of its step.
typedef struct shoal_step {
  uint32_t size;
  int32_t dimensions;
  double time;
  double dt;           // step of the loop that the operator is attached to; 0 in stages outside the loops
  uint64_t number;     // steps that this loop has made
  double parent_dt;    // step of the parent loop; dt itself at the top
  double parent_time;  // time of the parent loop at the beginning of its step
} shoal_step;

// A piece of an operator's work: owned particles begin <= i < end. Chunks do not depend on the number of threads.
typedef struct shoal_chunk {
  uint32_t size;
  uint32_t number;
  uint64_t begin, end;
  double* partial;  // n_reductions values, set to their identities: the chunk's part of the reductions
} shoal_chunk;

typedef enum shoal_reduction { SHOAL_SUM = 0, SHOAL_MINIMUM = 1, SHOAL_MAXIMUM = 2 } shoal_reduction;

typedef enum shoal_configuration {
  SHOAL_CURRENT = 0,   // renewed as the particles move
  SHOAL_REFERENCE = 1  // built once from the initial positions
} shoal_configuration;

typedef struct shoal_relation_request {
  uint32_t size;
  uint32_t body;           // the neighbours' body
  uint32_t configuration;  // shoal_configuration
  uint32_t reserved;
  double cutoff;  // m
} shoal_relation_request;

// What bind hands over: views in the order of the operator's accesses and relations.
typedef struct shoal_binding {
  uint32_t size;
  int32_t dimensions;
  uint64_t n_owned;
  const shoal_field* own;              // [access]; data NULL for SHOAL_NOT_OWN
  const shoal_neighbours* neighbours;  // [relation]
  const shoal_field* of_neighbours;  // [relation * n_accesses + access]; data NULL unless SHOAL_OF_NEIGHBOURS
} shoal_binding;

// Writes or reads a block of bytes of an operator's own state in a checkpoint.
typedef struct shoal_stream {
  uint32_t size;
  uint32_t reserved;
  void* context;
  shoal_status (*write)(void* context, const void* data, uint64_t bytes);
  shoal_status (*read)(void* context, void* data, uint64_t bytes);
} shoal_stream;

enum {
  // run is called once, on the main thread, with all particles as one chunk
  SHOAL_OPERATOR_SERIAL = 1u << 0,
  // scheduled only if an output, a probe or another operator reads one of the fields that it writes
  SHOAL_OPERATOR_ON_DEMAND = 1u << 1,
  // time_step looks at the particles of a chunk; else it is called once, with an empty chunk
  SHOAL_OPERATOR_TIME_STEP_OF_PARTICLES = 1u << 2
};

// Particles that leave the operator's body and particles that join it (since 1.2). The arrays are the operator's and
// stay until its next call.
typedef struct shoal_exchange {
  uint32_t size;
  uint32_t reserved;
  uint64_t n_leaving;
  const uint64_t* leaving;  // owned particles, ascending
  uint64_t n_joining;
  // [n_joining] owned particles, leaving or not, of which they start as copies; UINT64_MAX: of none. NULL: of none all
  const uint64_t* sources;
} shoal_exchange;

// An operator on one body, possibly with neighbours in this and other bodies. Any callback but `run` may be NULL.
typedef struct shoal_operator {
  uint32_t size;
  uint32_t flags;    // SHOAL_OPERATOR_*
  const char* name;  // e.g. "fluid.viscous_force"
  uint32_t body;
  uint32_t n_accesses;
  const shoal_access* accesses;
  uint32_t n_relations;
  uint32_t n_reductions;
  const shoal_relation_request* relations;
  const uint32_t* reductions;  // shoal_reduction
  void* self;
  void (*destroy)(void* self);  // [main]
  // Called before the first run and whenever arrays have moved.                               // [main]
  shoal_status (*bind)(void* self, const shoal_binding* binding);
  shoal_status (*begin)(void* self, const shoal_step* step);                          // [main]
  shoal_status (*run)(void* self, const shoal_step* step, const shoal_chunk* chunk);  // [worker]
  // After all chunks; results are the reductions in the order of `reductions`.                // [main]
  shoal_status (*end)(void* self, const shoal_step* step, const double* results);
  // Largest stable step of the loop that the operator is attached to, in s.                   // [worker]
  double (*time_step)(void* self, const shoal_step* step, const shoal_chunk* chunk);
  shoal_status (*save)(void* self, const shoal_stream* stream);  // [main]
  shoal_status (*load)(void* self, const shoal_stream* stream);  // [main]
  // Since 1.1
  uint32_t bytes_per_pair;  // that the operator keeps beside its neighbour lists, for `shoal plan`
  uint32_t
      bytes_per_particle;  // of its neighbours' bodies, apart from fields and what it keeps of pairs (since 1.3)
  // Since 1.2
  // Called whenever neighbours are about to be renewed in a step, in the order of attachment: fills in which particles
  // leave the operator's body and which join it. Neighbour lists are those of the last step. `step` is that of the loop
  // that renews neighbours, before it has a size: dt is that of its last step.                  // [main]
  shoal_status (*exchange)(void* self, const shoal_step* step, shoal_exchange* exchange);
  // The particles that join are begin <= i < end; called after bind, and not if none joins. Fields of those that copy
  // none are zero, but for the volume (spacing^D); those that this call leaves to them get the initial values of the case,
  // as long as the operator does not name them as written. NULL if there is nothing to fill in. // [main]
  shoal_status (*fill)(void* self, const shoal_step* step, uint64_t begin, uint64_t end);
  // What the user should know of the run so far, in one line: writes at most `size` bytes with the final 0 to `text`, an
  // empty one if there is nothing to say. Shown at the end of a run and kept in its summary; NULL: never anything.
  void (*remark)(void* self, char* text, uint64_t size);  // [main]
  // Since 1.3
  // Called after `begin` with all chunks, before the first of them is run: for what an operator derives of its fields
  // before it reads it of neighbours.                                                                // [worker]
  shoal_status (*prepare)(void* self, const shoal_step* step, const shoal_chunk* chunk);
} shoal_operator;

// ---------------------------------------------------------------------------------------------------------------
// The builder: how physics say what a run consists of. All functions are [main].

typedef struct shoal_body {
  uint32_t size;
  uint32_t index;
  const char* name;
  uint64_t n_particles;          // owned, at the time of the call
  double spacing;                // initial distance of the particles, m
  double smoothing_length;       // m
  double cutoff;                 // radius of the smoothing kernel's support, m
  const char* smoothing_kernel;  // name, see shoal/smoothing_kernel.hpp
  const shoal_object* material;  // NULL if the body has none
  double lower[3], upper[3];     // bounds of the initial particles, m
} shoal_body;

typedef struct shoal_context shoal_context;  // opaque: the kernel's own

// Stages outside the loops, to be given as loop name to attach.
#define SHOAL_INITIAL "initial"  // once before the first step; not after a restart
#define SHOAL_SAMPLE "sample"    // before outputs and probes, when one is due

typedef struct shoal_builder {
  uint32_t size;
  int32_t dimensions;
  shoal_context* context;
  uint32_t n_bodies;
  uint32_t reserved;
  const shoal_body* bodies;
  double gravity[3];          // m/s2
  double end_time;            // s
  double lower[3], upper[3];  // the domain, m; infinite where it is open
  uint32_t periodic[3];       // 1 where the domain repeats
  uint32_t reserved_2;
  // Declares loop `name` with its stages in order, or adds stages to an existing one. At the top if `parent` is
  // NULL, else inside stage `parent_stage` of `parent`, where it sub-cycles to cover the parent's step. A later
  // call with a parent moves a top loop into it (how couplings nest the loops of others).
  shoal_status (*loop)(shoal_context*, const char* name, const char* parent, const char* parent_stage,
                       uint32_t n_stages, const char* const* stages);
  // Neighbour lists in the current configuration are renewed at the beginning of each step of this loop.
  shoal_status (*renew_neighbours_in)(shoal_context*, const char* loop);
  // Attaches an operator; the kernel copies the struct and owns `self` from here on (also if it fails).
  // loop NULL: the stage in which the field that it accumulates to is owned. Operators of one stage run in the
  // order in which they were attached.
  shoal_status (*attach)(shoal_context*, const char* loop, const char* stage, const shoal_operator* op);
  // The caller owns a field: others may accumulate to it, and it is set to zero at the beginning of this stage.
  shoal_status (*own_field)(shoal_context*, uint32_t body, const char* field, const char* loop,
                            const char* stage);
  // The run stops with SHOAL_PHYSICS_FAILED when a component leaves [minimum, maximum] or is NaN.
  shoal_status (*guard)(shoal_context*, uint32_t body, const char* field, double minimum, double maximum);
  // A C interface (shoal/interfaces/) of a body's material: the struct of functions and its `self`; *api is NULL
  // if the material does not offer it in this revision.
  shoal_status (*material_interface)(shoal_context*, uint32_t body, const char* name, uint32_t revision,
                                     const void** api, void** self);
  // Particles of the body are re-sorted along cells as they move (1), or keep their initial order (0, default).
  shoal_status (*body_moves)(shoal_context*, uint32_t body, uint32_t moves);
  // A line for `shoal plan`, e.g. the sound speed that was chosen and why.
  void (*note)(shoal_context*, const char* text);
} shoal_builder;

// ---------------------------------------------------------------------------------------------------------------
// What a plugin registers

// SHOAL_TYPE_PHYSICS and SHOAL_TYPE_OPERATOR. [main]
typedef struct shoal_physics_api {
  uint32_t size;
  uint32_t reserved;
  // Reads the values of `object`, declares loops, fields and operators.
  shoal_status (*build)(const shoal_object* object, const shoal_builder* builder);
} shoal_physics_api;

// SHOAL_TYPE_MATERIAL. [main] unless the interface says otherwise.
typedef struct shoal_material_api {
  uint32_t size;
  uint32_t reserved;
  shoal_status (*create)(const shoal_object* object, int32_t dimensions, void** self);
  void (*destroy)(void* self);
  const void* (*interface)(void* self, const char* name, uint32_t revision);  // NULL if not offered
} shoal_material_api;

// SHOAL_TYPE_SHAPE. Points are always three numbers. [main]
typedef struct shoal_shape_api {
  uint32_t size;
  uint32_t reserved;
  shoal_status (*create)(const shoal_object* object, int32_t dimensions, void** self);
  void (*destroy)(void* self);
  // Signed distance to the surface, negative inside. [any]
  shoal_status (*distance)(void* self, uint64_t n, const double* points, double* distances);
  void (*bounds)(void* self, double lower[3], double upper[3]);
} shoal_shape_api;

typedef struct shoal_snapshot_field {
  uint32_t size;
  uint32_t rank;  // shoal_rank
  uint32_t data_type;
  uint32_t components;
  const char* name;
  const char* unit;
  const void* data;  // components interleaved, owned particles
} shoal_snapshot_field;

typedef struct shoal_snapshot_body {
  uint32_t size;
  uint32_t n_fields;
  const char* name;
  uint64_t n_particles;
  const double* position;  // interleaved, D per particle
  const int64_t* id;
  const shoal_snapshot_field* fields;  // the same names, ranks and order in every snapshot of a run
} shoal_snapshot_body;

typedef struct shoal_snapshot {
  uint32_t size;
  int32_t dimensions;
  double time;
  uint64_t step;      // number of outer steps
  uint64_t sequence;  // 0, 1, 2, ... for each output
  uint32_t n_bodies;
  uint32_t reserved;
  const shoal_snapshot_body* bodies;
} shoal_snapshot;

// SHOAL_TYPE_OUTPUT. The kernel reads the parameters `every`, `at` (times), `bodies` and `fields`, if the type has
// them, to decide when to call write and with what; the rest is the output's own. [main]
typedef struct shoal_output_api {
  uint32_t size;
  uint32_t reserved;
  // `resumed_sequence` is the sequence number of the next snapshot: 0, or more after a restart, when files of
  // later snapshots of the interrupted run must be forgotten.
  shoal_status (*create)(const shoal_object* object, const char* folder, const char* title,
                         uint64_t resumed_sequence, void** self);
  void (*destroy)(void* self);
  // Writes are atomic: a reader, or a kill, never sees half a file.
  shoal_status (*write)(void* self, const shoal_snapshot* snapshot);
} shoal_output_api;

// SHOAL_TYPE_PROBE: named numbers from a snapshot, e.g. one row of a CSV file. [main]
typedef struct shoal_probe_api {
  uint32_t size;
  uint32_t reserved;
  shoal_status (*create)(const shoal_object* object, int32_t dimensions, void** self);
  void (*destroy)(void* self);
  // Names and units of the numbers, and the fields that the snapshot must hold.
  uint32_t (*columns)(void* self, const char* const** names, const char* const** units);
  uint32_t (*fields)(void* self, const char* const** bodies, const char* const** fields);
  shoal_status (*sample)(void* self, const shoal_snapshot* snapshot, double* values);
} shoal_probe_api;

struct shoal_type {
  uint32_t size;
  uint32_t kind;       // shoal_type_kind
  const char* name;    // "plugin.type"
  const char* doc;     // what it models, when to take it
  const char* source;  // paper, or NULL
  uint32_t n_parameters;
  uint32_t reserved;
  const shoal_parameter* parameters;
  const void* api;  // shoal_physics_api, shoal_material_api, ... according to kind
};

typedef struct shoal_requirement {
  uint32_t size;
  uint32_t reserved;
  const char* id;
  const char* minimum_version;  // "1.2.0" or NULL
  const char* below_version;    // first version that no longer serves, or NULL
} shoal_requirement;

typedef struct shoal_plugin {
  uint32_t size;
  uint32_t n_requirements;
  const char* id;        // "fluid": the first part of its types' names
  const char* version;   // "1.2.3"
  const char* licence;   // SPDX expression
  const char* summary;   // one line
  const char* citation;  // or NULL
  const shoal_requirement* requirements;
  uint32_t n_types;
  uint32_t reserved;
  const shoal_type* const* types;
} shoal_plugin;

// ---------------------------------------------------------------------------------------------------------------
// The host: what the kernel offers everywhere.

enum { SHOAL_LOG_DEBUG = 0, SHOAL_LOG_INFO = 1, SHOAL_LOG_WARNING = 2, SHOAL_LOG_ERROR = 3 };

typedef struct shoal_host {
  uint32_t size;
  uint32_t abi_major;
  uint32_t abi_minor;
  uint32_t isa;                                   // what this machine has
  const char* version;                            // of Shoal
  void (*log)(uint32_t level, const char* text);  // [any]
  // Says why the callback is about to return a status other than SHOAL_OK.      // [any]
  void (*fail)(const char* text);
  // out[k] at the k-th point (D interleaved coordinates) and time t.            // [any]
  shoal_status (*evaluate)(const shoal_expression* expression, int32_t dimensions, uint64_t n,
                           const double* position, double t, double* out);
  // Of a parameter with SHOAL_PARAMETER_NAMES: the k-th name that the expression uses and the case does not know; NULL
  // behind the last.                                                            // [any]
  const char* (*expression_name)(const shoal_expression* expression, uint32_t k);
  // As evaluate, with columns[k][i] the value of name k at point i.             // [any]
  shoal_status (*evaluate_names)(const shoal_expression* expression, int32_t dimensions, uint64_t n,
                                 const double* position, const double* const* columns, double t, double* out);
  // The run has come to what it is for, e.g. to rest: it ends behind this outer step, with all outputs and probes
  // sampled once more, as it would at the end that the case names. `reason` is said to the user.   // [any]
  void (*finish)(const char* reason);
} shoal_host;

// Exported by each plugin as `shoal_plugin_entry`; called once, after the stamp was accepted. The host outlives the
// plugin. Returns NULL on failure. [main]
typedef const shoal_plugin* (*shoal_plugin_entry_function)(const shoal_host* host);

#define SHOAL_STAMP_SYMBOL "shoal_plugin_stamp"
#define SHOAL_ENTRY_SYMBOL "shoal_plugin_entry"

#ifdef __cplusplus
}
#endif
