#include "scenarios/recordings/bags/cloud_from_message.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>

#include "core/geometry/colour.h"
#include "scenarios/recordings/images_and_clouds/pinhole_fit.h"
#include "scenarios/text_files/refuse.h"

namespace remote_touch {
namespace {

static_assert(std::endian::native == std::endian::little, "a message may be the other way round");

constexpr std::uint64_t kMaxPoints = 1u << 24;  // 0.4 GB of coordinates
constexpr std::uint8_t kInt32 = 5, kFloat32 = 7, kFloat64 = 8;

const PointField* field_named(const PointCloudMessage& message, const std::string& name) {
  const auto found = std::find_if(message.fields.begin(), message.fields.end(),
                                  [&](const PointField& field) { return field.name == name; });
  return found == message.fields.end() ? nullptr : &*found;
}

void check_place(const PointField& field, std::uint64_t size, const PointCloudMessage& message,
                 const std::string& subject) {
  if (field.offset + size <= message.point_step) return;
  refuse(subject, "field ", field.name, " ends at byte ", field.offset + size,
         ": expected at most point_step = ", message.point_step);
}

// Throws InputError if a field has several values a point. Some programs write 0 for a single value.
void check_count(const PointField& field, const std::string& subject) {
  if (field.count <= 1) return;
  refuse(subject, "field ", field.name, " has ", field.count, " values a point: expected 1");
}

const PointField& coordinate(const PointCloudMessage& message, const std::string& name,
                             const std::string& subject) {
  const PointField* field = field_named(message, name);
  if (!field) refuse(subject, "has no field ", name, ": expected x, y and z");
  if (field->datatype != kFloat32 && field->datatype != kFloat64)
    refuse(subject, "field ", name, " has datatype ", field->datatype,
           ": expected 7 (float32) or 8 (float64)");
  check_place(*field, field->datatype == kFloat64 ? 8 : 4, message, subject);
  check_count(*field, subject);
  return *field;
}

// Throws InputError if the data cannot hold what the message claims. The products of 32-bit numbers fit in 64
// bits.
void check_size(const PointCloudMessage& message, const std::string& subject) {
  const std::uint64_t width = message.width, height = message.height;
  if (width * height > kMaxPoints)
    refuse(subject, "claims ", width, " x ", height, " points: expected up to ", kMaxPoints);
  if (width * height == 0) return;
  const std::uint64_t row = width * message.point_step;
  if (height > 1 && message.row_step < row)
    refuse(subject, "row_step = ", message.row_step, ": expected ", row, " or more, a row of points");
  const std::uint64_t needed = (height - 1) * message.row_step + row;
  if (message.data.size() < needed)
    refuse(subject, "has ", message.data.size(), " bytes of data: expected ", needed,
           " or more, as its width, height and steps say");
}

template <class Value>
Value value_at(const char* bytes, bool big_endian) {
  using Word = std::conditional_t<sizeof(Value) == 8, std::uint64_t, std::uint32_t>;
  Word word = 0;
  std::memcpy(&word, bytes, sizeof word);
  if (big_endian) {
    auto* first = reinterpret_cast<unsigned char*>(&word);
    std::reverse(first, first + sizeof word);
  }
  return std::bit_cast<Value>(word);
}

template <class Value, class Column>
void read_column(const PointCloudMessage& message, const PointField& field, Column& column) {
  column.resize(std::size_t{message.width} * message.height);
  auto* out = column.data();
  for (std::size_t v = 0; v < message.height; ++v) {
    const char* at = message.data.data() + v * message.row_step + field.offset;
    for (std::size_t u = 0; u < message.width; ++u, at += message.point_step)
      *out++ = value_at<Value>(at, message.big_endian);
  }
}

void read_coordinate(const PointCloudMessage& message, const std::string& name, const std::string& subject,
                     std::vector<double>& column) {
  const PointField& field = coordinate(message, name, subject);
  if (field.datatype == kFloat64) {
    read_column<double>(message, field, column);
  } else {
    read_column<float>(message, field, column);
  }
}

// PCL stores the bits of the colour as a float, other programs store them as an integer.
void read_colour(const PointCloudMessage& message, const std::string& subject,
                 std::vector<std::uint32_t>& colour) {
  const PointField* field = field_named(message, "rgb");
  if (!field) field = field_named(message, "rgba");
  if (!field) return;
  if (field->datatype < kInt32 || field->datatype > kFloat32)
    refuse(subject, "field ", field->name, " has datatype ", field->datatype,
           ": expected 5 (int32), 6 (uint32) or 7 (float32)");
  check_place(*field, 4, message, subject);
  check_count(*field, subject);
  read_column<std::uint32_t>(message, *field, colour);
  for (std::uint32_t& c : colour) c = field->datatype == kFloat32 ? colour_of_float(c) : c & 0xFFFFFF;
}

}  // namespace

PointCloud cloud_from_message(const PointCloudMessage& message, const std::string& subject) {
  check_size(message, subject);
  PointCloud cloud;
  if (message.width == 0) return cloud;  // an empty cloud may have any number of rows
  read_coordinate(message, "x", subject, cloud.x);
  read_coordinate(message, "y", subject, cloud.y);
  read_coordinate(message, "z", subject, cloud.z);
  read_colour(message, subject, cloud.colour);
  mark_missing_points(cloud);
  if (message.height > 1) {
    cloud.grid_columns = static_cast<int>(message.width);
    cloud.image = fit_pinhole(cloud, cloud.grid_columns, static_cast<int>(message.height));
  }
  return cloud;
}

}  // namespace remote_touch
