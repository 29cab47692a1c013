// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// A line on stderr that says how far a batch is, while it runs; only on a terminal, and gone when the batch ends.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string>
#include <thread>

namespace thalweg::cli {

class Progress {
 public:
  /// Shows `noun` and the share of `total` that `done()` has counted.
  Progress(std::string noun, std::size_t total, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// For Execution::done; null when nothing is shown, so that the batch need not count.
  [[nodiscard]] std::atomic<std::size_t>* done() { return shown_ ? &done_ : nullptr; }

 private:
  void show_until_stopped();

  std::string noun_;
  std::size_t total_;
  bool shown_;
  std::atomic<std::size_t> done_ = 0;
  std::mutex mutex_;
  std::condition_variable stopping_;
  bool stopped_ = false;
  std::thread thread_;
};

}  // namespace thalweg::cli
