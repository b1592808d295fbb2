// A tool in scenes whose answer is known: the oracles of chapter 6, through the whole program.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "analysis/trace/trace.h"
#include "core/points/vector.h"
#include "runners/experiment/simulation/simulation.h"

namespace remote_touch::tool_contact_test {
namespace {

std::string number(double value) {
  return std::to_string(value);
}

Trace run(const std::string& scenario, const std::string& renderer, const std::string& trajectory,
          const std::vector<std::string>& overrides = {}) {
  const std::string json = R"({"scenario": )" + scenario + R"(, "renderer": )" + renderer +
                           R"(, "trajectory": )" + trajectory + "}";
  return simulate(Experiment::from_json(json, "test", overrides));
}

std::string tool(const std::string& mesh, const std::string& rule) {
  return R"({"name": "tool", "tool_mesh": ")" + mesh + R"(", "contact_rule": ")" + rule + R"("})";
}

std::string poses(const std::string& rows) {
  return R"({"name": "poses", "poses": [)" + rows + "]}";
}

int sum(const std::vector<std::int32_t>& column) {
  return std::accumulate(column.begin(), column.end(), 0);
}

// Returns the angle about y, in degrees, at which a bar of 80 x 10 mm comes to rest in a slot of 40 mm when
// it is turned to 30 degrees.
double bar_stops_at(const std::string& rule, double spacing_m, double phase_m) {
  const Trace trace = run(R"({"name": "slot"})", tool("bar", rule),
                          poses("[0,0,0,0,0,0,0], [0,0,0,0,30,0,1], [0,0,0,0,30,0,0.2]"),
                          {"scenario.spacing_m=" + number(spacing_m), "scenario.phase_m=" + number(phase_m)});
  EXPECT_EQ(sum(trace.budget_exhausted), 0);
  return rotation_vector(trace.tool_orientation[trace.length() - 1]).y() / kRadiansPerDegree;
}

// The closed form is 40 sin(a) + 5 cos(a) = 20: 22.62 degrees. Disks hold the corner as a wall would,
// wherever the columns of points are.
TEST(ToolContact, LookAheadStopsABarInASlotAtItsLimit) {
  for (const double spacing : {0.001, 0.002, 0.005})
    for (const double phase : {0.0, 0.3, 0.5})
      EXPECT_NEAR(bar_stops_at("look-ahead", spacing, phase * spacing), 22.62, 0.02)
          << spacing << " " << phase;
}

// Returns the least angle, in degrees, at which the corner has sunk so far behind the wall that a column of
// points meets a face of the bar. The column before the corner meets the long face, which recedes by tan(a).
// The next column meets the end. Lengths are in millimetres.
double bar_sinks_to(double spacing, double phase) {
  for (double degrees = 22.62;; degrees += 0.001) {
    const double a = degrees * kRadiansPerDegree;
    const double corner_x = 40 * std::cos(a) - 5 * std::sin(a);
    const double sunk = 40 * std::sin(a) + 5 * std::cos(a) - 20;
    const double before = std::fmod(corner_x - phase, spacing);
    if (sunk >= std::min(before * std::tan(a), (spacing - before) / std::tan(a))) return degrees;
  }
}

// Voxels let the corner sink between the columns. If these lie alike at both corners, the bar stays in the
// middle. Interpolation in voxels of half a millimetre blunts its edges: 0.06 mm are 0.1 degrees.
TEST(ToolContact, ABarInASlotSinksBetweenColumnsByVoxels) {
  for (const double spacing : {1.0, 2.0, 5.0})
    for (const double phase : {0.0, 0.5 * spacing})
      EXPECT_NEAR(bar_stops_at("voxels", 1e-3 * spacing, 1e-3 * phase), bar_sinks_to(spacing, phase), 0.1)
          << spacing << " " << phase;
}

// A plane rises at this speed under a slab that is held. Returns true if the slab is carried.
bool is_carried(int thickness_mm, double speed_m_per_s, const std::string& rule) {
  const double rise = 0.08 + 0.006 * thickness_mm;
  const Trace trace =
      run(R"({"name": "moving-plane", "columns": 40, "rows": 40, "start_height_m": -0.03, "wait_s": 0.1})",
          tool("slab-" + std::to_string(thickness_mm), rule), poses("[0,0,0,0,0,0,0]"),
          {"scenario.speed_m_per_s=" + number(speed_m_per_s), "scenario.rise_height_m=" + number(rise),
           "duration_s=" + number(0.3 + rise / speed_m_per_s)});
  return trace.signed_distance_m.back() > 0;
}

// A frame that jumps by more than the interior of the tool passes through it: the bound is v < f_c (h - 2w).
// The rule that remembers its side loses nothing to a shell: v < f_c h.
TEST(ToolContact, SlabsAreLiftedUpToTheBoundOfTheirRule) {
  for (const int h : {5, 10, 20, 40}) {
    const double by_voxels = 30 * (0.001 * h - 0.001), by_look_ahead = 30 * 0.001 * h;
    EXPECT_TRUE(is_carried(h, 0.98 * by_voxels, "voxels")) << h;
    EXPECT_FALSE(is_carried(h, 1.02 * by_voxels, "voxels")) << h;
    EXPECT_TRUE(is_carried(h, 0.97 * by_look_ahead, "look-ahead")) << h;
    EXPECT_FALSE(is_carried(h, 1.03 * by_look_ahead, "look-ahead")) << h;
  }
}

// The continuous rule moves a tool out at a frame only if it was held when the frame came. A slab at rest is
// held from the first frame in which the plane is inside it. If one frame has the plane below the slab and
// the next one above it, the slab is lost. This happens in a fraction 1 - f_c h / v of all start times,
// although a held slab is carried at this speed.
TEST(ToolContact, ASlabAtRestIsCarriedIfAFrameShowsThePlaneInItByContinuous) {
  constexpr double kSpeed = 0.5, kJump_m = kSpeed / 30, kStart_m = -0.03, kHalf_m = 0.005;
  int lost = 0;
  for (int phase = 0; phase < 5; ++phase) {
    const double wait_s = 0.1 + phase / 150.0;
    const Trace trace =
        run(R"({"name": "moving-plane", "columns": 40, "rows": 40, "rise_height_m": 0.1})",
            tool("slab-10", "continuous"), poses("[0,0,0,0,0,0,0]"),
            {"scenario.start_height_m=" + number(kStart_m), "scenario.wait_s=" + number(wait_s),
             "scenario.speed_m_per_s=" + number(kSpeed), "duration_s=0.5"});
    bool is_shown_in_it = false;
    for (int frame = 0; frame < 9; ++frame)
      is_shown_in_it |= std::abs(kStart_m + kJump_m * (frame - 30 * wait_s)) < kHalf_m;
    EXPECT_EQ(trace.signed_distance_m.back() > 0, is_shown_in_it) << phase;
    lost += is_shown_in_it ? 0 : 1;
  }
  EXPECT_NEAR(lost / 5.0, 1 - 30 * 0.01 / kSpeed, 1e-12);
}

// (4.15) for a tool: a plane rises evenly under a held slab at 0.1 m/s, 3.33 mm a frame. The force jumps by k
// v / f_c at each frame without the term, not at all with it, and by twice that with the printed sign.
TEST(ToolContact, ForceFollowsTheSurfaceBetweenFrames) {
  const auto max_jump_N = [](const std::string& sign) {
    const Trace trace =
        run(R"({"name": "moving-plane", "columns": 40, "rows": 40, "start_height_m": -0.02, "wait_s": 0.1,
                "speed_m_per_s": 0.1, "rise_height_m": 0.04})",
            tool("slab-40", "look-ahead"), poses("[0,0,0,0,0,0,0]"),
            {"renderer.velocity_estimate=true", "renderer.velocity_force=" + sign, "duration_s=0.4"});
    double max = 0;
    for (std::size_t i = 1; i < trace.length(); ++i)  // the estimate has settled at 0.25 s
      if (trace.time_s[i] > 0.25) max = std::max(max, (trace.force_N[i] - trace.force_N[i - 1]).norm());
    EXPECT_GT(trace.force_N.back().y(), 5);
    return max;
  };
  const double jump_N = 600 * 0.1 / 30, tick_N = 600 * 0.1 / 1000;
  EXPECT_NEAR(max_jump_N("none"), jump_N, 0.01);
  EXPECT_NEAR(max_jump_N("minus"), tick_N, 0.01);
  EXPECT_GT(max_jump_N("plus"), 1.9 * jump_N);
}

