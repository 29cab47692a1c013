// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Every verdict comes with a proof that the independent checker accepts, and no forged one passes.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "proof_check.h"
#include "random_queries.h"
#include "random_shapes.h"
#include "sampling.h"
#include "thalweg/ops.h"
#include "thalweg/proof.h"

namespace thalweg::property {
namespace {

using oracle::ProofClaim;
using oracle::ProvenQuery;
using oracle::Vec;

Vec vec_of(const float* p, int dimension) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), dimension == 3 ? static_cast<double>(p[2]) : 0.0};
}

ProvenQuery query_of(const Proof& proof) {
  ProvenQuery query;
  query.is_ball = proof.is_ball;
  for (std::size_t k = 0; k < 3; ++k) query.corners[k] = vec_of(proof.corners[proof.is_ball ? 0 : k], proof.dimension);
  query.radius = static_cast<double>(proof.radius);
  query.tolerance = proof.tolerance;
  return query;
}

ProofClaim claim_of(const Proof& proof) {
  ProofClaim claim;
  claim.status = std::string(name(proof.status));
  claim.point = vec_of(proof.point, proof.dimension);
  claim.u = proof.u, claim.v = proof.v, claim.value = proof.value;
  for (const ProofCell& cell : proof.cells) {
    ProofClaim::Cell& made = claim.cells.emplace_back();
    std::copy_n(cell.at, 6, made.at.begin());
    made.bound = cell.bound;
  }
  return claim;
}

/// Proves every row and has each proof checked; counts what was proven.
struct Tally {
  std::size_t separated = 0, overlapping = 0, touching = 0, unverified = 0, undecided = 0;
};

void check_rows(const Shape& shape, const std::vector<float>& rows, bool balls, Tally& tally) {
  const Tape tape = std::move(compile(shape)).value();
  const oracle::Field field(shape);
  const auto width = static_cast<std::size_t>(balls ? tape.dimension + 1 : 3 * tape.dimension);
  for (std::size_t row = 0; row * width < rows.size(); ++row) {
    const float* numbers = rows.data() + row * width;
    const auto proof = balls ? prove_circle(tape, numbers, {}) : prove_triangle(tape, numbers, {});
    ASSERT_TRUE(proof) << to_string(proof.error());
    const bool is_sure = proof->row_status == Status::separated || proof->row_status == Status::overlapping;
    ASSERT_TRUE(!is_sure || proof->status == proof->row_status) << name(proof->status) << " row " << row;
    const std::string fault = oracle::fault_of(field, query_of(*proof), claim_of(*proof));
    // The checker bounds by enclosures alone, and may run out of evaluations where far points helped the row.
    if (fault == "a bound could not be verified") {
      ++tally.unverified;
      continue;
    }
    ASSERT_EQ(fault, "") << name(proof->status) << " row " << row << "\n" << oracle::describe(shape, 0);
    tally.separated += proof->status == Status::separated ? 1U : 0U;
    tally.overlapping += proof->status == Status::overlapping ? 1U : 0U;
    tally.touching += proof->status == Status::touching ? 1U : 0U;
    tally.undecided += proof->status == Status::undecided ? 1U : 0U;
  }
}

