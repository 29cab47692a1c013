// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The tape's machine, written once over the lane type T and over what a register holds:
//
//   ValueMode      acc is f                        one field value per lane
//   GradientMode   acc is f and its gradient       closed forms of the op templates, divided once at the end
//   EnclosureMode  acc is [lo, hi] over a cell     from Lipschitz constants, support functions and monotone operators
//
// A chunk of pack_lanes<W>() points runs through the whole tape before the next one starts: the accumulator and the
// temporaries of an op stay in vector registers, and the few live registers of the tape stay in the first-level cache.
// Included once per SIMD target.
#if defined(THALWEG_KERNELS_INTERPRETER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_KERNELS_INTERPRETER_INL
#undef THALWEG_KERNELS_INTERPRETER_INL
#else
#define THALWEG_KERNELS_INTERPRETER_INL
#endif

#include "kernels/kernels.h"
#include "ops/all.inl"
#include "thalweg/tape.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Of plain gradients: 32 registers hold twice as many vectors as 16.
#if HWY_TARGET <= HWY_AVX3 || HWY_ARCH_ARM
inline constexpr int kPlainGradientWidth = kMostGradientWidth;
#else
inline constexpr int kPlainGradientWidth = kGradientWidth;
#endif

template <class T>
HWY_INLINE size_t lanes_of() {
  if constexpr (std::is_same_v<T, Real>) {
    return 1;
  } else {
    return sizeof(T) / sizeof(float);
  }
}

/// What one chunk needs: the program and the memory of registers and positions.
template <class T>
struct Machine {
  using Scalar = typename ConstantsOf<T>::Scalar;
  const Instruction* instructions;
  size_t instruction_count;
  const Scalar* pool;
  Scalar* registers;     ///< [register][component][lane]
  Scalar* positions;     ///< [position][axis][lane]
  uint32_t* definition;  ///< [position]: the instruction that made it
};

template <class T, int D>
HWY_INLINE Point<T, D> load_point(const typename ConstantsOf<T>::Scalar* from) {
  const size_t n = lanes_of<T>();
  if constexpr (D == 2) {
    return {Make<T>::load(from), Make<T>::load(from + n)};
  } else {
    return {Make<T>::load(from), Make<T>::load(from + n), Make<T>::load(from + 2 * n)};
  }
}
template <class T>
HWY_INLINE void store_point(Point<T, 2> p, typename ConstantsOf<T>::Scalar* to) {
  store(p.x, to);
  store(p.y, to + lanes_of<T>());
}
template <class T>
HWY_INLINE void store_point(Point<T, 3> p, typename ConstantsOf<T>::Scalar* to) {
  store(p.x, to);
  store(p.y, to + lanes_of<T>());
  store(p.z, to + 2 * lanes_of<T>());
}
template <class T>
HWY_INLINE Constants<T> constants_of(const Machine<T>& m, const Instruction& in) {
  return {m.pool + in.constants, in.constant_count};
}
template <class T>
HWY_INLINE Constants<T> after(Constants<T> c, size_t first) {
  return {c.pool + first, c.count - first};
}
template <class T>
HWY_INLINE Point<T, 2> translated(Point<T, 2> p, Constants<T> c) {
  return {p.x - c[0], p.y - c[1]};
}
template <class T>
HWY_INLINE Point<T, 3> translated(Point<T, 3> p, Constants<T> c) {
  return {p.x - c[0], p.y - c[1], p.z - c[2]};
}

template <class Op, int D>
inline constexpr bool kApplies = Op::kDeclaration.dimension == 0 || Op::kDeclaration.dimension == D;

/// The op of that number; the cases beyond the last op are given the first one and discarded.
template <int I>
using OpAt = Op<(I < kOpCount ? I : 0)>;

/// True for ops that are instructions on positions.
template <class Op>
inline constexpr bool kMovesPosition = Op::kDeclaration.kind == OpKind::warp ||
                                       (Op::kDeclaration.kind == OpKind::place && Op::kDeclaration.name == "rigid");

// It does not settle on these two.
// clang-format off
#define THALWEG_CASES_8(CASE, N) \
  CASE(N) CASE(N + 1) CASE(N + 2) CASE(N + 3) CASE(N + 4) CASE(N + 5) CASE(N + 6) CASE(N + 7)
