// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "gradient/strategies.h"

#include <cmath>

namespace thalweg {
namespace {

Error refused(std::string_view option, std::string_view expected, std::string_view found) {
  return {.file = "", .place = std::string(option), .expected = std::string(expected), .found = std::string(found)};
}

bool is_dichotomy(Gradient strategy) {
  return strategy == Gradient::dichotomy || strategy == Gradient::dichotomy_verbatim;
}

bool is_length(double x) { return std::isfinite(x) && x >= 0; }

bool has_size(const Tape& tape) {
  const Bounds& bounds = tape.facts.bounds;
  return !bounds.empty(tape.dimension) && bounds.finite(tape.dimension) && bounds.diagonal(tape.dimension) > 0;
}

}  // namespace

std::optional<Error> refusal(const Tape& tape, Gradient strategy, const ProbeOffset& offset) {
  if (is_dichotomy(strategy) && tape.dimension != 2) {
    return refused("--gradient", "a strategy for 3D: autodiff, central, forward, simplex, closest_point",
                   name(strategy));
  }
  if (!is_length(offset.absolute) || !is_length(offset.of_value) || !is_length(offset.of_scene)) {
    return refused("--gradient-offset", "numbers of at least 0", "another number");
  }
  if (offset.absolute == 0 && offset.of_value == 0 && offset.of_scene == 0) {
    return refused("--gradient-offset", "a number above 0", "0");
  }
  if (offset.of_scene > 0 && !has_size(tape)) {
    return refused("--gradient-offset", "an offset that does not ask for the size of an unbounded scene", "scene");
  }
  return std::nullopt;
}

GradientRule rule_of(const Tape& tape, Gradient strategy, const ProbeOffset& offset) {
  double absolute = offset.absolute;
  if (offset.of_scene > 0) absolute = std::fmax(absolute, offset.of_scene * tape.facts.bounds.diagonal(tape.dimension));
  // The published code has one fixed offset.
  const double of_value = strategy == Gradient::dichotomy_verbatim ? 0 : offset.of_value;
  return {.strategy = strategy,
          .probe = {.absolute = static_cast<float>(absolute), .of_value = static_cast<float>(of_value)}};
}

std::uint32_t evaluations_of(const GradientRule& rule, int dimension, bool with_value) {
  const auto d = static_cast<std::uint32_t>(dimension);
  const std::uint32_t at_point = with_value || rule.probe.of_value > 0 ? 1 : 0;
  switch (rule.strategy) {
    case Gradient::autodiff:
    case Gradient::closest_point:
      return 1;
    case Gradient::central:
      return 2 * d + at_point;
    case Gradient::forward:
      return d + 1;
    case Gradient::simplex:
      return d + 1 + at_point;
    case Gradient::dichotomy:
    case Gradient::dichotomy_verbatim:
      return 1 + 3 + 8;
  }
  return 0;
}

void evaluate_gradient(const GradientRule& rule, const Tape& tape, const Kernels& kernels,
                       const GradientColumns& columns, float* kernel_scratch) {
  if (rule.strategy != Gradient::autodiff) {
    kernels.strategy(tape, rule, columns, kernel_scratch);
    if (rule.strategy == Gradient::closest_point) return;  // which counts for each point
  } else {
    kernels.gradient(tape, columns.points, columns.count, columns.value, columns.gradient, kernel_scratch);
  }
  if (columns.evaluations == nullptr) return;
  const std::uint32_t cost = evaluations_of(rule, tape.dimension, columns.value != nullptr);
  for (std::size_t i = 0; i < columns.count; ++i) columns.evaluations[i] += cost;
}

}  // namespace thalweg
