// Fig 5.8 on recorded depth images: the camera at rest, and moved by hand.
#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/measures.h"
#include "core/points/number_columns.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/parts/fixture_run.h"

namespace remote_touch {

namespace {

// Checks a run against its recording, frame by frame: the position of the proxy relative to the measured
// points, and the motion of the surface. They are computed from every point, not with the renderer's kernels.

// Outcome of a frame, in the last tick before the next frame arrived.
struct FrameOutcome {
  std::size_t tick = 0;
  double nearest_distance_m = kNoValue;  // distance of the proxy to the nearest measured point; NaN: none
  double hidden_m = kNoValue;            // depth of the proxy behind that of its own pixel; NaN at a hole
  // Motion of a pixel's point since the last frame, median over the image, and the same towards the camera,
  // around the pixel that the HIP presses. NaN if unknown.
  double camera_motion_m = kNoValue, surface_motion_m = kNoValue;
};

constexpr int kAround_px = 10;  // 1 cm at 0.6 m

// Index of a frame in the recording, which plays forwards and backwards: 0 1 2 3 2 1 0 1 ...
int recorded_frame(int frame, int count) {
  const int cycle = std::max(1, 2 * count - 2), index = frame % cycle;
  return index < count ? index : cycle - index;
}

double median_or_unknown(std::vector<double> values) {
  return values.empty() ? kNoValue : median_in_place(values);
}

struct Pixel {
  int u, v;
};

// pre: in front of the camera, whose frame is the world's.
Pixel pixel_of(const Vec3& p, const CameraIntrinsics& camera) {
  return {static_cast<int>(std::floor(camera.fx * p.x() / p.z() + camera.cx + 0.5)),
          static_cast<int>(std::floor(camera.fy * p.y() / p.z() + camera.cy + 0.5))};
}

double nearest_distance_m(const Vec3& p, const PointCloud& cloud) {
  double squared = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double d = (cloud.point(i) - p).squaredNorm();
    squared = d < squared ? d : squared;  // a NaN is not less, so it is skipped
  }
  return std::isinf(squared) ? kNoValue : std::sqrt(squared);
}

double hidden_m(const Vec3& p, const PointCloud& cloud) {
  const CameraIntrinsics& camera = cloud.image->camera;
  const Pixel at = pixel_of(p, camera);
  if (at.u < 0 || at.v < 0 || at.u >= camera.width || at.v >= camera.height) return kNoValue;
  return p.z() - cloud.z[static_cast<std::size_t>(at.v) * camera.width + at.u];
}

// Motion from one frame of the recording to the next.
struct Motion {
  double camera_position_m = 0, surface_m = 0;
};

Motion motion(const PointCloud& before, const PointCloud& after, Pixel pressed) {
  const CameraIntrinsics& camera = after.image->camera;
  std::vector<double> everywhere, here;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const std::size_t i = static_cast<std::size_t>(v) * camera.width + u;
      const Vec3 displacement = after.point(i) - before.point(i);
      if (!displacement.allFinite()) continue;
      everywhere.push_back(displacement.norm());
      if (std::abs(u - pressed.u) <= kAround_px && std::abs(v - pressed.v) <= kAround_px)
        here.push_back(-displacement.z());
    }
  }
  return {median_or_unknown(std::move(everywhere)), median_or_unknown(std::move(here))};
}

std::vector<FrameOutcome> last_ticks(const Trace& trace) {
  std::vector<FrameOutcome> outcomes;
  for (std::size_t i = 0; i < trace.length(); ++i)
    if (i + 1 == trace.length() || trace.frame_update(i + 1)) outcomes.push_back({i});
  return outcomes;
}

int recorded_frame_count(const Experiment& experiment) {
  const InputPart part = experiment.inputs().front();
  const FrameRange frames = frames_of(part, index_recording(find_input(part.path)));
  return frames.last - frames.first + 1;
}