#define THALWEG_CASES_64(CASE, N)                                                     \
  THALWEG_CASES_8(CASE, N) THALWEG_CASES_8(CASE, N + 8) THALWEG_CASES_8(CASE, N + 16) \
  THALWEG_CASES_8(CASE, N + 24) THALWEG_CASES_8(CASE, N + 32)                         \
  THALWEG_CASES_8(CASE, N + 40) THALWEG_CASES_8(CASE, N + 48) THALWEG_CASES_8(CASE, N + 56)
// clang-format on
#define THALWEG_CASES_128(CASE) THALWEG_CASES_64(CASE, 0) THALWEG_CASES_64(CASE, 64)
static_assert(kOpCount <= 128, "give the dispatch more cases");

/// The gradient before an op's move of position; only moves are ever asked for.
template <class Declared, class T, int D>
HWY_INLINE Point<T, D> pull_through(Point<T, D> p, Constants<T> c, Point<T, D> g) {
  if constexpr (kMovesPosition<Declared> && kApplies<Declared, D>) {
    return Declared::pull(p, c, g);
  } else {
    HWY_ASSUME(false);
    return g;
  }
}

/// Brings the gradient of a primitive back to the query point.
template <class T, int D>
HWY_INLINE Point<T, D> pull_back(const Machine<T>& m, const Instruction& in, Point<T, D> g) {
  if ((in.flags & Instruction::kTurned) != 0) g = Op<rigid_index<D>()>::pull(g, constants_of(m, in), g);
  size_t slot = in.operand;
  while (slot != 0) {
    const Instruction& made = m.instructions[m.definition[slot]];
    const Constants<T> c = constants_of(m, made);
    const auto from = load_point<T, D>(m.positions + made.operand * D * lanes_of<T>());
    switch (made.op) {
#define THALWEG_CASE(I)                    \
  case I:                                  \
    g = pull_through<OpAt<I>>(from, c, g); \
    break;
      THALWEG_CASES_128(THALWEG_CASE)
#undef THALWEG_CASE
    }
    slot = made.operand;
  }
  return g;
}

// --- modes: what a register holds and how each kind of op acts on it ------------------------------------------------

template <class T_, int D_>
struct ValueMode {
  using T = T_;
  static constexpr int D = D_;
  static constexpr size_t kComponents = 1;
  static constexpr bool kHasScalars = true;
  struct Register {
    T value;
  };

  template <class Declared>
  HWY_INLINE Register primitive(const Machine<T>&, const Instruction&, Point<T, D> p, Constants<T> c) const {
    return {Declared::field(p, c).value};
  }
  template <class Declared>
  HWY_INLINE Register combine(const Machine<T>&, const Instruction&, Register a, Register b, Constants<T> c) const {
    const Field<T, D> fa{a.value, {}};
    const Field<T, D> fb{b.value, {}};
    return {Declared::combine(fa, fb, c).value};
  }
  template <class Declared>
  HWY_INLINE Register map(const Machine<T>&, const Instruction&, Register a, Constants<T> c) const {
    return {Declared::map(Field<T, D>{a.value, {}}, c).value};
  }
  template <class Declared>
  HWY_INLINE Register leaf(const Machine<T>&, const Instruction&, Point<T, D> p, Constants<T> c) const {
    return {Declared::leaf(p, c).value};
  }
  template <class Declared>
  HWY_INLINE Register unary(const Machine<T>&, const Instruction&, Register a) const {
    return {Declared::apply(Field<T, D>{a.value, {}}).value};
  }
  template <class Declared>
  HWY_INLINE Register binary(const Machine<T>&, const Instruction&, Register a, Register b) const {
    return {Declared::apply(Field<T, D>{a.value, {}}, Field<T, D>{b.value, {}}).value};
  }
  static HWY_INLINE Register immediate(Constants<T> c) { return {c[0]}; }
  template <class S>
  static HWY_INLINE Register load(const S* from) {
    return {Make<T>::load(from)};
  }
  template <class S>
  static HWY_INLINE void save(Register a, S* to) {
    store(a.value, to);
  }
};

template <class T_, int D_>
struct GradientMode {
  using T = T_;
  static constexpr int D = D_;
  static constexpr size_t kComponents = 2 + D;
  static constexpr bool kHasScalars = true;
  using Register = Ray<T, D>;

