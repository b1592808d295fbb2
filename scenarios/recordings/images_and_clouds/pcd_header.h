// The header of a PCD file (Point Cloud Library, versions 0.5 to 0.7): text lines "KEYWORD value..." and #
// comments, up to and including the line DATA. The points follow it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/vector.h"

namespace remote_touch {

// The part of a PCD file that is not yet read, and the number of the line that was read last.
struct PcdText {
  std::string_view text;
  std::size_t line = 0;

  // Returns the words of the next line and removes the line from text.
  std::vector<std::string_view> take_line();
};

// One field of the point layout: count values of size bytes each.
struct PcdField {
  std::string_view name;
  char type = 'F';  // F: floating point, I: signed, U: unsigned
  std::size_t size = 0, count = 0;
  std::size_t first_byte = 0, first_value = 0;  // start of this field within a point

  // Returns TYPE, SIZE and COUNT as the header spells them, for messages.
  std::string text() const;
};

// Content of the header that is needed to decode DATA. All lengths are checked: points = width * height, and
// none is 0.
struct PcdHeader {
  std::vector<PcdField> fields;
  std::size_t width = 0, height = 0, points = 0;
  std::size_t point_bytes = 0, point_values = 0;
  std::string_view encoding;       // ascii, binary or binary_compressed
  PcdField x, y, z;                // TYPE F, SIZE 4 or 8, COUNT 1
  std::optional<PcdField> colour;  // rgb or rgba: SIZE 4, COUNT 1
  // VIEWPOINT: position and rotation of the sensor in the coordinates of the points. Empty if the sensor was
  // at the origin and not rotated, which is also the meaning of a file without a VIEWPOINT.
  std::optional<RigidTransform> X_FV;
};

// Removes the header from rest, which then starts after the DATA line. The header's names are views into the
// text. Older versions have no VIEWPOINT, may say COLUMNS for FIELDS, and have no WIDTH and HEIGHT for points
// in no order. Throws InputError about file (with ":line" for a line that is not a valid entry) if an entry
// is missing or not allowed.
PcdHeader read_pcd_header(const std::string& file, PcdText& rest);

// Returns a word of the file for a message: quoted, short and printable, even if the file is not text at all.
std::string shown(std::string_view word);

}  // namespace remote_touch
