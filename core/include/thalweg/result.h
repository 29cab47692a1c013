// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Errors are values with a place: what a parser, a compiler or a query refuses comes back as an Error that says
// where, what was expected and what was found. The library never prints, exits or throws for bad input.
#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace thalweg {

/// One refused request. `file` and `place` may be empty until the caller that knows them fills them in.
struct Error {
  std::string file;      ///< name of the text or array that holds the fault
  std::string place;     ///< JSON pointer, line:column, row, dtype or option name
  std::string expected;  ///< what would have been accepted
  std::string found;     ///< what was there
};

/// `FILE: PLACE: expected E, found F`, the one line that every front end prints; empty parts are left out.
[[nodiscard]] std::string to_string(const Error& error);

/// Either a value or the error that kept it from being made.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}      // NOLINT(google-explicit-constructor)
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] explicit operator bool() const { return state_.index() == 0; }
  [[nodiscard]] const T& operator*() const& { return value(); }
  [[nodiscard]] T&& operator*() && { return std::move(*this).value(); }
  [[nodiscard]] const T* operator->() const { return &value(); }

  [[nodiscard]] const T& value() const& {
    assert(*this);
    return *std::get_if<0>(&state_);
  }
  [[nodiscard]] T&& value() && {
    assert(*this);
    return std::move(*std::get_if<0>(&state_));
  }
  [[nodiscard]] const Error& error() const {
    assert(!*this);
    return *std::get_if<1>(&state_);
  }

 private:
  std::variant<T, Error> state_;
};

}  // namespace thalweg