// Returns the outcomes of all frames. It goes through them in the order of the recording, so that each is
// read once. The first frame has no frame before it: its motions are NaN. pre: the experiment plays a part of
// a recording forwards and backwards (ping-pong), and every frame arrives.
std::vector<FrameOutcome> frame_outcomes(const Experiment& experiment, const Trace& trace,
                                         const Scenario& scenario) {
  std::vector<FrameOutcome> outcomes = last_ticks(trace);
  const int count = recorded_frame_count(experiment);
  std::vector<Motion> to(static_cast<std::size_t>(count));  // motion to each frame from the one before
  PointCloud before;
  for (int index = 0; index < count; ++index) {
    PointCloud cloud = scenario.cloud(index);
    if (index > 0)
      to[static_cast<std::size_t>(index)] =
          motion(before, cloud, pixel_of(trace.hip_position_m[0], cloud.image->camera));
    for (FrameOutcome& outcome : outcomes) {
      if (recorded_frame(trace.frame_index[outcome.tick], count) != index) continue;
      outcome.nearest_distance_m = nearest_distance_m(trace.proxy_position_m[outcome.tick], cloud);
      outcome.hidden_m = hidden_m(trace.proxy_position_m[outcome.tick], cloud);
    }
    before = std::move(cloud);
  }
  for (FrameOutcome& outcome : outcomes) {
    const int frame = trace.frame_index[outcome.tick];
    if (frame <= 0) continue;
    const int now = recorded_frame(frame, count), last = recorded_frame(frame - 1, count);
    const Motion& step = to[static_cast<std::size_t>(std::max(now, last))];
    outcome.camera_motion_m = step.camera_position_m;
    outcome.surface_motion_m = now > last ? step.surface_m : -step.surface_m;  // played backwards
  }
  return outcomes;
}

// A tick in which the proxy changed to the wrong side of the true surface.
struct PopThrough {
  std::size_t tick = 0;
  double surface_motion_m =
      0;  // past the proxy since the frame before, by the planes of both; NaN if unknown
};
std::vector<PopThrough> pop_throughs(const Trace& trace, const Scenario& scenario) {
  std::vector<PopThrough> found;
  double known_m = kNoValue;  // the newest distance that is known
  for (std::size_t i = 0; i < trace.length(); ++i) {
    const double distance_m = trace.signed_distance_m[i];
    if (std::isnan(distance_m)) continue;
    if (known_m >= 0 && distance_m < 0) {
      PopThrough pop{i, kNoValue};
      // The second distance is that of the proxy when the frame arrived, before its first step.
      if (trace.frame_update(i) && !std::isnan(trace.signed_distance_m[i - 1]))
        pop.surface_motion_m =
            trace.signed_distance_m[i - 1] -
            scenario.signed_distance(trace.proxy_position_m[i - 1] + trace.frame_correction_m[i],
                                     trace.time_s[i]);
      found.push_back(pop);
    }
    known_m = distance_m;
  }
  return found;
}

constexpr double kContactShell_m = 1e-5;  // r_2 - r_c: a proxy in contact may rest anywhere in this shell
const char* const kTrackedSheet =
    R"(renderer={"name": "tracked-sheet", "exit_rule": "out-of-contact", "xi": 0.3333333333333333, "theta_deg": 1})";
constexpr double kRecordedGrown_s = 10, kRecordedSteady_s = 0.1;

struct RecordedRun {
  std::string title;
  FixtureRun run;
  std::vector<std::size_t> ticks;  // the last one of each frame
  Table frames;                    // one row for each of them
  std::vector<PopThrough> pops;

  const Numbers& operator[](const char* column) const { return numbers(frames, column); }
  Numbers beyond_fixture_m() const { return minus((*this)["nearest"], at(ticks, run.radius_m)); }
};

RecordedRun recorded_run(const std::string& name, const std::string& title, const Experiment& experiment,
                         FixtureRun run) {
  const Trace& t = run.trace;
  const std::vector<FrameOutcome> frames = frame_outcomes(experiment, t, *run.scenario);
  std::vector<std::size_t> ticks;
  for (const FrameOutcome& frame : frames) ticks.push_back(frame.tick);
  const Numbers nearest_m = each(frames, &FrameOutcome::nearest_distance_m),
                boundary_m = each(ticks, [&](std::size_t i) { return run.boundary_m(i); });
  Table table{name, title + ": the last tick of each frame"};
  table.add("time", "s", "simulated time", at(ticks, t.time_s));
  table.add("frame", "1", "frame in use", at(ticks, doubles(t.frame_index)));
  table.add("hip_z", "m", "depth of the HIP", at(ticks, along(2, t.hip_position_m)));
  table.add("proxy_z", "m", "depth of the proxy's centre", at(ticks, along(2, t.proxy_position_m)));
  table.add("nearest", "m", "distance of the proxy's centre to the nearest measured point", nearest_m);
  table.add("boundary", "m", "r_f + r_c", boundary_m);
  table.add("deviation", "m", "nearest - r_f - r_c", minus(nearest_m, boundary_m));
  table.add("signed_distance", "m",
            "distance to the plane through the pixels around the proxy, negative behind",
            at(ticks, t.signed_distance_m));
  table.add("hidden", "m", "how far the proxy lies behind what its own pixel measured",
            each(frames, &FrameOutcome::hidden_m));
  table.add("camera_motion", "m",
            "median over the image of how far a pixel's point moved since the last frame",
            each(frames, &FrameOutcome::camera_motion_m));
  table.add("surface_motion", "m", "towards the camera since then, around the pixel that the HIP presses",
            each(frames, &FrameOutcome::surface_motion_m));
  table.add("force", "N", "magnitude of the force", at(ticks, norms(t.force_N)));
  std::vector<PopThrough> pops = pop_throughs(t, *run.scenario);
  return {title, std::move(run), ticks, table, std::move(pops)};
}