  template <class Declared>
  HWY_INLINE Register primitive(const Machine<T>&, const Instruction&, Point<T, D> p, Constants<T> c) const {
    return undivided(Declared::field(p, c));
  }
  /// What is left to do for a primitive that was not asked at the query point; once in the machine, not in each op.
  static HWY_INLINE void bring_back(const Machine<T>& m, const Instruction& in, Register& f) {
    f.toward = pull_back<T, D>(m, in, f.toward);
  }
  template <class Declared>
  HWY_INLINE Register combine(const Machine<T>&, const Instruction&, const Register& a, const Register& b,
                              Constants<T> c) const {
    return Declared::combine(a, b, c);
  }
  template <class Declared>
  HWY_INLINE Register map(const Machine<T>&, const Instruction&, const Register& a, Constants<T> c) const {
    return Declared::map(a, c);
  }
  template <class Declared>
  HWY_INLINE Register leaf(const Machine<T>&, const Instruction&, Point<T, D> p, Constants<T> c) const {
    return undivided(Declared::leaf(p, c));
  }
  template <class Declared>
  HWY_INLINE Register unary(const Machine<T>&, const Instruction&, const Register& a) const {
    return undivided(Declared::apply(divided(a)));
  }
  template <class Declared>
  HWY_INLINE Register binary(const Machine<T>&, const Instruction&, const Register& a, const Register& b) const {
    return undivided(Declared::apply(divided(a), divided(b)));
  }
  static HWY_INLINE Register immediate(Constants<T> c) { return undivided(without_slope<T, D>(c[0])); }
  template <class S>
  static HWY_INLINE Register load(const S* from) {
    const size_t n = lanes_of<T>();
    return {Make<T>::load(from), load_point<T, D>(from + 2 * n), Make<T>::load(from + n)};
  }
  template <class S>
  static HWY_INLINE void save(const Register& a, S* to) {
    const size_t n = lanes_of<T>();
    store(a.value, to);
    store(a.length, to + n);
    store_point(a.toward, to + 2 * n);
  }
};

/// Cells are given by what bounds need of them: the reach (greatest distance from the centre c to a point of the
/// cell), the least of g . (v - c) over the cell's vertices v, and the greatest |v - c + o| for an offset o. Tapes with
/// formulas have a mode of their own (ranges.inl).
template <class T_, int D_, class Cell, bool kWithGradient>
struct EnclosureMode {
  using T = T_;
  static constexpr int D = D_;
  static constexpr size_t kComponents = kWithGradient ? 3 + D : 3;
  static constexpr bool kHasScalars = false;
  struct Register {
    T lo, value, hi;
    Point<T, D> gradient;  ///< at the centre, if wanted
  };

  Cell cell;

