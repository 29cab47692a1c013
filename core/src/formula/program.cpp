// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The text form of `.vm` files: a name, an opcode and its arguments on each line, empty lines and lines that start with
// # left out. Arguments are names of lines above, but for `const`, which has a number.
#include <charconv>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "formula/formula.h"
#include "scene/text.h"

namespace thalweg::formula {
namespace {

class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  Result<Formula> read() {
    int last = -1;
    while (start_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', start_), text_.size());
      take_words(end);
      start_ = end + 1;
      if (words_.empty() || text_[words_[0].begin] == '#') continue;
      auto step = line();
      if (!step) return step.error();
      last = *step;
    }
    if (last < 0) return fault(text_.size(), "at least one line with a name and an opcode", "none");
    return builder_.finish(last);
  }

 private:
  struct Word {
    std::size_t begin, end;
  };

  void take_words(std::size_t end) {
    words_.clear();
    end_ = end;
    const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; };
    for (std::size_t i = start_; i < end;) {
      while (i < end && is_space(text_[i])) ++i;
      const std::size_t begin = i;
      while (i < end && !is_space(text_[i])) ++i;
      if (i > begin) words_.push_back({begin, i});
    }
  }

  [[nodiscard]] std::string_view at(std::size_t word) const {
    return text_.substr(words_[word].begin, words_[word].end - words_[word].begin);
  }
  [[nodiscard]] Error fault(std::size_t position, std::string expected, std::string found) const {
    return {.file = "",
            .place = scene::line_and_column(text_, position),
            .expected = std::move(expected),
            .found = std::move(found)};
  }
  [[nodiscard]] Error fault_at(std::size_t word, std::string expected) const {
    if (word >= words_.size()) return fault(end_, std::move(expected), "the end of the line");
    return fault(words_[word].begin, std::move(expected), scene::in_quotes(at(word)));
  }

  Result<int> line() {
    if (named_.contains(at(0))) return fault_at(0, "a name that no line above has");
    if (builder_.size() > kMostSteps) {
      return fault(words_[0].begin, "at most " + std::to_string(kMostSteps) + " steps", "more");
    }
    auto step = operation();
    if (step) named_.emplace(at(0), *step);
    return step;
  }

  Result<int> operation() {
    if (words_.size() < 2) return fault_at(1, "an opcode");
    const std::string_view opcode = at(1);
    if (opcode == "const") return number();
    for (int axis = 0; axis < 3; ++axis) {
      static constexpr std::string_view kVariables[] = {"var-x", "var-y", "var-z"};
      if (opcode != kVariables[axis]) continue;
      if (words_.size() > 2) return fault_at(2, "the end of the line");
      return builder_.coordinate(axis);
    }
    const int op = ops::find_opcode(opcode);
    if (op < 0) {
      const bool is_hash = opcode == "mix" || opcode == "rand";
      return fault_at(1, is_hash ? "an opcode that is supported (mix and rand are not)" : "an opcode");
    }
    const int operands = ops::registry()[static_cast<std::size_t>(op)].operands;
    int of[2] = {-1, -1};
    for (int i = 0; i < operands; ++i) {
      const auto word = static_cast<std::size_t>(2 + i);
      const auto found = word < words_.size() ? named_.find(at(word)) : named_.end();
      if (found == named_.end()) return fault_at(word, "the name of a line above");
      of[i] = found->second;
    }
    if (words_.size() > static_cast<std::size_t>(2 + operands)) {
      return fault_at(static_cast<std::size_t>(2 + operands), "the end of the line");
    }
    return builder_.apply(op, of[0], of[1]);
  }

  Result<int> number() {
    static constexpr std::string_view kExpected = "a number that float32 can hold";
    if (words_.size() < 3) return fault_at(2, std::string(kExpected));
    std::string_view digits = at(2);
    if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
    double value = 0;
    const auto [rest, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool fits = std::fabs(value) <= static_cast<double>(std::numeric_limits<float>::max());
    if (fault != std::errc() || rest != digits.data() + digits.size() || !fits) {
      return fault_at(2, std::string(kExpected));
    }
    if (words_.size() > 3) return fault_at(3, "the end of the line");
    return builder_.constant(value);
  }

  std::string_view text_;
  std::size_t start_ = 0;  ///< of the next line
  std::size_t end_ = 0;    ///< of the current one
  std::vector<Word> words_;
  std::unordered_map<std::string_view, int> named_;
  Builder builder_;
};

}  // namespace

Result<Formula> parse_program(std::string_view text) { return Reader(text).read(); }

}  // namespace thalweg::formula
