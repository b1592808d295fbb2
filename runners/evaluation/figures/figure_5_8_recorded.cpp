// Fig 5.8 on recorded depth images: the camera at rest, and moved by hand.
#include <algorithm>
#include <cmath>

#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/measures.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/parts/fixture_run.h"
#include "runners/evaluation/figures/parts/recorded_fixture.h"

namespace remote_touch {

namespace {

constexpr double kContactShell_m = 1e-5;  // r_2 - r_c: a proxy in contact may rest anywhere in this shell
const char* const kTrackedSheet =
    R"(renderer={"name": "tracked-sheet", "exit_rule": "out-of-contact", "xi": 0.3333333333333333, "theta_deg": 1})";
constexpr double kRecordedGrown_s = 10, kRecordedSteady_s = 0.1;

struct RecordedRun {
  std::string table, title;
  FixtureRun run;
  std::vector<FrameOutcome> frames;
  std::vector<PopThrough> pops;
};

Table frame_table(const RecordedRun& r) {
  TableRows rows;
  for (const FrameOutcome& frame : r.frames) {
    const std::size_t i = frame.tick;
    const Trace& trace = r.run.trace;
    rows.push_back({trace.time_s[i], static_cast<double>(trace.frame_index[i]), trace.hip_position_m[i].z(),
                    trace.proxy_position_m[i].z(), frame.nearest_distance_m, r.run.boundary_m(i),
                    frame.nearest_distance_m - r.run.boundary_m(i), trace.signed_distance_m[i],
                    frame.hidden_m, frame.camera_motion_m, frame.surface_motion_m, trace.force_N[i].norm()});
  }
  const std::vector<ColumnName> columns = {
      {"time", "s", "simulated time"},
      {"frame", "1", "frame in use"},
      {"hip_z", "m", "depth of the HIP"},
      {"proxy_z", "m", "depth of the proxy's centre"},
      {"nearest", "m", "distance of the proxy's centre to the nearest measured point"},
      {"boundary", "m", "r_f + r_c"},
      {"deviation", "m", "nearest - r_f - r_c"},
      {"signed_distance", "m", "distance to the plane through the pixels around the proxy, negative behind"},
      {"hidden", "m", "how far the proxy lies behind what its own pixel measured"},
      {"camera_motion", "m", "median over the image of how far a pixel's point moved since the last frame"},
      {"surface_motion", "m", "towards the camera since then, around the pixel that the HIP presses"},
      {"force", "N", "magnitude of the force"}};
  return table_of(r.table, r.title + ": the last tick of each frame", columns, rows);
}

double known_side_fraction(const RecordedRun& r) {
  const auto& distance = r.run.trace.signed_distance_m;
  const auto known = std::count_if(distance.begin(), distance.end(), [](double d) { return !std::isnan(d); });
  return static_cast<double>(known) / static_cast<double>(distance.size());
}

// Returns the share of the frames for which holds(frame) is true.
template <class Holds>
double frame_fraction(const RecordedRun& r, Holds&& holds) {
  const auto count = std::count_if(r.frames.begin(), r.frames.end(), holds);
  return static_cast<double>(count) / static_cast<double>(r.frames.size());
}

double visible_fraction(const RecordedRun& r) {
  return frame_fraction(r, [](const FrameOutcome& f) { return !std::isnan(f.hidden_m); });
}

double hidden_fraction(const RecordedRun& r) {
  return frame_fraction(r, [](const FrameOutcome& f) { return f.hidden_m > 0; });
}

double min_beyond_fixture_m(const RecordedRun& r) {
  std::vector<double> beyond_m;
  for (const FrameOutcome& frame : r.frames)
    beyond_m.push_back(frame.nearest_distance_m - r.run.radius_m[frame.tick]);
  return min_of(beyond_m);
}

double mean_deviation_m(const RecordedRun& r) {
  std::vector<double> deviations_m;
  for (const FrameOutcome& frame : r.frames)
    if (r.run.trace.time_s[frame.tick] >= kRecordedGrown_s + kRecordedSteady_s)
      deviations_m.push_back(frame.nearest_distance_m - r.run.boundary_m(frame.tick));
  return mean(deviations_m);
}

double min_motion_m(const RecordedRun& r) {
  std::vector<double> motions_m;
  for (const PopThrough& pop : r.pops) motions_m.push_back(pop.surface_motion_m);
  return min_of(motions_m);
}

// Returns the largest motion in a frame that has a frame before it.
double max_motion_m(const RecordedRun& r, double FrameOutcome::*of) {
  return max_where(
      r.frames.size(), [&](std::size_t i) { return r.run.trace.frame_index[r.frames[i].tick] > 0; },
      [&](std::size_t i) { return std::abs(r.frames[i].*of); });
}

Table violation_table(const std::vector<RecordedRun>& runs) {
  std::vector<std::string> names;
  for (const RecordedRun& r : runs) names.push_back(r.table);
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
       {"least motion of the surface past the proxy in a frame that popped it through", "m", min_motion_m},
       {"frames whose pixel at the proxy measured something", "fraction", visible_fraction},
       {"frames in which the proxy is hidden behind that pixel", "fraction", hidden_fraction},
       {"frames with a measured point nearer than r_f", "fraction",
        [](R r) {
          return frame_fraction(
              r, [&](const FrameOutcome& f) { return f.nearest_distance_m < r.run.radius_m[f.tick]; });
        }},
       {"smallest distance to a measured point - r_f", "m", min_beyond_fixture_m},
       {"mean of distance - r_f - r_c from 10.1 s on", "m", mean_deviation_m},
       {"largest camera motion in a frame", "m",
        [](R r) { return max_motion_m(r, &FrameOutcome::camera_motion_m); }},
       {"largest surface motion in a frame", "m",
        [](R r) { return max_motion_m(r, &FrameOutcome::surface_motion_m); }}});
}

