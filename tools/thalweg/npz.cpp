// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// NPZ through libzip. The archive is built in memory: libzip would make a temporary file of its own, which our
// signal handler could not remove.
#include "npz.h"

#include <zip.h>

#include <array>
#include <limits>

#include <fmt/format.h>

#include "failure.h"
#include "input.h"
#include "npy.h"

namespace thalweg::cli {

namespace {

constexpr zip_uint16_t kDosDate = 1 << 5 | 1;  // 1980-01-01, the first date that the format knows
constexpr std::size_t kChunk = std::size_t{1} << 16;

struct FreeSource {
  void operator()(zip_source_t* source) const { zip_source_free(source); }
};
using Source = std::unique_ptr<zip_source_t, FreeSource>;

struct CloseFile {
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};

struct Discard {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};

// libzip runs out of memory, or it has met a bug of ours; either is no fault of the request.
[[noreturn]] void fail_archive(const char* message) { fail("result", "zip archive", "to be built in memory", message); }

std::string message_of(zip_error_t& error) {
  std::string message = zip_error_strerror(&error);
  zip_error_fini(&error);
  return message;
}

// The members' bytes are referred to, not copied: headers and columns live until the archive is closed.
void add_member(zip_t* archive, const Column& column, const std::string& header) {
  // libzip takes mutable bytes but only reads them when it is not asked to free them.
  std::array<zip_buffer_fragment_t, 2> fragments = {};
  fragments[0] = {reinterpret_cast<zip_uint8_t*>(const_cast<char*>(header.data())), header.size()};
  fragments[1] = {static_cast<zip_uint8_t*>(const_cast<void*>(column.numbers)), column.byte_count()};
  const zip_uint64_t count = fragments[1].length == 0 ? 1 : 2;
  Source source(zip_source_buffer_fragment(archive, fragments.data(), count, 0));
  if (!source) fail_archive(zip_strerror(archive));
  const zip_int64_t index = zip_file_add(archive, (column.name + ".npy").c_str(), source.get(), ZIP_FL_ENC_UTF_8);
  if (index < 0) fail_archive(zip_strerror(archive));
  static_cast<void>(source.release());  // owned by the archive now
  const auto member = static_cast<zip_uint64_t>(index);
  if (zip_set_file_compression(archive, member, ZIP_CM_STORE, 0) != 0 ||
      zip_file_set_dostime(archive, member, 0, kDosDate, 0) != 0) {
    fail_archive(zip_strerror(archive));
  }
}

void copy_source(zip_source_t* source, Output& output) {
  if (zip_source_open(source) != 0) fail_archive("an archive that does not open");
  std::string chunk(kChunk, '\0');
  while (true) {
    const zip_int64_t got = zip_source_read(source, chunk.data(), chunk.size());
    if (got < 0) fail_archive("an archive that does not read");
    if (got == 0) break;
    output.write(std::string_view(chunk).substr(0, static_cast<std::size_t>(got)));
  }
  zip_source_close(source);
}

void write_npz(Output& output, std::span<const Column> columns) {
  zip_error_t error;
  zip_error_init(&error);
  Source bytes(zip_source_buffer_create(nullptr, 0, 1, &error));
  if (!bytes) fail_archive(message_of(error).c_str());
  std::unique_ptr<zip_t, Discard> archive(zip_open_from_source(bytes.get(), ZIP_TRUNCATE, &error));
  if (!archive) fail_archive(message_of(error).c_str());
  zip_source_keep(bytes.get());  // one reference is the archive's, one ours
  std::vector<std::string> headers;
  headers.reserve(columns.size());
  for (const Column& column : columns) {
    headers.push_back(npy_header_bytes(column));
    add_member(archive.get(), column, headers.back());
  }
  if (zip_close(archive.get()) != 0) fail_archive(zip_strerror(archive.get()));
  static_cast<void>(archive.release());
  copy_source(bytes.get(), output);
}

}  // namespace

void check_result_name(const std::string& path, std::size_t array_count) {
  if (has_extension(path, ".npy")) {
    if (array_count == 1) return;
    refuse(kCommandLine, "--output", "a name that ends in .npz, for several arrays", path);
  }
  if (!has_extension(path, ".npz") && !is_stream(path)) {
    refuse(kCommandLine, "--output", "a name that ends in .npz or .npy, or -", path.empty() ? "an empty name" : path);
  }
}

void write_columns(Output& output, const std::string& path, std::span<const Column> columns) {
  if (!has_extension(path, ".npy")) return write_npz(output, columns);
  const Column& column = columns.front();
  output.write(npy_header_bytes(column));
  output.write({static_cast<const char*>(column.numbers), column.byte_count()});
}

void NpzReader::Discard::operator()(zip* archive) const { zip_discard(archive); }

NpzReader::NpzReader(std::string_view bytes, std::string name) : name_(std::move(name)) {
  if (bytes.empty()) refuse(name_, "zip archive", "an NPZ file", "an empty file");  // to libzip an archive of nothing
  zip_error_t error;
  zip_error_init(&error);
  Source source(zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error));
  if (!source) fail_archive(message_of(error).c_str());
  archive_.reset(zip_open_from_source(source.get(), ZIP_RDONLY, &error));
  if (!archive_) refuse(name_, "zip archive", "an NPZ file", message_of(error));
  static_cast<void>(source.release());
}

std::string NpzReader::member_name(const std::string& member) const { return fmt::format("{}[{}]", name_, member); }

std::optional<std::string> NpzReader::member(const std::string& member) const {
  const std::unique_ptr<zip_file_t, CloseFile> file(zip_fopen(archive_.get(), (member + ".npy").c_str(), 0));
  if (!file) {
    if (zip_error_code_zip(zip_get_error(archive_.get())) == ZIP_ER_NOENT) return std::nullopt;
    refuse(member_name(member), "zip member", "a readable member", zip_strerror(archive_.get()));
  }
  std::string bytes;
  std::string chunk(kChunk, '\0');
  while (true) {
    const zip_int64_t got = zip_fread(file.get(), chunk.data(), chunk.size());
    if (got < 0) refuse(member_name(member), "zip member", "a readable member", zip_file_strerror(file.get()));
    if (got == 0) return bytes;
    bytes.append(chunk, 0, static_cast<std::size_t>(got));
  }
}

}  // namespace thalweg::cli
