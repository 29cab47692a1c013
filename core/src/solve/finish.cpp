// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The end of every tile: statuses from what was found and proven, normals from one gradient pass, and all of it into
// the caller's columns. Rows that cannot be answered give status 255, NaN and zeros.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solve/finish.cpp"
#include <hwy/foreach_target.h>
// foreach_target must come first
#include <hwy/highway.h>

#include <limits>

#include "gradient/strategies.h"
#include "kernels/rows.inl"
#include "solve/finish.h"
#include "solve/tile.h"
#include "solve/write_ties.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

using I32 = hn::RebindToSigned<F32>;
using U32 = hn::RebindToUnsigned<F32>;

/// Calls `body(i, count)` for each vector of the tile.
template <class Body>
HWY_INLINE void for_each_vector(size_t count, Body&& body) {
  const size_t lanes = vector_lanes();
  for (size_t i = 0; i < count; i += lanes) body(i, HWY_MIN(lanes, count - i));
}

/// Writes `count` lanes of one-byte numbers.
HWY_INLINE void store_bytes(hn::Vec<I32> x, uint8_t* to, size_t count) {
  const hn::Rebind<uint8_t, I32> d8;
  HWY_ALIGN uint8_t lanes[HWY_MAX_BYTES];
  const auto bytes = hn::DemoteTo(d8, x);
  if (count == hn::Lanes(d8)) {
    hn::StoreU(bytes, d8, to);
  } else {
    hn::StoreU(bytes, d8, lanes);
    std::copy_n(lanes, count, to);
  }
}

HWY_INLINE void store_floats(V32 x, float* to, size_t count) {
  HWY_ALIGN float lanes[HWY_MAX_BYTES / sizeof(float)];
  if (count == vector_lanes()) {
    hn::StoreU(x, F32(), to);
  } else {
    hn::StoreU(x, F32(), lanes);
    std::copy_n(lanes, count, to);
  }
}

template <int D>
HWY_INLINE void store_rows(const Point<Pack<1>, D>& p, float* to, size_t count) {
  float lanes[3 * HWY_MAX_BYTES / sizeof(float)];
  if (count == vector_lanes()) {
    store_interleaved(p, to);
  } else {
    store_interleaved(p, lanes);
    std::copy_n(lanes, count * D, to);
  }
}

HWY_INLINE M32 is_set(const float* flags) { return hn::Gt(hn::LoadU(F32(), flags), hn::Zero(F32())); }

HWY_INLINE hn::Vec<I32> number_if(M32 m, int yes, int no) {
  const I32 d;
  return hn::IfThenElse(hn::RebindMask(d, m), hn::Set(d, yes), hn::Set(d, no));
}

/// algorithms: separated and overlapping are proofs, touching a proven bracket, anything else undecided.
void write_statuses(const QueryTile& tile, const QueryState& s) {
  const F32 d;
  const I32 di;
  const auto tolerance = hn::Set(d, static_cast<float>(tile.limits->tolerance));
  for_each_vector(tile.count, [&](size_t i, size_t count) HWY_ATTR {
    const auto value = hn::LoadU(d, s.value + i);
    const auto lower = hn::LoadU(d, s.lower + i);
    const auto below = hn::Le(hn::Add(value, hn::LoadU(d, s.slack + i)), tolerance);
    const auto brackets = hn::And(below, hn::Ge(lower, hn::Neg(tolerance)));
    auto status = number_if(brackets, static_cast<int>(Status::touching), static_cast<int>(Status::undecided));
    const auto choose = [&](M32 m, Status wanted) HWY_ATTR {
      status = hn::IfThenElse(hn::RebindMask(di, m), hn::Set(di, static_cast<int>(wanted)), status);
    };
    choose(is_set(s.witness + i), Status::overlapping);
    choose(hn::Gt(lower, hn::Zero(d)), Status::separated);
    choose(is_set(s.is_bad + i), Status::bad_row);
    store_bytes(status, tile.columns.status + i, count);
  });
}

void write_flags(const QueryTile& tile, const QueryState& s) {
  const F32 d;
  const CollideColumns& out = tile.columns;
  for_each_vector(tile.count, [&](size_t i, size_t count) HWY_ATTR {
    const auto bad = is_set(s.is_bad + i);
    if (out.converged != nullptr) {
      store_bytes(number_if(hn::AndNot(bad, is_set(s.converged + i)), 1, 0), out.converged + i, count);
    }
    if (out.claimed != nullptr) {
      const auto negative = hn::Lt(hn::LoadU(d, s.value + i), hn::Zero(d));
      store_bytes(number_if(hn::AndNot(bad, negative), 1, 0), out.claimed + i, count);
    }
  });
}

/// Numbers of the rows that could be answered, 0 for the others.
void write_numbers(const QueryTile& tile, const QueryState& s, const uint32_t* from, uint32_t* to) {
  if (to == nullptr) return;
  for (size_t q = 0; q < tile.count; ++q) to[q] = s.is_bad[q] == 0 ? from[q] : 0;
}

HWY_INLINE uint8_t stop_of(const QueryState& s, size_t q) {
  if (s.stop != nullptr) return s.stop[q];
  return static_cast<uint8_t>(s.converged[q] > 0 ? Stop::goal : Stop::budget);
}

void write_counts(const QueryTile& tile, const QueryState& s) {
  const CollideColumns& out = tile.columns;
  write_numbers(tile, s, s.iterations, out.iterations);
  write_numbers(tile, s, s.evaluations, out.evaluations);
  for (size_t q = 0; q < tile.count && out.stop != nullptr; ++q) {
    out.stop[q] = s.is_bad[q] == 0 ? stop_of(s, q) : static_cast<uint8_t>(Stop::none);
  }
  if (out.starts == nullptr) return;
  for (size_t q = 0; q < tile.count; ++q) out.starts[q] = s.is_bad[q] == 0 ? tile.limits->starts : 0;
}

