// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Files with random damage: every reader either reads them or refuses them, and never does anything else. Run under
// the sanitizers this is a fuzz test that always tries the same damage.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "csv.h"
#include "mesh.h"
#include "npy.h"
#include "npz.h"
#include "support.h"

namespace thalweg::cli {
namespace {

constexpr int kMutations = 4000;
const RowShape kTriangles{{3, 3}, "triangles"};

// Flips, inserts, removes and doubles a few bytes.
std::string damaged(std::string bytes, std::mt19937_64& random) {
  constexpr std::array<char, 12> kLikely = {'0', '9', '-', '(', ')', ',', '\'', '\n', ' ', '\0', '\x7f', '\xff'};
  const std::size_t times = 1 + random() % 4;
  for (std::size_t i = 0; i < times && !bytes.empty(); ++i) {
    const std::size_t at = random() % bytes.size();
    const char byte = random() % 2 == 0 ? kLikely[random() % kLikely.size()] : static_cast<char>(random());
    switch (random() % 5) {
      case 0:
        bytes[at] = byte;
        break;
      case 1:
        bytes.insert(at, 1, byte);
        break;
      case 2:
        bytes.erase(at, 1 + random() % 8);
        break;
      case 3:
        bytes.resize(at);
        break;
      default:
        bytes.insert(at, bytes.substr(at, 1 + random() % 16));
    }
  }
  return bytes;
}

template <class Read>
void try_damage(const std::string& whole, Read read) {
  ASSERT_NO_THROW(read(whole));
  std::mt19937_64 random(20250101);
  for (int i = 0; i < kMutations; ++i) {
    const std::string bytes = damaged(whole, random);
    try {
      read(bytes);
    } catch (const Failure& failure) {
      ASSERT_EQ(failure.code(), ExitCode::request) << "mutation " << i << ": " << failure.what();
    }
  }
}

TEST(DamagedFiles, NpyIsReadOrRefused) {
  try_damage(npy_file(npy_dictionary("<f4", "(2, 3)"), std::string(24, 'x')),
             [](const std::string& bytes) { static_cast<void>(parse_npy(bytes, "a.npy")); });
}

TEST(DamagedFiles, CsvIsReadOrRefused) {
  try_damage("a,b,c,d,e,f,g,h,i\n1,2,3,4,5,6,7,8,9\nnan,-inf,1e300,1e-300,0,+1,2.5,.5,1.\n",
             [](const std::string& bytes) { static_cast<void>(parse_csv(bytes, kTriangles, "a.csv")); });
}

TEST(DamagedFiles, ObjIsReadOrRefused) {
  try_damage("v 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\nf 1 2 3\nf -1/2/3 -2//1 -3/7\nf 1 2 4 3\n",
             [](const std::string& bytes) { static_cast<void>(parse_obj(bytes, kTriangles, "a.obj")); });
}

TEST(DamagedFiles, PlyIsReadOrRefused) {
  const std::string header =
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const auto read = [](const std::string& bytes) { static_cast<void>(parse_ply(bytes, kTriangles, "a.ply")); };
  try_damage("ply\nformat ascii 1.0\n" + header + "0 0 1\n2 0 1\n0 2 1\n3 0 1 2\n", read);
  try_damage("ply\nformat binary_little_endian 1.0\n" + header + std::string(36, '\0') + '\x03' + bytes_of({0, 1, 2}),
             read);
}

TEST(DamagedFiles, StlIsReadOrRefused) {
  const auto read = [](const std::string& bytes) { static_cast<void>(parse_stl(bytes, kTriangles, "a.stl")); };
  try_damage(
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1\nvertex 2 0 1\nvertex 0 2 1\nendloop\nendfacet\n"
      "endsolid a\n",
      read);
  try_damage(std::string(80, ' ') + bytes_of({2}) + std::string(100, '\0'), read);
}

TEST(DamagedFiles, NpzIsReadOrRefused) {
  const TemporaryFolder folder;
  const std::string path = folder.path("a.npz");
  const std::array<std::uint8_t, 3> status = {0, 1, 2};
  Output output(path);
  write_columns(output, path, std::array<Column, 1>{{{"status", Dtype::uint8, {3}, status.data()}}});
  output.commit();
  try_damage(read_file(path), [](const std::string& bytes) {
    const NpzReader archive(bytes, "a.npz");
    const std::optional<std::string> member = archive.member("status");
    if (member) static_cast<void>(parse_npy_uint8(*member, "status"));
  });
}

}  // namespace
}  // namespace thalweg::cli
