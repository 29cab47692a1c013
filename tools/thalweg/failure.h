// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// How a command fails: one exception type that carries the exit code and the error that is printed. The library
// returns errors as values; a command is a straight line from its arguments to its output, so it throws and
// run() catches, once.
#pragma once

#include <exception>
#include <string>
#include <utility>

#include "thalweg/result.h"

namespace thalweg::cli {

enum class ExitCode : int {
  done = 0,
  request = 1,  ///< the request is wrong: arguments, scene, array
  machine = 2,  ///< the machine failed us: a failed write, memory
};

/// The file name that stands in errors about arguments.
inline constexpr const char* kCommandLine = "command line";

class Failure : public std::exception {
 public:
  Failure(ExitCode code, Error error);

  [[nodiscard]] ExitCode code() const { return code_; }
  [[nodiscard]] const Error& error() const { return error_; }
  [[nodiscard]] const char* what() const noexcept override { return line_.c_str(); }  ///< one line, no newline

 private:
  ExitCode code_;
  Error error_;
  std::string line_;
};

/// Throws: the request is wrong.
[[noreturn]] void refuse(std::string file, std::string place, std::string expected, std::string found);

/// Throws: the machine failed us.
[[noreturn]] void fail(std::string file, std::string place, std::string expected, std::string found);

/// Throws a library error as a wrong request; `file` and `place` fill what the library left empty.
[[noreturn]] void refuse(Error error, const std::string& file, const std::string& place);

/// The value of a result, or the failure that it holds.
template <class T>
[[nodiscard]] T unwrap(Result<T> result, const std::string& file, const std::string& place) {
  if (!result) refuse(result.error(), file, place);
  return std::move(result).value();
}

/// `thalweg: FILE: PLACE: expected E, found F`: always one line, whatever control characters the parts hold.
[[nodiscard]] std::string error_line(const Error& error);

}  // namespace thalweg::cli
