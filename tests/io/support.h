// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// What the tests of readers share: bytes of NPY files made by hand, temporary folders, and the error of a refusal.
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>

#include "failure.h"

namespace thalweg::cli {

/// The bytes of numbers as they lie in memory.
template <class T>
std::string bytes_of(std::initializer_list<T> numbers) {
  return {reinterpret_cast<const char*>(std::data(numbers)), numbers.size() * sizeof(T)};
}

/// An NPY file of this version with this header text, unpadded, and these data.
std::string npy_file(std::string_view header, std::string_view data, int major = 1, int minor = 0);

/// The header that NumPy writes.
std::string npy_dictionary(std::string_view descr, std::string_view shape, std::string_view order = "False");

/// The error that `action` refuses with; a test failure, and an empty error, when it does not.
Error refusal(const std::function<void()>& action);

/// A folder that is removed with everything in it.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] std::string path(std::string_view file) const { return folder_ + "/" + std::string(file); }
  [[nodiscard]] std::size_t file_count() const;

 private:
  std::string folder_;
};

void write_file(const std::string& path, std::string_view bytes);
std::string read_file(const std::string& path);

}  // namespace thalweg::cli
