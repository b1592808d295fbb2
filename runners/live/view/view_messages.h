// The messages of a live run to its page. Numbers are little endian, and begin at multiples of eight bytes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/trace/column.h"
#include "core/geometry/point_cloud.h"
#include "runners/live/loop/live_controls.h"
#include "runners/live/loop/live_run.h"

namespace remote_touch {

// One page has the hand and the sliders. All others watch; poses and changes of parameters from them are
// refused.
enum class PageRole { hand, watches };

// JSON: {"columns": [{"name", "unit", "meaning", "width", "names"}, ...]}; hashes are left out.
std::string columns_message(const std::vector<Column>& columns);

// JSON: {"values": [...], "refused": TEXT}: the present values of the live parameters. TEXT is the reason why
// the newest changes were refused; it is empty if they were made.
std::string parameters_message(const LiveControls& controls, const std::string& refused);

// JSON: {"hand": true} for the page that moves the hand and has the sliders, {"hand": false} for one that
// watches.
std::string role_message(PageRole role);

// JSON: {"trouble": {"camera": TEXT, "force": TEXT}}: what does not work now. A TEXT is empty if that part
// works.
std::string trouble_message(const LiveTrouble& trouble);

// JSON: {"ended": TEXT}: why the run has ended.
std::string ended_message(const std::string& why);

// JSON: {"alive": true}, sent when nothing else was sent for a second.
std::string alive_message();

// JSON, the answer to a request for `state`: {"protocol": NUMBER, "ended": TEXT, "full": BOOL}. protocol:
// kViewProtocol, by which a page recognises a server of another version. ended: why the run has ended; empty
// while it runs. full: the maximum number of pages is connected.
std::string state_message(const std::string& ended, bool is_full);
inline constexpr int kViewProtocol = 3;

// The region near the hand: within reach_m of the HIP or the proxy. The user feels its points and must see
// them.
struct NearHand {
  Vec3 hip_W = Vec3::Zero(), proxy_W = Vec3::Zero();
  double reach_m = 0;

  bool contains(const Vec3& p_W) const;
};

struct PointLimit {
  std::size_t max_points = 0;  // points near the hand may exceed it
  NearHand near;
};

// 1 (u32), number of the message (u32), rows (u32), 0 (u32); then all rows of each column (f64).
std::string ticks_message(const std::vector<Column>& columns, std::uint32_t number);

// 2 (u32), number of the message (u32), index of the frame (i32), points (u32), kinds of data after the
// positions (u32: 1 colours, 2 radii of forbidden regions, 3 both), measured points (u32), step in metres and
// the corner in metres (f64 x 4): a position is corner + step * number. Then positions (u16 x 3 each),
// colours (u8 x 3 each) and radii in metres (f32). If the cloud has more than limit.max_points measured
// points, only every n-th of them is sent, but all points near the hand.
std::string frame_message(const PointCloud& cloud, std::int32_t index, const PointLimit& limit,
                          std::uint32_t number);

}  // namespace remote_touch
