// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// STL, binary and ASCII. A file is binary when its length is the one that its own count promises: many binary files
// also begin with `solid`, the word that marks ASCII.
#include <bit>
#include <cstring>
#include <optional>

#include <fmt/format.h>

#include "failure.h"
#include "mesh.h"
#include "text.h"

namespace thalweg::cli {

namespace {

constexpr std::size_t kHeaderBytes = 84;    // a comment of 80, then the count
constexpr std::size_t kTriangleBytes = 50;  // normal, 3 corners, 2 bytes of attributes

std::optional<std::size_t> promised_count(std::string_view bytes) {
  if (bytes.size() < kHeaderBytes) return std::nullopt;
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, 4);
  return count;
}

Array parse_binary(std::string_view bytes, const RowShape& row, const std::string& name) {
  MeshBuilder mesh(row, name);
  const std::size_t count = (bytes.size() - kHeaderBytes) / kTriangleBytes;
  for (std::size_t triangle = 0; triangle < count; ++triangle) {
    const Place place{"triangle", triangle};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      std::array<float, 3> position = {};
      std::memcpy(position.data(), bytes.data() + kHeaderBytes + triangle * kTriangleBytes + 12 * (corner + 1), 12);
      mesh.add_vertex({position[0], position[1], position[2]}, place);
    }
    const auto first = static_cast<std::int64_t>(3 * triangle);
    mesh.add_face({first, first + 1, first + 2}, place);
  }
  return mesh.take();
}

// Between `solid` and `endsolid` only the lines `vertex x y z` matter; three make a triangle.
class AsciiReader {
 public:
  AsciiReader(const RowShape& row, const std::string& name) : name_(name), mesh_(row, name) {}

  void read_line(std::string_view line, std::size_t number) {
    place_.number = number;
    const std::string_view keyword = take_word(line);
    if (keyword == "vertex") return read_vertex(line);
    if (keyword == "endloop") return end_loop();
    ended_ = keyword == "endsolid" || (ended_ && keyword.empty());
    if (keyword.empty() || keyword == "solid" || keyword == "endsolid" || keyword == "facet" || keyword == "outer" ||
        keyword == "endfacet") {
      return;
    }
    refuse(name_, place_.text(), "an STL keyword", in_quotes(keyword));
  }

  Array take() {
    if (!ended_) refuse(name_, "the end of the file", "endsolid", place_.text());
    return mesh_.take();
  }

 private:
  void read_vertex(std::string_view line) {
    std::array<double, 3> position = {};
    for (double& coordinate : position) {
      const std::string_view word = take_word(line);
      const std::optional<double> number = parse_number(word);
      if (!number)
        refuse(name_, place_.text(), "3 numbers after vertex", word.empty() ? "the end of the line" : in_quotes(word));
      coordinate = *number;
    }
    mesh_.add_vertex(position, place_);
    ++corners_;
  }

  void end_loop() {
    if (corners_ != 3) refuse(name_, place_.text(), "3 vertices in a loop", fmt::format("{}", corners_));
    const auto count = static_cast<std::int64_t>(mesh_.vertex_count());
    mesh_.add_face({count - 3, count - 2, count - 1}, place_);
    corners_ = 0;
  }

  const std::string& name_;
  Place place_{"line"};
  std::size_t corners_ = 0;
  bool ended_ = false;
  MeshBuilder mesh_;
};

}  // namespace

Array parse_stl(std::string_view bytes, const RowShape& row, const std::string& name) {
  const std::optional<std::size_t> count = promised_count(bytes);
  if (count && bytes.size() == kHeaderBytes + *count * kTriangleBytes) return parse_binary(bytes, row, name);
  if (bytes.substr(0, 5) != "solid") {
    if (!count) {
      refuse(name, "STL header", fmt::format("{} bytes, or the word solid", kHeaderBytes),
             fmt::format("{} bytes", bytes.size()));
    }
    refuse(name, "data", fmt::format("{} bytes for {} triangles", kHeaderBytes + *count * kTriangleBytes, *count),
           fmt::format("{} bytes", bytes.size()));
  }
  AsciiReader reader(row, name);
  Lines lines(bytes);
  while (const std::optional<std::string_view> line = lines.next()) reader.read_line(*line, lines.number());
  return reader.take();
}

}  // namespace thalweg::cli
