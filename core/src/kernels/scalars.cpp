// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A scalar instruction is so short that finding the next one costs more than it does itself. So a chunk is twice as
// wide as elsewhere; an instruction is taken to code that knows where its operands come from and how it takes them
// (compile/fuse.cpp); and it is taken there by comparisons, the frequent ops behind the fewest: processors foresee them
// over programs of thousands of instructions, where they lose track of a jump through a table. The bits are those of
// the machine of interpreter.inl.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/scalars.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come first
#include <hwy/highway.h>

#include <array>

#include "kernels/rows.inl"
#include "kernels/scalars.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {
namespace {

/// The ways to write an instruction: where its operands come from, and their order.
constexpr int kForms = 128;
constexpr bool has(int form, std::uint8_t flag) { return (form & flag) != 0; }

HWY_INLINE int form_of(const Instruction& in) { return in.op * kForms + (in.flags & (kForms - 1)); }

/// Whether instructions of this op may be written so: registers alone are changed, and for brief ops.
template <class Declared>
constexpr bool is_form(int form) {
  if constexpr (Declared::kDeclaration.kind != OpKind::scalar) {
    return false;
  } else {
    const bool changes_first = has(form, Instruction::kChangesFirst);
    const bool changes_other = has(form, Instruction::kChangesOther);
    const bool squares = has(form, Instruction::kSquaredFirst | Instruction::kSquaredOther);
    if (Declared::kOperands == 0) return form == 0;
    if (Declared::kOperands == 1 && (form & ~(Instruction::kLoads | Instruction::kChangesFirst)) != 0) return false;
    if (changes_first && !has(form, Instruction::kLoads)) return false;
    if (changes_other && has(form, Instruction::kImmediate)) return false;
    if ((changes_first || changes_other) && !Declared::kIsBrief) return false;
    if (squares && !Declared::kTakesSquares) return false;
    // What commutes is written swapped.
    return has(form, Instruction::kSwapped) || !requires { Declared::kCommutes; };
  }
}

/// What instructions jump to, in order of number.
struct Leaf {
  int number = 0;
  int weight = 0;  ///< how often, roughly
};
template <class Declared>
constexpr int weight_of() {
  if constexpr (Declared::kDeclaration.kind != OpKind::scalar) {
    return 0;
  } else {
    return Declared::kOperands == 0 || Declared::kCallsFunction ? 1 : 16;
  }
}
template <int... I>
constexpr size_t count_leaves(std::integer_sequence<int, I...>) {
  size_t count = 0;
  for (int form = 0; form < kForms; ++form) count += (size_t{is_form<Op<I>>(form)} + ...);
  return count;
}
using EachOp = std::make_integer_sequence<int, kOpCount>;
inline constexpr auto kLeaves = []<int... I>(std::integer_sequence<int, I...> all) {
  std::array<Leaf, count_leaves(all)> leaves{};
  size_t made = 0;
  const auto add = [&]<int Number>() {
    for (int form = 0; form < kForms; ++form) {
      if (is_form<Op<Number>>(form)) leaves[made++] = {Number * kForms + form, weight_of<Op<Number>>()};
    }
  };
  (add.template operator()<I>(), ...);
  return leaves;
}
(EachOp());

/// Where [first, last) is cut so that both sides are met equally often.
constexpr size_t cut_of(size_t first, size_t last) {
  int all = 0;
  for (size_t i = first; i < last; ++i) all += kLeaves[i].weight;
  size_t cut = first + 1;
  for (int left = kLeaves[first].weight; cut + 1 < last && 2 * (left + kLeaves[cut].weight) <= all; ++cut) {
    left += kLeaves[cut].weight;
  }
  return cut;
}

template <class Declared, class T>
HWY_INLINE T applied(T a) {
  return Declared::apply(Field<T, 2>{a, {}}).value;
}
template <class Declared, class T>
HWY_INLINE T applied(T a, T b) {
  return Declared::apply(Field<T, 2>{a, {}}, Field<T, 2>{b, {}}).value;
}

/// What instructions look into; by value, so that the compiler knows it for their own.
struct Memory {
  float* registers;
  const float* positions;
  const float* pool;
  int dimension;
};

/// A register as an instruction of that form takes it; a vector. `c` has w and c.
template <bool kAffine, bool kSquared>
HWY_INLINE Pack<1> taken(const float* r, const float* c) {
  auto a = Make<Pack<1>>::load(r);
  if constexpr (kAffine) a = mul_add(Make<Pack<1>>::set(c[0]), a, Make<Pack<1>>::set(c[1]));
  if constexpr (kSquared) a = a * a;
  return a;
}

/// Where an instruction finds its operands, one vector of the chunk after the other.
struct Operands {
  const float* first;
  const float* other;
  const float* constants;

