// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Reading and writing NPY. The header is a Python literal of one known form, so a small recursive reader suffices:
// what it does not know, it refuses.
#include "npy.h"

#include <bit>
#include <cstring>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "failure.h"

namespace thalweg::cli {

static_assert(std::endian::native == std::endian::little, "arrays are copied from little-endian files as they are");

namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::size_t kAlignment = 64;

// A cursor over the header's text that refuses with the place `header, character N`.
class HeaderText {
 public:
  HeaderText(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  [[noreturn]] void refuse_here(std::string expected) const {
    const std::string found = at_ < text_.size() ? fmt::format("'{}'", text_.substr(at_, 12)) : "the end of the header";
    refuse(name_, fmt::format("NPY header, character {}", at_), std::move(expected), found);
  }

  void skip_spaces() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n' || text_[at_] == '\t')) ++at_;
  }

  bool accept(std::string_view token) {
    skip_spaces();
    if (text_.substr(at_, token.size()) != token) return false;
    at_ += token.size();
    return true;
  }

  void expect(std::string_view token) {
    if (!accept(token)) refuse_here(fmt::format("'{}'", token));
  }

  std::string string() {
    skip_spaces();
    const char quote = at_ < text_.size() ? text_[at_] : '\0';
    if (quote != '\'' && quote != '"') refuse_here("a string");
    const std::size_t end = text_.find(quote, at_ + 1);
    if (end == std::string_view::npos) refuse_here("a closed string");
    std::string value(text_.substr(at_ + 1, end - at_ - 1));
    at_ = end + 1;
    return value;
  }

  std::size_t whole_number() {
    skip_spaces();
    const std::size_t begin = at_;
    std::size_t value = 0;
    for (; at_ < text_.size() && text_[at_] >= '0' && text_[at_] <= '9'; ++at_) {
      const auto digit = static_cast<std::size_t>(text_[at_] - '0');
      if (value > (std::numeric_limits<std::size_t>::max() - digit) / 10) {
        at_ = begin;
        refuse_here("a length below 2^64");
      }
      value = value * 10 + digit;
    }
    if (at_ == begin) refuse_here("a whole number");
    return value;
  }

  void expect_end() {
    skip_spaces();
    if (at_ != text_.size()) refuse_here("the end of the header");
  }

