// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Which instructions can decide the value over a region, many regions at once: one pass backwards over the tape
// carries, for the accumulator and each register, the range of values that matter to what comes later. Of min(a, b)
// < c only values below c do. An operand whose interval lies outside of what can matter is not needed, nor is then
// what only it needed.
//
// Why the bits stay. Say only values of min(a, b) up to C matter, and b > C all over the region. Where a <= C the
// result is a with or without b; elsewhere it is above C with or without b. A blend of width w is exact where its
// operands are further apart than w and lowers the result by w / 4 at the most: with b > C + 2w, either a <= C + w and
// the result is a, or it is above C both times. Maxima mirror this. A range of one number asks for the side of it
// alone.
//
// Bounds over cells no larger than the gap have their ends within the gap of the value at the centre, lower ends below
// it and upper ones above. Where values up to C matter so do lower ends up to C and upper ends up to C + gap, and each
// choice cuts the three alike: b > C + gap leaves b out of all, and the gap is not added again further down.
//
// Pieces of one region share a tape. What one of them needs is kept for all; of an operand that they could do without,
// the others then ask what they would of one that they need: to be right up to C, and above C beyond. Where both
// operands lie above C a piece asks for neither of them, since either will do.
//
// At the root the caller says what matters.
// Included once per SIMD target.
#if defined(THALWEG_KERNELS_RELEVANCE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_KERNELS_RELEVANCE_INL
#undef THALWEG_KERNELS_RELEVANCE_INL
#else
#define THALWEG_KERNELS_RELEVANCE_INL
#endif

#include <array>
#include <cstring>
#include <limits>

#include "kernels/interpreter.inl"
#include "kernels/regions.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// What the pass asks of an op.
enum class Part : uint8_t { move, leaf, whole, pair, guard, choice, load, keep };
struct Role {
  Part part = Part::leaf;
  bool greatest = false;      ///< of a choice
  bool second_falls = false;  ///< of a choice
  bool blends = false;        ///< of a choice
};

template <class Declared>
consteval Role role_of() {
  constexpr OpKind kKind = Declared::kDeclaration.kind;
  if constexpr (kMovesPosition<Declared>) {
    return {.part = Part::move};
  } else if constexpr (kKind == OpKind::combine) {
    return {.part = Part::choice,
            .greatest = Declared::kSelection == Selection::greatest,
            .second_falls = Declared::kTrend[1] < 0,
            .blends = Declared::kBlends};
  } else if constexpr (kKind == OpKind::scalar) {
    if constexpr (requires { Declared::kSelection; }) {
      return {.part = Part::choice, .greatest = Declared::kSelection == Selection::greatest};
    } else if constexpr (requires { Declared::kInternal; }) {
      return {.part = Part::guard};
    } else {
      return {.part = Declared::kOperands == 0 ? Part::leaf : Declared::kOperands == 1 ? Part::whole : Part::pair};
    }
  } else {
    return {.part = kKind == OpKind::map ? Part::whole : Part::leaf};
  }
}

inline constexpr auto kRoles = []<int... I>(std::integer_sequence<int, I...>) {
  return std::array<Role, kOpCount>{role_of<Op<I>>()...};
}
(std::make_integer_sequence<int, kOpCount>());

HWY_INLINE Role role_of(const Instruction& in) {
  if (in.op < kOpCount) return kRoles[in.op];
  return {.part = in.op == Instruction::kLoad ? Part::load : Part::keep};
}

HWY_INLINE uint32_t bits_of(PackMask<1> m) {
  uint8_t bytes[8] = {};
  hn::StoreMaskBits(F32(), m.m, bytes);
  uint32_t bits;
  std::memcpy(&bits, bytes, sizeof bits);
  return bits;
}
template <int W>
HWY_INLINE uint32_t bits_of(PackMask<W> m) {
  return bits_of(m.lo) | bits_of(m.hi) << pack_lanes<W / 2>();
}

