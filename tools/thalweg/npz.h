// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Result files: NPZ (a zip archive of NPY members, stored, with fixed dates so that equal results are equal bytes) or
// NPY for one array alone.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "array.h"
#include "output.h"

struct zip;

namespace thalweg::cli {

/// Refuses a result name that is neither .npz, .npy with a single array, `-`, nor a device or pipe.
void check_result_name(const std::string& path, std::size_t array_count);

/// Writes the columns to an open output: NPY when its name says so, else NPZ. The caller commits.
void write_columns(Output& output, const std::string& path, std::span<const Column> columns);

/// Members of an NPZ file held in memory, which must outlive the reader.
class NpzReader {
 public:
  NpzReader(std::string_view bytes, std::string name);

  /// The bytes of `member`.npy, or nothing when the archive has no such member.
  [[nodiscard]] std::optional<std::string> member(const std::string& member) const;
  [[nodiscard]] std::string member_name(const std::string& member) const;  ///< for errors: FILE[member]

 private:
  struct Discard {
    void operator()(zip* archive) const;
  };
  std::unique_ptr<zip, Discard> archive_;
  std::string name_;
};

}  // namespace thalweg::cli
