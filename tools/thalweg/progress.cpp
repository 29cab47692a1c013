// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The progress line.
#include "progress.h"

#include <unistd.h>

#include <chrono>

#include <fmt/format.h>

#include "output.h"

namespace thalweg::cli {

namespace {

constexpr std::chrono::milliseconds kInterval{200};
constexpr const char* kEraseLine = "\r\x1b[K";

}  // namespace

Progress::Progress(std::string noun, std::size_t total, bool quiet)
    : noun_(std::move(noun)), total_(total), shown_(!quiet && total > 0 && ::isatty(STDERR_FILENO) == 1) {
  if (shown_) thread_ = std::thread([this] { show_until_stopped(); });
}

Progress::~Progress() {
  if (!shown_) return;
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  stopping_.notify_one();
  thread_.join();
}

void Progress::show_until_stopped() {
  std::unique_lock lock(mutex_);
  bool printed = false;
  while (!stopping_.wait_for(lock, kInterval, [this] { return stopped_; })) {
    const double percent =
        100.0 * static_cast<double>(done_.load(std::memory_order_relaxed)) / static_cast<double>(total_);
    write_stderr(fmt::format("{}{} {:.0f} %", kEraseLine, noun_, percent));
    printed = true;
  }
  if (printed) write_stderr(kEraseLine);
}

}  // namespace thalweg::cli