 private:
  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
};

std::vector<std::size_t> shape_tuple(HeaderText& text) {
  std::vector<std::size_t> shape;
  text.expect("(");
  while (!text.accept(")")) {
    shape.push_back(text.whole_number());
    if (text.accept(",")) continue;
    if (shape.size() == 1) text.refuse_here("',' after the only length");  // (3) is a number in Python, not a tuple
    text.expect(")");
    break;
  }
  return shape;
}

bool boolean(HeaderText& text) {
  if (text.accept("True")) return true;
  if (text.accept("False")) return false;
  text.refuse_here("True or False");
}

NpyHeader parse_dictionary(HeaderText& text, const std::string& name) {
  std::optional<std::string> descr;
  std::optional<bool> fortran_order;
  std::optional<std::vector<std::size_t>> shape;
  text.expect("{");
  while (!text.accept("}")) {
    const std::string key = text.string();
    text.expect(":");
    const auto once = [&](bool absent) {
      if (!absent) refuse(name, "NPY header", "each key once", fmt::format("'{}' twice", key));
    };
    if (key == "descr") {
      once(!descr);
      if (text.accept("[")) refuse(name, "dtype", "'<f4' or '<f8'", "a structured dtype");
      descr = text.string();
    } else if (key == "fortran_order") {
      once(!fortran_order);
      fortran_order = boolean(text);
    } else if (key == "shape") {
      once(!shape);
      shape = shape_tuple(text);
    } else {
      refuse(name, "NPY header", "the keys descr, fortran_order and shape", fmt::format("'{}'", key));
    }
    if (text.accept(",")) continue;
    text.expect("}");
    break;
  }
  text.expect_end();
  const auto present = [&](bool here, const char* key) {
    if (!here) refuse(name, "NPY header", fmt::format("the key '{}'", key), "a header without it");
  };
  present(descr.has_value(), "descr");
  present(fortran_order.has_value(), "fortran_order");
  present(shape.has_value(), "shape");
  return NpyHeader{*std::move(descr), *fortran_order, *std::move(shape), 0};
}

std::size_t little_endian(std::string_view bytes) {
  std::size_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

// The product of the shape times the element's size, or nothing when it overflows.
std::optional<std::size_t> byte_count(std::span<const std::size_t> shape, std::size_t element) {
  std::size_t bytes = element;
  bool empty = false;
  bool overflows = false;
  for (const std::size_t length : shape) {
    empty = empty || length == 0;
    overflows = overflows || (length != 0 && bytes > std::numeric_limits<std::size_t>::max() / length);
    if (!empty && !overflows) bytes *= length;
  }
  if (empty) return 0;
  if (overflows) return std::nullopt;
  return bytes;
}

// Refuses unless exactly the bytes that the header promises follow it.
std::string_view checked_data(std::string_view bytes, const NpyHeader& header, std::size_t element,
                              const std::string& name) {
  if (header.fortran_order) refuse(name, "fortran_order", "C order", "Fortran order");
  const std::string_view data = bytes.substr(header.data_offset);
  const std::optional<std::size_t> wanted = byte_count(header.shape, element);
  if (!wanted) {
    refuse(name, "shape", "an array that fits the address space", shape_text(header.shape));
  }
  if (data.size() != *wanted) {
    refuse(name, "data", fmt::format("{} bytes for shape {}", *wanted, shape_text(header.shape)),
           fmt::format("{} bytes", data.size()));
  }
  return data;
}

}  // namespace

bool looks_like_npy(std::string_view bytes) { return bytes.substr(0, kMagic.size()) == kMagic; }

NpyHeader parse_npy_header(std::string_view bytes, const std::string& name) {
  if (bytes.empty()) refuse(name, "NPY magic", "an NPY file", "an empty file");
  if (!looks_like_npy(bytes)) refuse(name, "NPY magic", "'\\x93NUMPY'", "other bytes");
  if (bytes.size() < 8) refuse(name, "NPY version", "2 bytes", fmt::format("{} bytes", bytes.size() - 6));
  const int major = static_cast<unsigned char>(bytes[6]);
  const int minor = static_cast<unsigned char>(bytes[7]);
  if (major < 1 || major > 3 || minor != 0) {
    refuse(name, "NPY version", "1.0, 2.0 or 3.0", fmt::format("{}.{}", major, minor));
  }
  const std::size_t length_bytes = major == 1 ? 2 : 4;
  const std::size_t begin = 8 + length_bytes;
  if (bytes.size() < begin)
    refuse(name, "NPY header length", fmt::format("{} bytes", length_bytes), "the end of the file");
  const std::size_t length = little_endian(bytes.substr(8, length_bytes));
  if (bytes.size() - begin < length) {
    refuse(name, "NPY header", fmt::format("{} bytes", length), fmt::format("{} bytes", bytes.size() - begin));
  }
  HeaderText text(bytes.substr(begin, length), name);
  NpyHeader header = parse_dictionary(text, name);
  header.data_offset = begin + length;
  return header;
}

Array parse_npy(std::string_view bytes, const std::string& name) {
  NpyHeader header = parse_npy_header(bytes, name);
  const bool single = header.descr == "<f4";
  if (!single && header.descr != "<f8") {
    refuse(name, "dtype", "little-endian float32 or float64 ('<f4' or '<f8')", fmt::format("'{}'", header.descr));
  }
  const std::string_view data = checked_data(bytes, header, single ? 4 : 8, name);
  Array array{std::move(header.shape), std::vector<float>(data.size() / (single ? 4 : 8))};
  if (data.empty()) return array;
  if (single) {
    std::memcpy(array.values.data(), data.data(), data.size());
    return array;
  }
  for (std::size_t i = 0; i < array.values.size(); ++i) {
    double number = 0;
    std::memcpy(&number, data.data() + 8 * i, 8);
    array.values[i] = to_float32(number);
  }
  return array;
}

std::vector<std::uint8_t> parse_npy_uint8(std::string_view bytes, const std::string& name) {
  const NpyHeader header = parse_npy_header(bytes, name);
  if (header.descr != "|u1" && header.descr != "<u1") {
    refuse(name, "dtype", "uint8 ('|u1')", fmt::format("'{}'", header.descr));
  }
  const std::string_view data = checked_data(bytes, header, 1, name);
  return {data.begin(), data.end()};
}

std::string npy_header_bytes(const Column& column) {
  std::string text = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", descr(column.dtype),
                                 shape_text(column.shape));
  const std::size_t prefix = kMagic.size() + 4;
  const std::size_t unpadded = prefix + text.size() + 1;
  text.append((kAlignment - unpadded % kAlignment) % kAlignment, ' ');
  text += '\n';
  std::string bytes(kMagic);
  bytes += '\x01';
  bytes += '\x00';
  bytes += static_cast<char>(text.size() & 0xff);
  bytes += static_cast<char>(text.size() >> 8 & 0xff);
  return bytes + text;
}

}  // namespace thalweg::cli
