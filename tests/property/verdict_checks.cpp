// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "verdict_checks.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "random_queries.h"

namespace thalweg::property {
namespace {

using oracle::Bracket;
using oracle::Field;
using oracle::Vec;
using oracle::Verdict;

std::size_t row_length(Form form, int dimension) {
  return static_cast<std::size_t>(form == Form::triangles ? 3 * dimension : dimension + 1);
}

CollideColumns columns_of(Answers& a) {
  const std::size_t n = a.rows.size() / row_length(a.form, a.dimension);
  const std::size_t d = n * static_cast<std::size_t>(a.dimension);
  for (auto* bytes : {&a.status, &a.converged, &a.claimed, &a.ambiguous}) bytes->assign(n, 77);
  for (auto* numbers : {&a.starts, &a.iterations, &a.evaluations}) numbers->assign(n, 77);
  a.value.assign(n, 0), a.lower.assign(n, 0);
  a.point.assign(d, 0), a.normal.assign(d, 0);
  if (a.form == Form::triangles) a.barycentric.assign(3 * n, 0);
  CollideColumns columns;
  columns.status = a.status.data(), columns.converged = a.converged.data();
  columns.claimed = a.claimed.data(), columns.ambiguous = a.ambiguous.data();
  columns.starts = a.starts.data(), columns.iterations = a.iterations.data();
  columns.evaluations = a.evaluations.data();
  columns.value = a.value.data(), columns.lower = a.lower.data();
  columns.point = a.point.data(), columns.normal = a.normal.data();
  columns.barycentric = a.barycentric.empty() ? nullptr : a.barycentric.data();
  return columns;
}

double segment_gap(Vec p, Vec a, Vec b) {
  const Vec along = b - a;
  const double square = dot(along, along);
  const double t = square > 0 ? std::clamp(dot(p - a, along) / square, 0.0, 1.0) : 0;
  return distance(p, a + along * t);
}

Vec cross(Vec a, Vec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }

/// Distance from p to the filled triangle.
double triangle_gap(Vec p, const std::array<Vec, 3>& t) {
  const double edges = std::min({segment_gap(p, t[0], t[1]), segment_gap(p, t[1], t[2]), segment_gap(p, t[2], t[0])});
  const Vec normal = cross(t[1] - t[0], t[2] - t[0]);
  const double area = length(normal);
  const double size = std::max(distance(t[0], t[1]), distance(t[0], t[2]));
  if (area <= 1e-9 * size * size) return edges;
  for (std::size_t i = 0; i < 3; ++i) {
    if (dot(cross(t[(i + 1) % 3] - t[i], p - t[i]), normal) < 0) return edges;
  }
  return std::abs(dot(p - t[0], normal)) / area;
}

struct Row {
  std::array<Vec, 3> triangle;  // circles: the centre, three times
  double radius = 0;
  double magnitude = 0;
  double lower = 0, value = 0;
  Vec point, normal;
  Status status = Status::undecided;
  bool converged = false;
};

Row row_at(const Answers& a, std::size_t i) {
  Row row;
  if (a.form == Form::triangles) {
    row.triangle = oracle::triangle_at(a.rows, i, a.dimension);
  } else {
    const float* p = a.rows.data() + i * row_length(a.form, a.dimension);
    const Vec centre = oracle::point_at(p, 0, a.dimension);
    row.triangle = {centre, centre, centre};
    row.radius = p[a.dimension];
  }
  for (const Vec v : row.triangle) {
    row.magnitude = std::max({row.magnitude, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  }
  row.magnitude += row.radius;
  row.lower = a.lower[i], row.value = a.value[i];
  row.point = oracle::point_at(a.point.data(), i, a.dimension);
  row.normal = oracle::point_at(a.normal.data(), i, a.dimension);
  row.status = static_cast<Status>(a.status[i]);
  row.converged = a.converged[i] == 1;
  return row;
}

/// Faults that need no oracle.
std::string shape_fault(const Row& row, const Answers& a, std::size_t i) {
  if (a.status[i] > 3) return "status " + std::to_string(a.status[i]);
  if (a.converged[i] > 1 || a.ambiguous[i] > 1 || a.claimed[i] > 1) return "a flag is neither 0 nor 1";
  const double rounding = 1e-6 * row.magnitude;
  const double gap = a.form == Form::triangles ? triangle_gap(row.point, row.triangle)
                                               : distance(row.point, row.triangle[0]) - row.radius;
  if (!(gap <= rounding)) return "the point is outside the query by " + std::to_string(gap);
  if (!(std::abs(length(row.normal) - 1) < 1e-5)) return "the normal's length is " + std::to_string(length(row.normal));
  if (a.form == Form::circles) return "";
  Vec sum;
  double weights = 0, least = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const double weight = a.barycentric[3 * i + k];
    sum = sum + row.triangle[k] * weight;
    weights += weight, least = std::min(least, weight);
  }
  if (!(least >= 0) || !(std::abs(weights - 1) < 1e-5)) return "the barycentric coordinates are not a point";
  if (!(distance(sum, row.point) <= 4 * rounding)) return "the barycentric coordinates are another point";
  return "";
}

std::string verdict_fault(const Field& field, const Row& row, const Bracket& found, const Answers& a) {
  const double margin = field.margin(row.magnitude);
  const Verdict truth = verdict(field, found, row.magnitude);
  switch (row.status) {
    case Status::separated:
      if (truth == Verdict::overlapping) return "separated, but the oracle has a negative point";
      return row.lower >= 0 ? "" : "separated with a negative lower bound";
    case Status::overlapping:
      if (truth == Verdict::separated) return "overlapping, but the oracle proved them apart";
      return field(row.point) <= margin ? "" : "overlapping, but f is not negative at the point";
    case Status::touching:
      if (found.lower > a.tolerance + margin || found.upper < -a.tolerance - margin) return "touching, but it is not";
      return "";
    default:
      return "";
  }
}

std::string bound_fault(const Field& field, const Tape& tape, const Row& row, const Bracket& found) {
  const double margin = field.margin(row.magnitude);
  const double slack = tape.slack(row.magnitude);
  if (row.lower > found.upper + margin) return "lower is above the minimum";
  if (row.lower > row.value + slack) return "lower is above value";
  if (row.value < found.lower - slack - margin) return "value is below the minimum";
  if (!(std::abs(row.value - field(row.point)) <= slack + margin)) return "value is not f at the point";
  return "";
}

std::string goal_fault(const Tape& tape, const Row& row, const Bracket& found, const Answers& a) {
  if (a.options.goal != Goal::deepest || !row.converged) return "";
  const double slack = tape.slack(row.magnitude);
  if (row.value > found.upper + a.tolerance + slack) return "deepest has converged, but there is a deeper point";
  if (row.value - row.lower > a.tolerance + 2 * slack) return "deepest has converged, but value - lower is greater";
  return "";
}

std::string text_of(const Answers& a, const Row& row, const Bracket& found, std::size_t i) {
  std::ostringstream out;
  out << std::setprecision(9) << "row " << i << ":";
  const std::size_t length = row_length(a.form, a.dimension);
  for (std::size_t k = 0; k < length; ++k) out << ' ' << a.rows[i * length + k];
  out << "\nstatus " << name(row.status) << ", value " << row.value << ", lower " << row.lower << ", point "
      << row.point.x << ' ' << row.point.y << ' ' << row.point.z << ", converged " << row.converged << ", evaluations "
      << a.evaluations[i] << ", tolerance " << a.tolerance << "\noracle [" << found.lower << ", " << found.upper
      << "] at " << found.witness.x << ' ' << found.witness.y << ' ' << found.witness.z << " after "
      << found.evaluations << " evaluations";
  return out.str();
}

}  // namespace

Answers answer(const Tape& tape, Form form, std::vector<float> rows, const CollideOptions& options) {
  Answers a;
  a.form = form, a.dimension = tape.dimension, a.rows = std::move(rows), a.options = options;
  a.tolerance = options.tolerance > 0 ? options.tolerance : default_tolerance(tape);
  const CollideColumns columns = columns_of(a);
  const Queries queries{a.rows.data(), a.count()};
  auto summary = form == Form::triangles ? collide_triangles(tape, queries, options, columns)
                                         : collide_circles(tape, queries, options, columns);
  if (!summary) throw std::invalid_argument(to_string(summary.error()));
  a.summary = *summary;
  return a;
}

Bracket oracle_minimum(const Field& field, const Answers& a, std::size_t i, const oracle::Limits& limits) {
  const Row row = row_at(a, i);
  return a.form == Form::triangles ? minimum_over_triangle(field, row.triangle, limits)
                                   : minimum_over_ball(field, row.triangle[0], row.radius, limits);
}

Findings check_rows(const Field& field, const Tape& tape, const Answers& a) {
  Findings findings;
  oracle::Limits limits;
  limits.verdict_only = a.options.goal == Goal::verdict;
  limits.width = limits.verdict_only ? 0 : a.tolerance / 4;
  limits.cap = 4000;
  for (std::size_t i = 0; i < a.count(); ++i) {
    const Row row = row_at(a, i);
    const Bracket found = oracle_minimum(field, a, i, limits);
    findings.unknown += verdict(field, found, row.magnitude) == Verdict::cannot_tell ? 1U : 0U;
    findings.undecided += row.status == Status::undecided ? 1U : 0U;
    findings.unconverged += row.converged ? 0U : 1U;
    findings.over_budget += a.evaluations[i] > a.options.budget ? 1U : 0U;
    std::string fault = shape_fault(row, a, i);
    if (fault.empty()) fault = verdict_fault(field, row, found, a);
    if (fault.empty()) fault = bound_fault(field, tape, row, found);
    if (fault.empty()) fault = goal_fault(tape, row, found, a);
    if (fault.empty()) continue;
    findings.fault = fault + "\n" + text_of(a, row, found, i);
    return findings;
  }
  return findings;
}

}  // namespace thalweg::property
