// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Wavefront OBJ: `v` and `f` lines give the triangles; every other known kind of line says nothing about them.
#include <algorithm>
#include <optional>

#include "failure.h"
#include "mesh.h"
#include "text.h"

namespace thalweg::cli {

namespace {

constexpr std::array<std::string_view, 12> kIgnored = {"vt",     "vn",     "vp", "g", "o",      "s",
                                                       "mtllib", "usemtl", "l",  "p", "usemap", "maplib"};

class ObjReader {
 public:
  ObjReader(const RowShape& row, const std::string& name) : name_(name), mesh_(row, name) {}

  void read_line(std::string_view line, std::size_t number) {
    place_.number = number;
    const std::string_view keyword = take_word(line);
    if (keyword == "v") return read_vertex(line);
    if (keyword == "f") return read_face(line);
    const bool known =
        keyword.empty() || keyword[0] == '#' || std::find(kIgnored.begin(), kIgnored.end(), keyword) != kIgnored.end();
    if (!known) refuse(name_, place_.text(), "an OBJ keyword (v, f, vt, vn, ...)", in_quotes(keyword));
  }

  Array take() { return mesh_.take(); }

 private:
  void read_vertex(std::string_view line) {
    std::array<double, 3> position = {};
    for (double& coordinate : position) {
      const std::string_view word = take_word(line);
      const std::optional<double> number = parse_number(word);
      if (!number)
        refuse(name_, place_.text(), "3 numbers after v", word.empty() ? "the end of the line" : in_quotes(word));
      coordinate = *number;
    }
    mesh_.add_vertex(position, place_);  // a weight or a colour may follow
  }

  // Corners count from 1; negative ones count back from the last vertex.
  void read_face(std::string_view line) {
    corners_.clear();
    for (std::string_view word = take_word(line); !word.empty() && word[0] != '#'; word = take_word(line)) {
      const std::optional<long long> index = parse_integer(word.substr(0, word.find('/')));
      if (!index || *index == 0) refuse(name_, place_.text(), "a vertex number, positive or negative", in_quotes(word));
      const auto count = static_cast<std::int64_t>(mesh_.vertex_count());
      corners_.push_back(*index > 0 ? *index - 1 : *index < -count ? -1 : count + *index);
    }
    mesh_.add_face(corners_, place_);
  }

  const std::string& name_;
  Place place_{"line"};
  std::vector<std::int64_t> corners_;
  MeshBuilder mesh_;
};

}  // namespace

Array parse_obj(std::string_view text, const RowShape& row, const std::string& name) {
  ObjReader reader(row, name);
  Lines lines(text);
  while (const std::optional<std::string_view> line = lines.next()) reader.read_line(*line, lines.number());
  return reader.take();
}

}  // namespace thalweg::cli
