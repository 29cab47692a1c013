// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// One batch of moving queries with every column, and where the tests think their points are.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "oracle/oracle.h"
#include "thalweg/batch.h"

namespace thalweg {

enum class Moving { triangles_to_ends, triangles, circles };

struct AskedSweeps {
  Tape tape;
  Moving kind;
  std::size_t d, width, count;
  std::vector<float> rows, moves;  ///< the latter ends, or motions
  SweepOptions options;
  std::vector<std::uint8_t> status, converged;
  std::vector<float> lower, upper, value, point, normal, barycentric;
  std::vector<std::uint32_t> evaluations;
  Summary summary;

  AskedSweeps(const Shape& shape, Moving moving, std::vector<float> queries, std::vector<float> how_they_move,
              const SweepOptions& asked = {}, const Execution& execution = {})
      : tape(std::move(compile(shape)).value()),
        kind(moving),
        d(static_cast<std::size_t>(shape.dimension())),
        width(moving == Moving::circles ? d + 1 : 3 * d),
        count(queries.size() / width),
        rows(std::move(queries)),
        moves(std::move(how_they_move)),
        options(asked) {
    for (auto* bytes : {&status, &converged}) bytes->resize(count);
    for (auto* numbers : {&lower, &upper, &value}) numbers->resize(count);
    for (auto* vectors : {&point, &normal}) vectors->resize(d * count);
    barycentric.resize(3 * count);
    evaluations.resize(count);
    SweepQueries queries_of{.rows = rows.data(), .count = count};
    (kind == Moving::triangles_to_ends ? queries_of.ends : queries_of.motions) = moves.data();
    const SweepColumns columns{status.data(), lower.data(),  upper.data(),       converged.data(),  value.data(),
                               point.data(),  normal.data(), barycentric.data(), evaluations.data()};
    const auto answered = kind == Moving::circles ? sweep_circles(tape, queries_of, options, columns, execution)
                                                  : sweep_triangles(tape, queries_of, options, columns, execution);
    EXPECT_TRUE(answered) << to_string(answered.error());
    if (answered) summary = *answered;
  }

  [[nodiscard]] Status status_at(std::size_t row) const { return static_cast<Status>(status[row]); }
  [[nodiscard]] double tolerance() const { return options.tolerance > 0 ? options.tolerance : kDefaultSweepTolerance; }
  [[nodiscard]] oracle::Vec vec(const std::vector<float>& of, std::size_t row) const {
    return {of[row * d], of[row * d + 1], d == 3 ? of[row * d + 2] : 0};
  }
  [[nodiscard]] bool same_bits(const AskedSweeps& other) const {
    const auto same = [](const auto& a, const auto& b) {
      return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
    };
    return same(status, other.status) && same(converged, other.converged) && same(lower, other.lower) &&
           same(upper, other.upper) && same(value, other.value) && same(point, other.point) &&
           same(normal, other.normal) && same(evaluations, other.evaluations) &&
           (kind == Moving::circles || same(barycentric, other.barycentric));
  }

  /// A point of the world at time t in the scene's frame.
  [[nodiscard]] oracle::Vec in_scene(std::size_t row, oracle::Vec x, double t) const {
    if (kind == Moving::triangles_to_ends) return x;
    const float* const m = moves.data() + row * (d == 2 ? 3 : 7);
    x = x - oracle::Vec{m[0], m[1], d == 3 ? m[2] : 0} * t;
    if (d == 2) return turned(x, {0, 0, 1}, -t * static_cast<double>(m[2]));
    const oracle::Vec v{m[4], m[5], m[6]};
    const double length = oracle::length(v);
    if (length == 0) return x;
    const double sign = m[3] < 0 ? -1 : 1;
    return turned(x, v * (sign / length), -t * 2 * std::atan2(length, sign * static_cast<double>(m[3])));
  }
  /// A point of row's triangle by barycentric coordinates, or of its ball by a vector of at most unit length.
  [[nodiscard]] oracle::Vec point_of(std::size_t row, oracle::Vec at, double t) const {
    const float* const r = rows.data() + row * width;
    const auto corner = [&](const float* from, std::size_t k) {
      return oracle::Vec{from[k * d], from[k * d + 1], d == 3 ? from[k * d + 2] : 0};
    };
    if (kind == Moving::circles) return corner(r, 0) + at * static_cast<double>(r[d]);
    const auto mixed = [&](const float* from) {
      return corner(from, 0) * at.x + corner(from, 1) * at.y + corner(from, 2) * at.z;
    };
    if (kind == Moving::triangles) return mixed(r);
    return mixed(r) * (1 - t) + mixed(moves.data() + row * width) * t;
  }

 private:
  static oracle::Vec turned(oracle::Vec p, oracle::Vec n, double angle) {
    const oracle::Vec cross{n.y * p.z - n.z * p.y, n.z * p.x - n.x * p.z, n.x * p.y - n.y * p.x};
    return p * std::cos(angle) + cross * std::sin(angle) + n * ((1 - std::cos(angle)) * dot(n, p));
  }
};

}  // namespace thalweg
