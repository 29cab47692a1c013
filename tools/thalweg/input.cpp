// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Reading files and stdin as a whole.
#include "input.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <system_error>

#include "failure.h"

namespace thalweg::cli {

namespace {

constexpr std::size_t kChunk = std::size_t{1} << 18;

struct Descriptor {
  int number = -1;
  bool owned = false;
  Descriptor(int n, bool o) : number(n), owned(o) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (owned) ::close(number);
  }
};

int open_for_reading(const std::string& path, const std::string& name) {
  const int number = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (number < 0) refuse(name, "file", "a readable file", system_message(errno));
  return number;
}

std::string read_all(int number, const std::string& name, std::size_t size_hint) {
  std::string bytes;
  bytes.reserve(size_hint);
  std::size_t used = 0;
  while (true) {
    if (bytes.size() - used < kChunk) bytes.resize(std::max(used + kChunk, std::min(bytes.capacity(), 2 * used)));
    const ssize_t got = ::read(number, bytes.data() + used, bytes.size() - used);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(name, "file", "a successful read", system_message(errno));
    if (got == 0) break;
    used += static_cast<std::size_t>(got);
  }
  bytes.resize(used);
  return bytes;
}

}  // namespace

std::string system_message(int error_number) { return std::generic_category().message(error_number); }

std::string input_name(const std::string& path) { return path == "-" ? "stdin" : path; }

std::string read_input(const std::string& path) {
  static std::atomic<bool> stdin_taken = false;
  const bool from_stdin = path == "-";
  const std::string name = input_name(path);
  if (from_stdin && stdin_taken.exchange(true)) {
    refuse(kCommandLine, "-", "stdin named for one input", "stdin named twice");
  }
  if (path.find('\0') != std::string::npos) refuse(name, "file", "a file name", "a name with a null byte");
  const Descriptor descriptor(from_stdin ? STDIN_FILENO : open_for_reading(path, name), !from_stdin);
  struct stat status = {};
  if (::fstat(descriptor.number, &status) != 0) refuse(name, "file", "a readable file", system_message(errno));
  if (S_ISDIR(status.st_mode)) refuse(name, "file", "a file", "a directory");
  // One chunk more than the file, so that the read that finds the end does not grow the buffer.
  const std::size_t size = S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) + kChunk : kChunk;
  return read_all(descriptor.number, name, size);
}

bool has_extension(std::string_view path, std::string_view extension) {
  if (path.size() <= extension.size()) return false;
  const std::string_view tail = path.substr(path.size() - extension.size());
  return std::equal(tail.begin(), tail.end(), extension.begin(),
                    [](char a, char b) { return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b; });
}

Scene read_scene(const std::string& path) {
  const std::string name = input_name(path);
  const std::string text = read_input(path);
  if (has_extension(path, ".vm")) return unwrap(parse_program(text, name), name, "1:1");
  // A file that a node names lies beside the scene.
  const auto read_text = [&](const std::string& named) -> Result<std::string> {
    const std::filesystem::path folder = path == "-" ? "." : std::filesystem::path(path).parent_path();
    try {
      return read_input(((folder.empty() ? "." : folder) / named).string());
    } catch (const Failure& failure) {
      return failure.error();
    }
  };
  return unwrap(parse_scene(text, name, read_text), name, "/");
}

}  // namespace thalweg::cli
