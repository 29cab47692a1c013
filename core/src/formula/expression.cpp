// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// An expression by recursive descent:
//   sum     = product {("+" | "-") product}
//   product = signed {("*" | "/") signed}
//   signed  = {"+" | "-"} value
//   value   = number | "x" | "y" | "z" | function "(" sum {"," sum} ")" | "(" sum ")"
#include <charconv>
#include <cmath>
#include <optional>

#include "formula/formula.h"
#include "scene/text.h"

namespace thalweg::formula {
namespace {

/// Parentheses may be nested this deep.
constexpr int kDeepest = 500;

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  Result<Formula> read() {
    const int root = sum();
    skip_space();
    if (!error_ && at_ < text_.size()) refuse("an operator or the end");
    if (error_) return *error_;
    return builder_.finish(root);
  }

 private:
  // After a fault every rule returns at once, with any number.

  int refuse(std::string expected) { return refuse_at(at_, std::move(expected), shown(at_)); }
  int refuse_at(std::size_t position, std::string expected, std::string found) {
    if (!error_) {
      error_ = Error{.file = "",
                     .place = scene::line_and_column(text_, position),
                     .expected = std::move(expected),
                     .found = std::move(found)};
    }
    at_ = text_.size();
    return 0;
  }
  /// The word or character at a place.
  [[nodiscard]] std::string shown(std::size_t position) const {
    if (position >= text_.size()) return "the end";
    std::size_t end = position;
    while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]) || text_[end] == '.')) ++end;
    return scene::in_quotes(text_.substr(position, std::max<std::size_t>(end - position, 1)));
  }

  void skip_space() {
    while (at_ < text_.size() && (text_[at_] == ' ' || (text_[at_] >= '\t' && text_[at_] <= '\r'))) ++at_;
  }
  /// Takes one of these characters if it comes next; 0 if none does.
  char take(std::string_view any_of) {
    skip_space();
    if (at_ >= text_.size() || any_of.find(text_[at_]) == std::string_view::npos) return 0;
    return text_[at_++];
  }
  int apply(std::string_view name, int a, int b = -1) {
    if (error_) return 0;
    if (builder_.size() > kMostSteps) return refuse("at most " + std::to_string(kMostSteps) + " steps");
    return builder_.apply(ops::find_function(name), a, b);
  }

  int sum() {
    if (++depth_ > kDeepest) return refuse("at most " + std::to_string(kDeepest) + " nested parentheses");
    int left = product();
    while (const char sign = take("+-")) {
      const int right = product();
      left = apply(sign == '+' ? "add" : "sub", left, right);
    }
    --depth_;
    return left;
  }
  int product() {
    int left = signed_value();
    while (const char sign = take("*/")) {
      const int right = signed_value();
      left = apply(sign == '*' ? "mul" : "div", left, right);
    }
    return left;
  }
  int signed_value() {
    bool negative = false;
    while (const char sign = take("+-")) negative = negative != (sign == '-');
    const int of = value();
    return negative ? apply("neg", of) : of;
  }
  int value() {
    if (take("(") != 0) {
      const int inner = sum();
      if (take(")") == 0) return refuse("\")\" or an operator");
      return inner;
    }
    skip_space();
    if (at_ >= text_.size()) return refuse("a number, a coordinate or a function");
    if (is_digit(text_[at_]) || text_[at_] == '.') return number();
    if (is_letter(text_[at_])) return word();
    return refuse("a number, a coordinate or a function");
  }
  int number() {
    double found = 0;
    const auto [rest, fault] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), found);
    if (fault != std::errc() || !(std::fabs(found) <= 3e38)) return refuse("a number that float32 can hold");
    at_ = static_cast<std::size_t>(rest - text_.data());
    return builder_.constant(found);
  }
  int word() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
    const std::string_view name = text_.substr(begin, at_ - begin);
    for (int axis = 0; axis < 3; ++axis) {
      if (name == std::string_view("xyz").substr(static_cast<std::size_t>(axis), 1)) return builder_.coordinate(axis);
    }
    const int op = ops::find_function(name);
    const bool is_function = op >= 0 && !ops::registry()[static_cast<std::size_t>(op)].internal;
    const int operands = is_function ? ops::registry()[static_cast<std::size_t>(op)].operands : 0;
    if (!is_function) return refuse_at(begin, "x, y, z or a function", scene::in_quotes(name));
    if (take("(") == 0) return refuse("\"(\" after " + std::string(name));
    int of[2] = {-1, -1};
    for (int i = 0; i < operands; ++i) {
      if (i > 0 && take(",") == 0) return refuse("\",\": " + std::string(name) + " has two arguments");
      of[i] = sum();
    }
    if (take(")") == 0) return refuse("\")\" after the last argument of " + std::string(name));
    return apply(name, of[0], of[1]);
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int depth_ = 0;
  Builder builder_;
  std::optional<Error> error_;
};

}  // namespace

Result<Formula> parse_expression(std::string_view text) { return Reader(text).read(); }

}  // namespace thalweg::formula
