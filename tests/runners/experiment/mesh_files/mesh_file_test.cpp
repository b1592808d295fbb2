// Meshes from files: what the formats allow, and what is refused.
#include "runners/experiment/mesh_files/mesh_file.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <sstream>

#include "core/mesh/triangle_mesh.h"
#include "tests/support/meshes.h"
#include "tests/support/test_files.h"

namespace remote_touch::mesh_file_test {
namespace {

namespace fs = std::filesystem;

const std::string kVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n";

class MeshFileTest : public testing::Test {
 protected:
  MeshCheck check(const std::string& name, const std::string& bytes) const {
    return check_mesh(read_mesh(folder_.write(name, bytes)));
  }
  std::string refused(const std::string& name, const std::string& bytes) const {
    const fs::path file = folder_.write(name, bytes);
    return refusal([&] { read_mesh(file); });
  }
  TestFolder folder_{"mesh_file"};
};

TEST_F(MeshFileTest, ReadsObjWithPolygonsAndAllKindsOfFaces) {
  const MeshCheck cube =
      check("cube.obj", kVertices +
                            "vt 0 0\nvn 0 0 1\nf 1 3 4 2\nf 5/1 6/1 8/1 7/1\nf 1//1 2//1 6//1 5//1\n"
                            "f 3/1/1 7/1/1 8/1/1 4/1/1\nf -8 -4 -2 -6\nf 2 4 8 6\n");
  EXPECT_TRUE(cube.closed()) << text(cube);
  EXPECT_EQ(cube.vertices, 8);
  EXPECT_EQ(cube.triangles, 12);
  EXPECT_NEAR(cube.volume_m3, 1, 1e-12);
}

TEST_F(MeshFileTest, ObjectsOfAFileAreOneMesh) {
  const MeshCheck cube = check("Cube.OBJ", "mtllib none.mtl\n" + kVertices +
                                               "o a\nusemtl x\nf 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\no b\n"
                                               "g c\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
  EXPECT_TRUE(cube.closed()) << text(cube);
  EXPECT_EQ(cube.parts, 1);
}

TEST_F(MeshFileTest, StlHasNoSharedVertices) {
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
  const MeshCheck check_of =
      check("t.stl", stl + "endsolid t\n");  // mirrored: inside out, and 0 and -0 are one
  EXPECT_TRUE(check_of.closed()) << text(check_of);
  EXPECT_EQ(check_of.vertices, 4);
  EXPECT_NEAR(check_of.volume_m3, -1.0 / 6, 1e-9);
}

const std::string kPlyText =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
    "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";

TEST_F(MeshFileTest, APlyFileIsRead) {
  const MeshCheck solid = check("t.ply", kPlyText);
  EXPECT_TRUE(solid.closed()) << text(solid);
  EXPECT_NEAR(solid.volume_m3, 1.0 / 6, 1e-9);
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

// They are refused before the repair, which would make a closed surface of them.
TEST_F(MeshFileTest, PolygonsThatCrossThemselvesAreRefused) {
  EXPECT_HAS(refused("u.obj", std::string(kU) + "f 8 7 6 5 4 3 2 1\nf 9 10 11 12 13 15 14 16\n"),
             "u.obj: cannot be read (a face of 8 corners, the first at 4 4 2, crosses or touches itself");
}

TEST_F(MeshFileTest, ARepeatedCornerCountsOnce) {
  const MeshCheck cube = check("cube.obj", kVertices +
                                               "f 1 1 3 4 2\nf 5 6 8 7 5\nf 1 2 6 5\nf 3 7 8 4\n"
                                               "f 1 5 7 3\nf 2 2 4 8 8 6 2\n");
  EXPECT_TRUE(cube.closed()) << text(cube);
  EXPECT_EQ(cube.triangles, 12);
}

// The library would leave out the fourth corner, and begin a new facet with two corners of the last one.
TEST_F(MeshFileTest, FacetsOfStlWithAnotherNumberOfCornersAreRefused) {
  const auto facet = [](int corners) {
    std::string text = "facet normal 0 0 1\nouter loop\n";
    for (int i = 0; i < corners; ++i)
      text += "vertex " + std::to_string(i % 2) + " " + std::to_string(i / 2) + " 0\n";
    return text + "endloop\nendfacet\n";
  };
  const auto problem = [&](const std::string& facets) {
    const fs::path file = folder_.write("q.stl", "solid q\n" + facets + "endsolid q\n");
    return refusal([&] {
      read_mesh(file);
      throw InputError("read");
    });
  };
  EXPECT_EQ(problem(facet(3) + facet(3)), "read");
  EXPECT_HAS(problem(facet(4) + facet(3)),
             "q.stl: cannot be read (line 7: a facet does not have three vertices)");
  EXPECT_HAS(problem(facet(2) + facet(3)),
             "q.stl: cannot be read (line 6: a facet does not have three vertices)");
}

constexpr const char* kMark = "\xEF\xBB\xBF";
const std::string kCube = kVertices + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

TEST_F(MeshFileTest, ByteOrderMarksAreSkipped) {
  EXPECT_TRUE(check("cube.obj", kMark + kCube).closed());
  EXPECT_TRUE(check("t.ply", kMark + kPlyText).closed());
}

// Texture coordinates, normals and materials may be missing or wrong, because a tool does not use them.
TEST_F(MeshFileTest, ObjFacesMayNameWhatIsMissing) {
  EXPECT_TRUE(
      check("cube.obj", "mtllib none.mtl\nvt 0.5 0.5\nvt\nvn 0 0 1\n" + kVertices +
                            "usemtl red\nf 1/1 3/2 4/3 2/99\nf 5/9/9 6/9/9 8/9/9 7/9/9\nf 1//9 2//9 6//9 "
                            "5//9\nf 3/ 7/ 8/ 4/\n  f 1/9 5/9 \\\n7/9 3/9\n\tf -7/-3 -5/-3 -1/-3 -3/-3\n")
          .closed());
}

// The library would leave out such a vertex, so that the numbers of all later vertices would be wrong.
TEST_F(MeshFileTest, ObjVerticesMayHaveColours) {
  std::string cube = kCube;
  cube.replace(cube.find("v 1 1 0"), 7, "v 1 1 0 0.5 0.5 0.5 1  # with alpha");
  cube.replace(cube.find("v 0 0 1"), 7, "v 0 0 1 0.5 0.5 0.5");
  cube.replace(cube.find("v 1 0 1"), 7, "v 1 0 1 2");  // the weight of a rational curve
  const MeshCheck whole = check("cube.obj", cube);
  EXPECT_TRUE(whole.closed());
  EXPECT_NEAR(whole.volume_m3, 1, 1e-9);
  EXPECT_HAS(refused("flat.obj", "v 1 2\n" + kCube),
             "flat.obj: cannot be read (line 1: a vertex has fewer than three");
}

TEST_F(MeshFileTest, ObjFacesMayHaveAComment) {
  std::string cube = kCube;
  cube.replace(cube.find("f 1 3 4 2"), 9, "f 1 3 +4 002 # face 1 / 2");
  EXPECT_TRUE(check("cube.obj", cube).closed());
}

// A cube or a tetrahedron in which one text is replaced by another. If it were not refused, the library would
// read another shape: the beginning of a word as a number, or the next line for what is missing.
class ChangedMeshTest : public MeshFileTest {
 protected:
  std::string problem(const std::string& name, std::string text, const std::string& old,
                      const std::string& changed) const {
    const std::size_t at = text.find(old);
    EXPECT_NE(at, std::string::npos) << old;
    return refused(name, text.replace(at, old.size(), changed));
  }
};

constexpr const char* kRead = "no InputError";

TEST_F(ChangedMeshTest, ObjNumbersAreWholeWords) {
  const auto vertex = [&](const std::string& line) { return problem("x.obj", kCube, "v 1 1 0", line); };
  for (const char* number : {"0x1", "1D0", "1.0.9", "1,0", "1mm", "one", "1e", "--1", "+-1", "1e999"})
    EXPECT_HAS(vertex(std::string("v 1 ") + number + " 0"),
               std::string("x.obj: cannot be read (line 4: '") + number)
        << number;
  for (const char* number : {"1.", "+1", "1e0", "0.1E+01", "1.0000", "01", ".5", "+.5"})
    EXPECT_EQ(vertex(std::string("v 1 ") + number + " 0"), kRead) << number;
  EXPECT_HAS(vertex("v 1 1 0 1 1"), "line 4: a vertex has 5 numbers: expected x y z, then w, or a colour");
  EXPECT_HAS(vertex("v 1 1 0 0 0 0 0 0"), "line 4: a vertex has 8 numbers");
  const auto face = [&](const std::string& line) { return problem("x.obj", kCube, "f 1 3 4 2", line); };
  for (const char* corner : {"4.7", "0", "4a", "0x4", "/4", "-9", "1e0"})
    EXPECT_HAS(face(std::string("f 1 3 ") + corner + " 2"), std::string("line 9: corner '") + corner)
        << corner;
  EXPECT_HAS(face("f 1 3 4 99"), "line 9: vertex 99: expected 1 to 8");
}

TEST_F(ChangedMeshTest, PlyRowsHaveWhatTheHeaderSays) {
  const auto row = [&](const std::string& old, const std::string& line) {
    return problem("x.ply", kPlyText, old + "\n", line + "\n");
  };
  EXPECT_HAS(row("1 0 0", "1 0"), "x.ply: cannot be read (line 11: an element 'vertex' has only 2 values)");
  EXPECT_HAS(row("1 0 0", "1 0 0 0"), "line 11: an element 'vertex' has 4 values: expected 3");
  EXPECT_HAS(row("1 0 0", "1 0x9 0"), "line 11: '0x9': expected a number of type float");
  EXPECT_HAS(row("3 0 1 3", "4 0 1 3"), "line 15: an element 'face' has only 4 values");
  EXPECT_HAS(row("3 0 1 3", "3 0 1 3 2"), "line 15: an element 'face' has 5 values: expected 4");
  EXPECT_HAS(row("3 0 1 3", "3 0 1.7 3"), "line 15: '1.7': expected a number of type int");
  EXPECT_HAS(row("3 0 1 3", "-1 0 1 3"), "line 15: a list has -1 values");
  EXPECT_HAS(row("3 2 0 3", "3 2 0 3\n3 0 1 2"), "line 18: more than the elements that the header counts");
  EXPECT_HAS(row("3 2 0 3", ""), "it ends after 3 of 4 elements 'face'");
  EXPECT_EQ(row("1 0 0", "\n\t1.0 0 0 \r"), kRead);
  EXPECT_EQ(row("3 2 0 3", "3 2 0 3\n\n "), kRead);
  EXPECT_HAS(row("property float y", "property real y"), "property 'y' of element 'vertex' has a type");
  EXPECT_HAS(row("format ascii 1.0", "format text 1.0"), "format 'text': expected ascii or a binary one");
}

// The four faces of a tetrahedron, as lists of bytes with integers.
std::string packed_faces() {
  std::string data;
  for (const auto& face : std::vector<std::array<int, 3>>{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}) {
    data += '\3';
    for (const int corner : face) data += raw(corner);
  }
  return data;
}

TEST_F(MeshFileTest, PlyFacesMayComeBeforeTheirVertices) {
  const std::string vertices = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string faces = "element face 4\ncomment of faces\nproperty list uchar int vertex_indices\n";
  const std::string other = "element edge 1\nproperty uchar vertex1\nproperty uchar vertex2\n";
  const std::string corners = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n", points = "0 0 0\n1 0 0\n0 1 0\n0 0 1";
  const MeshCheck text =
      check("t.ply", "ply\nformat ascii 1.0\n" + faces + vertices + "end_header\n" + corners + points);
  EXPECT_TRUE(text.closed());
  EXPECT_NEAR(text.volume_m3, 1.0 / 6, 1e-9);
  std::string data = packed_faces();
  data += std::string("\0\1", 2);
  for (const float value : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f}) data += raw(value);
  const std::string header =
      "ply\nformat binary_little_endian 1.0\n" + faces + other + vertices + "end_header\n";
  const MeshCheck binary = check("b.ply", header + data);
  EXPECT_TRUE(binary.closed());
  EXPECT_NEAR(binary.volume_m3, 1.0 / 6, 1e-9);
  EXPECT_HAS(refused("b.ply", header + data + "face"),
             "b.ply: cannot be read (it has 4 bytes after the last element)");
  data[4 * 13 - 13] = '\7';  // a list that reads the bytes of the next elements
  EXPECT_HAS(refused("b.ply", header + data), "b.ply: cannot be read (it ends after ");
}

TEST_F(MeshFileTest, BinaryPlyListsAreNotNegative) {
  for (const char* const format : {"binary_little_endian", "binary_big_endian"}) {
    const std::string header = std::string("ply\nformat ") + format +
                               " 1.0\nelement face 1\nproperty list char uchar vertex_indices\n"
                               "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                               "end_header\n";
    EXPECT_HAS(refused("b.ply", header + '\xff' + std::string(255 + 3 * 12, '\0')),
               "b.ply: cannot be read (element 'face' 0 has a list of negative length)");
  }
}

const std::string kStlText =
    "solid a facet\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\n"
    "facet normal nan nan -nan(ind)\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\n"
    "facet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\n"
    "facet normal 0 0 1\nouter loop\nvertex 0 1 0\nvertex 0 0 0\nvertex 0 0 1\nendloop\nendfacet\nendsolid a\n";

TEST_F(ChangedMeshTest, StlWordsAreThoseOfTheFormat) {
  const auto line = [&](const std::string& old, const std::string& changed) {
    return problem("x.stl", kStlText, old + "\n", changed + "\n");
  };
  for (const char* number : {"0x9", "9D-1", "1.O4", "0.0.9", "1,5"})
    EXPECT_HAS(line("vertex 0 1 0", std::string("vertex 0 ") + number + " 0"),
               std::string("x.stl: cannot be read (line 5: '") + number);
  EXPECT_HAS(line("vertex 0 1 0", "vertex 0 1"), "line 6: 'vertex' in a vertex: expected a number");
  EXPECT_HAS(line("vertex 0 1 0", "vertex 0 1 0 0"), "line 5: '0': expected vertex");
  EXPECT_HAS(line("endsolid a", ""), "the file ends: expected endsolid");
  EXPECT_HAS(line("endsolid a", "endsolid a\nmore"), "line 31: 'more': expected solid");
  EXPECT_EQ(line("endsolid a", "endsolid\n\n"), kRead);
}

TEST_F(MeshFileTest, StlTextMayBeInCapitalsAndHaveManySolids) {
  std::string capitals = kStlText;
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  for (const std::string& text :
       {kStlText, capitals, "  " + capitals, "solid gr\xc3\xbcn" + kStlText.substr(5)}) {
    const MeshCheck solid = check("x.stl", text);
    EXPECT_TRUE(solid.closed());
    EXPECT_NEAR(std::abs(solid.volume_m3), 1.0 / 6, 1e-9);
  }
  const std::size_t half = kStlText.find("facet normal", 100);
  EXPECT_TRUE(
      check("x.stl", kStlText.substr(0, half) + "endsolid\nsolid b\n" + kStlText.substr(half)).closed());
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

TEST_F(MeshFileTest, RefusalsNameTheFile) {
  EXPECT_HAS(refusal([&] { read_mesh(folder_ / "none.obj"); }), "none.obj: no such file: expected an OBJ");
  EXPECT_HAS(refused("a.txt", "v 0 0 0\n"), "a.txt: not a mesh");
  for (const std::string name : {"empty.obj", "empty.ply", "empty.stl"})
    EXPECT_HAS(refused(name, ""), name + ": cannot be read (it is empty); expected an OBJ, PLY or STL file");
  for (const char* bytes : {"\n", "\xEF\xBB\xBF", "  \n\t\n", "mtllib a.mtl\nvn 0 0 1\n"})
    EXPECT_HAS(refused("no.obj", bytes), "no.obj: cannot be read (it has neither vertices nor faces)");
  EXPECT_HAS(refused("bad.ply", "ply\nformat nothing\n"), "bad.ply: cannot be read");
  EXPECT_HAS(refused("points.obj", kVertices + "p 1\np 2\n"), "points.obj: ");
  EXPECT_HAS(refused("cut.stl", std::string(84, '\1')), "cut.stl: ");
}

std::string ply(const std::string& format, const std::string& vertices, const std::string& faces) {
  return "ply\nformat " + format + " 1.0\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
         "\nproperty list uint int vertex_indices\nend_header\n";
}

// Each of these files made the library allocate gigabytes or run for ever.
TEST_F(MeshFileTest, FilesThatClaimMoreThanTheyHoldAreRefused) {
  const std::string points(9 * 4, '\0');
  EXPECT_HAS(refused("cut.ply", "ply\nformat ascii 1.0\n"),
             "cut.ply: cannot be read (its header has no end)");
  EXPECT_HAS(refused("many.ply", ply("ascii", "300000000", "1") + "0 0 0\n"),
             "many.ply: cannot be read (its header claims");
  EXPECT_HAS(refused("faces.ply", ply("binary_little_endian", "3", "4000000000") + points),
             "faces.ply: cannot be read (its header claims");
  EXPECT_HAS(refused("list.ply", ply("binary_little_endian", "3", "1") + points + raw(1u << 30) + points),
             "list.ply: cannot be read (");
  EXPECT_HAS(refused("list.ply", ply("ascii", "3", "1") + "0 0 0\n1 0 0\n0 1 0\n4294967295 0 1 2\n"),
             "list.ply: cannot be read (");
  EXPECT_HAS(
      refused("many.stl", std::string(80, ' ') + raw(4'000'000'000u) + std::string(50, '\0')),
      "many.stl: cannot be read (its header claims 4000000000 facets, which need 200000000084 bytes: it "
      "has 134); expected");
  EXPECT_HAS(refused("short.stl", "abc"),
             "short.stl: cannot be read (it is no text that begins with the word solid");
}

// Many programs write "solid" into the header of a binary file.
TEST_F(MeshFileTest, ABinaryStlOfAnotherLengthIsNoText) {
  std::string stl = "solid cube" + std::string(70, '\0') + raw(2u);
  for (const float value : {0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f}) stl += raw(value);
  stl += std::string(2 + 50, '\0');
  EXPECT_EQ(refused("two.stl", stl), kRead);
  EXPECT_HAS(refused("more.stl", stl + "meta"),
             "more.stl: cannot be read (its header claims 2 facets, which need 184 bytes: it has 188)");
  EXPECT_HAS(refused("cut.stl", stl.substr(0, 150)), "which need 184 bytes: it has 150");
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

}  // namespace
}  // namespace remote_touch::mesh_file_test
