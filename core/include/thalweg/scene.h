// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Scene text (JSON, UTF-8) to a Shape. Nothing is guessed: an unknown key, a missing or non-finite number, a wrong
// arity or dimension is an Error whose place is the JSON pointer of what is wrong.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "thalweg/shape.h"

namespace thalweg {

struct Scene {
  Shape shape;
  int dimension = 2;
};

/// The text of a file that a scene names, by its path as the scene has it; of an error only `expected` and `found`
/// count.
using ReadText = std::function<Result<std::string>(const std::string& path)>;

/// Parses a scene from memory. `file` is only used to name the text in errors. Nodes that name a file are refused
/// without `read_text`.
[[nodiscard]] Result<Scene> parse_scene(std::string_view text, std::string_view file, const ReadText& read_text = {});

/// A program in the form of `.vm` files as a scene: of dimension 3 if its result depends on z, else 2.
[[nodiscard]] Result<Scene> parse_program(std::string_view text, std::string_view file);

/// The scene file text of a shape: `{"thalweg": 1, "dimension": d, "shape": ...}`.
[[nodiscard]] std::string scene_text(const Shape& shape);

/// JSON Schema (draft 2020-12) of the scene format, generated from the op table.
[[nodiscard]] std::string scene_schema();

}  // namespace thalweg