template <class T>
HWY_INLINE Interval<T> mirrored(Interval<T> a) {
  return {-a.hi, -a.lo};
}
template <class T>
HWY_INLINE Interval<T> hull(Interval<T> a, Interval<T> b) {
  return {min(a.lo, b.lo), max(a.hi, b.hi)};
}
/// The end points lie `apart` floats from each other.
template <class T>
HWY_INLINE Interval<T> load_interval(const float* from, size_t apart) {
  return {Make<T>::load(from), Make<T>::load(from + apart)};
}
template <class T>
HWY_INLINE void store_interval(Interval<T> a, float* to, size_t apart) {
  store(a.lo, to);
  store(a.hi, to + apart);
}
/// b without a.
template <int W>
HWY_INLINE PackMask<W> without(PackMask<W> b, PackMask<W> a) {
  return differ(b, both(a, b));
}
/// a + b for bounds from above: the sum and two roundings of it.
template <class T>
HWY_INLINE T add_up(T a, T b) {
  const T sum = a + b;
  return mul_add(min(abs(sum), Make<T>::set(3e38F)), Make<T>::set(0x1p-22F), sum);
}

/// The pass over one chunk of regions.
template <class T>
class Relevance {
 public:
  /// `record` ends with the operands of the last choice: intervals of both, as if for the least of two.
  Relevance(const Tape& tape, const RegionWork& work, const float* record_end, const RegionColumns& regions,
            size_t chunk)
      : tape_(tape),
        work_(work),
        record_(record_end),
        gap_(Make<T>::load(regions.gap + chunk * lanes_of<T>())),
        are_pieces_(regions.are_pieces),
        shift_(chunk * lanes_of<T>()),
        chunk_(chunk) {}

  HWY_INLINE void run(Interval<T> root) {
    accumulator_ = root;
    for (size_t i = tape_.instructions.size(); i-- > 0;) {
      const InstructionUse use = step(tape_.instructions[i]);
      InstructionUse& all = work_.use[i];
      if (chunk_ == 0) {
        all = use;
      } else {
        all.run |= use.run << shift_;
        all.stored |= use.stored << shift_;
        all.accumulator |= use.accumulator << shift_;
        all.operand |= use.operand << shift_;
      }
    }
    work_.positions[0] = 0;
  }

 private:
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();
  static HWY_INLINE Interval<T> nothing() { return {Make<T>::set(kInfinity), Make<T>::set(-kInfinity)}; }
  static HWY_INLINE Interval<T> everything() { return {Make<T>::set(-kInfinity), Make<T>::set(kInfinity)}; }
  template <class M>
  static HWY_INLINE Interval<T> where(M m, Interval<T> a) {
    return {select(m, a.lo, nothing().lo), select(m, a.hi, nothing().hi)};
  }

  HWY_INLINE float* range(uint16_t slot) const { return work_.ranges + slot * 2 * kRegionLanes; }
  HWY_INLINE void require(uint16_t slot, Interval<T> values) {
    const auto all = hull(load_interval<T>(range(slot), kRegionLanes), values);
    store_interval(all, range(slot), kRegionLanes);
  }

  /// A constant in place of a register needs nothing.
  static HWY_INLINE bool reads_register(const Instruction& in) { return (in.flags & Instruction::kImmediate) == 0; }
  static HWY_INLINE bool loads(const Instruction& in) { return (in.flags & Instruction::kLoads) != 0; }
  HWY_INLINE void require_operand(const Instruction& in, Interval<T> values) {
    if (reads_register(in)) require(in.operand, values);
  }

  HWY_INLINE InstructionUse step(const Instruction& in) {
    const Role role = role_of(in);
    InstructionUse use;
    if (role.part == Part::move) {
      use.run = use.stored = use.accumulator = use.operand = work_.positions[in.target];
      work_.positions[in.target] = 0;
      work_.positions[in.operand] |= use.run;
      return use;
    }
    if (role.part == Part::choice || role.part == Part::guard) record_ -= 4 * lanes_of<T>();
    Interval<T> matters = accumulator_;
    if (in.target != Instruction::kNone) {
      const auto stored = load_interval<T>(range(in.target), kRegionLanes);
      use.stored = bits_of(stored.lo <= stored.hi);
      if (use.stored != 0) store_interval(nothing(), range(in.target), kRegionLanes);
      matters = hull(matters, stored);
    }
    const auto live = matters.lo <= matters.hi;
    use.run = bits_of(live);
    if (use.run == 0) return use;
    const Interval<T> read_next = accumulator_;
    accumulator_ = nothing();
    switch (role.part) {
      case Part::choice:
        choose(in, role, live, matters, use);
        break;
      case Part::guard:
        guard(in, live, matters, use);
        break;
      case Part::pair:
        use.accumulator = use.operand = use.run;
        accumulator_ = where(live, everything());
        require_operand(in, accumulator_);
        break;
      case Part::keep:
        use.accumulator = use.run;
        accumulator_ = matters;
        break;
      case Part::load:
        use.operand = use.run;
        require(in.operand, where(live, matters));
        break;
      case Part::whole:
        use.accumulator = use.operand = use.run;
        accumulator_ = where(live, everything());
        break;
      default:
        use.accumulator = use.operand = use.run;
        work_.positions[in.operand] |= use.run;
    }
    if (role.part >= Part::guard) leave_out_idle(in, read_next, use);
    if (loads(in)) {
      require(in.first, accumulator_);
      accumulator_ = nothing();
    }
    return use;
  }

