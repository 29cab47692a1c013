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

#include "kernels/scalars.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {
namespace {

/// How many ways there are to write an instruction: where its operands come from, and their order.
constexpr int kForms = 8;
constexpr int kFormFlags = Instruction::kLoads | Instruction::kSwapped | Instruction::kImmediate;
static_assert(kFormFlags == kForms - 1);

HWY_INLINE int form_of(const Instruction& in) { return in.op * kForms + (in.flags & kFormFlags); }

/// What instructions jump to, in order of number.
struct Leaf {
  int number = 0;
  int weight = 0;  ///< how often, roughly
};
template <class Declared>
constexpr int weight_of(int form) {
  if constexpr (Declared::kDeclaration.kind != OpKind::scalar) {
    return 0;
  } else if (Declared::kOperands == 0 || Declared::kCallsFunction) {
    return 1;
  } else {
    // What commutes is written swapped.
    const bool is_rare = requires { Declared::kCommutes; }
    &&(form & Instruction::kSwapped) == 0;
    return is_rare ? 1 : 16;
  }
}
template <class Declared>
constexpr int forms_of() {
  if constexpr (Declared::kDeclaration.kind != OpKind::scalar) {
    return 0;
  } else {
    return Declared::kOperands == 0 ? 1 : Declared::kOperands == 1 ? Instruction::kLoads + 1 : kForms;
  }
}
template <int... I>
constexpr int count_leaves(std::integer_sequence<int, I...>) {
  return (forms_of<Op<I>>() + ...);
}
using EachOp = std::make_integer_sequence<int, kOpCount>;
inline constexpr auto kLeaves = []<int... I>(std::integer_sequence<int, I...> all) {
  std::array<Leaf, static_cast<size_t>(count_leaves(all))> leaves{};
  size_t made = 0;
  const auto add = [&]<int Number>() {
    for (int form = 0; form < forms_of<Op<Number>>(); ++form) {
      leaves[made++] = {Number * kForms + form, weight_of<Op<Number>>(form)};
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

/// The operand that is not the accumulator, `lane` lanes into the chunk.
template <class T>
HWY_INLINE T other_operand(Memory m, const Instruction& in, bool is_immediate, size_t lane) {
  if (is_immediate) return Make<T>::set(m.pool[in.constants]);
  return Make<T>::load(m.registers + in.operand * lanes_of<ScalarChunk>() + lane);
}

/// An op that calls a function, vector by vector: calls would push a chunk out of its registers.
template <class Declared>
HWY_NOINLINE void call_by_vectors(Memory m, const Instruction& in, float* acc) {
  for (size_t i = 0; i < lanes_of<ScalarChunk>(); i += lanes_of<Pack<1>>()) {
    const auto a = Make<Pack<1>>::load(acc + i);
    if constexpr (Declared::kOperands == 1) {
      store(applied<Declared>(a), acc + i);
    } else {
      const auto b = other_operand<Pack<1>>(m, in, (in.flags & Instruction::kImmediate) != 0, i);
      const bool swapped = (in.flags & Instruction::kSwapped) != 0;
      store(swapped ? applied<Declared>(a, b) : applied<Declared>(b, a), acc + i);
    }
  }
}

template <class Declared>
HWY_INLINE ScalarChunk leaf_of(Memory m, const Instruction& in) {
  const auto d = static_cast<size_t>(m.dimension);
  const auto* const at = m.positions + in.operand * d * lanes_of<ScalarChunk>();
  const Constants<ScalarChunk> c{m.pool + in.constants, in.constant_count};
  return m.dimension == 2 ? Declared::leaf(load_point<ScalarChunk, 2>(at), c).value
                          : Declared::leaf(load_point<ScalarChunk, 3>(at), c).value;
}

template <class Declared, int kForm>
HWY_INLINE void execute(Memory m, const Instruction& in, ScalarChunk& acc) {
  if constexpr ((kForm & Instruction::kLoads) != 0) {
    acc = Make<ScalarChunk>::load(m.registers + in.first * lanes_of<ScalarChunk>());
  }
  if constexpr (Declared::kOperands == 0) {
    acc = leaf_of<Declared>(m, in);
  } else if constexpr (Declared::kCallsFunction) {
    HWY_ALIGN float memory[kMostChunkLanes];
    store(acc, memory);
    call_by_vectors<Declared>(m, in, memory);
    acc = Make<ScalarChunk>::load(memory);
  } else if constexpr (Declared::kOperands == 1) {
    acc = applied<Declared>(acc);
  } else {
    const auto other = other_operand<ScalarChunk>(m, in, (kForm & Instruction::kImmediate) != 0, 0);
    acc = (kForm & Instruction::kSwapped) != 0 ? applied<Declared>(acc, other) : applied<Declared>(other, acc);
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

void run_scalars(const ScalarMachine& machine, int dimension, float* value) {
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
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();
