// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// NPZ results and the atomic output that they go through.
#include "npz.h"

#include <gtest/gtest.h>

#include <sys/stat.h>
#include <unistd.h>

#include "npy.h"
#include "support.h"

namespace thalweg::cli {
namespace {

const std::vector<std::uint8_t> kStatus = {0, 1, 255};
const std::vector<float> kPoint = {1, 2, 3, 4, 5, 6};

std::vector<Column> columns() {
  return {{"status", Dtype::uint8, {3}, kStatus.data()}, {"point", Dtype::float32, {3, 2}, kPoint.data()}};
}

std::string written(const TemporaryFolder& folder, const std::string& file, const std::vector<Column>& list) {
  const std::string path = folder.path(file);
  Output output(path);
  write_columns(output, path, list);
  output.commit();
  return read_file(path);
}

TEST(Npz, RoundTripKeepsEveryColumn) {
  const TemporaryFolder folder;
  const std::string bytes = written(folder, "a.npz", columns());
  const NpzReader archive(bytes, "a.npz");
  EXPECT_EQ(parse_npy_uint8(archive.member("status").value(), "status"), kStatus);
  const Array point = parse_npy(archive.member("point").value(), "point");
  EXPECT_EQ(point.shape, (std::vector<std::size_t>{3, 2}));
  EXPECT_EQ(point.values, kPoint);
  EXPECT_FALSE(archive.member("other").has_value());
}

TEST(Npz, EqualResultsAreEqualBytes) {
  const TemporaryFolder folder;
  EXPECT_EQ(written(folder, "a.npz", columns()), written(folder, "b.npz", columns()));
}

TEST(Npz, ColumnsWithoutRowsAreWritten) {
  const TemporaryFolder folder;
  const std::string bytes = written(folder, "a.npz", {{"value", Dtype::float32, {0}, nullptr}});
  const Array value = parse_npy(NpzReader(bytes, "a.npz").member("value").value(), "value");
  EXPECT_EQ(value.shape, std::vector<std::size_t>{0});
}

TEST(Npz, ASingleColumnMayBeNpy) {
  const TemporaryFolder folder;
  const std::string bytes = written(folder, "a.npy", {{"point", Dtype::float32, {3, 2}, kPoint.data()}});
  EXPECT_EQ(parse_npy(bytes, "a.npy").values, kPoint);
}

TEST(Npz, RefusesSeveralColumnsAsNpy) {
  EXPECT_EQ(refusal([] { check_result_name("a.npy", 2); }).place, "--output");
  EXPECT_NO_THROW(check_result_name("a.npy", 1));
}

TEST(Npz, RefusesAnotherEnding) {
  EXPECT_EQ(refusal([] { check_result_name("a.csv", 1); }).found, "a.csv");
  EXPECT_EQ(refusal([] { check_result_name("", 1); }).found, "an empty name");
  EXPECT_NO_THROW(check_result_name("-", 5));
  EXPECT_NO_THROW(check_result_name("/dev/null", 5));
}

TEST(Npz, RefusesAFileThatIsNoArchive) {
  EXPECT_EQ(refusal([] { const NpzReader archive("not a zip file", "a.npz"); }).place, "zip archive");
  EXPECT_EQ(refusal([] { const NpzReader archive("", "a.npz"); }).place, "zip archive");
}

TEST(Npz, RefusesATruncatedArchive) {
  const TemporaryFolder folder;
  const std::string bytes = written(folder, "a.npz", columns());
  const std::string half = bytes.substr(0, bytes.size() / 2);
  EXPECT_EQ(refusal([&] { const NpzReader archive(half, "a.npz"); }).place, "zip archive");
}

TEST(Npz, RefusesAMemberWithAWrongChecksum) {
  const TemporaryFolder folder;
  std::string bytes = written(folder, "a.npz", columns());
  const std::size_t number = bytes.find(bytes_of({4.F, 5.F}));
  ASSERT_NE(number, std::string::npos);
  bytes[number] ^= 1;
  const NpzReader archive(bytes, "a.npz");
  EXPECT_EQ(refusal([&] { static_cast<void>(archive.member("point")); }).place, "zip member");
}

TEST(Output, IsNotThereBeforeItIsCommitted) {
  const TemporaryFolder folder;
  const std::string path = folder.path("a.npz");
  {
    Output output(path);
    output.write("half");
    EXPECT_NE(::access(path.c_str(), F_OK), 0);
    EXPECT_EQ(folder.file_count(), 1U);
  }
  EXPECT_EQ(folder.file_count(), 0U) << "the unfinished file is removed";
}

TEST(Output, KeepsTheOldFileUntilItIsCommitted) {
  const TemporaryFolder folder;
  const std::string path = folder.path("a.npz");
  write_file(path, "old");
  {
    Output output(path);
    output.write("new");
  }
  EXPECT_EQ(read_file(path), "old");
  Output output(path);
  output.write("new");
  output.commit();
  EXPECT_EQ(read_file(path), "new");
  EXPECT_EQ(folder.file_count(), 1U);
}

TEST(Output, FollowsALinkAndKeepsTheMode) {
  const TemporaryFolder folder;
  write_file(folder.path("real.npz"), "old");
  ASSERT_EQ(::chmod(folder.path("real.npz").c_str(), 0600), 0);
  ASSERT_EQ(::symlink("real.npz", folder.path("link.npz").c_str()), 0);
  Output output(folder.path("link.npz"));
  output.write("new");
  output.commit();
  struct stat status = {};
  ASSERT_EQ(::lstat(folder.path("link.npz").c_str(), &status), 0);
  EXPECT_TRUE(S_ISLNK(status.st_mode));
  ASSERT_EQ(::stat(folder.path("real.npz").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0600U);
  EXPECT_EQ(read_file(folder.path("real.npz")), "new");
}

TEST(Output, FailsOfTheMachineOnAFullDevice) {
  Output output("/dev/full");
  try {
    output.write("x");
    FAIL() << "a full device took the bytes";
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.code(), ExitCode::machine);
    EXPECT_EQ(failure.error().file, "/dev/full");
  }
}

TEST(Output, FailsOfTheMachineWithoutAFolder) {
  const TemporaryFolder folder;
  EXPECT_THROW(Output(folder.path("none/a.npz")), Failure);
  EXPECT_EQ(folder.file_count(), 0U);
}

}  // namespace
}  // namespace thalweg::cli