// Adds a column of panels for one run.
void add_panels(Figure& figure, const RecordedRun& r, int column) {
  int row = 0;
  const auto add = [&](const std::string& title, const char* y_label, std::pair<double, double> y_range,
                       const std::vector<Curve>& curves) {
    figure.panels.push_back(
        plot(title, "time (s)", y_label, curves, {{{row++, column}}, {{0, 15}}, y_range}));
  };
  const std::string& t = r.table;
  add(r.title, "z (m)", {0.5, 0.67},
      {{t, "time", "hip_z", CurveStyle::dashed, "HIP"}, {t, "time", "proxy_z", CurveStyle::line, "proxy"}});
  add("Proxy to surface", "distance (m)", {-0.04, 0.13},
      {{t, "time", "nearest", CurveStyle::line, "nearest measured point"},
       {t, "time", "signed_distance", CurveStyle::dots, "plane, negative behind"},
       {t, "time", "boundary", CurveStyle::dashed, "r_f + r_c"}});
  add("Motion in a frame", "motion (m)", {-0.065, 0.03},
      {{t, "time", "camera_motion", CurveStyle::line, "median over the image"},
       {t, "time", "surface_motion", CurveStyle::line, "where the HIP presses, to the camera"}});
  add("Force", "force (N)", {0, 50}, {{t, "time", "force", CurveStyle::line, ""}});
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
  for (const std::size_t i : {2, 0, 1, 3}) {
    std::vector<FrameOutcome> frames = frame_outcomes(experiments[i], made[i].trace, *made[i].scenario);
    std::vector<PopThrough> pops = pop_throughs(made[i].trace, *made[i].scenario);
    runs.push_back({words[i].first, words[i].second, std::move(made[i]), std::move(frames), std::move(pops)});
  }
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
    figure.tables.push_back(frame_table(runs[i]));
    add_panels(figure, runs[i], static_cast<int>(i));
  }
  figure.tables.push_back(violation_table(runs));
  add_claims(figure, runs[0], runs[1], runs[2], runs[3]);
  return figure;
}

}  // namespace remote_touch
