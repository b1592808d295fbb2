// What a live run sends to its page. Numbers are little endian, and begin at multiples of eight bytes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/columns/column.h"
#include "core/cloud/point_cloud.h"
#include "runners/live/loop/live_controls.h"

namespace remote_touch {

// JSON: {"columns": [{"name", "unit", "meaning", "width", "names"}, ...]}; hashes are left out.
std::string columns_message(const std::vector<Column>& columns);

// JSON: {"values": [...], "refused": TEXT}, the present values of the live parameters, and why the newest
// changes were not made; empty: they were.
std::string parameters_message(const LiveControls& controls, const std::string& refused);

// 1 (u32), number of the message (u32), rows (u32), 0 (u32); then of each column all rows (f64).
std::string ticks_message(const std::vector<Column>& columns, std::uint32_t number);

// 2 (u32), number of the message (u32), index of the frame (i32), points (u32), what follows the positions
// (u32: 1 colours, 2 radii of forbidden regions, 3 both), measured points (u32), step in metres and the
// corner in metres (f64 x 4): a position is corner + step * number. Then positions (u16 x 3 each), colours
// (u8 x 3 each) and radii in metres (f32). A cloud with more than max_points shows every n-th.
std::string frame_message(const PointCloud& cloud, std::int32_t index, std::size_t max_points,
                          std::uint32_t number);

}  // namespace remote_touch