  /// f lies within the reach of its value at the centre (every primitive is 1-Lipschitz). Two facts say more.
  /// The signed distance of a convex set is the greatest of u . p - h(u) over unit u, h its support function: any u
  /// gives a lower bound, and the gradient at the centre a tight one. And an exact depth is at most the distance to
  /// any one point of the surface: to c - f grad f, the closest one of the centre, it is again tight. What is unsigned
  /// is nowhere below 0.
  template <class Declared>
  HWY_INLINE Register primitive(const Machine<T>& m, const Instruction& in, Point<T, D> p, Constants<T> c) const {
    const auto f = divided(Declared::field(p, c));
    const T reach = cell.reach();
    const auto u = f.gradient;
    T lo = f.value - reach;
    if constexpr (Declared::kDeclaration.is_unsigned) lo = max(lo, zero<T>());
    Point<T, D> slope{};
    if constexpr (kWithGradient) slope = pull_back<T, D>(m, in, u);
    if ((in.flags & (Instruction::kSupport | Instruction::kDepth)) != 0) {
      if constexpr (!kWithGradient) slope = pull_back<T, D>(m, in, u);
      const auto is_unit = Make<T>::set(0.9) < dot(u, u);
      if constexpr (requires { Declared::support(p, c); }) {
        if ((in.flags & Instruction::kSupport) != 0) {
          const T plane = dot(u, p) - Declared::support(u, c) + cell.least_slope(slope);
          lo = select(is_unit, max(lo, plane), lo);
        }
      }
      if ((in.flags & Instruction::kDepth) != 0) {
        const T depth = -cell.most_distance(scaled(slope, f.value));
        lo = select(both(is_unit, f.value < zero<T>()), max(lo, depth), lo);
      }
    }
    return {lo, f.value, f.value + reach, slope};
  }
  /// Operators are monotone in each operand: the end points of the operands give those of the result.
  template <class Declared>
  HWY_INLINE Register combine(const Machine<T>&, const Instruction&, const Register& a, const Register& b,
                              Constants<T> c) const {
    constexpr bool kRising = Declared::kTrend[1] > 0;
    const auto at = [&](T x, T y) { return Declared::combine(Field<T, D>{x, {}}, Field<T, D>{y, {}}, c).value; };
    const Field<T, D> f = Declared::combine(Field<T, D>{a.value, a.gradient}, Field<T, D>{b.value, b.gradient}, c);
    return {at(a.lo, kRising ? b.lo : b.hi), f.value, at(a.hi, kRising ? b.hi : b.lo), f.gradient};
  }
  template <class Declared>
  HWY_INLINE Register map(const Machine<T>&, const Instruction&, const Register& a, Constants<T> c) const {
    const auto at = [&](T x) { return Declared::map(Field<T, D>{x, {}}, c).value; };
    const Field<T, D> f = Declared::map(Field<T, D>{a.value, a.gradient}, c);
    if constexpr (Declared::kTrend == 0) {
      const Interval<T> ends = Declared::enclose(Interval<T>{a.lo, a.hi}, c);
      return {ends.lo, f.value, ends.hi, f.gradient};
    } else {
      return {at(a.lo), f.value, at(a.hi), f.gradient};
    }
  }
  template <class S>
  static HWY_INLINE Register load(const S* from) {
    const size_t n = lanes_of<T>();
    Register a{Make<T>::load(from), Make<T>::load(from + n), Make<T>::load(from + 2 * n), {}};
    if constexpr (kWithGradient) a.gradient = load_point<T, D>(from + 3 * n);
    return a;
  }
  template <class S>
  static HWY_INLINE void save(const Register& a, S* to) {
    const size_t n = lanes_of<T>();
    store(a.lo, to);
    store(a.value, to + n);
    store(a.hi, to + 2 * n);
    if constexpr (kWithGradient) store_point(a.gradient, to + 3 * n);
  }
};

// --- the machine
// ------------------------------------------------------------------------------------------------------

/// Arithmetic on the accumulator: of nothing, of it alone, or of it and a register or constant.
template <class Declared, class Mode>
HWY_INLINE void scalar_step(const Mode& mode, const Machine<typename Mode::T>& m, const Instruction& in,
                            typename Mode::Register& acc) {
  using T = typename Mode::T;
  const Constants<T> c{m.pool + in.constants, in.constant_count};
  if constexpr (Declared::kOperands == 0) {
    acc = mode.template leaf<Declared>(m, in,
                                       load_point<T, Mode::D>(m.positions + in.operand * Mode::D * lanes_of<T>()), c);
    return;
  }
  if ((in.flags & Instruction::kLoads) != 0) {
    acc = Mode::load(m.registers + in.first * Mode::kComponents * lanes_of<T>());
  }
  if constexpr (Declared::kOperands == 1) {
    acc = mode.template unary<Declared>(m, in, acc);
  } else if constexpr (Declared::kOperands == 2) {
    const auto other = (in.flags & Instruction::kImmediate) != 0
                           ? Mode::immediate(c)
                           : Mode::load(m.registers + in.operand * Mode::kComponents * lanes_of<T>());
    if ((in.flags & Instruction::kSwapped) != 0) {
      acc = mode.template binary<Declared>(m, in, acc, other);
    } else {
      acc = mode.template binary<Declared>(m, in, other, acc);
    }
  }
}

/// Whether a mode runs anything but scalar instructions.
template <class Mode>
inline constexpr bool kHasFields = true;
template <class Mode>
requires(!Mode::kHasFields) inline constexpr bool kHasFields<Mode> = false;

