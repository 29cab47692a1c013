// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// PLY, ASCII and binary of either byte order: the vertices' x, y, z and the faces' list of vertices are read, every
// other element and property is stepped over.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include <fmt/format.h>

#include "failure.h"
#include "mesh.h"
#include "text.h"

namespace thalweg::cli {

namespace {

enum class Encoding : std::uint8_t { ascii, little, big };

struct ScalarType {
  std::string_view name, alias;
  std::size_t size;
  char kind;  // i: signed, u: unsigned, f: floating
};
constexpr std::array<ScalarType, 8> kScalarTypes = {{{"char", "int8", 1, 'i'},
                                                     {"uchar", "uint8", 1, 'u'},
                                                     {"short", "int16", 2, 'i'},
                                                     {"ushort", "uint16", 2, 'u'},
                                                     {"int", "int32", 4, 'i'},
                                                     {"uint", "uint32", 4, 'u'},
                                                     {"float", "float32", 4, 'f'},
                                                     {"double", "float64", 8, 'f'}}};

struct Property {
  std::string name;
  const ScalarType* type = nullptr;
  const ScalarType* count_type = nullptr;  // set for lists
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;
  std::string_view body;
  std::size_t lines = 0;
};

class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, const std::string& name) : lines_(bytes), name_(name) {}

  Header read() {
    const std::optional<std::string_view> magic = lines_.next();
    if (!magic || *magic != "ply") refuse(name_, "line 1", "ply", in_quotes(magic.value_or("")));
    while (true) {
      const std::optional<std::string_view> line = lines_.next();
      if (!line) refuse(name_, "PLY header", "end_header", "the end of the file");
      rest_ = *line;
      const std::string_view keyword = take_word(rest_);
      if (keyword == "end_header") break;
      read_keyword(keyword);
    }
    if (!has_format_) refuse(name_, "PLY header", "a format line", "a header without it");
    header_.body = lines_.rest();
    header_.lines = lines_.number();
    return std::move(header_);
  }

 private:
  [[noreturn]] void refuse_word(std::string expected, std::string_view found) const {
    refuse(name_, fmt::format("line {}", lines_.number()), std::move(expected), in_quotes(found));
  }

  void read_keyword(std::string_view keyword) {
    if (keyword == "comment" || keyword == "obj_info") return;
    if (keyword == "format") return read_format();
    if (keyword == "element") return read_element();
    if (keyword == "property") return read_property();
    refuse_word("format, element, property, comment or end_header", keyword);
  }

  void read_format() {
    const std::string_view word = take_word(rest_);
    const std::string_view version = take_word(rest_);
    if (word == "ascii") {
      header_.encoding = Encoding::ascii;
    } else if (word == "binary_little_endian") {
      header_.encoding = Encoding::little;
    } else if (word == "binary_big_endian") {
      header_.encoding = Encoding::big;
    } else {
      refuse_word("ascii, binary_little_endian or binary_big_endian", word);
    }
    if (version != "1.0") refuse_word("version 1.0", version);
    has_format_ = true;
  }

  void read_element() {
    Element element;
    element.name = take_word(rest_);
    const std::string_view word = take_word(rest_);
    const std::optional<long long> count = parse_integer(word);
    if (!count || *count < 0) refuse_word("a number of elements", word);
    element.count = static_cast<std::size_t>(*count);
    header_.elements.push_back(std::move(element));
  }

  const ScalarType* read_type() {
    const std::string_view word = take_word(rest_);
    const auto* const type = std::find_if(kScalarTypes.begin(), kScalarTypes.end(), [&](const ScalarType& candidate) {
      return candidate.name == word || candidate.alias == word;
    });
    if (type == kScalarTypes.end()) refuse_word("a number type", word);
    return type;
  }

  void read_property() {
    if (header_.elements.empty()) refuse_word("an element before its properties", "property");
    Property property;
    std::string_view ahead = rest_;
    if (take_word(ahead) == "list") {
      rest_ = ahead;
      property.count_type = read_type();
      if (property.count_type->kind == 'f') refuse_word("a whole number type", property.count_type->name);
    }
    property.type = read_type();
    property.name = take_word(rest_);
    if (property.name.empty()) refuse_word("a name of the property", property.name);
    header_.elements.back().properties.push_back(std::move(property));
  }

  Lines lines_;
  const std::string& name_;
  std::string_view rest_;
  bool has_format_ = false;
  Header header_;
};

// The numbers of the body, one after the other; every read checks that they are there.
class Body {
 public:
  Body(const Header& header, const std::string& name) : encoding_(header.encoding), rest_(header.body), name_(name) {}

  [[nodiscard]] double number(const ScalarType& type, Place place) {
    return encoding_ == Encoding::ascii ? ascii_number(place) : binary_number(type, place);
  }

