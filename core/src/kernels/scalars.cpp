// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A scalar instruction is so short that finding the next one costs more than it does itself. So a chunk is twice as
// wide as elsewhere; an instruction is taken to code that knows where its operand comes from and whether its result is
// kept; and it is taken there by comparisons, the frequent ops behind the fewest: processors foresee them over programs
// of thousands of instructions, where they lose track of a jump through a table. The bits are those of the machine of
// interpreter.inl.
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
    const bool changes_first = has(form, Instruction::kChangesFirst),
               changes_other = has(form, Instruction::kChangesOther);
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
/// The accumulator, or what is read in its place.
template <int kForm>
HWY_INLINE Pack<1> first_operand(Memory m, const Instruction& in, Pack<1> acc, size_t lane) {
  if constexpr (!has(kForm, Instruction::kLoads)) return acc;
  const float* const r = m.registers + in.first * lanes_of<ScalarChunk>() + lane;
  return taken<has(kForm, Instruction::kAffineFirst), has(kForm, Instruction::kSquaredFirst)>(
      r, m.pool + in.constants + 2);
}
template <int kForm>
HWY_INLINE Pack<1> other_operand(Memory m, const Instruction& in, size_t lane) {
  const float* const c = m.pool + in.constants;
  if constexpr (has(kForm, Instruction::kImmediate)) return Make<Pack<1>>::set(c[0]);
  const float* const r = m.registers + in.operand * lanes_of<ScalarChunk>() + lane;
  return taken<has(kForm, Instruction::kAffineOther), has(kForm, Instruction::kSquaredOther)>(r, c);
}

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
HWY_INLINE Pack<1> result(Memory m, const Instruction& in, Pack<1> acc, size_t lane) {
  const auto first = first_operand<kForm>(m, in, acc, lane);
  if constexpr (Declared::kOperands == 1) {
    return applied<Declared>(first);
  } else {
    const auto other = other_operand<kForm>(m, in, lane);
    return has(kForm, Instruction::kSwapped) ? applied<Declared>(first, other) : applied<Declared>(other, first);
  }
}
template <class Declared, int kForm, int W>
HWY_INLINE Pack<W> result(Memory m, const Instruction& in, Pack<W> acc, size_t lane) {
  return {result<Declared, kForm>(m, in, acc.lo, lane),
          result<Declared, kForm>(m, in, acc.hi, lane + lanes_of<Pack<W / 2>>())};
}

/// An op that calls a function, which would push a chunk out of its registers.
template <class Declared, int kForm>
HWY_NOINLINE void call_by_vectors(Memory m, const Instruction& in, float* acc) {
  for (size_t lane = 0; lane < lanes_of<ScalarChunk>(); lane += lanes_of<Pack<1>>()) {
    store(result<Declared, kForm>(m, in, Make<Pack<1>>::load(acc + lane), lane), acc + lane);
  }
}

template <class Declared, int kForm>
HWY_INLINE void execute(Memory m, const Instruction& in, ScalarChunk& acc) {
  if constexpr (Declared::kOperands == 0) {
    acc = leaf_of<Declared>(m, in);
  } else if constexpr (Declared::kCallsFunction) {
    HWY_ALIGN float memory[kMostChunkLanes];
    store(acc, memory);
    call_by_vectors<Declared, kForm>(m, in, memory);
    acc = Make<ScalarChunk>::load(memory);
  } else {
    acc = result<Declared, kForm>(m, in, acc, 0);
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

}  // namespace

ScalarMachine value_machine(const Tape& tape, float* scratch) {
  ScalarMachine m = tape.dimension == 2 ? machine_for<ValueMode<ScalarChunk, 2>>(tape, scratch)
                                        : machine_for<ValueMode<ScalarChunk, 3>>(tape, scratch);
  if (tape.values.instructions.empty()) return m;
  m.instructions = tape.values.instructions.data();
  m.instruction_count = tape.values.instructions.size();
  m.pool = tape.values.constants.data();
  m.registers = m.positions;
  return m;
}

bool run_scalars(const ScalarMachine& machine, int dimension, float* value) {
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
  store(acc, value);
  return all_numbers(acc);
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();