template <class Declared, class Mode>
HWY_INLINE void step(const Mode& mode, const Machine<typename Mode::T>& m, const Instruction& in,
                     typename Mode::Register& acc) {
  using T = typename Mode::T;
  constexpr int D = Mode::D;
  constexpr OpKind kKind = Declared::kDeclaration.kind;
  [[maybe_unused]] const Constants<T> c = constants_of(m, in);
  if constexpr (!kApplies<Declared, D> || (!kHasFields<Mode> && kKind != OpKind::scalar)) {
    HWY_ASSUME(false);
  } else if constexpr (kKind == OpKind::primitive) {
    const auto at = load_point<T, D>(m.positions + in.operand * D * lanes_of<T>());
    using Rigid = Op<rigid_index<D>()>;
    const bool turned = !Declared::kDeclaration.absorbs_rotation && (in.flags & Instruction::kTurned) != 0;
    const auto p = turned ? Rigid::map(at, c) : translated(at, c);
    acc = mode.template primitive<Declared>(m, in, p, after(c, turned ? Rigid::kConstants : D));
  } else if constexpr (kKind == OpKind::combine) {
    const auto other = Mode::load(m.registers + in.operand * Mode::kComponents * lanes_of<T>());
    if ((in.flags & Instruction::kSwapped) != 0) {
      acc = mode.template combine<Declared>(m, in, acc, other, c);
    } else {
      acc = mode.template combine<Declared>(m, in, other, acc, c);
    }
  } else if constexpr (kKind == OpKind::map) {
    acc = mode.template map<Declared>(m, in, acc, c);
  } else if constexpr (kKind == OpKind::scalar) {
    if constexpr (Mode::kHasScalars) {
      scalar_step<Declared>(mode, m, in, acc);
    } else {
      HWY_ASSUME(false);
    }
  } else if constexpr (kMovesPosition<Declared>) {
    const auto from = load_point<T, D>(m.positions + in.operand * D * lanes_of<T>());
    store_point(Declared::map(from, c), m.positions + in.target * D * lanes_of<T>());
    m.definition[in.target] = static_cast<uint32_t>(&in - m.instructions);
  }
}

/// Runs the tape over one chunk whose points are at position 0.
template <class Mode>
HWY_INLINE typename Mode::Register run(const Mode& mode, const Machine<typename Mode::T>& m) {
  using T = typename Mode::T;
  typename Mode::Register acc{};
  const Instruction* const end = m.instructions + m.instruction_count;
  for (const Instruction* in = m.instructions; in != end; ++in) {
    switch (in->op) {
#define THALWEG_CASE(I)                                 \
  case I:                                               \
    if constexpr (I < kOpCount) {                       \
      using Declared = OpAt<I>;                         \
      step<Declared>(mode, m, *in, acc);                \
      if constexpr (kMovesPosition<Declared>) continue; \
    }                                                   \
    break;
      THALWEG_CASES_128(THALWEG_CASE)
#undef THALWEG_CASE
      default:
        if (in->op == Instruction::kLoad)
          acc = Mode::load(m.registers + in->operand * Mode::kComponents * lanes_of<T>());
    }
    if constexpr (requires { Mode::bring_back(m, *in, acc); }) {
      if ((in->flags & (Instruction::kTurned | Instruction::kWarped)) != 0) Mode::bring_back(m, *in, acc);
    }
    if (in->target != Instruction::kNone) {
      Mode::save(acc, m.registers + in->target * Mode::kComponents * lanes_of<T>());
    }
  }
  return acc;
}

/// Floats of one machine's registers and positions.
template <class Mode>
HWY_INLINE size_t machine_floats(const Tape& tape) {
  const size_t registers = static_cast<size_t>(tape.register_count) * Mode::kComponents;
  return (registers + static_cast<size_t>(tape.position_count) * Mode::D) * lanes_of<typename Mode::T>();
}

/// Cuts a scratch block into a machine's memory.
template <class Mode>
HWY_INLINE Machine<typename Mode::T> machine_for(const Tape& tape, float* scratch) {
  const auto positions = static_cast<size_t>(tape.position_count);
  Machine<typename Mode::T> m;
  m.instructions = tape.instructions.data();
  m.instruction_count = tape.instructions.size();
  m.pool = tape.constants.data();
  m.definition = reinterpret_cast<uint32_t*>(scratch);
  m.positions = scratch + definition_floats(tape);
  m.registers = m.positions + positions * Mode::D * lanes_of<typename Mode::T>();
  return m;
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
