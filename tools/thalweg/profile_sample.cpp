// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "profile_sample.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "uniform.h"

namespace thalweg::cli {

namespace {

constexpr double kKinkReach = 1e-3;    // in diagonals
constexpr double kKinkAngle = 0.0873;  // 5 degrees
constexpr int kSurfaceSteps = 12;

class Sampler {
 public:
  Sampler(const Tape& tape, std::uint64_t seed)
      : tape_(tape), d_(static_cast<std::size_t>(tape.dimension)), uniform_(seed) {
    diagonal_ = tape.facts.bounds.diagonal(tape.dimension);
  }

  void place_anywhere(double margin, double* p) {
    for (std::size_t axis = 0; axis < d_; ++axis) {
      const double lo = tape_.facts.bounds.lo[axis] - margin * diagonal_;
      const double hi = tape_.facts.bounds.hi[axis] + margin * diagonal_;
      p[axis] = lo + (hi - lo) * uniform_();
    }
  }

  /// Down the gradient to the surface, then off it by 1e-6 to 1 diagonals in a random direction.
  void place_near_surface(double* p) {
    place_anywhere(0.1, p);
    for (int step = 0; step < kSurfaceSteps; ++step) {
      double gradient[3];
      const double value = evaluate_double(tape_, p, gradient);
      double square = 0;
      for (std::size_t axis = 0; axis < d_; ++axis) square += gradient[axis] * gradient[axis];
      if (!(square > 1e-6)) break;
      for (std::size_t axis = 0; axis < d_; ++axis) p[axis] -= value * gradient[axis] / square;
    }
    const double distance = diagonal_ * std::pow(10, -6 + 5.5 * uniform_());
    double direction[3], square = 0;
    do {
      square = 0;
      for (std::size_t axis = 0; axis < d_; ++axis) {
        direction[axis] = 2 * uniform_() - 1;
        square += direction[axis] * direction[axis];
      }
    } while (!(square > 1e-2 && square <= 1));
    for (std::size_t axis = 0; axis < d_; ++axis) p[axis] += distance * direction[axis] / std::sqrt(square);
  }

  [[nodiscard]] double uniform() { return uniform_(); }

 private:
  const Tape& tape_;
  std::size_t d_;
  double diagonal_ = 1;
  Uniform uniform_;
};

template <class A>
double angle(const A* a, const double* b, std::size_t dimension) {
  double dot = 0, aa = 0, bb = 0, cross = 0;
  for (std::size_t i = 0; i < dimension; ++i) {
    const auto x = static_cast<double>(a[i]);
    dot += x * b[i], aa += x * x, bb += b[i] * b[i];
    for (std::size_t j = i + 1; j < dimension; ++j) {
      const double w = x * b[j] - static_cast<double>(a[j]) * b[i];
      cross += w * w;
    }
  }
  // The sine keeps the digits that the cosine of a small angle has lost.
  return aa > 0 && bb > 0 ? std::atan2(std::sqrt(cross), dot) : std::numeric_limits<double>::quiet_NaN();
}

/// Whether the gradient turns over a small regular simplex around p.
bool has_kink_near(const Tape& tape, const double* p, const double* reference, double reach) {
  static constexpr double kFlat[3][3] = {{1, 0, 0}, {-0.5, 0.8660254, 0}, {-0.5, -0.8660254, 0}};
  static constexpr double kSpace[4][3] = {{0.57735, 0.57735, 0.57735},
                                          {0.57735, -0.57735, -0.57735},
                                          {-0.57735, 0.57735, -0.57735},
                                          {-0.57735, -0.57735, 0.57735}};
  const auto d = static_cast<std::size_t>(tape.dimension);
  for (std::size_t vertex = 0; vertex <= d; ++vertex) {
    double at[3] = {}, gradient[3];
    for (std::size_t axis = 0; axis < d; ++axis) {
      at[axis] = p[axis] + reach * (d == 2 ? kFlat[vertex][axis] : kSpace[vertex][axis]);
    }
    evaluate_double(tape, at, gradient);
    if (!(angle(gradient, reference, d) < kKinkAngle)) return true;
  }
  return false;
}

}  // namespace

double angle_between(const float* a, const double* b, std::size_t dimension) { return angle(a, b, dimension); }

ProfileSample ProfileSample::head(std::size_t most) const {
  ProfileSample part = *this;
  if (most >= count()) return part;
  part.points.resize(most * dimension);
  part.reference.resize(most * dimension);
  part.near_kink.resize(most);
  part.band.resize(most);
  return part;
}

ProfileSample make_profile_sample(const Tape& tape, std::size_t count, std::uint64_t seed) {
  ProfileSample sample;
  sample.dimension = static_cast<std::size_t>(tape.dimension);
  sample.diagonal = tape.facts.bounds.diagonal(tape.dimension);
  Sampler sampler(tape, seed);
  for (std::size_t i = 0; i < count; ++i) {
    double p[3] = {}, gradient[3];
    i % 2 == 0 ? sampler.place_anywhere(0.25, p) : sampler.place_near_surface(p);
    // The point is the float32 one that the strategies get.
    for (std::size_t axis = 0; axis < sample.dimension; ++axis) {
      sample.points.push_back(static_cast<float>(p[axis]));
      p[axis] = static_cast<double>(sample.points.back());
    }
    const double value = evaluate_double(tape, p, gradient);
    sample.reference.insert(sample.reference.end(), gradient, gradient + sample.dimension);
    sample.near_kink.push_back(has_kink_near(tape, p, gradient, kKinkReach * sample.diagonal) ? 1 : 0);
    const auto band = std::upper_bound(kBandStarts.begin(), kBandStarts.end(), std::fabs(value) / sample.diagonal);
    sample.band.push_back(static_cast<std::uint8_t>(band - kBandStarts.begin() - 1));
  }
  return sample;
}

std::vector<float> profile_triangles(const Tape& tape, std::size_t count, std::uint64_t seed) {
  const auto d = static_cast<std::size_t>(tape.dimension);
  const double reach = tape.facts.bounds.diagonal(tape.dimension) / 36;
  Sampler sampler(tape, seed ^ 0x7472);
  std::vector<float> rows;
  for (std::size_t i = 0; i < count; ++i) {
    double centre[3];
    sampler.place_anywhere(0.125, centre);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      for (std::size_t axis = 0; axis < d; ++axis) {
        rows.push_back(static_cast<float>(centre[axis] + reach * (2 * sampler.uniform() - 1)));
      }
    }
  }
  return rows;
}

}  // namespace thalweg::cli
