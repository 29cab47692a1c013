// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "workload.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "random.h"
#include "thalweg/ops.h"

namespace thalweg::determinism {
namespace {

using oracle::Random;

/// Every sort of 2D primitive and operator, 1920 by 1080 units.
Shape scene2() {
  const Vec2 corners[] = {{0, 0}, {160, 20}, {120, 90}, {180, 160}, {20, 140}, {60, 70}};
  const std::vector<Shape> parts = {
      star(300, 12, 4).translate(Vec2{1000, 550}),
      circle(200).translate(Vec2{750, 400}),
      rounded_box(Vec2{120, 80}, {10, 20, 30, 0}).rotate(0.3).translate(Vec2{300, 200}),
      polygon(corners).translate(Vec2{1500, 700}),
      onion(pie(0.8, 120), 6).translate(Vec2{1500, 200}),
      round(segment(Vec2{0, 0}, Vec2{200, 90}), 12).translate(Vec2{200, 800}),
      ring(1.1, 90, 30).rotate(-0.7).translate(Vec2{500, 700}),
      moon(50, 90, 80).scale(1.3).translate(Vec2{1000, 150}),
  };
  const Shape blended = smooth_union(8, parts);
  const Shape cut = smooth_subtraction(4, {blended, box(Vec2{60, 60}).translate(Vec2{1000, 550})});
  return cut | (cool_s().scale(120).translate(Vec2{1780, 500}) & half_plane(Vec2{0, 1}, 560)) |
         mirror(triangle(Vec2{20, 900}, Vec2{120, 930}, Vec2{60, 1040}), 0) | arc(2, 60, 9).translate(Vec2{700, 950});
}

Shape scene3() {
  const Shape plate = box(Vec3{40, 6, 25}) - cylinder(20, 7).translate(Vec3{24, 0, 8});
  const Shape post = capsule(Vec3{0, 0, 0}, Vec3{0, 40, 0}, 9).rotate(Vec3{0, 0, 1}, -0.4);
  const Shape hoop = torus(18, 5).rotate(Vec3{1, 0.2, 0}, 0.9).translate(Vec3{-16, 20, 0});
  const Shape body = smooth_union(2, {plate, post, hoop}).translate(Vec3{60, 50, -30});
  const Shape ball = smooth_intersection(1, {sphere(22).translate(Vec3{10, 20, 10}), plane(Vec3{0.6, 0, 0.8}, 18)});
  return body | ball | mirror(round(box(Vec3{5, 8, 5}), 2).translate(Vec3{20, -30, 0}), 0);
}

/// Choices that are sure and such that are not, functions, and a constant in every place.
Shape formula2() {
  return expression(
      "min(max(abs(x / 300 - 2) - 1, 1.5 - y / 200), sqrt(square(x / 100 - 9) + square(y / 100 - 5)) - 2) "
      "+ 0.1 * sin(x / 50) * cos(y / 400) - max(0.2, min(0.3, 2 - sqrt(x / 200)))");
}
Shape formula3() {
  return expression(
      "max(max(abs(x / 40 - 1) - 0.8, abs(y / 30) - 1), square(x / 20) / 9 + cos(z / 9) - atan2(y / 10, z / 10 + 7))",
      3);
}

/// What is moved about the scene of pairs, and distances: a body of several parts, and another one with a hole.
Shape mover(int dimension) {
  if (dimension == 2) return smooth_union(3, {box(Vec2{160, 40}), star(120, 7, 4).translate(Vec2{130, 40})});
  return smooth_union(1, {box(Vec3{20, 4, 6}), sphere(9).translate(Vec3{18, 5, 0})});
}

/// Many parts, so that queries are answered in spatial order by shortened tapes.
Shape many_parts2() {
  Random random(7);
  std::vector<Shape> parts;
  for (int i = 0; i < 200; ++i) {
    const Shape part = i % 2 == 0 ? circle(30) : star(40, 5, 3);
    const double x = random.uniform(0, 1920);
    parts.push_back(part.translate(Vec2{x, random.uniform(0, 1080)}));
  }
  return union_(parts);
}

struct Box {
  double least, most;
};

Box side(int dimension, int axis) {
  static constexpr Box kPlane[] = {{-100, 2020}, {-100, 1180}}, kSpace[] = {{-10, 130}, {-50, 120}, {-80, 50}};
  return dimension == 2 ? kPlane[axis] : kSpace[axis];
}

void add_centre(Random& random, int dimension, double* centre) {
  for (int axis = 0; axis < dimension; ++axis) {
    centre[axis] = random.uniform(side(dimension, axis).least, side(dimension, axis).most);
  }
}

/// Every seventh is a needle, every eleventh a point, every thirteenth large.
std::vector<float> triangles(Random& random, int dimension, std::size_t count) {
  std::vector<float> rows;
  const double usual = dimension == 2 ? 60 : 8;
  for (std::size_t i = 0; i < count; ++i) {
    double centre[3] = {};
    add_centre(random, dimension, centre);
    const double size = i % 11 == 0 ? 0 : i % 13 == 0 ? 20 * usual : usual;
    for (int corner = 0; corner < 3; ++corner) {
      const double here = i % 7 == 0 && corner == 2 ? size * 1e-5 : size;
      for (int axis = 0; axis < dimension; ++axis) {
        rows.push_back(static_cast<float>(centre[axis] + random.uniform(-here, here)));
      }
    }
  }
  return rows;
}

std::vector<float> circles(Random& random, int dimension, std::size_t count) {
  std::vector<float> rows;
  for (std::size_t i = 0; i < count; ++i) {
    double centre[3] = {};
    add_centre(random, dimension, centre);
    for (int axis = 0; axis < dimension; ++axis) rows.push_back(static_cast<float>(centre[axis]));
    rows.push_back(i % 11 == 0 ? 0 : static_cast<float>(random.uniform(0, dimension == 2 ? 40 : 6)));
  }
  return rows;
}

std::vector<float> points(Random& random, int dimension, std::size_t count) {
  std::vector<float> rows;
  for (std::size_t i = 0; i < count; ++i) {
    double centre[3] = {};
    add_centre(random, dimension, centre);
    for (int axis = 0; axis < dimension; ++axis) rows.push_back(static_cast<float>(centre[axis]));
  }
  return rows;
}

std::vector<float> poses(Random& random, int dimension, std::size_t count) {
  std::vector<float> rows;
  for (std::size_t i = 0; i < count; ++i) {
    double centre[3] = {};
    add_centre(random, dimension, centre);
    for (int axis = 0; axis < dimension; ++axis) rows.push_back(static_cast<float>(centre[axis]));
    for (int k = 0; k < (dimension == 2 ? 1 : 4); ++k) rows.push_back(static_cast<float>(random.uniform(-1, 1)));
  }
  return rows;
}

/// Ways of up to a fifth of the scene, and for motions turns of up to a radian; every third row does not turn.
std::vector<float> ends_of(Random& random, int dimension, const std::vector<float>& triangles) {
  std::vector<float> ends;
  const double most = dimension == 2 ? 300 : 30;
  for (const float x : triangles)
    ends.push_back(static_cast<float>(static_cast<double>(x) + random.uniform(-most, most)));
  return ends;
}
std::vector<float> motions(Random& random, int dimension, std::size_t count) {
  std::vector<float> rows;
  const double most = dimension == 2 ? 300 : 30;
  for (std::size_t i = 0; i < count; ++i) {
    for (int axis = 0; axis < dimension; ++axis) rows.push_back(static_cast<float>(random.uniform(-most, most)));
    if (dimension == 3) rows.push_back(1);
    const double turn = i % 3 == 0 ? 0 : 0.5;
    for (int k = 0; k < (dimension == 2 ? 1 : 3); ++k) rows.push_back(static_cast<float>(random.uniform(-turn, turn)));
  }
  return rows;
}

/// Rows that cannot be answered, among the others.
void spoil(std::vector<float>& rows) {
  rows[rows.size() / 2] = std::numeric_limits<float>::quiet_NaN();
  rows[rows.size() / 3] = std::numeric_limits<float>::infinity();
  rows[rows.size() / 4] = -1e16F;
}

Tape compiled(const Shape& shape) {
  auto tape = compile(shape);
  if (!tape) throw std::logic_error(to_string(tape.error()));
  return std::move(tape).value();
}

template <class T>
std::vector<T> filled(std::size_t count) {
  return std::vector<T>(count, static_cast<T>(77));
}

}  // namespace

void Hash::add(const void* bytes, std::size_t count) {
  const auto* next = static_cast<const unsigned char*>(bytes);
  for (std::size_t i = 0; i < count; ++i) state_ = (state_ ^ next[i]) * 0x100000001b3U;
}

Workload::Workload(std::string_view name) {
  const bool is_3d = name.find("3_") != std::string_view::npos;
  const int d = is_3d ? 3 : 2;
  const std::string_view rest = name.substr(name.find('_') + 1);
  tape_ = compiled(is_3d ? scene3() : scene2());
  Random random(2026);
  options_.goal = rest == "deepest" || rest == "many" ? Goal::deepest : Goal::verdict;
  count_ = rest == "deepest" ? 300 : 3000;
  if (name.starts_with("grid")) {
    kind_ = Kind::grid;
    return;
  }
  if (name.starts_with("sweeps")) {
    kind_ = Kind::sweeps;
    count_ = rest == "many" ? 600 : 300;
    if (rest == "many") tape_ = compiled(many_parts2());
    has_circles_ = rest == "circles";
    moves_scene_ = has_circles_ || rest == "motions";
    rows_ = has_circles_ ? circles(random, d, count_) : triangles(random, d, count_);
    moves_ = moves_scene_ ? motions(random, d, count_) : ends_of(random, d, rows_);
  } else if (name.starts_with("pairs") || name.starts_with("distances")) {
    kind_ = name.starts_with("pairs") ? Kind::pairs : Kind::distances;
    second_ = compiled(mover(d));
    rows_ = poses(random, d, count_ = 200);
    if (rest == "many") tape_ = compiled(many_parts2());
  } else if (name.starts_with("formula")) {
    tape_ = compiled(is_3d ? formula3() : formula2());
    kind_ = rest == "verdict" ? Kind::triangles : Kind::points;
    rows_ = rest == "verdict" ? triangles(random, d, count_ = 200) : points(random, d, count_);
  } else if (name.starts_with("eval")) {
    kind_ = Kind::points;
    gradient_ = *parse_gradient(rest);
    rows_ = points(random, d, count_ *= 2);
  } else if (name.starts_with("triangles")) {
    if (const auto method = parse_method(rest)) options_.method = *method;
    if (rest == "thesis") count_ = 400;
    rows_ = triangles(random, d, count_);
  } else {
    kind_ = Kind::circles;
    if (rest == "published") options_.method = Method::published;
    rows_ = circles(random, d, count_);
    rows_[rows_.size() / 5 / static_cast<std::size_t>(d + 1) * static_cast<std::size_t>(d + 1) - 1] = -1;
  }
  spoil(rows_);
}

std::uint64_t Workload::run(const Execution& execution) const {
  if (kind_ == Kind::grid) return run_grid(execution);
  if (kind_ == Kind::pairs) return run_pairs(execution);
  if (kind_ == Kind::distances) return run_distances(execution);
  if (kind_ == Kind::sweeps) return run_sweeps(execution);
  return kind_ == Kind::points ? run_points(execution) : run_queries(execution);
}

std::uint64_t Workload::run_points(const Execution& execution) const {
  auto value = filled<float>(count_);
  auto gradient = filled<float>(rows_.size());
  const auto evaluated = evaluate(tape_, Points{rows_.data(), count_}, {.strategy = gradient_},
                                  {.value = value.data(), .gradient = gradient.data()}, execution);
  if (!evaluated) throw std::logic_error(to_string(evaluated.error()));
  const std::size_t bad = evaluated->bad_rows;
  auto alone = filled<float>(count_);
  evaluate(tape_, rows_.data(), count_, alone.data(), nullptr, execution);
  Hash hash;
  hash.add(&bad, sizeof bad);
  hash.add(value), hash.add(gradient), hash.add(alone);
  return hash.value();
}

std::uint64_t Workload::run_grid(const Execution& execution) const {
  const Grid grid =
      tape_.dimension == 2
          ? Grid{.origin = {-100, -100}, .step = {{11, 1}, {-0.5, 9}}, .size = {190, 137, 1}}
          : Grid{.origin = {-10, -50, -80}, .step = {{3.1}, {0, 4.2, 1}, {0, -0.7, 3}}, .size = {45, 41, 43}};
  Hash hash;
  for (const float band : {std::numeric_limits<float>::infinity(), 10.0F, 0.0F}) {
    auto value = filled<float>(grid.count());
    auto inside = filled<std::uint8_t>(grid.count());
    const auto evaluated = evaluate_grid(
        tape_, grid, {.value = band > 0 ? value.data() : nullptr, .inside = inside.data(), .band = band}, execution);
    if (!evaluated) throw std::logic_error(to_string(evaluated.error()));
    hash.add(value), hash.add(inside);
  }
  return hash.value();
}

PairQueries Workload::pair_queries(const Tape* const* shapes) const {
  return {.shapes = shapes, .shape_count = 2, .poses = rows_.data(), .count = count_};
}

std::uint64_t Workload::run_pairs(const Execution& execution) const {
  const auto d = static_cast<std::size_t>(tape_.dimension), slots = std::size_t{4};
  auto status = filled<std::uint8_t>(count_), converged = status, of_contact = filled<std::uint8_t>(slots * count_);
  auto evaluations = filled<std::uint32_t>(count_), found = evaluations;
  auto value = filled<float>(count_), lower = value, point = filled<float>(d * count_), normal = point;
  auto contact_point = filled<float>(slots * d * count_), contact_normal = contact_point;
  auto contact_value = filled<float>(slots * count_), contact_lower = contact_value;
  CollideColumns columns;
  columns.status = status.data(), columns.converged = converged.data(), columns.evaluations = evaluations.data();
  columns.value = value.data(), columns.lower = lower.data();
  columns.point = point.data(), columns.normal = normal.data();
  PairContacts contacts;
  contacts.capacity = options_.goal == Goal::deepest ? slots : 0;
  contacts.found = contacts.capacity == 0 ? nullptr : found.data();
  contacts.point = contact_point.data(), contacts.normal = contact_normal.data();
  contacts.value = contact_value.data(), contacts.lower = contact_lower.data();
  contacts.converged = of_contact.data();
  PairOptions options;
  static_cast<CollideOptions&>(options) = options_;
  const Tape* const shapes[] = {&tape_, &second_};
  const auto summary = collide_pairs(pair_queries(shapes), options, columns, contacts, execution);
  if (!summary) throw std::logic_error(to_string(summary.error()));
  Hash hash;
  for (const auto* column : {&status, &converged, &of_contact}) hash.add(*column);
  for (const auto* column : {&evaluations, &found}) hash.add(*column);
  for (const auto* column : {&value, &lower, &point, &normal}) hash.add(*column);
  for (const auto* column : {&contact_point, &contact_normal, &contact_value, &contact_lower}) hash.add(*column);
  return hash.value();
}

std::uint64_t Workload::run_distances(const Execution& execution) const {
  const auto d = static_cast<std::size_t>(tape_.dimension);
  auto status = filled<std::uint8_t>(count_), converged = status;
  auto distance = filled<float>(count_), lower = distance;
  auto point_a = filled<float>(d * count_), point_b = point_a, normal = point_a;
  auto evaluations = filled<std::uint32_t>(count_);
  const Tape* const shapes[] = {&tape_, &second_};
  const auto summary = measure_distances(pair_queries(shapes), {},
                                         {status.data(), distance.data(), lower.data(), point_a.data(), point_b.data(),
                                          normal.data(), converged.data(), evaluations.data()},
                                         execution);
  if (!summary) throw std::logic_error(to_string(summary.error()));
  Hash hash;
  for (const auto* column : {&status, &converged}) hash.add(*column);
  for (const auto* column : {&distance, &lower, &point_a, &point_b, &normal}) hash.add(*column);
  hash.add(evaluations);
  return hash.value();
}

std::uint64_t Workload::run_sweeps(const Execution& execution) const {
  const auto d = static_cast<std::size_t>(tape_.dimension);
  auto status = filled<std::uint8_t>(count_), converged = status;
  auto lower = filled<float>(count_), upper = lower, value = lower;
  auto point = filled<float>(d * count_), normal = point, barycentric = filled<float>(3 * count_);
  auto evaluations = filled<std::uint32_t>(count_);
  const SweepColumns columns{status.data(), lower.data(),  upper.data(),       converged.data(),  value.data(),
                             point.data(),  normal.data(), barycentric.data(), evaluations.data()};
  SweepQueries queries{.rows = rows_.data(), .count = count_};
  (moves_scene_ ? queries.motions : queries.ends) = moves_.data();
  const auto summary = has_circles_ ? sweep_circles(tape_, queries, {}, columns, execution)
                                    : sweep_triangles(tape_, queries, {}, columns, execution);
  if (!summary) throw std::logic_error(to_string(summary.error()));
  Hash hash;
  for (const auto* column : {&status, &converged}) hash.add(*column);
  for (const auto* column : {&lower, &upper, &value, &point, &normal, &barycentric}) hash.add(*column);
  hash.add(evaluations);
  return hash.value();
}

std::uint64_t Workload::run_queries(const Execution& execution) const {
  const auto d = static_cast<std::size_t>(tape_.dimension);
  auto status = filled<std::uint8_t>(count_), converged = status, claimed = status, ambiguous = status;
  auto starts = filled<std::uint32_t>(count_), iterations = starts, evaluations = starts;
  auto value = filled<float>(count_), lower = value;
  auto point = filled<float>(d * count_), normal = point, barycentric = filled<float>(3 * count_);
  CollideColumns columns;
  columns.status = status.data(), columns.converged = converged.data();
  columns.claimed = claimed.data(), columns.ambiguous = ambiguous.data();
  columns.starts = starts.data(), columns.iterations = iterations.data();
  columns.evaluations = evaluations.data();
  columns.value = value.data(), columns.lower = lower.data();
  columns.point = point.data(), columns.normal = normal.data();
  if (kind_ == Kind::triangles) columns.barycentric = barycentric.data();
  const Queries queries{rows_.data(), count_};
  const auto summary = kind_ == Kind::triangles ? collide_triangles(tape_, queries, options_, columns, execution)
                                                : collide_circles(tape_, queries, options_, columns, execution);
  if (!summary) throw std::logic_error(to_string(summary.error()));
  Hash hash;
  hash.add(&summary->evaluations, sizeof summary->evaluations);
  for (const auto* column : {&status, &converged, &claimed, &ambiguous}) hash.add(*column);
  for (const auto* column : {&starts, &iterations, &evaluations}) hash.add(*column);
  for (const auto* column : {&value, &lower, &point, &normal, &barycentric}) hash.add(*column);
  return hash.value();
}

}  // namespace thalweg::determinism
