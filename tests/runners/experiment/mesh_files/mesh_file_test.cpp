// Meshes from files: what the formats allow, what is refused, and meshes that are kept outside of the
// repository.
#include "runners/experiment/mesh_files/mesh_file.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/mesh/voxel_tool.h"
#include "tests/support/meshes.h"
#include "tests/support/recorded_data.h"
#include "tests/support/test_files.h"

namespace remote_touch::mesh_file_test {
namespace {

namespace fs = std::filesystem;

const std::string kVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n";
const std::string kCube = kVertices + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
const std::string kPlyText =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
    "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";

const std::string kStlText =
    "solid a facet\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\n"
    "facet normal nan nan -nan(ind)\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\n"
    "facet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\n"
    "facet normal 0 0 1\nouter loop\nvertex 0 1 0\nvertex 0 0 0\nvertex 0 0 1\nendloop\nendfacet\nendsolid a\n";

// The four faces of a tetrahedron, as lists of bytes with integers.
std::string packed_faces() {
  std::string data;
  for (const auto& face : std::vector<std::array<int, 3>>{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}) {
    data += '\3';
    for (const int corner : face) data += raw(corner);
  }
  return data;
}

// Returns the text with another one in place of a part.
std::string changed(std::string text, const std::string& part, const std::string& by) {
  const std::size_t at = text.find(part);
  EXPECT_NE(at, std::string::npos) << part;
  return text.replace(at, part.size(), by);
}

class MeshFileTest : public testing::Test {
 protected:
  std::string refused(const std::string& name, const std::string& bytes) const {
    const fs::path file = folder_.write(name, bytes);
    return refusal([&] { read_mesh(file); });
  }
  TestFolder folder_{"mesh_file"};
};

// --- what is read ---

// STL has no shared vertices; 0 and -0 are one.
std::string mirrored_stl() {
  std::string stl = "solid t\n";
  const TriangleMesh solid = meshes::tetrahedron({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  for (const auto& triangle : solid.triangles) {
    stl += "facet normal 0 0 0\nouter loop\n";
    for (const int corner : triangle) {
      const Vec3& v = solid.vertices[corner];
      stl += "vertex " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " -" + std::to_string(v.z()) +
             "\n";
    }
    stl += "endloop\nendfacet\n";
  }
  return stl + "endsolid t\n";
}

std::string in_capitals(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

// A cube or a tetrahedron in everything that the formats allow. Texture coordinates, normals and materials
// may be missing or wrong, because a tool does not use them.
TEST_F(MeshFileTest, ReadsTheSameSolidInEveryForm) {
  const std::string ply_vertices = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string ply_faces = "element face 4\ncomment of faces\nproperty list uchar int vertex_indices\n";
  const std::string ply_edges = "element edge 1\nproperty uchar vertex1\nproperty uchar vertex2\n";
  std::string faces_first = packed_faces() + std::string("\0\1", 2);
  for (const float value : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f})
    faces_first += raw(value);
  std::string colours = changed(kCube, "v 1 1 0", "v 1 1 0 0.5 0.5 0.5 1  # with alpha");
  colours = changed(colours, "v 0 0 1", "v 0 0 1 0.5 0.5 0.5");
  colours = changed(colours, "v 1 0 1", "v 1 0 1 2");  // the weight of a rational curve
  const std::string mark = "\xEF\xBB\xBF", capitals = in_capitals(kStlText);
  const std::size_t half = kStlText.find("facet normal", 100);
  struct Row {
    const char* name;
    std::string bytes;
    double volume_m3;
  };
  const Row rows[] = {
      {"faces.obj",
       kVertices + "vt 0 0\nvn 0 0 1\nf 1 3 4 2\nf 5/1 6/1 8/1 7/1\nf 1//1 2//1 6//1 5//1\n"
                   "f 3/1/1 7/1/1 8/1/1 4/1/1\nf -8 -4 -2 -6\nf 2 4 8 6\n",
       1},
      {"missing.obj",
       "mtllib none.mtl\nvt 0.5 0.5\nvt\nvn 0 0 1\n" + kVertices +
           "usemtl red\nf 1/1 3/2 4/3 2/99\nf 5/9/9 6/9/9 8/9/9 7/9/9\nf 1//9 2//9 6//9 5//9\n"
           "f 3/ 7/ 8/ 4/\n  f 1/9 5/9 \\\n7/9 3/9\n\tf -7/-3 -5/-3 -1/-3 -3/-3\n",
       1},
      {"Objects.OBJ",
       "mtllib none.mtl\n" + kVertices +
           "o a\nusemtl x\nf 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\no b\n"
           "g c\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n",
       1},
      {"repeated.obj",
       kVertices + "f 1 1 3 4 2\nf 5 6 8 7 5\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 2 4 8 8 6 2\n", 1},
      {"colours.obj", colours, 1},
      {"comment.obj", changed(kCube, "f 1 3 4 2", "f 1 3 +4 002 # face 1 / 2"), 1},
      {"mark.obj", mark + kCube, 1},
      {"mark.ply", mark + kPlyText, 1.0 / 6},
      {"faces-first.ply",
       "ply\nformat ascii 1.0\n" + ply_faces + ply_vertices +
           "end_header\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n0 0 0\n1 0 0\n0 1 0\n0 0 1",
       1.0 / 6},
      {"edges.ply",
       "ply\nformat binary_little_endian 1.0\n" + ply_faces + ply_edges + ply_vertices + "end_header\n" +
           faces_first,
       1.0 / 6},
      {"mirrored.stl", mirrored_stl(), -1.0 / 6},
      {"text.stl", kStlText, 1.0 / 6},
      {"capitals.stl", capitals, 1.0 / 6},
      {"spaces.stl", "  " + capitals, 1.0 / 6},
      {"name.stl", "solid gr\xc3\xbcn" + kStlText.substr(5), 1.0 / 6},
      {"two.stl", kStlText.substr(0, half) + "endsolid\nsolid b\n" + kStlText.substr(half), 1.0 / 6},
  };
  for (const Row& row : rows) {
    const MeshCheck solid = check_mesh(read_mesh(folder_.write(row.name, row.bytes)));
    SCOPED_TRACE(row.name + (": " + text(solid)));
    EXPECT_TRUE(solid.closed());
    EXPECT_EQ(solid.parts, 1);
    EXPECT_EQ(solid.vertices, row.volume_m3 == 1 ? 8 : 4);
    EXPECT_EQ(solid.triangles, row.volume_m3 == 1 ? 12 : 4);
    EXPECT_NEAR(solid.volume_m3, row.volume_m3, 1e-9);
  }
}

// A U: its caps are concave faces of eight corners, its notch is empty.
constexpr const char* kU =
    "v 4 4 0\nv 4 1 0\nv 2 1 0\nv 2 4 0\nv 0 4 0\nv 0 0 0\nv 6 0 0\nv 6 4 0\n"
    "v 4 4 2\nv 4 1 2\nv 2 1 2\nv 2 4 2\nv 0 4 2\nv 0 0 2\nv 6 0 2\nv 6 4 2\n"
    "f 1 2 10 9\nf 2 3 11 10\nf 3 4 12 11\nf 4 5 13 12\nf 5 6 14 13\nf 6 7 15 14\nf 7 8 16 15\nf 8 1 9 16\n";

double surface_m2(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm() / 2;
  return sum;
}

TEST_F(MeshFileTest, ConcavePolygonsKeepTheirArea) {
  const fs::path file =
      folder_.write("u.obj", std::string(kU) + "f 8 7 6 5 4 3 2 1\nf 9 10 11 12 13 14 15 16\n");
  const TriangleMesh u = read_mesh(file);
  const MeshCheck check = check_mesh(u);
  EXPECT_TRUE(check.closed()) << text(check);
  EXPECT_NEAR(std::abs(check.volume_m3), 2 * 18, 1e-9);
  EXPECT_NEAR(surface_m2(u), 2 * 18 + 2 * (4 + 6 + 4 + 2 + 3 + 2 + 3 + 2), 1e-9);
}

// The library reads the line feed there as the end of the header.
TEST_F(MeshFileTest, BinaryPlyMayBeginWithALineFeed) {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
  std::string data;
  const float first = std::bit_cast<float>(0x3f80000au);  // begins with the byte 0x0A
  for (const float value : {first, 0.f, 0.f, 2.f, 0.f, 0.f, 0.f, 2.f, 0.f, 0.f, 0.f, 2.f}) data += raw(value);
  data += packed_faces();
  ASSERT_EQ(data.front(), '\n');
  std::string windows = header;
  for (std::size_t at = 0; (at = windows.find('\n', at)) != std::string::npos; at += 2)
    windows.replace(at, 1, "\r\n");
  for (const std::string& before : {header, windows}) {
    const TriangleMesh solid = read_mesh(folder_.write("t.ply", before + data));
    EXPECT_TRUE(check_mesh(solid).closed());
    EXPECT_EQ(solid.vertices[0], Vec3(first, 0, 0));
  }
}

// --- what is refused ---

constexpr const char* kRead = "no InputError";

// If these were not refused, the library would read another shape: the beginning of a word as a number, the
// next line for what is missing, other numbers of all later vertices, or a repaired polygon.
TEST_F(MeshFileTest, ObjOfOtherWordsIsRefused) {
  const auto vertex = [](const std::string& line) { return changed(kCube, "v 1 1 0", line); };
  const auto face = [](const std::string& line) { return changed(kCube, "f 1 3 4 2", line); };
  std::vector<std::pair<std::string, std::string>> rows = {
      {vertex("v 1 1 0 1 1"), "line 4: a vertex has 5 numbers: expected x y z, then w, or a colour"},
      {vertex("v 1 1 0 0 0 0 0 0"), "line 4: a vertex has 8 numbers"},
      {"v 1 2\n" + kCube, "x.obj: cannot be read (line 1: a vertex has fewer than three"},
      {face("f 1 3 4 99"), "line 9: vertex 99: expected 1 to 8"},
      {std::string(kU) + "f 8 7 6 5 4 3 2 1\nf 9 10 11 12 13 15 14 16\n",
       "x.obj: cannot be read (a face of 8 corners, the first at 4 4 2, crosses or touches itself"},
      {kVertices + "p 1\np 2\n", "x.obj: "},
  };
  for (const char* number : {"0x1", "1D0", "1.0.9", "1,0", "1mm", "one", "1e", "--1", "+-1", "1e999"})
    rows.push_back({vertex(std::string("v 1 ") + number + " 0"),
                    std::string("x.obj: cannot be read (line 4: '") + number});
  for (const char* number : {"1.", "+1", "1e0", "0.1E+01", "1.0000", "01", ".5", "+.5"})
    rows.push_back({vertex(std::string("v 1 ") + number + " 0"), kRead});
  for (const char* corner : {"4.7", "0", "4a", "0x4", "/4", "-9", "1e0"})
    rows.push_back({face(std::string("f 1 3 ") + corner + " 2"), std::string("line 9: corner '") + corner});
  for (const char* bytes : {"\n", "\xEF\xBB\xBF", "  \n\t\n", "mtllib a.mtl\nvn 0 0 1\n"})
    rows.push_back({bytes, "x.obj: cannot be read (it has neither vertices nor faces)"});
  for (const auto& [bytes, why] : rows) EXPECT_HAS(refused("x.obj", bytes), why);
}

TEST_F(MeshFileTest, PlyThatIsNotAsItsHeaderSaysIsRefused) {
  const auto row = [](const std::string& old, const std::string& line) {
    return changed(kPlyText, old + "\n", line + "\n");
  };
  const auto claims = [](const std::string& format, const std::string& vertices, const std::string& faces) {
    return "ply\nformat " + format + " 1.0\nelement vertex " + vertices +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
           "\nproperty list uint int vertex_indices\nend_header\n";
  };
  const std::string of_bytes = "binary_little_endian", points(9 * 4, '\0');
  const std::string binary =
      changed(claims(of_bytes, "4", "4"), "list uint", "list uchar") + std::string(48, '\0');
  std::string long_list = packed_faces();
  long_list[3 * 13] = '\7';  // the last list has three values
  const std::pair<std::string, std::string> rows[] = {
      {row("1 0 0", "1 0"), "x.ply: cannot be read (line 11: an element 'vertex' has only 2 values)"},
      {row("1 0 0", "1 0 0 0"), "line 11: an element 'vertex' has 4 values: expected 3"},
      {row("1 0 0", "1 0x9 0"), "line 11: '0x9': expected a number of type float"},
      {row("3 0 1 3", "4 0 1 3"), "line 15: an element 'face' has only 4 values"},
      {row("3 0 1 3", "3 0 1 3 2"), "line 15: an element 'face' has 5 values: expected 4"},
      {row("3 0 1 3", "3 0 1.7 3"), "line 15: '1.7': expected a number of type int"},
      {row("3 0 1 3", "-1 0 1 3"), "line 15: a list has -1 values"},
      {row("3 2 0 3", "3 2 0 3\n3 0 1 2"), "line 18: more than the elements that the header counts"},
      {row("3 2 0 3", ""), "it ends after 3 of 4 elements 'face'"},
      {row("1 0 0", "\n\t1.0 0 0 \r"), kRead},
      {row("3 2 0 3", "3 2 0 3\n\n "), kRead},
      {row("property float y", "property real y"), "property 'y' of element 'vertex' has a type"},
      {row("format ascii 1.0", "format text 1.0"), "format 'text': expected ascii or a binary one"},
      {"ply\nformat nothing\n", "x.ply: cannot be read"},
      {binary + packed_faces() + "face", "x.ply: cannot be read (it has 4 bytes after the last element)"},
      {binary + long_list, "x.ply: cannot be read (it ends after "},
      // Each of these made the library allocate gigabytes or run for ever.
      {"ply\nformat ascii 1.0\n", "x.ply: cannot be read (its header has no end)"},
      {claims("ascii", "300000000", "1") + "0 0 0\n", "x.ply: cannot be read (its header claims"},
      {claims(of_bytes, "3", "4000000000") + points, "x.ply: cannot be read (its header claims"},
      {claims(of_bytes, "3", "1") + points + raw(1u << 30) + points, "x.ply: cannot be read ("},
      {claims("ascii", "3", "1") + "0 0 0\n1 0 0\n0 1 0\n4294967295 0 1 2\n", "x.ply: cannot be read ("},
  };
  for (const auto& [bytes, why] : rows) EXPECT_HAS(refused("x.ply", bytes), why);
  for (const char* const format : {"binary_little_endian", "binary_big_endian"}) {
    const std::string header = std::string("ply\nformat ") + format +
                               " 1.0\nelement face 1\nproperty list char uchar vertex_indices\n"
                               "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                               "end_header\n";
    EXPECT_HAS(refused("x.ply", header + '\xff' + std::string(255 + 3 * 12, '\0')),
               "x.ply: cannot be read (element 'face' 0 has a list of negative length)");
  }
}

// The library would leave out the fourth corner of a facet, and begin a new facet with two corners of the
// last one. Many programs write "solid" into the header of a binary file.
TEST_F(MeshFileTest, StlOfOtherWordsOrAnotherLengthIsRefused) {
  const auto line = [](const std::string& old, const std::string& by) {
    return changed(kStlText, old + "\n", by + "\n");
  };
  const auto facet = [](int corners) {
    std::string text = "facet normal 0 0 1\nouter loop\n";
    for (int i = 0; i < corners; ++i)
      text += "vertex " + std::to_string(i % 2) + " " + std::to_string(i / 2) + " 0\n";
    return text + "endloop\nendfacet\n";
  };
  const auto solid = [](const std::string& facets) { return "solid q\n" + facets + "endsolid q\n"; };
  const std::string three = "a facet does not have three vertices)";
  std::string binary = "solid cube" + std::string(70, '\0') + raw(2u);
  for (const float value : {0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) binary += raw(value);
  binary += std::string(2 + 50, '\0');
  std::vector<std::pair<std::string, std::string>> rows = {
      {solid(facet(3) + facet(3)), kRead},
      {solid(facet(4) + facet(3)), "x.stl: cannot be read (line 7: " + three},
      {solid(facet(2) + facet(3)), "x.stl: cannot be read (line 6: " + three},
      {line("vertex 0 1 0", "vertex 0 1"), "line 6: 'vertex' in a vertex: expected a number"},
      {line("vertex 0 1 0", "vertex 0 1 0 0"), "line 5: '0': expected vertex"},
      {line("endsolid a", ""), "the file ends: expected endsolid"},
      {line("endsolid a", "endsolid a\nmore"), "line 31: 'more': expected solid"},
      {line("endsolid a", "endsolid\n\n"), kRead},
      {binary, kRead},
      {binary + "meta",
       "x.stl: cannot be read (its header claims 2 facets, which need 184 bytes: it has 188)"},
      {binary.substr(0, 150), "which need 184 bytes: it has 150"},
      {std::string(80, ' ') + raw(4'000'000'000u) + std::string(50, '\0'),
       "its header claims 4000000000 facets, which need 200000000084 bytes: it has 134); expected"},
      {"abc", "x.stl: cannot be read (it is no text that begins with the word solid"},
      {std::string(84, '\1'), "x.stl: "},
  };
  for (const char* number : {"0x9", "9D-1", "1.O4", "0.0.9", "1,5"})
    rows.push_back({line("vertex 0 1 0", std::string("vertex 0 ") + number + " 0"),
                    std::string("x.stl: cannot be read (line 5: '") + number});
  for (const auto& [bytes, why] : rows) EXPECT_HAS(refused("x.stl", bytes), why);
}

TEST_F(MeshFileTest, RefusalsNameTheFile) {
  EXPECT_HAS(refusal([&] { read_mesh(folder_ / "none.obj"); }), "none.obj: no such file: expected an OBJ");
  EXPECT_HAS(refused("a.txt", "v 0 0 0\n"), "a.txt: not a mesh");
  for (const std::string name : {"empty.obj", "empty.ply", "empty.stl"})
    EXPECT_HAS(refused(name, ""), name + ": cannot be read (it is empty); expected an OBJ, PLY or STL file");
}

// A box of 0.3 m at map coordinates: single precision would move its corners by centimetres.
TEST_F(MeshFileTest, CoordinatesBeyondSinglePrecisionAreRefused) {
  const auto box_at = [&](double x, double y) {
    const TriangleMesh box = box_mesh({0.323, 0.36, 0.25}, {x, y, 0});
    std::ostringstream obj;
    obj.precision(17);
    for (const Vec3& v : box.vertices) obj << "v " << v.x() << " " << v.y() << " " << v.z() << "\n";
    for (const auto& [a, b, c] : box.triangles) obj << "f " << a + 1 << " " << b + 1 << " " << c + 1 << "\n";
    return obj.str();
  };
  EXPECT_HAS(
      refused("map.obj", box_at(391'000.1, 5'820'000.2)),
      "map.obj: cannot be read (its coordinates reach 5.82e+06 and are read in single precision, to 0.34");
  EXPECT_HAS(refused("map.obj", box_at(-20'000, 0)), "expected a mesh nearer to its origin");
  const fs::path file = folder_.write("near.obj", box_at(500, 0));
  EXPECT_NEAR(check_mesh(read_mesh(file)).volume_m3, 0.323 * 0.36 * 0.25, 3e-4 * 0.323 * 0.36 * 0.25);
}

TEST_F(MeshFileTest, CornersThatAreNoVerticesAreRefusedOrCounted) {
  const fs::path file = folder_.write("far.obj", kVertices + "f 1 2 99\nf 1 2 3\n");
  const std::string message = refusal([&] {
    if (!check_mesh(read_mesh(file)).closed()) throw InputError(file.string(), "not closed");
  });
  EXPECT_HAS(message, "far.obj: ");
}

// The counts that the header of a PLY file claims are checked against the size of the file before any library
// reads it.

std::string header(const std::string& format, const std::string& vertices, const std::string& faces) {
  return "ply\nformat " + format + " 1.0\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty double z\nelement face " + faces +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

TEST_F(MeshFileTest, HeadersOfPlyAreCheckedAgainstTheSizeOfTheFile) {
  const std::string binary(3 * 16 + 1, '\0');  // three vertices; the face is a list of none
  std::string windows = header("binary_big_endian", "3", "1");
  for (std::size_t at = 0; (at = windows.find('\n', at)) != std::string::npos; at += 2)
    windows.replace(at, 1, "\r\n");
  const std::string whole = header("ascii", "3", "1"), end = "its header has no end",
                    many = "its header claims";
  std::vector<std::pair<std::string, std::string>> rows = {
      {whole + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2", ""},
      {header("binary_little_endian", "3", "1") + binary, ""},
      {windows + binary, ""},
      {"ply\nformat ascii 1.0\ncomment end_header is near\nobj_info x\nend_header\n", ""},
      {"ply\nformat ascii 1.0\nproperty end_header\nend_headers\n", end},
      {header("binary_little_endian", "3", "1") + std::string(3 * 16, '\0'),  // one byte less
       "its header claims 4 elements, more than its 48 bytes hold"},
      {whole + "0 0 0\n1 0 0\n0 1 0", "its header claims 4 elements"},
  };
  for (std::size_t length = 0; length + 1 < whole.size(); ++length)
    rows.push_back({whole.substr(0, length), end});
  for (const char* count : {"300000000", "4294967295", "4294967296", "18446744073709551615"}) {
    rows.push_back({header("ascii", count, "1") + "0 0 0\n", many});
    rows.push_back({header("ascii", "0", count) + "0 0 0\n", many});
    rows.push_back({header("binary_big_endian", count, count) + "0 0 0\n", many});
  }
  for (const char* none : {"-1", "many", "18446744073709551616", "3.5", ""})
    rows.push_back({header("ascii", none, "1") + "0 0 0\n", "its header has a count that is not a number: "});
  for (const auto& [bytes, problem] : rows) {
    const std::string found = ply_problem(folder_.write("x.ply", bytes));
    EXPECT_TRUE(problem.empty() ? found.empty() : contains(found, problem)) << found << "\n" << bytes;
  }
}

// Meshes that are kept outside of the repository; the tests are skipped if they are missing.

struct Known {
  const char* file;
  int vertices, triangles, boundary_edges, non_manifold_edges, parts;
};
class RealMeshTest : public testing::TestWithParam<Known> {};

TEST_P(RealMeshTest, IsAsItsReadmeSays) {
  const fs::path file = data_root() / "meshes" / GetParam().file;
  if (!fs::exists(file)) GTEST_SKIP() << "recorded data are missing: " << file;
  const MeshCheck check = check_mesh(read_mesh(file));
  EXPECT_EQ(check.vertices, GetParam().vertices);
  EXPECT_EQ(check.triangles, GetParam().triangles);
  EXPECT_EQ(check.boundary_edges, GetParam().boundary_edges);
  EXPECT_EQ(check.non_manifold_edges, GetParam().non_manifold_edges);
  EXPECT_EQ(check.parts, GetParam().parts);
}

// Coarse voxels save time. Interior and shell together have the volume of the mesh, but parts that overlap
// count twice in the mesh.
TEST_P(RealMeshTest, BecomesATool) {
  const fs::path file = data_root() / "meshes" / GetParam().file;
  if (!fs::exists(file)) GTEST_SKIP() << "recorded data are missing: " << file;
  ToolReport report;
  const VoxelToolSettings settings{.voxel_m = 2e-3, .size_m = 0.15, .repair = GetParam().boundary_edges > 0};
  const VoxelTool tool = make_voxel_tool(read_mesh(file), settings, report);
  const double voxel = 8e-9, solid = static_cast<double>(report.voxels[2]),
               shell = static_cast<double>(report.voxels[1]);
  EXPECT_GT(tool.volume_m3, voxel * solid);
  EXPECT_NEAR(tool.volume_m3, voxel * (solid + shell), (settings.repair ? 0.1 : 0.02) * tool.volume_m3);
  EXPECT_NEAR(report.sides_m.maxCoeff(), 0.15, 1e-9);
  EXPECT_LT(report.thin_fraction, 0.2);
}

INSTANTIATE_TEST_SUITE_P(Meshes, RealMeshTest,
                         testing::Values(Known{"stanford_bunny.obj", 3301, 6598, 0, 0, 1},
                                         Known{"hand_closed.obj", 7993, 15982, 0, 0, 1},
                                         Known{"husky.obj", 962, 1920, 0, 0, 1},
                                         Known{"pr2_gripper_coarse_15cm.obj", 939, 1795, 81, 6, 5},
                                         Known{"ycb_power_drill.obj", 7866, 15728, 0, 0, 1}),
                         [](const auto& tool) {
                           std::string name = tool.param.file;
                           return name.substr(0, name.find('.'));
                         });

}  // namespace
}  // namespace remote_touch::mesh_file_test