  Operands(Memory m, const Instruction& in)
      : first(m.registers + in.first * lanes_of<ScalarChunk>()),
        other(m.registers + in.operand * lanes_of<ScalarChunk>()),
        constants(m.pool + in.constants) {}

  /// The accumulator, or what is read in its place.
  template <int kForm>
  HWY_INLINE Pack<1> first_at(size_t lane, Pack<1> acc) const {
    if constexpr (!has(kForm, Instruction::kLoads)) return acc;
    return taken<has(kForm, Instruction::kAffineFirst), has(kForm, Instruction::kSquaredFirst)>(first + lane,
                                                                                                constants + 2);
  }
  template <int kForm>
  HWY_INLINE Pack<1> other_at(size_t lane) const {
    if constexpr (has(kForm, Instruction::kImmediate)) return Make<Pack<1>>::set(constants[0]);
    return taken<has(kForm, Instruction::kAffineOther), has(kForm, Instruction::kSquaredOther)>(other + lane,
                                                                                                constants);
  }
};

template <class Declared>
HWY_INLINE ScalarChunk leaf_of(Memory m, const Instruction& in) {
  const Constants<ScalarChunk> c{m.pool + in.constants, in.constant_count};
  if constexpr (Declared::kDeclaration.dimension != 3) {
    if (m.dimension == 2) return Declared::leaf(load_point<ScalarChunk, 2>(m.positions), c).value;
  }
  return Declared::leaf(load_point<ScalarChunk, 3>(m.positions), c).value;
}

/// Vector after vector, so that operands stay in the machine's registers where it has few.
template <class Declared, int kForm>
HWY_INLINE Pack<1> result(Operands of, Pack<1> acc, size_t lane) {
  const auto first = of.first_at<kForm>(lane, acc);
  if constexpr (Declared::kOperands == 1) {
    return applied<Declared>(first);
  } else {
    const auto other = of.other_at<kForm>(lane);
    return has(kForm, Instruction::kSwapped) ? applied<Declared>(first, other) : applied<Declared>(other, first);
  }
}
template <class Declared, int kForm, int W>
HWY_INLINE Pack<W> result(Operands of, Pack<W> acc, size_t lane) {
  return {result<Declared, kForm>(of, acc.lo, lane),
          result<Declared, kForm>(of, acc.hi, lane + lanes_of<Pack<W / 2>>())};
}

/// An op that calls a function, which would push a chunk out of its registers.
template <class Declared, int kForm>
HWY_NOINLINE void call_by_vectors(Operands of, float* acc) {
  for (size_t lane = 0; lane < lanes_of<ScalarChunk>(); lane += lanes_of<Pack<1>>()) {
    store(result<Declared, kForm>(of, Make<Pack<1>>::load(acc + lane), lane), acc + lane);
  }
}

template <class Declared, int kForm>
HWY_INLINE void execute(Memory m, const Instruction& in, ScalarChunk& acc) {
  if constexpr (Declared::kOperands == 0) {
    acc = leaf_of<Declared>(m, in);
  } else if constexpr (Declared::kCallsFunction) {
    HWY_ALIGN float memory[kMostChunkLanes];
    store(acc, memory);
    call_by_vectors<Declared, kForm>({m, in}, memory);
    acc = Make<ScalarChunk>::load(memory);
  } else {
    acc = result<Declared, kForm>(Operands{m, in}, acc, 0);
  }
}

/// Finds the instruction among kLeaves[kFirst] to [kLast - 1].
template <size_t kFirst, size_t kLast>
HWY_INLINE void find_and_execute(int form, Memory m, const Instruction& in, ScalarChunk& acc) {
  if constexpr (kLast - kFirst == 1) {
    constexpr int kNumber = kLeaves[kFirst].number;
    execute<Op<kNumber / kForms>, kNumber % kForms>(m, in, acc);
  } else {
    constexpr size_t kCut = cut_of(kFirst, kLast);
    if (form < kLeaves[kCut].number) {
      find_and_execute<kFirst, kCut>(form, m, in, acc);
    } else {
      find_and_execute<kCut, kLast>(form, m, in, acc);
    }
  }
}

/// For the value program, where the tape has one.
ScalarMachine machine_of(const Tape& tape, float* scratch) {
  ScalarMachine m = tape.dimension == 2 ? machine_for<ValueMode<ScalarChunk, 2>>(tape, scratch)
                                        : machine_for<ValueMode<ScalarChunk, 3>>(tape, scratch);
  if (tape.values.instructions.empty()) return m;
  m.instructions = tape.values.instructions.data();
  m.instruction_count = tape.values.instructions.size();
  m.pool = tape.values.constants.data();
  m.registers = m.positions;
  return m;
}

/// Runs the program over one chunk whose points are at position 0.
HWY_INLINE ScalarChunk run(const ScalarMachine& machine, int dimension) {
  ScalarChunk acc{};
  const size_t lanes = lanes_of<ScalarChunk>();
  const Memory m{machine.registers, machine.positions, machine.pool, dimension};
  const Instruction* const end = machine.instructions + machine.instruction_count;
  for (const Instruction* in = machine.instructions; in != end; ++in) {
    if (in->op >= Instruction::kKeep) {
      if (in->op == Instruction::kLoad) acc = Make<ScalarChunk>::load(m.registers + in->operand * lanes);
    } else {
      find_and_execute<0, kLeaves.size()>(form_of(*in), m, *in, acc);
    }
    if (in->target != Instruction::kNone) store(acc, m.registers + in->target * lanes);
  }
  return acc;
}

template <int D>
RowColumns<ScalarChunk, D> rows_of(const ScalarBatch& batch) {
  return {batch.rows, batch.count, batch.value, nullptr, true};
}

/// Stores the next chunk of points at a machine's position 0. Whether all can be answered.
HWY_INLINE bool take(const ScalarBatch& batch, size_t dimension, float* position) {
  if (batch.rows != nullptr) {
    return dimension == 2 ? rows_of<2>(batch).take(batch.done, position) : rows_of<3>(batch).take(batch.done, position);
  }
  for (size_t axis = 0; axis < dimension; ++axis) {
    store(Make<ScalarChunk>::load(batch.columns[axis] + batch.done), position + axis * lanes_of<ScalarChunk>());
  }
  return true;
}

/// Of a chunk that is not whole, or has rows that cannot be answered.
template <int D>
HWY_NOINLINE void give_some(ScalarBatch& batch, bool all_good, const float* f) {
  auto rows = rows_of<D>(batch);
  rows.give(batch.done, all_good, Make<ScalarChunk>::load(f));
  batch.bad_rows += rows.bad_rows;
}

HWY_INLINE void give(ScalarBatch& batch, size_t dimension, bool all_good, ScalarChunk f) {
  const bool is_whole = batch.value != nullptr && batch.done + lanes_of<ScalarChunk>() <= batch.count;
  if (batch.rows == nullptr || HWY_LIKELY(is_whole && all_good && all_numbers(f))) {
    store(f, batch.value + batch.done);
    return;
  }
  HWY_ALIGN float memory[kMostChunkLanes];
  store(f, memory);
  dimension == 2 ? give_some<2>(batch, all_good, memory) : give_some<3>(batch, all_good, memory);
}

}  // namespace

void run_scalars(const Tape& tape, ScalarBatch& batch, float* scratch) {
  const ScalarMachine m = machine_of(tape, scratch);
  const auto dimension = static_cast<size_t>(tape.dimension);
  const size_t lanes = lanes_of<ScalarChunk>();
  for (; batch.done + lanes / 2 < batch.count; batch.done += lanes) {
    const bool all_good = take(batch, dimension, m.positions);
    give(batch, dimension, all_good, run(m, tape.dimension));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();