// The frames of a constant acceleration from rest differ by a / f_c^2. That is all that the tool has to
// survive if there is an estimate, a < (h - 2w) f_c^2. If there is none, the speed grows beyond every bound.
TEST(ToolContact, TheVelocityEstimateCarriesASlabThatAccelerates) {
  const double bound = 900 * (0.01 - 0.001);
  for (const std::string rule : {"voxels", "look-ahead"})
    for (const bool estimate : {true, false}) {
      const double a = 0.9 * bound, rise = 0.5;
      const Trace trace = run(
          R"({"name": "moving-plane", "columns": 40, "rows": 40, "start_height_m": -0.0048, "wait_s": 0.2, "speed_m_per_s": 0})",
          tool("slab-10", rule), poses("[0,0,0,0,0,0,0]"),
          {"scenario.acceleration_m_per_s2=" + number(a), "scenario.rise_height_m=" + number(rise),
           "duration_s=" + number(0.5 + std::sqrt(2 * rise / a)),
           std::string("renderer.velocity_estimate=") + (estimate ? "true" : "false")});
      EXPECT_EQ(trace.signed_distance_m.back() > 0, estimate) << rule;
    }
}

// The slab lies flush, as it comes or after a turn. The points beside the tool lie in the plane of its face,
// and must not act as walls at its sides. The field is blunt at its corners, which must not count as a ridge
// inside.
TEST(ToolContact, ASlabThatLiesFlatOnTheBackOfASheetSlidesAndIsLetGo) {
  for (const std::string tilt : {"0", "3"})
    for (const std::string width : {"0.078", "0.15"}) {
      const Trace trace = run(
          R"({"name": "panel", "normal": [0, 1, 0], "width_m": )" + width + R"(, "height_m": )" + width + "}",
          tool("slab-20", "look-ahead"),
          poses("[0,-0.06,0," + tilt + ",0,0,0], [0,-0.003,0," + tilt +
                ",0,0,0.5], [0,-0.003,0,0,0,0,0.3], [0.013,-0.003,0.009,0,0,0,0.3], "
                "[0.013,-0.06,0.009,0,0,0,0.5]"));
      const std::string what = "tilt " + tilt + ", width " + width;
      for (std::size_t i = 500; i < 1100; ++i) ASSERT_LT(trace.proxy_position_m[i].y(), -0.0099) << what;
      for (std::size_t i = 800; i < 1100; ++i) {
        const Vec3 lag = trace.proxy_position_m[i] - trace.hip_position_m[i];
        ASSERT_LT(std::hypot(lag.x(), lag.z()), 1e-9) << what << ", tick " << i;
      }
      const std::size_t last = trace.length() - 1;
      EXPECT_LT((trace.proxy_position_m[last] - trace.hip_position_m[last]).norm(), 1e-12) << what;
    }
}

// A contact that held the tool is forgotten once it is left behind. A ball that was at the back of a plane
// and went round it is lifted by the plane like a ball that was not.
TEST(ToolContact, ATouchFromBehindDoesNotCountForEver) {
  for (const char* displacement :
       {"[0,-0.05,0,0,0,0,0], [0,-0.009,0,0,0,0,0.3]", "[0,-0.05,0,0,0,0,0], [0,-0.03,0,0,0,0,0.3]"}) {
    const Trace trace = run(
        R"({"name": "moving-plane", "columns": 40, "rows": 40, "start_height_m": 0, "wait_s": 1.5, "speed_m_per_s": 0.3,
            "rise_height_m": 0.05})",
        tool("ball", "look-ahead"),
        poses(std::string(displacement) +
              ", [0,-0.05,0,0,0,0,0.2], [0.2,-0.05,0,0,0,0,0.2], [0.2,0.05,0,0,0,0,0.2], "
              "[0,0.0122,0,0,0,0,0.4]"),
        {"duration_s=2"});
    EXPECT_NEAR(trace.proxy_position_m[trace.length() - 1].y(), 0.06, 1e-3) << displacement;
  }
}

}  // namespace
}  // namespace remote_touch::tool_contact_test