// Returns the share of the values for which holds(value) is true.
template <class Holds>
double share(const Numbers& values, Holds&& holds) {
  return mean(each(values, [&](double value) { return holds(value) ? 1.0 : 0.0; }));
}

bool is_known(double value) {
  return !std::isnan(value);
}

double known_side_fraction(const RecordedRun& r) {
  return share(r.run.trace.signed_distance_m, is_known);
}

double visible_fraction(const RecordedRun& r) {
  return share(r["hidden"], is_known);
}

double hidden_fraction(const RecordedRun& r) {
  return share(r["hidden"], [](double hidden_m) { return hidden_m > 0; });
}

double min_beyond_fixture_m(const RecordedRun& r) {
  return min_of(r.beyond_fixture_m());
}

double mean_deviation_m(const RecordedRun& r) {
  const Numbers& time_s = r["time"];
  return mean(where(r["deviation"],
                    [&](std::size_t i) { return time_s[i] >= kRecordedGrown_s + kRecordedSteady_s; }));
}

// Returns the largest motion in a frame that has a frame before it.
double max_motion_m(const RecordedRun& r, const char* column) {
  const Numbers& frame = r["frame"];
  return max_of(magnitudes(where(r[column], [&](std::size_t i) { return frame[i] > 0; })));
}

Table violation_table(const std::vector<RecordedRun>& runs) {
  std::vector<std::string> names;
  for (const RecordedRun& r : runs) names.push_back(r.frames.name);
  using R = const RecordedRun&;
  return quantity_table<RecordedRun>(
      "violations", "how often and how far the fixture was violated", names, runs,
      {{"ticks in which the side is known", "fraction", known_side_fraction},
       {"of those, ticks on the wrong side", "fraction",
        [](R r) { return wrong_side_fraction(r.run.trace); }},
       {"deepest behind the surface", "m", [](R r) { return max_penetration_m(r.run.trace); }},
       {"pop-throughs", "1", [](R r) { return static_cast<double>(r.pops.size()); }},
       {"time of the first", "s",
        [](R r) { return r.pops.empty() ? kNoValue : r.run.trace.time_s[r.pops[0].tick]; }},
       {"r_f at the first", "m",
        [](R r) { return r.pops.empty() ? kNoValue : r.run.radius_m[r.pops[0].tick]; }},
       {"least motion of the surface past the proxy in a frame that popped it through", "m",
        [](R r) { return min_of(each(r.pops, &PopThrough::surface_motion_m)); }},
       {"frames whose pixel at the proxy measured something", "fraction", visible_fraction},
       {"frames in which the proxy is hidden behind that pixel", "fraction", hidden_fraction},
       {"frames with a measured point nearer than r_f", "fraction",
        [](R r) { return share(r.beyond_fixture_m(), [](double m) { return m < 0; }); }},
       {"smallest distance to a measured point - r_f", "m", min_beyond_fixture_m},
       {"mean of distance - r_f - r_c from 10.1 s on", "m", mean_deviation_m},
       {"largest camera motion in a frame", "m", [](R r) { return max_motion_m(r, "camera_motion"); }},
       {"largest surface motion in a frame", "m", [](R r) { return max_motion_m(r, "surface_motion"); }}});
}

// Adds a column of panels for one run.
void add_panels(Figure& figure, const RecordedRun& r, int column) {
  PanelColumn panels{figure, r.frames.name, "time", "time (s)", column, {{0, 15}}};
  panels.add(r.title, "z (m)", {{"hip_z", CurveStyle::dashed, "HIP"}, {"proxy_z", CurveStyle::line, "proxy"}},
             {{0.5, 0.67}});
  panels.add("Proxy to surface", "distance (m)",
             {{"nearest", CurveStyle::line, "nearest measured point"},
              {"signed_distance", CurveStyle::dots, "plane, negative behind"},
              {"boundary", CurveStyle::dashed, "r_f + r_c"}},
             {{-0.04, 0.13}});
  panels.add("Motion in a frame", "motion (m)",
             {{"camera_motion", CurveStyle::line, "median over the image"},
              {"surface_motion", CurveStyle::line, "where the HIP presses, to the camera"}},
             {{-0.065, 0.03}});
  panels.add("Force", "force (N)", {{"force"}}, {{0, 50}});
}

