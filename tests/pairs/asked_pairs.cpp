// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "asked_pairs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "solve/pairs/problem.h"
#include "thalweg/scene.h"

namespace thalweg {
namespace {

template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

/// A unit quaternion, or an angle.
void add_turn(oracle::Random& random, int dimension, std::vector<float>& pose) {
  if (dimension == 2) return pose.push_back(static_cast<float>(random.uniform(-3, 3)));
  double q[4], square = 0;
  do {
    square = 0;
    for (double& x : q) {
      x = random.uniform(-1, 1);
      square += x * x;
    }
  } while (square > 1 || square < 0.01);
  for (const double x : q) pose.push_back(static_cast<float>(x / std::sqrt(square)));
}

Shape bounded_shape(oracle::Random& random, int dimension, int nodes) {
  while (true) {
    Shape shape = oracle::random_shape(random, dimension, nodes);
    const Bounds& bounds = shape.facts().bounds;
    const bool usable = bounds.finite(dimension) && !bounds.empty(dimension) && bounds.diagonal(dimension) > 0 &&
                        shape.facts().lipschitz <= 1 && !shape.facts().is_unsigned;
    if (usable) return shape;
  }
}

}  // namespace

AskedPairs::AskedPairs(const Shape& first, const Shape& second, std::vector<float> rows, Goal goal, Method method,
                       std::uint32_t starts, const Execution& execution)
    : a(std::move(compile(first)).value()),
      b(std::move(compile(second)).value()),
      d(static_cast<std::size_t>(a.dimension)),
      width(d == 2 ? 3 : 7),
      count(rows.size() / width),
      poses(std::move(rows)) {
  PairOptions options;
  options.goal = goal;
  options.method = method;
  options.starts = starts;
  const PairLimits limits = limits_of(a, b, options);
  tolerance = limits.tolerance;
  region = limits.region;
  size = limits.size;
  for (auto* bytes : {&status, &converged, &claimed, &ambiguous}) bytes->resize(count);
  for (auto* floats : {&value, &lower}) floats->resize(count);
  for (auto* vectors : {&point, &normal}) vectors->resize(count * d);
  for (auto* numbers : {&starts_run, &iterations, &evaluations, &found}) numbers->resize(count);
  for (auto* slots : {&contact_value, &contact_lower}) slots->resize(count * kContacts);
  for (auto* slots : {&contact_point, &contact_normal}) slots->resize(count * kContacts * d);
  const Tape* shapes[2] = {&a, &b};
  const PairQueries queries{shapes, 2, poses.data(), nullptr, count};
  CollideColumns columns;
  columns.status = status.data();
  columns.value = value.data();
  columns.lower = lower.data();
  columns.converged = converged.data();
  columns.point = point.data();
  columns.normal = normal.data();
  columns.claimed = claimed.data();
  columns.starts = starts_run.data();
  columns.iterations = iterations.data();
  columns.evaluations = evaluations.data();
  columns.ambiguous = ambiguous.data();
  PairContacts contacts;
  if (goal == Goal::deepest) {
    contacts.capacity = kContacts;
    contacts.found = found.data();
    contacts.point = contact_point.data();
    contacts.normal = contact_normal.data();
    contacts.value = contact_value.data();
    contacts.lower = contact_lower.data();
  }
  const auto summary = collide_pairs(queries, options, columns, contacts, execution);
  if (!summary) ADD_FAILURE() << to_string(summary.error());
}

bool AskedPairs::same_bits(const AskedPairs& o) const {
  return same(status, o.status) && same(converged, o.converged) && same(claimed, o.claimed) &&
         same(ambiguous, o.ambiguous) && same(value, o.value) && same(lower, o.lower) && same(point, o.point) &&
         same(normal, o.normal) && same(starts_run, o.starts_run) && same(iterations, o.iterations) &&
         same(evaluations, o.evaluations) && same(found, o.found) && same(contact_point, o.contact_point) &&
         same(contact_normal, o.contact_normal) && same(contact_value, o.contact_value) &&
         same(contact_lower, o.contact_lower);
}

std::vector<float> torus_poses(std::size_t count) {
  oracle::Random random(7);
  std::vector<float> poses;
  for (std::size_t i = 0; i < count; ++i) {
    for (int axis = 0; axis < 3; ++axis) poses.push_back(static_cast<float>(random.uniform(-0.5, 0.5)));
    add_turn(random, 3, poses);
  }
  return poses;
}

RandomPair::RandomPair(oracle::Random& random, int dimension, int nodes)
    : a(bounded_shape(random, dimension, nodes)), b(bounded_shape(random, dimension, nodes)) {
  const Bounds& to = a.facts().bounds;
  const Bounds& from = b.facts().bounds;
  for (int axis = 0; axis < dimension; ++axis) {
    const double spread = 0.4 * (to.hi[axis] - to.lo[axis] + from.hi[axis] - from.lo[axis]);
    const double middle = (to.lo[axis] + to.hi[axis]) / 2 - (from.lo[axis] + from.hi[axis]) / 2;
    pose.push_back(static_cast<float>(middle + random.uniform(-spread, spread)));
  }
  add_turn(random, dimension, pose);
}

std::string RandomPair::describe() const {
  std::string text = scene_text(a) + "\nwith\n" + scene_text(b) + "\nat";
  for (const float x : pose) text += ' ' + std::to_string(x);
  return text;
}

}  // namespace thalweg