  void expect_end() const {
    const std::string_view left = encoding_ == Encoding::ascii ? trimmed_lines() : rest_;
    if (!left.empty()) refuse(name_, "data", "the end of the file", fmt::format("{} more bytes", left.size()));
  }

 private:
  [[nodiscard]] std::string_view trimmed_lines() const {
    const std::size_t begin = rest_.find_first_not_of(" \t\r\n");
    return begin == std::string_view::npos ? std::string_view() : rest_.substr(begin);
  }

  double ascii_number(Place place) {
    rest_ = trimmed_lines();
    const std::size_t end = std::min(rest_.find_first_of(" \t\r\n"), rest_.size());
    const std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(end);
    const std::optional<double> value = parse_number(word);
    if (!value) refuse(name_, place.text(), "a number", word.empty() ? "the end of the file" : in_quotes(word));
    return *value;
  }

  double binary_number(const ScalarType& type, Place place) {
    if (rest_.size() < type.size) {
      refuse(name_, place.text(), fmt::format("{} bytes", type.size), fmt::format("{} bytes", rest_.size()));
    }
    std::array<unsigned char, 8> bytes = {};
    std::memcpy(bytes.data(), rest_.data(), type.size);
    rest_.remove_prefix(type.size);
    if ((encoding_ == Encoding::big) != (std::endian::native == std::endian::big)) {
      std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(type.size));
    }
    return decode(bytes, type);
  }

  static double decode(const std::array<unsigned char, 8>& bytes, const ScalarType& type) {
    const auto as = [&]<class T>(T value) {
      std::memcpy(&value, bytes.data(), sizeof(T));
      return static_cast<double>(value);
    };
    const bool is_signed = type.kind == 'i';
    if (type.kind == 'f') return type.size == 4 ? as(float{}) : as(double{});
    if (type.size == 1) return is_signed ? as(std::int8_t{}) : as(std::uint8_t{});
    if (type.size == 2) return is_signed ? as(std::int16_t{}) : as(std::uint16_t{});
    return is_signed ? as(std::int32_t{}) : as(std::uint32_t{});
  }

  Encoding encoding_;
  std::string_view rest_;
  const std::string& name_;
};

// Reads the elements in the order of the header into a mesh.
class ElementReader {
 public:
  ElementReader(const Header& header, const RowShape& row, const std::string& name)
      : body_(header, name), name_(name), mesh_(row, name) {}

  void read(const Element& element) {
    if (element.properties.empty()) return;  // nothing of it is stored, whatever its count says
    const bool vertices = element.name == "vertex";
    const bool faces = element.name == "face";
    if (vertices) check_vertex(element);
    for (std::size_t i = 0; i < element.count; ++i) {
      const Place place{element.name, i};
      corners_.clear();
      for (const Property& property : element.properties) read_property(property, faces, place);
      if (vertices) mesh_.add_vertex(position_, place);
      if (faces) mesh_.add_face(corners_, place);
    }
  }

  Array take() {
    body_.expect_end();
    return mesh_.take();
  }

 private:
  void check_vertex(const Element& element) const {
    for (const std::string_view axis : {"x", "y", "z"}) {
      const bool there = std::any_of(element.properties.begin(), element.properties.end(),
                                     [&](const Property& p) { return p.name == axis && p.count_type == nullptr; });
      if (!there) refuse(name_, "element vertex", fmt::format("a property {}", axis), "an element without it");
    }
  }

  void read_property(const Property& property, bool faces, Place place) {
    if (property.count_type == nullptr) {
      const double value = body_.number(*property.type, place);
      if (property.name == "x") position_[0] = value;
      if (property.name == "y") position_[1] = value;
      if (property.name == "z") position_[2] = value;
      return;
    }
    const bool corners = faces && (property.name == "vertex_indices" || property.name == "vertex_index");
    const double count = body_.number(*property.count_type, place);
    if (!(count >= 0) || count != std::floor(count) || count > 4294967295.0) {
      refuse(name_, place.text(), "the length of a list", fmt::format("{}", count));
    }
    for (double left = count; left > 0; --left) {
      const double value = body_.number(*property.type, place);
      if (!corners) continue;
      const bool whole = std::fabs(value) <= 4294967295.0 && value == std::floor(value);
      if (!whole) refuse(name_, place.text(), "the number of a vertex", fmt::format("{}", value));
      corners_.push_back(static_cast<std::int64_t>(value));
    }
  }

  Body body_;
  const std::string& name_;
  std::array<double, 3> position_ = {};
  std::vector<std::int64_t> corners_;
  MeshBuilder mesh_;
};

}  // namespace

Array parse_ply(std::string_view bytes, const RowShape& row, const std::string& name) {
  const Header header = HeaderReader(bytes, name).read();
  ElementReader reader(header, row, name);
  for (const Element& element : header.elements) reader.read(element);
  return reader.take();
}

}  // namespace thalweg::cli
