// The models of depth sensors against recordings of such sensors: noise, steps of depth, holes beside depth
// edges, and errors against true objects.
#include <algorithm>
#include <cmath>

#include "analysis/trace/interval_estimates.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/studies/sensor_comparison.h"

namespace remote_touch {

namespace {

constexpr double kMedian = 0.5;
constexpr int kBeside_px = 3;
constexpr int kTruthFrameStep = 3, kStillFrames = 5;

// The experiments play a recording; their own path is replaced.
struct RecordedSensor {
  const char* experiment;
  ShownSensor shown;
};
const RecordedSensor kRecordedSensors[] = {
    {"fig4.16-moving",
     {"active_stereo",
      "Active stereo",
      {DepthSensorKind::active_stereo, "rgbd/visp_cube_dragon", kStillFrames, true, 1, 1.3},
      {0.3, 0.45, 0.6, 0.8, 1, 1.3},
      1}},
    {"fig4.16-boxes",
     {"structured_light",
      "Structured light",
      {DepthSensorKind::structured_light, "rgbd/pcd_single", 2, false, 0.9, 2},
      {0.5, 0.65, 0.8, 1, 1.2, 1.5, 2},
      0.7}},
};

CurveStyle source_style(const SensorSource& source) {
  if (&source == &kRecordedSensor) return CurveStyle::dots;
  return &source == &kSimulatedSensor ? CurveStyle::line : CurveStyle::dashed;
}

// Returns a curve for each source.
std::vector<Curve> source_curves(const std::string& table, const std::string& x,
                                 const std::string& quantity) {
  std::vector<Curve> curves;
  for (const SensorSource* source : kSensorSources)
    curves.push_back({table, x, quantity + "_" + source->column, source_style(*source), source->label});
  return curves;
}

// Returns curves for both sides of near surfaces. The own focal length does not change holes.
std::vector<Curve> side_curves(const std::string& table, const std::string& x) {
  std::vector<Curve> curves;
  for (const bool is_left : kEdgeSides)
    for (const SensorSource* source : {&kRecordedSensor, &kSimulatedSensor})
      curves.push_back({table, x, side_name(is_left) + "_" + source->column,
                        source == &kRecordedSensor ? CurveStyle::dots : CurveStyle::line,
                        std::string(source->label) + ", " + side_name(is_left) + " of near surfaces"});
  return curves;
}

void add_sensor_panels(Figure& figure, const MeasuredSensor& sensor, int column) {
  const std::string noise = sensor.table("noise"), title = sensor.shown.title + ": ";
  const auto add = [&](const std::string& what, int row, const char* x, const char* y,
                       const std::vector<Curve>& curves) {
    figure.panels.push_back(plot(title + what, x, y, curves, {{{row, column}}, {}, {}}));
  };
  if (sensor.shown.compared.is_at_rest)
    add("noise over time", 0, "depth (m)", "standard deviation (m)", source_curves(noise, "depth", "time"));
  add("noise about planes", 1, "depth (m)", "rms (m)", source_curves(noise, "depth", "planes"));
  add("step of depth", 2, "depth (m)", "step (m)", source_curves(noise, "depth", "step"));
  add("holes at edges", 3, "jump of 1 / z (1/m)", "median width (px)",
      side_curves(sensor.table("widths"), "jump"));
  add("holes beside edges", 4, "distance from the edge (px)", "fraction of holes",
      side_curves(sensor.table("holes"), "distance"));
}

void add_truth_panel(Figure& figure) {
  std::vector<Curve> curves;
  for (const char* object : {"cube", "dragon"})
    for (const char* source : {"recorded", "simulated"})
      curves.push_back({"truth", "frame", std::string("median_") + object + "_" + source,
                        source == std::string("recorded") ? CurveStyle::dots : CurveStyle::line,
                        std::string(object) + ", " + source});
  figure.panels.push_back(plot("Active stereo: depth minus true depth", "frame", "median over the object (m)",
                               curves, {{{0, 1}}, {}, {}}));
}

// Adds the claims about a ratio, simulated / recorded, in every range of distance from `first` on.
template <class Noise>
void add_range_claims(const Claims& claims, const MeasuredSensor& sensor, std::size_t first,
                      const std::string& what, const SensorSource& source, double factor, Noise&& noise_m) {
  const auto qualifies = [&](std::size_t range) { return range >= first; };
  const auto ratio = [&](std::size_t range) {
    return noise_m(source, range) / noise_m(kRecordedSensor, range);
  };
  claims.at_least(what + ": smallest simulated / recorded", min_where(sensor.ranges(), qualifies, ratio),
                  1 / factor, "ratio", "1 (equal)");
  claims.at_most(what + ": largest simulated / recorded", max_where(sensor.ranges(), qualifies, ratio),
                 factor, "ratio", "1 (equal)");
}

double width_ratio(const MeasuredSensor& sensor) {
  return median_hole_px(sensor.shown_edges(kSimulatedSensor, true)) /
         median_hole_px(sensor.shown_edges(kRecordedSensor, true));
}
double beside_right(const MeasuredSensor& sensor, const SensorSource& source) {
  return hole_fraction(sensor.shown_edges(source, false), kBeside_px);
}

void add_active_stereo_claims(Figure& figure, const MeasuredSensor& sensor, const Table& widths) {
  const Claims claims(figure, "active stereo: ");
  const auto time_ratio = [&](const SensorSource& source, std::size_t range, double share = kMedian) {
    return sensor.over_time_m(source, range, share) / sensor.over_time_m(kRecordedSensor, range, share);
  };
  claims.differs(
      "steps of depth show that the images were warped from a camera of shorter focal length: 1/32 px / "
      "(50 mm x step of 1 / z)",
      sensor.comparison.own_focal_px, 375, 390, "px", "607");
  claims.differs(
      "with the focal length of the images the model has too little noise over time: simulated / "
      "recorded at 0.6 to 0.8 m",
      time_ratio(kSimulatedSensor, 2), 0.62, 0.67, "ratio", "1 (equal)");
  claims.differs(
      "with the focal length of the images the model has too little noise over time: simulated / "
      "recorded at 1 to 1.3 m",
      time_ratio(kSimulatedSensor, 4), 0.57, 0.62, "ratio", "1 (equal)");
  add_range_claims(
      claims, sensor, 1,
      "with its own focal length the model has the sensor's noise over time from 0.45 m on", kOwnFocalSensor,
      1.4, [&](const SensorSource& source, std::size_t range) { return sensor.over_time_m(source, range); });
  claims.differs(
      "nearer than 0.45 m the recording, in whole millimetres, has more noise over time than the "
      "model with its own focal length: simulated / recorded",
      time_ratio(kOwnFocalSensor, 0), 0.38, 0.42, "ratio", "1 (equal)");
  claims.differs(
      "the sensor has pixels with far more noise over time than the median: 90 % quantile, "
      "simulated / recorded at 0.6 to 0.8 m, with its own focal length",
      time_ratio(kOwnFocalSensor, 2, kLoudShare), 0.44, 0.49, "ratio", "1 (equal)");
  add_range_claims(claims, sensor, 1, "the model has the sensor's noise about planes from 0.45 m on",
                   kSimulatedSensor, 1.35, [&](const SensorSource& source, std::size_t range) {
                     return sensor.about_planes_m(source, range);
                   });
  claims.differs("holes left of near surfaces are narrower in the model: median width, simulated / recorded",
                 width_ratio(sensor), 0.67, 0.72, "ratio", "1 (equal)");
  claims.between(
      "holes left of near surfaces widen with the jump of 1 / z as by the baseline: recorded slope "
      "/ focal length",
      shadow_baseline_m(widths, "left_recorded", sensor.comparison.focal_px), 0.04, 0.06, "m", "0.05");
  claims.differs("the sensor also has holes right of near surfaces: recorded fraction of holes 3 px away",
                 beside_right(sensor, kRecordedSensor), 0.65, 0.69, "fraction", "0");
}

void add_structured_light_claims(Figure& figure, const MeasuredSensor& sensor, const Table& widths) {
  const Claims claims(figure, "structured light: ");
  const double focal_px = sensor.comparison.focal_px;
  const double left_m = shadow_baseline_m(widths, "left_recorded", focal_px);
  const double right_m = shadow_baseline_m(widths, "right_recorded", focal_px);
  claims.between(
      "steps of depth show the focal length of the infrared camera: 1/8 px / (75 mm x step of 1 / z)",
      sensor.comparison.own_focal_px, 565, 595, "px", "580");
  const auto about_planes_m = [&](const SensorSource& source, std::size_t range) {
    return sensor.about_planes_m(source, range);
  };
  add_range_claims(claims, sensor, 1, "the model has the sensor's noise about planes from 0.65 m on",
                   kSimulatedSensor, 1.3, about_planes_m);
  claims.differs("nearer than 0.65 m the sensor has more noise about planes: simulated / recorded",
                 about_planes_m(kSimulatedSensor, 0) / about_planes_m(kRecordedSensor, 0), 0.69, 0.74,
                 "ratio", "1 (equal)");
  claims.differs("holes left of near surfaces are wider in the model: median width, simulated / recorded",
                 width_ratio(sensor), 1.57, 1.66, "ratio", "1 (equal)");
  claims.differs("the sensor also has holes right of near surfaces: recorded fraction of holes 3 px away",
                 beside_right(sensor, kRecordedSensor), 0.94, 0.97, "fraction", "0");
  claims.differs(
      "holes left of near surfaces widen with the jump of 1 / z less than by the baseline: recorded "
      "slope / focal length",
      left_m, 0.057, 0.061, "m", "0.075");
  claims.differs("holes right of near surfaces widen with the jump of 1 / z: recorded slope / focal length",
                 right_m, 0.023, 0.026, "m", "0");
  claims.between(
      "holes on both sides together widen with the jump of 1 / z as by the baseline: sum of the "
      "recorded slopes / focal length",
      left_m + right_m, 0.064, 0.087, "m", "0.075");
}

void add_truth_claims(Figure& figure, const Table& truth) {
  const Claims claims(figure, "active stereo: ");
  const auto drift_m = [&](const char* column) {
    return std::sqrt(moments_of(numbers(truth, column)).variance);
  };
  const auto average = [&](const char* column) { return moments_of(numbers(truth, column)).mean; };
  for (const std::string object : {"cube", "dragon"}) {
    claims.differs("the sensor's mean error on the true " + object +
                       " changes over the frames, that of the model does not: standard deviation of the "
                       "frame's median, simulated / recorded",
                   drift_m(("median_" + object + "_simulated").c_str()) /
                       drift_m(("median_" + object + "_recorded").c_str()),
                   0, 0.05, "ratio", "1 (equal)");
    claims.differs("errors on the true " + object +
                       " are spread less in the model: standard deviation in frame 0, simulated / recorded",
                   numbers(truth, "spread_" + object + "_simulated")[0] /
                       numbers(truth, "spread_" + object + "_recorded")[0],
                   0.23, 0.3, "ratio", "1 (equal)");
  }
  claims.differs(
      "the model loses more of the true table, which is seen at 78 to 88 degrees: share of the "
      "pixels with a depth, simulated / recorded",
      average("measured_table_simulated") / average("measured_table_recorded"), 0.9, 0.94, "ratio",
      "1 (equal)");
}

void add_truth(Figure& figure, const TrueObjectErrors& errors) {
  const Table truth = truth_table(errors);
  add_truth_panel(figure);
  add_truth_claims(figure, truth);
  figure.tables.push_back(truth);
}

void add_edge_checks(Figure& figure, const MeasuredSensor& sensor) {
  std::vector<double> counts;
  for (const SensorSource* source : kSensorSources)
    for (const bool is_left : kEdgeSides)
      counts.push_back(static_cast<double>(sensor.shown_edges(*source, is_left).size()));
  Claims(figure, "", &Claim::set_up)
      .at_least(sensor.shown.title + ": fractions of holes are those of many edges: smallest number",
                min_of(counts), 200, "edges");
}

}  // namespace

Figure figure_sensor_models_recorded(FigureContext& context) {
  Figure figure{
      "sensor-models-recorded", "Simulated depth sensors against real ones",
      "The models of mesh-scene's sensors, with published numbers only, and recordings of such sensors, "
      "measured by one code. Left: a D400 camera, five frames at rest. Right: two frames of a Kinect of "
      "2010. The models see the recorded scenes with filled holes; for noise about planes they see the "
      "planes that fit windows of 20 x 20 pixels, and the lower quartile of the windows is shown. Both "
      "recordings are warped to the view of a colour camera with another focal length than the sensor's "
      "own. The steps of depth show the latter; dashed: the models with noise and steps of that focal "
      "length. Depth minus true depth is the median over the pixels of an object; the true poses are "
      "uncertain by 3 mm, but equally in all frames. Holes beside an edge begin behind the last pixel of "
      "the near surface; their edges have jumps of 0.4 to 0.7 per m. What the models lack: pixels with "
      "far more noise than the median, an error that drifts, holes right of near surfaces, and the margin "
      "of holes around the shadow of active stereo."};
  figure.source = "the published models";
  int column = 0;
  for (const RecordedSensor& recorded : kRecordedSensors) {
    const ComparedSensor& compared = recorded.shown.compared;
    const Experiment experiment =
        Experiment::load(recorded.experiment, {"scenario.path=" + compared.recording});
    context.uses(experiment);
    const auto scene = experiment.build_scenario(context.kernels());
    const MeasuredSensor sensor{recorded.shown, compare_sensor(*scene, compared, context.kernels())};
    const Table widths = width_table(sensor);
    for (const Table& table : {noise_table(sensor), widths, hole_table(sensor)})
      figure.tables.push_back(table);
    add_sensor_panels(figure, sensor, column++);
    if (compared.kind == DepthSensorKind::structured_light) {
      add_structured_light_claims(figure, sensor, widths);
    } else {
      add_active_stereo_claims(figure, sensor, widths);
      add_truth(figure, true_object_errors(*scene, compared, kTruthFrameStep, context.kernels()));
    }
    add_edge_checks(figure, sensor);
  }
  return figure;
}

}  // namespace remote_touch