void add_claims(Figure& figure, const RecordedRun& still, const RecordedRun& moving, const RecordedRun& held,
                const RecordedRun& tracked) {
  const Claims claims(figure), checks(figure, "", &Claim::set_up);
  for (const RecordedRun* r : {&still, &held}) {
    add_side_claim(figure, r->title + ": ", r->run.trace);
    claims.at_most(
        r->title +
            ": the proxy is never hidden behind what its pixel measured: fraction of frames in which it is",
        hidden_fraction(*r), 0, "fraction", "none");
  }
  claims.differs(
      moving.title +
          ": the proxy is on the wrong side of the surface: fraction of the ticks in which the side is known",
      wrong_side_fraction(moving.run.trace), 0.7, 0.8, "fraction", "none (with the camera at rest)");
  add_side_claim(figure, tracked.title + ": ", tracked.run.trace);
  claims.between(
      still.title + ": while r_f = 0.02 m the proxy is r_f + r_c from the measured points: mean difference",
      mean_deviation_m(still), -kContactShell_m, kContactShell_m, "m", "0");
  for (const RecordedRun* r : {&still, &moving, &held}) {
    claims.at_least(
        r->title + ": no measured point comes within r_f of the proxy's centre: smallest distance minus r_f",
        min_beyond_fixture_m(*r), 0, "m", ">= 0");
    add_sound_claims(figure, r->title + ": ", r->run.trace);
  }
  // The plane is unknown at edges, but the measurement of the proxy's own pixel is nearly always known.
  for (const RecordedRun* r : {&still, &held})
    checks.at_least(r->title + ": the pixel at the proxy measured a depth in most frames: fraction of frames",
                    visible_fraction(*r), 0.9, "fraction");
  checks.at_least(tracked.title + ": the side of the surface is known in most ticks: fraction of ticks",
                  known_side_fraction(tracked), 0.5, "fraction");
}

// Returns four runs. The camera is at rest; it moves; it moves with the whole fixture from the start; and it
// moves with the tracked sheet as renderer.
std::vector<RecordedRun> recorded_runs(FigureContext& context) {
  std::vector<Experiment> experiments;  // the longest first, because they run in parallel
  experiments.push_back(Experiment::load("fig5.8-moving"));
  experiments.push_back(Experiment::load("fig5.8-moving", {"fixtures.0.schedule=[]"}));
  experiments.push_back(Experiment::load("fig5.8-recorded"));
  experiments.push_back(Experiment::load("fig5.8-moving", {kTrackedSheet}));
  std::vector<FixtureRun> made = run_fixtures(context, experiments);
  const std::pair<const char*, const char*> words[] = {{"moving", "moving camera"},
                                                       {"held", "moving camera, r_f = 0.02 m"},
                                                       {"still", "camera at rest"},
                                                       {"tracked", "moving camera, tracked sheet"}};
  std::vector<RecordedRun> runs;
  for (const std::size_t i : {2, 0, 1, 3})
    runs.push_back(recorded_run(words[i].first, words[i].second, experiments[i], std::move(made[i])));
  return runs;
}

}  // namespace

Figure figure_5_8_recorded(FigureContext& context) {
  const std::vector<RecordedRun> runs = recorded_runs(context);
  Figure figure{
      "5.8-recorded", "A fixture that grows on a recorded organ model",
      "The protocol of Fig 5.8 on depth images of a rigid organ model; the device is simulated: the HIP "
      "stays 3 mm behind the surface that one pixel sees, and lifts off while that pixel sees a hole or an "
      "edge. z points away from the camera. Left: camera at rest, five frames played to and fro, so only "
      "the sensor's noise moves. Then: camera moved by hand, which the paper did not try; and the same "
      "with r_f = 20 mm from the start. Each frame is shown by its last tick. There are two truths, both "
      "from the newest measurement. The nearest of all its points does not show on which side the proxy "
      "is. A plane through the pixels around the one that sees the proxy shows the side, but is unknown "
      "at edges. The proxy pops through where the measured surface jumps past its centre within a frame: "
      "from then on r_f keeps it away on the wrong side, deeper as r_f grows. The table violations counts "
      "these cases. A fixture that exists before the jump is wider than any jump, and the proxy stays "
      "outside. Right: the tracked sheet, which is not in the dissertation, under the growing fixture."};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    figure.tables.push_back(runs[i].frames);
    add_panels(figure, runs[i], static_cast<int>(i));
  }
  figure.tables.push_back(violation_table(runs));
  add_claims(figure, runs[0], runs[1], runs[2], runs[3]);
  return figure;
}

}  // namespace remote_touch
