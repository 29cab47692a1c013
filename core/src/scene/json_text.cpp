// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A first pass over the events finds what a document tree could no longer show; the second builds the tree.
#include "scene/json_text.h"

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scene/text.h"

namespace thalweg::scene {
namespace {

using nlohmann::json;

/// What the library says of a fault, without its own name, number and position.
std::string plain(std::string_view what) {
  if (const auto bracket = what.find("] "); bracket != std::string_view::npos) what.remove_prefix(bracket + 2);
  if (const auto colon = what.find(": "); colon != std::string_view::npos) what.remove_prefix(colon + 2);
  if (const auto dash = what.find(" - "); dash != std::string_view::npos) what.remove_prefix(dash + 3);
  std::string text(what);
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20; }, ' ');
  return text;
}

class Checker final : public nlohmann::json_sax<json> {
 public:
  Checker(std::string_view text, std::string_view file) : text_(text), file_(file) {}
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

  bool null() override { return step(); }
  bool boolean(bool) override { return step(); }
  bool number_integer(number_integer_t) override { return step(); }
  bool number_unsigned(number_unsigned_t) override { return step(); }
  bool number_float(number_float_t, const string_t&) override { return step(); }
  bool string(string_t&) override { return step(); }
  bool binary(binary_t&) override { return step(); }
  bool start_object(std::size_t) override { return open(true); }
  bool start_array(std::size_t) override { return open(false); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    levels_.back().step = pointer_step(name);
    if (levels_.back().keys.insert(name).second) return true;
    return fail(pointer(), "each key once", in_quotes(name) + " again");
  }
  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& e) override {
    const bool overflow = e.id == 406;
    return fail(line_and_column(text_, position == 0 ? 0 : position - 1),
                overflow ? "a number that a double can hold" : "JSON", plain(e.what()));
  }

 private:
  struct Level {
    bool is_object = false;
    std::size_t count = 0;
    std::string step;
    std::set<std::string> keys;
  };

  bool step() {
    if (!levels_.empty()) ++levels_.back().count;
    return true;
  }
  bool open(bool is_object) {
    if (levels_.size() == kDeepestNesting) {
      return fail(pointer(), "nesting of at most " + std::to_string(kDeepestNesting), "deeper nesting");
    }
    levels_.push_back({.is_object = is_object, .count = 0, .step = "", .keys = {}});
    return true;
  }
  bool close() {
    levels_.pop_back();
    return step();
  }
  [[nodiscard]] std::string pointer() const {
    std::string all;
    for (const Level& level : levels_) all += "/" + (level.is_object ? level.step : std::to_string(level.count));
    return all;
  }
  bool fail(std::string place, std::string expected, std::string found) {
    error_ = Error{std::string(file_), std::move(place), std::move(expected), std::move(found)};
    return false;
  }

  std::string_view text_;
  std::string_view file_;
  std::vector<Level> levels_;
  std::optional<Error> error_;
};

}  // namespace

std::string pointer_step(std::string_view key) {
  std::string escaped;
  for (const char c : key) {
    if (c == '~') {
      escaped += "~0";
    } else if (c == '/') {
      escaped += "~1";
    } else {
      escaped += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
  }
  return escaped;
}

Result<json> parse_json(std::string_view text, std::string_view file) {
  Checker checker(text, file);
  if (!json::sax_parse(text.begin(), text.end(), &checker)) return *checker.error();
  return json::parse(text.begin(), text.end(), nullptr, false);
}

}  // namespace thalweg::scene
