// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
#include "shape/validate.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace thalweg::shape {
namespace {

using ops::Entry;

bool in_range(const OpParameter& parameter, double number) {
  if (!std::isfinite(number)) return false;
  switch (parameter.quantity) {
    case Quantity::choice: {
      const auto words = 1 + std::count(parameter.choices.begin(), parameter.choices.end(), '|');
      return number >= 0 && number < static_cast<double>(words) && number == std::floor(number);
    }
    case Quantity::count:
      return number == std::floor(number) && parameter.least <= number && number <= parameter.most;
    default:
      // A size of zero is accepted where the range starts there; anything between it and the smallest length is not.
      if (parameter.least == 0 && number > 0 && number < ops::kSmallest) return false;
      return parameter.least <= number && number <= parameter.most;
  }
}

bool normalise(std::span<double> numbers) {
  double most = 0;
  for (const double number : numbers) most = std::max(most, std::fabs(number));
  if (most == 0) return false;
  double square = 0;
  for (double& number : numbers) {
    number /= most;
    square += number * number;
  }
  for (double& number : numbers) number /= std::sqrt(square);
  return true;
}

std::optional<Error> validate_parameter(const OpParameter& parameter, std::span<double> numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (in_range(parameter, numbers[i])) continue;
    std::string place(parameter.name);
    if (parameter.arity == 0) place += "/" + std::to_string(i / 2) + "/" + std::to_string(i % 2);
    if (parameter.arity > 1) place += "/" + std::to_string(i);
    return Error{.file = "", .place = place, .expected = describe(parameter), .found = to_text(numbers[i])};
  }
  const bool has_length = parameter.quantity == Quantity::direction || parameter.quantity == Quantity::quaternion;
  if (has_length && !normalise(numbers)) {
    return Error{
        .file = "", .place = std::string(parameter.name), .expected = "a vector of non-zero length", .found = "zero"};
  }
  return std::nullopt;
}

std::optional<Error> validate_operands(const Entry& entry, const std::vector<Shape>& of) {
  const bool many = entry.row.kind == OpKind::combine;
  const std::size_t wanted = entry.row.kind == OpKind::primitive ? 0 : 1;
  if (many ? of.empty() : of.size() != wanted) {
    return Error{.file = "",
                 .place = "of",
                 .expected = many ? "at least one operand" : std::to_string(wanted) + " operand(s)",
                 .found = std::to_string(of.size())};
  }
  const int dimension = entry.row.dimension != 0 || of.empty() ? entry.row.dimension : of[0].dimension();
  for (std::size_t i = 0; i < of.size(); ++i) {
    if (of[i].dimension() == dimension) continue;
    return Error{.file = "",
                 .place = many ? "of/" + std::to_string(i) : "of",
                 .expected = "a shape of dimension " + std::to_string(dimension),
                 .found = "one of dimension " + std::to_string(of[i].dimension())};
  }
  return std::nullopt;
}

/// The numbers of one parameter as an error shows them.
std::string found_in(const Entry& entry, std::span<const double> numbers, std::string_view name) {
  std::size_t at = 0;
  for (const OpParameter& parameter : entry.row.parameters) {
    const std::size_t count = parameter.arity == 0 ? numbers.size() - at : static_cast<std::size_t>(parameter.arity);
    if (parameter.name == name) {
      if (parameter.arity == 0) return std::to_string(count / 2) + " points";
      if (parameter.arity == 1) return to_text(numbers[at]);
      std::string text;
      for (const double number : numbers.subspan(at, count)) text.append(text.empty() ? "[" : ", ") += to_text(number);
      return text + "]";
    }
    at += count;
  }
  return "other numbers";
}

}  // namespace

std::string to_text(double number) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), number).ptr;
  return {text.data(), end};
}

std::string describe(const OpParameter& parameter) {
  const std::string range = "[" + to_text(parameter.least) + ", " + to_text(parameter.most) + "]";
  switch (parameter.quantity) {
    case Quantity::length:
    case Quantity::vector:
      return "a length in " + range;
    case Quantity::point:
      return "a coordinate in " + range;
    case Quantity::angle:
      return "an angle in " + range + " radians";
    case Quantity::count:
      return "a whole number in " + range;
    case Quantity::choice:
      return "one of " + std::string(parameter.choices);
    default:
      return "a number in " + range;
  }
}

std::optional<Error> validate(const Entry& entry, std::vector<double>& numbers, const std::vector<Shape>& of) {
  if (entry.row.kind == OpKind::formula || entry.row.kind == OpKind::scalar) {
    return Error{.file = "",
                 .place = std::string(entry.row.name),
                 .expected = "the text of a formula",
                 .found = std::to_string(numbers.size()) + " numbers"};
  }
  const std::size_t fixed = ops::number_count(entry.row);
  const bool has_list = !entry.row.parameters.empty() && entry.row.parameters.back().arity == 0;
  if (has_list ? numbers.size() % 2 != 0 || numbers.size() < fixed : numbers.size() != fixed) {
    return Error{.file = "",
                 .place = std::string(entry.row.name),
                 .expected = std::to_string(fixed) + " numbers",
                 .found = std::to_string(numbers.size())};
  }
  std::size_t at = 0;
  for (const OpParameter& parameter : entry.row.parameters) {
    const std::size_t count = parameter.arity == 0 ? numbers.size() - at : static_cast<std::size_t>(parameter.arity);
    if (auto error = validate_parameter(parameter, std::span(numbers).subspan(at, count))) return error;
    at += count;
  }
  if (auto error = validate_operands(entry, of)) return error;
  if (entry.check != nullptr) {
    if (const auto complaint = entry.check(numbers)) {
      return Error{.file = "",
                   .place = std::string(complaint->parameter),
                   .expected = std::string(complaint->expected),
                   .found = found_in(entry, numbers, complaint->parameter)};
    }
  }
  return std::nullopt;
}

}  // namespace thalweg::shape
