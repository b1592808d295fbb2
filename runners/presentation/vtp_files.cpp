#include "runners/presentation/export_formats.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "core/parameters/parameter.h"
#include "core/points/point_cloud.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {
namespace {

template <class Number>
constexpr const char* kTypeOf = nullptr;
template <>
constexpr const char* kTypeOf<double> = "Float64";
template <>
constexpr const char* kTypeOf<std::int32_t> = "Int32";
template <>
constexpr const char* kTypeOf<std::int64_t> = "Int64";
template <>
constexpr const char* kTypeOf<std::uint64_t> = "UInt64";
template <>
constexpr const char* kTypeOf<std::uint8_t> = "UInt8";

template <class Number>
VtkArray array_of(const std::string& name, const std::vector<Number>& values, int components = 1) {
  VtkArray array{name, kTypeOf<Number>, components, {}};
  for (const Number value : values) put(array.bytes, value);
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
    return {array_of("connectivity", points), array_of("offsets", ends)};
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

VtkPolyData paths_of(const ExportJob& job, const ExportedRun& run) {
  VtkPolyData data;
  for (const std::vector<Vec3>* const path : {&run.hip_W, &run.proxy_W}) {
    std::vector<std::int64_t>& line = data.lines.emplace_back();
    for (std::size_t i = 0; i < run.ticks(); ++i) {
      if (!job.keeps(i, run.ticks())) continue;
      line.push_back(static_cast<std::int64_t>(data.points.size()));
      data.points.push_back((*path)[i]);
    }
  }
  const std::vector<Table> tables = result_tables(job);
  for (const Column& column : tables.front().columns)
    std::visit(
        [&]<class Value>(const std::vector<Value>& values) {
          if constexpr (!std::is_same_v<Value, std::string>) {
            VtkArray& array = data.of_points.emplace_back(array_of(column.name, values, column.width));
            array.bytes += array.bytes;  // both lines have the same ticks
          }
        },
        column.values);
  data.of_cells.push_back(array_of("path", std::vector<std::int32_t>{0, 1}));
  return data;
}

VtkPolyData cloud_of(const ExportedFrame& frame, double time_s) {
  const PointCloud& cloud = frame.points;
  VtkPolyData data;
  data.time_s = time_s;
  data.has_vertices = true;
  for (std::size_t i = 0; i < cloud.size(); ++i) data.points.push_back(cloud.point(i));
  if (!cloud.colour.empty()) {
    VtkArray colour{"colour", "UInt8", 3, {}};
    std::vector<std::uint8_t> has_colour;
    for (const std::uint32_t c : cloud.colour) {
      has_colour.push_back(c != kNoColour);
      for (const int shift : {16, 8, 0})
        put(colour.bytes, static_cast<std::uint8_t>(shown_colour(c) >> shift));
    }
    data.of_points.push_back(std::move(colour));
    if (std::find(has_colour.begin(), has_colour.end(), 0) != has_colour.end())
      data.of_points.push_back(array_of("has_colour", has_colour));
  }
  if (cloud.has_normals()) {
    VtkArray normals{"normal", "Float64", 3, {}};
    for (std::size_t i = 0; i < cloud.size(); ++i) put(normals.bytes, cloud.nx[i], cloud.ny[i], cloud.nz[i]);
    data.of_points.push_back(std::move(normals));
  }
  if (!cloud.fixture_radius_m.empty())
    data.of_points.push_back(array_of("fixture_radius", cloud.fixture_radius_m));
  if (!cloud.stiffness_N_per_m.empty())
    data.of_points.push_back(array_of("stiffness", cloud.stiffness_N_per_m));
  return data;
}

VtkPolyData tool_at(const VoxelTool& tool, const ToolPose& pose, double time_s) {
  VtkPolyData data;
  data.time_s = time_s;
  for (const Vec3& v : tool.mesh.vertices) data.points.push_back(pose.p_W + pose.q_WT * v);
  for (const auto& face : tool.mesh.triangles) data.faces.push_back({face[0], face[1], face[2]});
  return data;
}

// The files that show one thing at several times.
struct Series {
  std::vector<std::string> names;
  std::vector<double> time_s;
};

class VtpFolder {
 public:
  explicit VtpFolder(const ExportJob& job) : job_(job), stem_(job.output.stem().string()) {}

  void add(Series& series, const std::string& thing, const VtkPolyData& data) {
    const std::string name = stem_ + "_" + thing + formatted("_%04zu.vtp", series.names.size());
    write(name, vtp_file(data));
    series.names.push_back(name);
    series.time_s.push_back(data.time_s);
  }
  void write(const std::string& name, const std::string& content) {
    job_.begin(path_of(name), kVtkOpening);
    job_.files.append(content);
  }
  // Writes STEM.pvd, which shows everything over time: the paths, and the cloud and the tool of each time.
  void write_collection(const Series& clouds, const Series& tools) {
    std::string xml =
        std::string(kVtkOpening) +
        "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n";
    const auto add = [&](double time_s, int part, const std::string& name) {
      xml += "<DataSet timestep=\"" + Json(time_s).dump() + "\" part=\"" + std::to_string(part) +
             "\" file=\"" + xml_escaped(name) + "\"/>\n";
    };
    if (clouds.names.empty()) add(0, 0, path_name());
    for (std::size_t i = 0; i < clouds.names.size(); ++i) {
      add(clouds.time_s[i], 0, path_name());
      add(clouds.time_s[i], 1, clouds.names[i]);
      if (i < tools.names.size()) add(clouds.time_s[i], 2, tools.names[i]);
    }
    write(stem_ + ".pvd", xml + "</Collection>\n</VTKFile>\n");
  }
  void write_series(const Series& series, const std::string& thing) const {
    constexpr const char* kOpening = "{\"file-series-version\":\"1.0\",";  // as dump() writes it
    if (series.names.empty()) return;
    Json list = Json::array();
    for (std::size_t i = 0; i < series.names.size(); ++i)
      list.push_back({{"name", series.names[i]}, {"time", series.time_s[i]}});
    job_.begin(path_of(stem_ + "_" + thing + ".vtp.series"), kOpening);
    job_.files.append(Json{{"file-series-version", "1.0"}, {"files", list}}.dump() + "\n");
  }
  std::string path_name() const { return job_.output.filename().string(); }

 private:
  std::filesystem::path path_of(const std::string& name) const { return job_.output.parent_path() / name; }
  const ExportJob& job_;
  const std::string stem_;
};

}  // namespace

std::string xml_escaped(const std::string& text, bool is_quoted) {
  std::string escaped;
  for (const char c : text)
    escaped += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' && is_quoted ? "&quot;" : std::string(1, c);
  return escaped;
}

std::string vtp_file(const VtkPolyData& data) {
  std::string appended, xml = kVtkOpening;
  xml +=
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "<PolyData>\n<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
      "format=\"ascii\">" +
      text_of(data.time_s) + "</DataArray>\n</FieldData>\n" + counts_of(data);
  const auto section = [&](const std::string& name, const std::vector<VtkArray>& arrays) {
    xml += "<" + name + ">\n";
    for (const VtkArray& one : arrays) {
      xml += "<DataArray type=\"" + std::string(one.type) + "\" Name=\"" + xml_escaped(one.name) +
             "\" NumberOfComponents=\"" + std::to_string(one.components) +
             "\" format=\"appended\" offset=\"" + std::to_string(appended.size()) + "\"/>\n";
      put(appended, std::uint64_t{one.bytes.size()});
      appended += one.bytes;
    }
    xml += "</" + name + ">\n";
  };
  VtkArray points{"Points", "Float64", 3, {}};
  for (const Vec3& p : data.points) put(points.bytes, p.x(), p.y(), p.z());
  Cells vertices, lines, faces;
  for (std::size_t i = 0; data.has_vertices && i < data.points.size(); ++i)
    vertices.add(std::array{static_cast<std::int64_t>(i)});
  for (const auto& line : data.lines) lines.add(line);
  for (const auto& face : data.faces) faces.add(face);
  section("Points", {points});
  section("Verts", vertices.arrays());
  section("Lines", lines.arrays());
  section("Polys", faces.arrays());
  section("PointData", data.of_points);
  section("CellData", data.of_cells);
  return xml + "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_" + appended +
         "\n</AppendedData>\n</VTKFile>\n";
}

void write_vtp(const ExportJob& job) {
  const ExportedRun run = exported_run(job);
  VtpFolder folder(job);
  folder.write(folder.path_name(), vtp_file(paths_of(job, run)));
  Series clouds, tools;
  for_each_frame(job, run, [&](const ExportedFrame& frame) {
    const double time_s = run.time_s[frame.first_tick];
    folder.add(clouds, "cloud", cloud_of(frame, time_s));
    if (run.tool) folder.add(tools, "tool", tool_at(*run.tool, run.tool_pose(frame.first_tick), time_s));
  });
  folder.write_series(clouds, "cloud");
  folder.write_series(tools, "tool");
  folder.write_collection(clouds, tools);
}

}  // namespace remote_touch
