// The scene of a trace for ParaView and VTK.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/points/vector.h"
#include "runners/presentation/export/exported_run.h"

namespace remote_touch {

// Values of the points or cells of a piece.
struct VtkArray {
  std::string name;
  const char* type;    // "Float64", "Int32", "UInt64", "UInt8", as VTK names them
  int components = 1;  // number of components of each value
  std::string bytes;   // little-endian
};

// Points, lines and triangles in the XML format of VTK: .vtp.
struct VtkPolyData {
  double time_s = 0;
  std::vector<Vec3> points;
  bool has_vertices = false;                       // each point is a cell, so that it is drawn
  std::vector<std::vector<std::int64_t>> lines;    // the point indices of each line
  std::vector<std::array<std::int64_t, 3>> faces;  // triangles
  std::vector<VtkArray> of_points, of_cells;
};

inline constexpr const char* kVtkOpening = "<?xml version=\"1.0\"?>\n<!-- remote-touch export -->\n";

// Returns the whole file. The numbers follow the XML unchanged (appended, raw). Coordinates have 64 bits, so
// that no digit is lost.
std::string vtp_file(const VtkPolyData& data);

// Returns a text as it must be written in the value of an attribute.
std::string xml_escaped(const std::string& text);

// x.vtp: the paths of the HIP and of the proxy as two lines, with the columns of the trace at each point.
// x_cloud_0000.vtp ...: the measured points of each frame in use. Points of unknown colour are grey; if there
// are some, has_colour is 0 for them and 1 for the others.
// x_tool_0000.vtp ...: the tool at its pose in the first tick that used the frame.
// x_cloud.vtp.series, x_tool.vtp.series: the names of these files with their times, as ParaView reads them.
// x.pvd: everything over time.
void write_vtp(const ExportJob& job);

}  // namespace remote_touch