template <int D>
void write_values(const QueryTile& tile, const QueryState& s) {
  const F32 d;
  const CollideColumns& out = tile.columns;
  const auto nan = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
  for_each_vector(tile.count, [&](size_t i, size_t count) HWY_ATTR {
    const auto bad = is_set(s.is_bad + i);
    const auto shown = [&](V32 x) HWY_ATTR { return Pack<1>{hn::IfThenElse(bad, nan, x)}; };
    const auto value = hn::LoadU(d, s.value + i);
    if (out.value != nullptr) store_floats(shown(value).v, out.value + i, count);
    if (out.lower != nullptr) {
      const auto lower = hn::LoadU(d, s.lower + i);
      store_floats(shown(hn::IfThenElse(hn::Lt(value, lower), value, lower)).v, out.lower + i, count);
    }
    if (out.point != nullptr) {
      Point<Pack<1>, D> p;
      p.x = shown(hn::LoadU(d, s.point[0] + i));
      p.y = shown(hn::LoadU(d, s.point[1] + i));
      if constexpr (D == 3) p.z = shown(hn::LoadU(d, s.point[2] + i));
      store_rows<D>(p, out.point + i * D, count);
    }
    if (out.barycentric != nullptr) {
      const auto u = hn::LoadU(d, s.barycentric[0] + i);
      const auto v = hn::LoadU(d, s.barycentric[1] + i);
      const auto first = hn::Max(hn::Zero(d), hn::Sub(hn::Sub(hn::Set(d, 1.0F), u), v));
      store_rows<3>({shown(first), shown(u), shown(v)}, out.barycentric + i * 3, count);
    }
  });
}

/// Unit gradients; where the gradient vanishes the last axis stands in and the row is ambiguous.
template <int D>
void write_normals(const QueryTile& tile, const QueryState& s, float* scratch, Arena& arena) {
  using P = Pack<1>;
  const CollideColumns& out = tile.columns;
  float* gradient[3] = {};
  for (int axis = 0; axis < D; ++axis) gradient[axis] = arena.take<float>(padded(tile.count));
  GradientColumns columns{.points = s.point, .count = tile.count, .gradient = gradient};
  // Closed forms come with one more pass; what is probed for, or searched, is counted.
  if (tile.limits->normals.strategy != Gradient::autodiff) columns.evaluations = s.evaluations;
  evaluate_gradient(tile.limits->normals, *tile.tape, *tile.kernels, columns, scratch);
  const P nan = Make<P>::set(std::numeric_limits<float>::quiet_NaN());
  for_each_vector(tile.count, [&](size_t i, size_t count) HWY_ATTR {
    Point<P, D> g;
    g.x = Make<P>::load(gradient[0] + i);
    g.y = Make<P>::load(gradient[1] + i);
    if constexpr (D == 3) g.z = Make<P>::load(gradient[2] + i);
    const P square = dot(g, g);
    const auto bad = is_set(s.is_bad + i);
    // NaN, where a formula is undefined, is no direction either.
    const PackMask<1> vanishes{hn::Not(hn::Gt(square.v, hn::Set(F32(), 1e-6F)))};
    Point<P, D> fixed = splat<P, D>(zero<P>());
    if constexpr (D == 2) {
      fixed.y = one<P>();
    } else {
      fixed.z = one<P>();
    }
    const auto normal = select(vanishes, fixed, scaled(g, one<P>() / sqrt(max(square, Make<P>::set(1e-6F)))));
    if (out.ambiguous != nullptr) {
      store_bytes(number_if(hn::AndNot(bad, vanishes.m), 1, 0), out.ambiguous + i, count);
    }
    if (out.normal != nullptr) {
      store_rows<D>(select(PackMask<1>{bad}, splat<P, D>(nan), normal), out.normal + i * D, count);
    }
  });
}

void finish_kernel(const QueryTile& tile, const QueryState& state, float* scratch, Arena& arena) {
  const CollideColumns& out = tile.columns;
  if (out.status != nullptr) write_statuses(tile, state);
  if (out.converged != nullptr || out.claimed != nullptr) write_flags(tile, state);
  const bool flat = tile.tape->dimension == 2;
  flat ? write_values<2>(tile, state) : write_values<3>(tile, state);
  if (out.normal != nullptr || out.ambiguous != nullptr) {
    flat ? write_normals<2>(tile, state, scratch, arena) : write_normals<3>(tile, state, scratch, arena);
  }
  write_counts(tile, state);
  if (out.ambiguous != nullptr || out.one_sided != nullptr) write_ties(tile, state, scratch, arena);
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "kernels/dispatch.h"
#include "kernels/entries.h"
namespace thalweg {
HWY_EXPORT(finish_kernel);
FinishKernel finish_entry(std::int64_t target) { return THALWEG_ENTRY_OF(finish_kernel, target); }

QueryState QueryState::make(Arena& arena, int dimension, std::size_t count) {
  const std::size_t room = padded(count);
  QueryState s;
  for (int axis = 0; axis < dimension; ++axis) s.point[axis] = arena.take<float>(room);
  for (float** column :
       {&s.value, &s.lower, &s.slack, &s.barycentric[0], &s.barycentric[1], &s.witness, &s.converged, &s.is_bad}) {
    *column = arena.take<float>(room);
  }
  s.evaluations = arena.take<std::uint32_t>(room);
  s.iterations = arena.take<std::uint32_t>(room);
  return s;
}
}  // namespace thalweg
#endif
