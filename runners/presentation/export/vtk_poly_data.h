// Points, lines and triangles in the XML format of VTK: .vtp.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/vector.h"

namespace remote_touch {

// Values of the points or cells of a piece.
struct VtkArray {
  std::string name;
  const char* type;    // "Float64", "Int32", "UInt64", "UInt8", as VTK names them
  int components = 1;  // number of components of each value
  std::string bytes;   // little-endian
};

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

}  // namespace remote_touch
