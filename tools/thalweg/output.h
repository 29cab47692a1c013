// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Atomic output: a file is written beside its target and renamed when it is whole, so that a failed or interrupted
// command leaves nothing half-written. `-` is stdout; a device or a pipe has nothing to rename and is written
// directly. One output is open at a time.
#pragma once

#include <string>
#include <string_view>

namespace thalweg::cli {

class Output {
 public:
  /// Opens the file beside `path`; fails when that cannot be done, before any work is spent.
  explicit Output(const std::string& path);
  ~Output();
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  void write(std::string_view bytes);
  /// Makes the output visible under its name. Without it the destructor removes what was written.
  void commit();

  [[nodiscard]] bool is_stdout() const { return target_ == "-"; }

 private:
  void open_beside();

  std::string target_;     ///< as given
  std::string final_;      ///< the target with links resolved
  std::string temporary_;  ///< empty when written directly
  int descriptor_ = -1;
};

/// Whether `path` is stdout or exists and is neither a regular file nor a directory: no rename, no extension.
[[nodiscard]] bool is_stream(const std::string& path);

/// Text to stdout or stderr in full; a failed write to stdout is a failure of the machine.
void write_stdout(std::string_view text);
void write_stderr(std::string_view text);

/// SIGINT, SIGTERM, SIGHUP and SIGPIPE remove the unfinished file, then end the process as they would have.
void remove_output_on_signals();

}  // namespace thalweg::cli