  /// What only keeps the accumulator runs where it stores it; what loads a register into itself, where the accumulator
  /// is read.
  HWY_INLINE void leave_out_idle(const Instruction& in, Interval<T> read_next, InstructionUse& use) const {
    const uint32_t read = bits_of(read_next.lo <= read_next.hi);
    if (!loads(in)) {
      use.run &= use.operand | use.stored;
    } else if (in.first == in.target) {
      use.run &= use.operand | read;
    }
    if (reads_register(in) && in.operand == in.target) use.run &= use.accumulator | read;
  }

  template <class M>
  static HWY_INLINE bool any(M m) {
    return bits_of(m) != 0;
  }
  template <class M>
  static HWY_INLINE M none(M m) {
    return differ(m, m);
  }

  template <class M>
  HWY_INLINE void choose(const Instruction& in, Role role, M live, Interval<T> matters, InstructionUse& use) {
    const auto first = load_interval<T>(record_, lanes_of<T>());
    const auto second = load_interval<T>(record_ + 2 * lanes_of<T>(), lanes_of<T>());
    if (role.greatest) matters = mirrored(matters);
    // Of an operand that may be undefined nothing is known: NaN in the first place of min gives way to the second.
    T first_most = min(second.hi, matters.hi);
    T second_most = min(first.hi, matters.hi);
    if (role.blends) {
      const T width = Make<T>::set(tape_.constants[in.constants]);
      const T most = add_up(matters.hi, width + width);
      first_most = min(add_up(second.hi, width), most);
      second_most = min(add_up(first.hi, width), most);
    }
    M needs_second = without(live, add_up(second_most, gap_) < second.lo);
    M needs_first = without(live, add_up(first_most, gap_) < first.lo);
    if (are_pieces_) {
      needs_second = any(needs_second) ? live : none(live);
      needs_first = any(needs_first) || !any(needs_second) ? live : none(live);
    } else {
      needs_first = either(needs_first, without(live, needs_second));
    }
    // Without the first operand a falling one would be left, which no load can negate.
    if (role.second_falls) needs_first = live;
    // Where what matters lies above all of the one operand, the other one still counts for its side of that.
    Interval<T> of_first = where(needs_first, {matters.lo, max(first_most, matters.lo)});
    Interval<T> of_second = where(needs_second, {matters.lo, max(second_most, matters.lo)});
    if (role.greatest) of_first = mirrored(of_first);
    if (role.greatest != role.second_falls) of_second = mirrored(of_second);
    const bool swapped = (in.flags & Instruction::kSwapped) != 0;
    accumulator_ = swapped ? of_first : of_second;
    require_operand(in, swapped ? of_second : of_first);
    use.accumulator = bits_of(swapped ? needs_first : needs_second);
    use.operand = bits_of(swapped ? needs_second : needs_first);
  }

  /// Returns its second operand where the first one is defined, which is all that is asked of that one.
  template <class M>
  HWY_INLINE void guard(const Instruction& in, M live, Interval<T> matters, InstructionUse& use) {
    const T first = Make<T>::load(record_);
    M asks_first = without(live, first == first);
    if (are_pieces_ && any(asks_first)) asks_first = live;
    const Interval<T> of_first = where(asks_first, everything());
    const Interval<T> of_second = where(live, matters);
    const bool swapped = (in.flags & Instruction::kSwapped) != 0;
    accumulator_ = swapped ? of_first : of_second;
    require(in.operand, swapped ? of_second : of_first);
    use.accumulator = swapped ? bits_of(asks_first) : use.run;
    use.operand = swapped ? use.run : bits_of(asks_first);
  }

  const Tape& tape_;
  const RegionWork& work_;
  const float* record_;
  T gap_;
  bool are_pieces_;
  size_t shift_, chunk_;
  Interval<T> accumulator_{};
};

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
