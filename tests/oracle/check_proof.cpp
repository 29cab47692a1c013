// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// thalweg_check_proof SCENE PROOF [--tolerance X]
//
// Checks what `thalweg collide --explain` wrote: exit code 0 and one line when the proof holds, 1 and the reason when
// it does not. The tolerance that was asked for is the checker's to know: 1e-4 of the diagonal of the scene's bounds,
// or X.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "proof_check.h"
#include "thalweg/scene.h"

namespace {

using namespace thalweg;

std::string read(const char* path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(std::string(path) + ": file: expected a readable file, found none");
  return {std::istreambuf_iterator<char>(file), {}};
}

double asked_tolerance(const Shape& shape, int count, char** arguments) {
  if (count == 5 && std::string(arguments[3]) == "--tolerance") return std::strtod(arguments[4], nullptr);
  const Bounds& bounds = shape.facts().bounds;
  return bounds.finite(shape.dimension()) ? 1e-4 * bounds.diagonal(shape.dimension()) : 1e-4;
}

int check(int count, char** arguments) {
  const auto scene = parse_scene(read(arguments[1]), arguments[1]);
  if (!scene) throw std::runtime_error(to_string(scene.error()));
  oracle::ProvenQuery query;
  oracle::ProofClaim claim;
  oracle::read_proof(read(arguments[2]), query, claim);
  const double tolerance = asked_tolerance(scene->shape, count, arguments);
  std::string fault = query.tolerance > tolerance * (1 + 1e-12) ? "the tolerance is not the one asked for" : "";
  if (fault.empty()) fault = oracle::fault_of(oracle::Field(scene->shape), query, claim);
  if (fault.empty()) {
    std::printf("%s: proven, %zu cells\n", claim.status.c_str(), claim.cells.size());
    return 0;
  }
  std::fprintf(stderr, "thalweg_check_proof: %s: proof: expected a proof of %s, found that %s\n", arguments[2],
               claim.status.c_str(), fault.c_str());
  return 1;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3 && count != 5) {
    std::fputs("thalweg_check_proof: arguments: expected SCENE PROOF [--tolerance X], found others\n", stderr);
    return 1;
  }
  try {
    return check(count, arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "thalweg_check_proof: %s\n", error.what());
    return 1;
  }
}
