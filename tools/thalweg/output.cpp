// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Atomic output and the signal handler that keeps it so.
#include "output.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <memory>

#include <fmt/format.h>

#include "failure.h"
#include "input.h"

namespace thalweg::cli {

namespace {

// What the signal handler may touch: the unfinished file's name, valid while the flag is set. The name is armed
// before the file is created: it holds our process id, so that it can only be ours.
std::array<char, PATH_MAX> unfinished_name = {};
volatile std::sig_atomic_t unfinished = 0;

void arm(const std::string& name) {
  std::memcpy(unfinished_name.data(), name.c_str(), name.size() + 1);
  unfinished = 1;
}

void disarm() { unfinished = 0; }

extern "C" void remove_unfinished(int number) {
  if (unfinished != 0) ::unlink(unfinished_name.data());
  std::signal(number, SIG_DFL);
  std::raise(number);
}

// Returns 0 or the errno of the failure.
int write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t wrote = ::write(descriptor, bytes.data(), bytes.size());
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(wrote));
  }
  return 0;
}

// The file that a chain of links ends in, so that the rename replaces it and not the link.
std::string resolved(const std::string& path) {
  const std::unique_ptr<char, decltype(&std::free)> real(::realpath(path.c_str(), nullptr), &std::free);
  return real ? std::string(real.get()) : path;
}

}  // namespace

bool is_stream(const std::string& path) {
  if (path == "-") return true;
  struct stat status = {};
  return ::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

Output::Output(const std::string& path) : target_(path) {
  if (is_stdout()) {
    descriptor_ = STDOUT_FILENO;
  } else if (is_stream(path)) {
    descriptor_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) fail(target_, "file", "a writable file", system_message(errno));
  } else {
    open_beside();
  }
}

void Output::open_beside() {
  final_ = resolved(target_);
  struct stat status = {};
  const bool exists = ::stat(final_.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) fail(target_, "file", "a writable file", "a directory");
  if (exists && ::access(final_.c_str(), W_OK) != 0) fail(target_, "file", "a writable file", system_message(errno));
  for (int attempt = 0; descriptor_ < 0; ++attempt) {
    const std::string folder = final_.substr(0, final_.find_last_of('/') + 1);
    temporary_ = fmt::format("{}.thalweg-{}-{}.tmp", folder, static_cast<long>(::getpid()), attempt);
    if (temporary_.size() >= unfinished_name.size()) {
      temporary_.clear();
      fail(target_, "file", "a writable file", system_message(ENAMETOOLONG));
    }
    arm(temporary_);
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ >= 0) break;
    const int error_number = errno;
    disarm();
    if (error_number != EEXIST) {
      temporary_.clear();
      fail(target_, "file", "a writable file", system_message(error_number));
    }
  }
  if (exists) static_cast<void>(::fchmod(descriptor_, status.st_mode & 07777));
}

Output::~Output() {
  if (descriptor_ >= 0 && !is_stdout()) ::close(descriptor_);
  if (!temporary_.empty()) {
    ::unlink(temporary_.c_str());
    disarm();
  }
}

void Output::write(std::string_view bytes) {
  const int error_number = write_all(descriptor_, bytes);
  if (error_number != 0) {
    fail(is_stdout() ? "stdout" : target_, "file", "a successful write", system_message(error_number));
  }
}

void Output::commit() {
  if (is_stdout()) return;
  const int closed = ::close(descriptor_);
  descriptor_ = -1;
  if (closed != 0) fail(target_, "file", "a successful write", system_message(errno));
  if (temporary_.empty()) return;
  if (::rename(temporary_.c_str(), final_.c_str()) != 0) {
    fail(target_, "file", "a successful rename", system_message(errno));
  }
  temporary_.clear();
  disarm();
}

void write_stdout(std::string_view text) {
  const int error_number = write_all(STDOUT_FILENO, text);
  if (error_number != 0) fail("stdout", "file", "a successful write", system_message(error_number));
}

// There is nowhere left to report a failure of stderr.
void write_stderr(std::string_view text) { static_cast<void>(write_all(STDERR_FILENO, text)); }

void remove_output_on_signals() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) {
    struct sigaction action = {};
    struct sigaction before = {};
    action.sa_handler = remove_unfinished;
    sigemptyset(&action.sa_mask);
    // A signal that the parent chose to ignore (nohup) stays ignored.
    if (::sigaction(number, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) {
      ::sigaction(number, &action, nullptr);
    }
  }
}

}  // namespace thalweg::cli
