#include "runners/presentation/export/vtk_poly_data.h"

#include <array>
#include <charconv>

#include "runners/presentation/export/little_endian.h"

namespace remote_touch {

namespace {

// The XML of a file and the numbers that it points to.
class VtkFile {
 public:
  void text(const std::string& more) { xml_ += more; }
  void array(const VtkArray& one) {
    xml_ += "<DataArray type=\"" + std::string(one.type) + "\" Name=\"" + xml_escaped(one.name) +
            "\" NumberOfComponents=\"" + std::to_string(one.components) + "\" format=\"appended\" offset=\"" +
            std::to_string(appended_.size()) + "\"/>\n";
    put(appended_, std::uint64_t{one.bytes.size()});
    appended_ += one.bytes;
  }
  void section(const std::string& name, const std::vector<VtkArray>& arrays) {
    text("<" + name + ">\n");
    for (const VtkArray& each : arrays) array(each);
    text("</" + name + ">\n");
  }
  std::string whole() const {
    return xml_ + "<AppendedData encoding=\"raw\">\n_" + appended_ + "\n</AppendedData>\n";
  }

 private:
  std::string xml_, appended_;
};

VtkArray integers(const std::string& name, const std::vector<std::int64_t>& values) {
  VtkArray array{name, "Int64", 1, {}};
  for (const std::int64_t value : values) put(array.bytes, value);
  return array;
}

// Cells as VTK stores them: the points of all cells one after another, and the index behind the last point of
// each.
struct Cells {
  std::vector<std::int64_t> points, ends;
  template <class Points>
  void add(const Points& of_cell) {
    points.insert(points.end(), of_cell.begin(), of_cell.end());
    ends.push_back(static_cast<std::int64_t>(points.size()));
  }
  std::vector<VtkArray> arrays() const {
    return {integers("connectivity", points), integers("offsets", ends)};
  }
};

std::string text_of(double number) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

std::string counts_of(const VtkPolyData& data) {
  return "<Piece NumberOfPoints=\"" + std::to_string(data.points.size()) + "\" NumberOfVerts=\"" +
         std::to_string(data.has_vertices ? data.points.size() : 0) + "\" NumberOfLines=\"" +
         std::to_string(data.lines.size()) + "\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
         std::to_string(data.faces.size()) + "\">\n";
}

}  // namespace

std::string xml_escaped(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '&')
      escaped += "&amp;";
    else if (c == '<')
      escaped += "&lt;";
    else if (c == '"')
      escaped += "&quot;";
    else
      escaped += c;
  }
  return escaped;
}

std::string vtp_file(const VtkPolyData& data) {
  VtkFile file;
  file.text(kVtkOpening);
  file.text(
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "<PolyData>\n<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
      "format=\"ascii\">" +
      text_of(data.time_s) + "</DataArray>\n</FieldData>\n" + counts_of(data));
  VtkArray points{"Points", "Float64", 3, {}};
  for (const Vec3& p : data.points)
    for (int axis = 0; axis < 3; ++axis) put(points.bytes, p[axis]);
  Cells vertices, lines, faces;
  for (std::size_t i = 0; data.has_vertices && i < data.points.size(); ++i)
    vertices.add(std::array{static_cast<std::int64_t>(i)});
  for (const auto& line : data.lines) lines.add(line);
  for (const auto& face : data.faces) faces.add(face);
  file.section("Points", {points});
  file.section("Verts", vertices.arrays());
  file.section("Lines", lines.arrays());
  file.section("Polys", faces.arrays());
  file.section("PointData", data.of_points);
  file.section("CellData", data.of_cells);
  file.text("</Piece>\n</PolyData>\n");
  return file.whole() + "</VTKFile>\n";
}

}  // namespace remote_touch
