// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "explain.h"

#include <cmath>

#include <fmt/format.h>

#include "failure.h"
#include "thalweg/proof.h"

namespace thalweg::cli {

namespace {

Json numbers(const float* values, int count) {
  Json list = Json::array();
  for (int i = 0; i < count; ++i) list.push_back(static_cast<double>(values[i]));
  return list;
}

Json query_of(const Proof& proof) {
  if (proof.is_ball) {
    return {{"query", "ball"},
            {"centre", numbers(proof.corners[0], proof.dimension)},
            {"radius", static_cast<double>(proof.radius)}};
  }
  Json corners = Json::array();
  for (const auto& corner : proof.corners) corners.push_back(numbers(corner, proof.dimension));
  return {{"query", "triangle"}, {"corners", std::move(corners)}};
}

Json cells_of(const Proof& proof) {
  Json cells = Json::array();
  for (const ProofCell& cell : proof.cells) {
    Json at = Json::array();
    for (int i = 0; i < (proof.is_ball ? 4 : 6); ++i) at.push_back(cell.at[i]);
    cells.push_back({{"at", std::move(at)}, {"bound", cell.bound}});
  }
  return cells;
}

}  // namespace

Json explain_row(const Tape& tape, QueryKind kind, const Array& rows, std::size_t row, const CollideOptions& options) {
  if (row >= rows.shape[0]) {
    refuse(kCommandLine, "--explain", fmt::format("a row below {}", rows.shape[0]), fmt::format("{}", row));
  }
  const std::size_t width = rows.values.size() / rows.shape[0];
  const float* numbers_of_row = rows.values.data() + row * width;
  const bool triangles = kind == QueryKind::triangles;
  const Proof proof =
      unwrap(triangles ? prove_triangle(tape, numbers_of_row, options) : prove_circle(tape, numbers_of_row, options),
             kCommandLine, "--explain");
  Json json = {{"thalweg_proof", 1}, {"row", row}, {"dimension", proof.dimension}};
  json.update(query_of(proof));
  json["tolerance"] = proof.tolerance;
  json["row_status"] = name(proof.row_status);
  json["status"] = name(proof.status);
  json["point"] = numbers(proof.point, proof.dimension);
  if (triangles) json["barycentric"] = {1 - proof.u - proof.v, proof.u, proof.v};
  json["value"] = proof.value;
  json["lower"] = proof.lower;
  json["evaluations"] = proof.evaluations;
  json["cells"] = cells_of(proof);
  return json;
}

}  // namespace thalweg::cli