TEST(Proof, OfEveryVerdictOnRandomShapesIsAcceptedByTheChecker) {
  Tally tally;
  for (const Drawn& drawn : drawn_trees(71'000, amount(16))) {
    const oracle::Field field(drawn.shape);
    const auto region = oracle::region_of(drawn.shape);
    oracle::Random random(drawn.seed);
    check_rows(drawn.shape, mixed_triangles(random, field, region, 24), false, tally);
    if (HasFatalFailure()) return;
    check_rows(drawn.shape, mixed_circles(random, field, region, 8), true, tally);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(tally.separated, 60U);
  EXPECT_GT(tally.overlapping, 60U);
  EXPECT_GT(tally.touching, 0U);
  EXPECT_LE(tally.unverified * 500, tally.separated);
}

/// A proof with an honest twin: the forgery must be refused, the twin accepted.
class ForgedProof : public testing::Test {
 protected:
  void make(const Shape& shape, const std::vector<float>& row, Status expected) {
    const Tape tape = std::move(compile(shape)).value();
    field_ = std::make_unique<oracle::Field>(shape);
    const auto proof = prove_triangle(tape, row.data(), {});
    ASSERT_TRUE(proof);
    ASSERT_EQ(proof->status, expected);
    query_ = query_of(*proof);
    claim_ = claim_of(*proof);
    ASSERT_EQ(fault(), "");
  }
  [[nodiscard]] std::string fault() const { return oracle::fault_of(*field_, query_, claim_); }

  std::unique_ptr<oracle::Field> field_;
  ProvenQuery query_;
  ProofClaim claim_;
};

/// A triangle that passes close between two discs.
const Shape& gate() {
  static const Shape shape = circle(1).translate(Vec2{0, 1.5}) | circle(1).translate(Vec2{0.3, -1.5});
  return shape;
}
const std::vector<float> kThrough = {-4, -0.3F, 4, -0.2F, -4, 0.35F};

TEST_F(ForgedProof, WithoutACellIsRefused) {
  make(gate(), kThrough, Status::separated);
  ASSERT_GT(claim_.cells.size(), 3U);
  const auto honest = claim_.cells;
  for (std::size_t gone = 0; gone < honest.size(); ++gone) {
    claim_.cells = honest;
    claim_.cells.erase(claim_.cells.begin() + static_cast<std::ptrdiff_t>(gone));
    ASSERT_EQ(fault(), "the cells do not cover the query") << gone;
    // A copy of another cell in its place covers no more.
    claim_.cells.push_back(claim_.cells.front());
    ASSERT_EQ(fault(), "the cells do not cover the query") << gone;
  }
}

TEST_F(ForgedProof, WithAnExaggeratedBoundIsRefused) {
  make(gate(), kThrough, Status::separated);
  const auto honest = claim_.cells;
  for (std::size_t cell = 0; cell < honest.size(); ++cell) {
    claim_.cells = honest;
    claim_.cells[cell].bound += 5;
    ASSERT_EQ(fault(), "a bound exceeds f") << cell;
  }
}

TEST_F(ForgedProof, WithABoundBelowZeroIsNoSeparation) {
  make(gate(), kThrough, Status::separated);
  claim_.cells[0].bound = -1e-9;
  EXPECT_EQ(fault(), "a bound is not above 0");
}

TEST_F(ForgedProof, WithAShrunkOrMovedCellIsRefused) {
  make(gate(), kThrough, Status::separated);
  const auto honest = claim_.cells;
  claim_.cells[0].at[0] += 0.03125;
  EXPECT_EQ(fault(), "the cells do not cover the query");
  claim_.cells = honest;
  claim_.cells[0].at[0] = 0.1;  // no dyadic number
  EXPECT_NE(fault(), "");
}

TEST_F(ForgedProof, OfAnotherFieldOrQueryIsRefused) {
  make(gate(), kThrough, Status::separated);
  query_.corners[2].y = 1.5;
  EXPECT_NE(fault(), "");
  query_.corners[2].y = kThrough[5];
  field_ = std::make_unique<oracle::Field>(gate() | circle(0.2));
  EXPECT_NE(fault(), "");
}

TEST_F(ForgedProof, WithAMovedWitnessIsRefused) {
  make(circle(1), {-0.5F, 0, 3, 0, 3, 1}, Status::overlapping);
  const ProofClaim honest = claim_;
  claim_.point = {3, 0.5, 0}, claim_.u = 0.5, claim_.v = 0.5, claim_.value = -0.2;
  EXPECT_EQ(fault(), "the value is not f at the point");
  claim_.value = (*field_)(claim_.point);
  EXPECT_EQ(fault(), "f is not negative at the point");
  claim_ = honest;
  claim_.point = {0, -0.5, 0}, claim_.value = -0.5;
  EXPECT_EQ(fault(), "the point is not where its coordinates say");
  claim_.u = -0.2, claim_.v = 0.1;
  EXPECT_EQ(fault(), "the point lies outside the query");
}

TEST_F(ForgedProof, WithAnotherToleranceOrVerdictIsRefused) {
  make(box(Vec2{2, 1}), {-1, 1, 1, 1, 0, 3}, Status::touching);
  query_.tolerance = 1e-300;
  EXPECT_NE(fault(), "");
  query_.tolerance = 1e-3;
  claim_.status = "separated";
  EXPECT_EQ(fault(), "a bound is not above 0");
  claim_.status = "overlapping";
  EXPECT_EQ(fault(), "f is not negative at the point");
  claim_.status = "certain";
  EXPECT_EQ(fault(), "no such status");
}

TEST(Proof, OfALocalMethodOrABadRowIsRefused) {
  const Tape tape = std::move(compile(circle(1))).value();
  const float row[] = {0, 0, 1, 0, 0, 1};
  CollideOptions options;
  options.method = Method::accelerated;
  const auto local = prove_triangle(tape, row, options);
  ASSERT_FALSE(local);
  EXPECT_EQ(local.error().place, "--method");
  const float bad[] = {0, 0, 1e16F, 0, 0, 1};
  EXPECT_FALSE(prove_triangle(tape, bad, {}));
}

}  // namespace
}  // namespace thalweg::property
