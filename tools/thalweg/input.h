// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Whole files in: scenes and arrays are read into memory before anything is parsed. `-` is stdin.
#pragma once

#include <string>
#include <string_view>

#include "thalweg/scene.h"

namespace thalweg::cli {

/// The name by which `path` goes in errors and reports: itself, or `stdin` for `-`.
[[nodiscard]] std::string input_name(const std::string& path);

/// All bytes of a file or of stdin. A missing file, a directory or a second reading of stdin is refused.
[[nodiscard]] std::string read_input(const std::string& path);

/// The scene in a file or on stdin.
[[nodiscard]] Scene read_scene(const std::string& path);

/// Whether `path` ends in `extension` (with its dot, in lower case), in any case.
[[nodiscard]] bool has_extension(std::string_view path, std::string_view extension);

/// What errno says, in words.
[[nodiscard]] std::string system_message(int error_number);

}  // namespace thalweg::cli
