// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The error line, and the ways to throw it.
#include "failure.h"

#include <fmt/format.h>

namespace thalweg::cli {

namespace {

// A file name or a JSON key may hold a newline; the line that a program reads must not.
std::string one_line(const std::string& text) {
  std::string line;
  line.reserve(text.size());
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code == 0x7f) {
      line += fmt::format("\\x{:02x}", code);
    } else {
      line += c;
    }
  }
  return line;
}

}  // namespace

std::string error_line(const Error& error) { return one_line("thalweg: " + to_string(error)); }

Failure::Failure(ExitCode code, Error error) : code_(code), error_(std::move(error)), line_(error_line(error_)) {}

void refuse(std::string file, std::string place, std::string expected, std::string found) {
  throw Failure(ExitCode::request, Error{std::move(file), std::move(place), std::move(expected), std::move(found)});
}

void fail(std::string file, std::string place, std::string expected, std::string found) {
  throw Failure(ExitCode::machine, Error{std::move(file), std::move(place), std::move(expected), std::move(found)});
}

void refuse(Error error, const std::string& file, const std::string& place) {
  if (error.file.empty()) error.file = file;
  if (error.place.empty()) error.place = place;
  throw Failure(ExitCode::request, std::move(error));
}

}  // namespace thalweg::cli
