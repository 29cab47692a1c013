// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "proof_check.h"

namespace thalweg::oracle {
namespace {

Vec vec_of(const nlohmann::json& numbers) {
  return {numbers.at(0).get<double>(), numbers.at(1).get<double>(), numbers.size() > 2 ? numbers[2].get<double>() : 0};
}

}  // namespace

void read_proof(std::string_view json, ProvenQuery& query, ProofClaim& claim) {
  const auto root = nlohmann::json::parse(json);
  query.is_ball = root.at("query") == "ball";
  query.tolerance = root.at("tolerance").get<double>();
  if (query.is_ball) {
    query.corners.fill(vec_of(root.at("centre")));
    query.radius = root.at("radius").get<double>();
  } else {
    for (std::size_t k = 0; k < 3; ++k) query.corners[k] = vec_of(root.at("corners").at(k));
    claim.u = root.at("barycentric").at(1).get<double>();
    claim.v = root.at("barycentric").at(2).get<double>();
  }
  claim.status = root.at("status").get<std::string>();
  claim.point = vec_of(root.at("point"));
  claim.value = root.at("value").get<double>();
  claim.cells.clear();
  for (const auto& cell : root.at("cells")) {
    ProofClaim::Cell& made = claim.cells.emplace_back();
    const auto& at = cell.at("at");
    for (std::size_t i = 0; i < 6; ++i) made.at[i] = i < at.size() ? at[i].get<double>() : 0;
    made.bound = cell.at("bound").get<double>();
  }
}

}  // namespace thalweg::oracle
