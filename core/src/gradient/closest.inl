// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The field g(P) = nearest surface point - P (Luneau 2025, section 2.3, its first idea): the gradient is the direction
// from that point, and the point is a witness of the distance.
//
// Where f is a distance the point is P - f grad f, at once: grad f already comes through the operators. Where f is only
// a bound, |P - Q|^2 is minimised over the surface: a step along the tangent plane at Q towards the foot of P, then
// Newton's steps along the gradient back to the surface; a step that does not come nearer is halved. Every lane
// goes its own way, stops by itself and takes the next point, so lanes stay full and no result depends on a neighbour.
// Included once per SIMD target.
#if defined(THALWEG_GRADIENT_CLOSEST_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef THALWEG_GRADIENT_CLOSEST_INL
#undef THALWEG_GRADIENT_CLOSEST_INL
#else
#define THALWEG_GRADIENT_CLOSEST_INL
#endif

#include "gradient/probes.inl"
#include "kernels/rows.inl"

HWY_BEFORE_NAMESPACE();
namespace thalweg {
namespace HWY_NAMESPACE {

/// Evaluations of one point, at most.
inline constexpr float kMostClosestEvaluations = 48;
/// Newton's steps of one return to the surface, at most.
inline constexpr float kMostReturns = 8;
/// What a direction may be off by, in radians, and a distance to the surface in its own length.
inline constexpr float kClosestAngle = 1e-3F;

template <class T, int D>
struct ClosestSearch {
  Point<T, D> from;     ///< P
  Point<T, D> trial;    ///< where f is asked next
  Point<T, D> nearest;  ///< the best surface point so far
  Point<T, D> tangent;  ///< from it along its tangent plane to the foot of P
  Point<T, D> normal;   ///< unit gradient at P; once a surface point is known, the one there
  T least;              ///< |P - nearest|
  T share;              ///< of the tangent that the trial tries
  T returns;            ///< Newton's steps since then
  T slack;              ///< what |f| on the surface may be by rounding
  T active;             ///< 1 while the search goes on
  T evaluations;
  T value;  ///< f at P
};

template <class T, int D>
HWY_INLINE ClosestSearch<T, D> begin_closest(const Tape& tape, Point<T, D> p, const Field<T, D>& f) {
  ClosestSearch<T, D> s;
  s.from = p;
  s.normal = normalised(f.gradient);
  s.trial = p - scaled(s.normal, f.value);
  s.nearest = s.trial;
  s.tangent = no_direction<T, D>();
  const Affine& slack = tape.has_formulas ? tape.enclosure_slack : tape.slack;
  s.slack = mul_add(largest_size(p), Make<T>::set(slack.b), Make<T>::set(slack.a));
  const bool outside = tape.facts.outside == Exactness::exact;
  const bool inside = tape.facts.inside == Exactness::exact;
  const T yes = one<T>();
  const T no = zero<T>();
  s.active = select(f.value < no, inside ? no : yes, outside ? no : yes);
  // An infinite distance: no surface point is known yet.
  s.least = select(no < s.active, Make<T>::set(std::numeric_limits<float>::infinity()), abs(f.value));
  s.share = yes;
  s.returns = no;
  s.evaluations = yes;
  s.value = f.value;
  return s;
}

/// One evaluation at the trial: back to the surface, or a verdict on the step that led there and the next one.
template <class T, int D>
HWY_INLINE void advance_closest(ClosestSearch<T, D>& s, const Field<T, D>& f) {
  // On a corner or a thin piece the trial may be where no gradient is; the last one will do.
  Point<T, D> normal = normalised(f.gradient);
  normal = select(zero<T>() < largest_size(normal), normal, s.normal);
  const Point<T, D> to_p = s.from - s.trial;
  const T distance = length(to_p);
  const T tolerance = mul_add(distance, Make<T>::set(kClosestAngle * 0.1F), s.slack + s.slack);
  const auto on_surface = abs(f.value) <= tolerance;
  const auto gives_up = Make<T>::set(kMostReturns) <= s.returns;

  const auto is_nearer = both(on_surface, distance < s.least);
  s.nearest = select(is_nearer, s.trial, s.nearest);
  s.normal = select(is_nearer, normal, s.normal);
  s.tangent = select(is_nearer, to_p - scaled(normal, dot(normal, to_p)), s.tangent);
  s.least = select(is_nearer, distance, s.least);
  const auto has_point = s.least < Make<T>::set(std::numeric_limits<float>::infinity());
  const T longer = min(s.share + s.share, one<T>());
  const auto settles = either(on_surface, gives_up);
  s.share = select(settles, select(is_nearer, longer, s.share * Make<T>::set(0.5)), s.share);

  // Newton's step, kept from leaping where the gradient is small.
  const T slope = max(length(f.gradient), Make<T>::set(0.25));
  const Point<T, D> back = s.trial - scaled(normal, f.value / slope);
  const Point<T, D> next = s.nearest + scaled(s.tangent, s.share);
  s.trial = select(both(settles, has_point), next, back);
  s.returns = select(settles, zero<T>(), s.returns + one<T>());
  s.evaluations = s.evaluations + one<T>();

  const T step = length(s.tangent) * s.share;
  const auto arrived = both(settles, step <= mul_add(s.least, Make<T>::set(kClosestAngle), s.slack));
  const auto is_lost = both(gives_up, Make<T>::set(std::numeric_limits<float>::infinity()) <= s.least);
  const auto is_spent = Make<T>::set(kMostClosestEvaluations) <= s.evaluations;
  s.active = select(either(either(both(has_point, arrived), is_lost), is_spent), zero<T>(), s.active);
}

template <class T, int D>
HWY_NOINLINE void run_gradients(const Machine<T>& m, float* to) {
  const Field<T, D> f = divided(run(GradientMode<T, D>{}, m));
  store(f.value, to);
  store_point(f.gradient, to + lanes_of<T>());
}
template <class T, int D>
HWY_INLINE Field<T, D> gradient_at_point(const Machine<T>& m, Point<T, D> p) {
  HWY_ALIGN float field[4 * kMostChunkLanes];
  store_point(p, m.positions);
  run_gradients<T, D>(m, field);
  return {Make<T>::load(field), load_point<T, D>(field + lanes_of<T>())};
}

/// What a search found. Close to the surface the direction is lost in rounding, and the normal there is as good.
template <class T, int D>
HWY_INLINE Point<T, D> closest_direction(const ClosestSearch<T, D>& s) {
  const auto is_far = both(Make<T>::set(64.0F) * s.slack < s.least, s.least < Make<T>::set(kLargestCoordinate));
  return select(is_far, normalised(scaled(s.from - s.nearest, sign_of(s.value))), s.normal);
}

}  // namespace HWY_NAMESPACE
}  // namespace thalweg
HWY_AFTER_NAMESPACE();

#endif
