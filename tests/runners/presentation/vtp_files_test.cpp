#include "runners/presentation/export_formats.h"

#include <gtest/gtest.h>

#include "tests/support/test_files.h"

namespace remote_touch::vtp_files_test {
namespace {

std::string array(const char* type, const char* name, int components, int offset) {
  return std::string("<DataArray type=\"") + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
         std::to_string(components) + "\" format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>\n";
}

TEST(VtkPolyData, IsTheFileOfTheFormat) {
  VtkPolyData data;
  data.time_s = 0.25;
  data.points = {{1, 2, 3}, {4, 5, 6}};
  data.has_vertices = true;
  data.lines = {{0, 1}};
  data.of_points = {{"a<b", "UInt8", 1, std::string("\x07\x08", 2)}};
  data.of_cells = {};
  const auto u64 = [](std::uint64_t value) { return raw(value); };
  const std::string expected =
      "<?xml version=\"1.0\"?>\n<!-- remote-touch export -->\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "<PolyData>\n<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
      "format=\"ascii\">0.25</DataArray>\n</FieldData>\n"
      "<Piece NumberOfPoints=\"2\" NumberOfVerts=\"2\" NumberOfLines=\"1\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"0\">\n<Points>\n" +
      array("Float64", "Points", 3, 0) + "</Points>\n<Verts>\n" + array("Int64", "connectivity", 1, 56) +
      array("Int64", "offsets", 1, 80) + "</Verts>\n<Lines>\n" + array("Int64", "connectivity", 1, 104) +
      array("Int64", "offsets", 1, 128) + "</Lines>\n<Polys>\n" + array("Int64", "connectivity", 1, 144) +
      array("Int64", "offsets", 1, 152) + "</Polys>\n<PointData>\n" + array("UInt8", "a&lt;b", 1, 160) +
      "</PointData>\n<CellData>\n</CellData>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_" +
      u64(48) + raw(1.0) + raw(2.0) + raw(3.0) + raw(4.0) + raw(5.0) + raw(6.0) +  // points
      u64(16) + u64(0) + u64(1) + u64(16) + u64(1) + u64(2) +                      // vertices
      u64(16) + u64(0) + u64(1) + u64(8) + u64(2) +                                // lines
      u64(0) + u64(0) +                                                            // faces
      u64(2) + "\x07\x08" + "\n</AppendedData>\n</VTKFile>\n";
  EXPECT_EQ(vtp_file(data), expected);
}

}  // namespace
}  // namespace remote_touch::vtp_files_test
