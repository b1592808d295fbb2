// The remote handshake of 1.1: a hand that shakes is touched, and moves the hand that touches it.
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "analysis/trace/curve_fits.h"
#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/measures.h"
#include "runners/evaluation/figures/parts/ball_gaps.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/parts/figure_pictures.h"
#include "runners/evaluation/figures/parts/fixture_run.h"

namespace remote_touch {

namespace {

// The shake of the experiment `handshake`: three periods of a sine, as straight pieces. The second and third
// are used where a hand with mass must have settled.
constexpr double kShake_hz = 1.5, kShakes_s = 0.5, kSettled_shake_s = kShakes_s + 1 / kShake_hz,
                 kRests_s = 2.5;
constexpr double kHeld_shake_s = 0.45;   // the HIP has pressed, and the hand still rests
constexpr double kShake_frames_hz = 30;  // frame rate of the experiment
constexpr double kDeeper_m =
    0.012;  // depth by which it presses more than in the first run the passive hand wants to be
constexpr double kFromAbove_m = 0.05, kReaching_m_per_s = 0.25;
constexpr std::size_t kStride_shake = 2;  // ticks, in tables

// True for ticks in whole periods of the shake, from the second on.
bool is_settled(const Trace& t, std::size_t i) {
  return t.time_s[i] >= kSettled_shake_s && t.time_s[i] < kRests_s;
}

// The hand that is touched: how far it is above its position at rest in each tick, and its velocity.
struct HandMotion {
  std::vector<double> up_m, velocity_m_per_s;
};

HandMotion motion_of(const MeshRun& run) {
  const std::vector<double>& time_s = run.trace.time_s;
  const auto height_m = [&](double at_s) {
    return run.scenario->true_meshes(at_s).front().X_WO->translation().y();
  };
  HandMotion motion;
  for (const double at_s : time_s) motion.up_m.push_back(height_m(at_s) - height_m(0));
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1, after = std::min(i + 1, time_s.size() - 1);
    motion.velocity_m_per_s.push_back((motion.up_m[after] - motion.up_m[before]) /
                                      (time_s[after] - time_s[before]));
  }
  return motion;
}

// The runs of one hand: pressed by a HIP that follows the frames; the same with an exact sensor; and a
// simulated hand with mass that wants to stay at a position inside.
struct Handshake {
  MeshRun pressed, exact, passive;
  HandMotion motion;  // the same in all of them
};

// Returns a trajectory to a position below that of the HIP at rest, in which it stays.
std::string waypoints_into(const Vec3& hip_W) {
  const Vec3 inside_W = hip_W - kDeeper_m * Vec3::UnitY(), above_W = inside_W + kFromAbove_m * Vec3::UnitY();
  const nlohmann::ordered_json trajectory = {
      {"name", "waypoints"},
      {"waypoints",
       {{above_W.x(), above_W.y(), above_W.z(), 0},
        {inside_W.x(), inside_W.y(), inside_W.z(), kReaching_m_per_s}}}};
  return "trajectory=" + trajectory.dump();
}

Handshake handshake_with(FigureContext& context, const std::vector<std::string>& hand) {
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), hand.begin(), hand.end());
    Experiment experiment = Experiment::load("handshake", more);
    Trace trace = context.run(experiment);
    return mesh_run(std::move(experiment), std::move(trace), kContactRadius_m, context.kernels());
  };
  MeshRun pressed = with({}), exact = with(exact_sensor());
  const Vec3 hip_W = pressed.trace.hip_position_m[tick_of(pressed.trace, kHeld_shake_s)];
  MeshRun passive = with({waypoints_into(hip_W), "operator={}"});
  HandMotion motion = motion_of(pressed);
  return {std::move(pressed), std::move(exact), std::move(passive), std::move(motion)};
}

// Heights of a position over its height at kHeld_shake_s, m.
std::vector<double> raised_m(const Trace& t, const std::vector<Vec3>& position) {
  std::vector<double> raised;
  for (const Vec3& p : position) raised.push_back(p.y() - position[tick_of(t, kHeld_shake_s)].y());
  return raised;
}

Table run_table(const std::string& name, const std::string& title, const MeshRun& run, const MeshRun* exact,
                const HandMotion& motion) {
  const Trace& t = run.trace;
  const auto hip = raised_m(t, t.hip_position_m), proxy = raised_m(t, t.proxy_position_m);
  TableRows rows;
  for (std::size_t i = 0; i < t.length(); i += kStride_shake) {
    rows.push_back({t.time_s[i], motion.up_m[i], hip[i], proxy[i], run.gaps[i].now_m,
                    run.gaps[i].at_capture_m, t.force_N[i].norm()});
    if (exact != nullptr) rows.back().push_back(exact->gaps[i].at_capture_m);
  }
  std::vector<ColumnName> columns = {
      {"time", "s", "simulated time"},
      {"hand", "m", "height of the shaking hand over its position at rest"},
      {"hip", "m", "height of the HIP over that at 0.45 s"},
      {"proxy", "m", "height of the proxy over that at 0.45 s"},
      {"gap", "m", "from the proxy's ball to the true surface; NaN: no contact"},
      {"gap_at_capture", "m", "to the true surface at the capture of the newest frame"},
      {"force", "N", "magnitude of the force"}};
  if (exact != nullptr)
    columns.push_back({"exact_gap", "m", "gap_at_capture with a sensor without noise and rounding"});
  return table_of(name, title, columns, rows);
}

// A sinusoid in the settled ticks, from values of all ticks.
Sinusoid shake_in(const Trace& t, const std::vector<double>& values) {
  std::vector<double> time_s, settled;
  for (std::size_t i = 0; i < t.length(); ++i)
    if (is_settled(t, i)) time_s.push_back(t.time_s[i]), settled.push_back(values[i]);
  return sinusoid_in(time_s, settled, kShake_hz);
}

// The motion of a passive hand of mass m, a spring k and a damper c on a surface of stiffness K that shakes.
struct PassiveHand {
  double amplitude;      // amplitude of the hand, divided by that of the surface: K / |K + k - m w^2 + i c w|
  double force_N_per_m;  // amplitude of the force over that of the hand: |k - m w^2 + i c w|
  double lag_s;
};

PassiveHand derived_hand(const Experiment& experiment) {
  const auto setting = [&](const char* name) { return experiment.value_at_start(name).get<double>(); };
  const double w = 2 * std::numbers::pi * kShake_hz, surface = setting("renderer.stiffness_N_per_m"),
               own = setting("operator.stiffness_N_per_m") - setting("operator.mass_kg") * w * w,
               damping = setting("operator.damping_Ns_per_m") * w;
  return {surface / std::hypot(surface + own, damping), std::hypot(own, damping),
          std::atan2(damping, surface + own) / w};
}

struct PassiveMotion {
  Sinusoid surface, hip, force;
};
PassiveMotion passive_motion(const Handshake& shake) {
  const Trace& t = shake.passive.trace;
  std::vector<double> up_N;
  for (const Vec3& force : t.force_N) up_N.push_back(force.y());
  return {shake_in(t, shake.motion.up_m), shake_in(t, raised_m(t, t.hip_position_m)), shake_in(t, up_N)};
}

double rms_velocity_m_per_s(const Handshake& shake) {
  return std::sqrt(mean_where(
      shake.motion.velocity_m_per_s.size(),
      [&](std::size_t i) { return !std::isnan(shake.pressed.gaps[i].now_m); },
      [&](std::size_t i) { return std::pow(shake.motion.velocity_m_per_s[i], 2); }));
}

// The surface that a frame shows is 0 to 1 / f_c old, so its rms displacement is v_rms / (3^(1/2) f_c).
double derived_age_gap_m(const Handshake& shake) {
  return rms_velocity_m_per_s(shake) / (std::sqrt(3.0) * kShake_frames_hz);
}

// The bound on the gap to the moving hand: its way between two frames, the largest error of a depth, and how
// deep the ball sinks between points.
double largest_gap_m(const Handshake& shake, double sink_m) {
  const double fastest_m_per_s = max_where(
      shake.motion.up_m.size(), [](std::size_t) { return true; },
      [&](std::size_t i) { return std::abs(shake.motion.velocity_m_per_s[i]); });
  return fastest_m_per_s / kShake_frames_hz + error_at_proxy(shake.pressed).largest_m() + sink_m;
}

// The depth to which the ball sinks between points of the palm, within 30 mm of the HIP at rest.
double sink_on_palm_m(const Handshake& shake) {
  constexpr double kPalm_m = 0.03;
  const Trace& t = shake.pressed.trace;
  const Vec3 middle_W = t.hip_position_m[tick_of(t, kHeld_shake_s)];
  const PointCloud& cloud = shake.exact.cloud;
  return deepest_sink_m(cloud, kContactRadius_m,
                        [&](std::size_t i) { return (cloud.point(i) - middle_W).norm() < kPalm_m; });
}

double touching_fraction(const Trace& t) {
  return mean_where(
      t.length(), [&](std::size_t i) { return t.time_s[i] >= kShakes_s && t.time_s[i] < kRests_s; },
      [&](std::size_t i) { return t.force_N[i].norm() > 0; });
}

void add_claims(Figure& figure, const Handshake& shake) {
  for (const auto& [where, run] :
       {std::pair{"pressed: ", &shake.pressed}, {"passive hand: ", &shake.passive}}) {
    add_side_claim(figure, where, run->trace);
    add_sound_claims(figure, where, run->trace);
    Claims(figure, where)
        .at_least("the contact is not lost during the shake: fraction of its ticks with a force",
                  touching_fraction(run->trace), 1, "fraction");
  }
  const Claims claims(figure);
  const double sink_m = sink_on_palm_m(shake), rms_m = rms_gap_m(shake.pressed.gaps, &BallGap::now_m);
  claims.at_most(
      "the proxy keeps to the moving hand within its way between two frames, the largest error of a "
      "depth and the sink between points: largest gap",
      max_gap_m(shake.pressed.gaps, &BallGap::now_m), largest_gap_m(shake, sink_m), "m");
  claims.between("most of the gap is the age of the frame: rms gap, divided by v_rms / (3^(1/2) f_c)",
                 rms_m / derived_age_gap_m(shake), 0.85, 1.15, "1");
  claims.at_most(
      "to the hand as the newest frame saw it, the gap is within the largest error of a depth: largest gap",
      max_gap_m(shake.pressed.gaps, &BallGap::at_capture_m),
      error_at_proxy(shake.pressed).largest_m() + sink_m, "m");
  claims.at_most(
      "with a sensor without noise and rounding, the ball only sinks between points: largest gap to the "
      "hand as the newest frame saw it",
      max_gap_m(shake.exact.gaps, &BallGap::at_capture_m), sink_m, "m");
  const PassiveHand derived = derived_hand(shake.passive.experiment);
  const PassiveMotion measured = passive_motion(shake);
  claims.between(
      "the shake moves a passive hand: amplitude of the HIP, divided by that of the shaking hand and by "
      "the derived ratio",
      measured.hip.amplitude / measured.surface.amplitude / derived.amplitude, 0.9, 1.1, "1");
  claims.between(
      "the force on a passive hand follows the shake: amplitude, divided by the derived one",
      measured.force.amplitude / (derived.force_N_per_m * derived.amplitude * measured.surface.amplitude),
      0.9, 1.1, "1");
}

Table summary_table(const Handshake& shake) {
  const PassiveHand derived = derived_hand(shake.passive.experiment);
  const PassiveMotion measured = passive_motion(shake);
  const DepthError depth = error_at_proxy(shake.pressed);
  Table table{"summary", "numbers of the runs"};
  std::vector<std::string> names, units;
  std::vector<double> values;
  const auto add = [&](const char* name, const char* unit, double value) {
    names.emplace_back(name), units.emplace_back(unit), values.push_back(value);
  };
  add("rms gap to the moving hand", "m", rms_gap_m(shake.pressed.gaps, &BallGap::now_m));
  add("largest gap to the moving hand", "m", max_gap_m(shake.pressed.gaps, &BallGap::now_m));
  add("rms gap, derived from the age of the frames alone", "m", derived_age_gap_m(shake));
  add("rms gap to the hand at capture", "m", rms_gap_m(shake.pressed.gaps, &BallGap::at_capture_m));
  add("largest gap to the hand at capture", "m", max_gap_m(shake.pressed.gaps, &BallGap::at_capture_m));
  add("rms gap to the hand at capture, exact sensor", "m",
      rms_gap_m(shake.exact.gaps, &BallGap::at_capture_m));
  add("standard deviation of a depth at the proxy", "m", depth.sigma_m);
  add("half a step of the depth", "m", depth.rounding_m);
  add("deepest sink between points of the palm", "m", sink_on_palm_m(shake));
  add("maximum force, pressed", "N", max_force_N(shake.pressed.trace));
  add("amplitude of the shaking hand", "m", measured.surface.amplitude);
  add("amplitude of the passive hand", "m", measured.hip.amplitude);
  add("amplitude of the passive hand, derived", "m", derived.amplitude * measured.surface.amplitude);
  add("lag of the passive hand", "s", lag_s(measured.surface, measured.hip, kShake_hz));
  add("lag of the passive hand, derived without the age of frames", "s", derived.lag_s);
  add("amplitude of the force on the passive hand", "N", measured.force.amplitude);
  table.columns.push_back({"quantity", "1", "what was measured", names, 1, {}});
  table.columns.push_back({"unit", "1", "unit of the value in this row", units, 1, {}});
  table.add("value", "1", "measured or derived value", values);
  return table;
}

// Adds the points of the frames in which the hand is highest and lowest, and the proxy at the first.
void add_picture(Figure& figure, const Handshake& shake) {
  const double highest_s = kShakes_s + 0.25 / kShake_hz, lowest_s = kShakes_s + 0.75 / kShake_hz;
  const Scenario& scenario = *shake.pressed.scenario;
  const auto add = [&](const std::string& name, double time_s) {
    const PointCloud cloud = scenario.cloud(scenario.newest_frame(time_s));
    figure.tables.push_back(
        cloud_table(name, "points of the frame at " + std::to_string(time_s).substr(0, 4) + " s", cloud,
                    chosen_points(cloud, [&](std::size_t i) { return cloud.is_measured(i); })));
  };
  add("lowest", lowest_s), add("highest", highest_s);
  const Vec3 proxy_W = shake.pressed.trace.proxy_position_m[tick_of(shake.pressed.trace, highest_s)];
  figure.tables.push_back(table_of("proxy", "proxy when the hand is highest",
                                   {{"x", "m", "x"}, {"y", "m", "y"}, {"z", "m", "z"}},
                                   {{proxy_W.x(), proxy_W.y(), proxy_W.z()}}));
  const auto points = [](const char* table, std::uint32_t colour, double size_m, const char* label) {
    return ScenePart{ScenePart::Kind::points, table, colour, size_m, label};
  };
  figure.panels.push_back(scene_panel(
      "What the camera sees of the hand", 0, 0,
      {{0.42, 0.30, 0.30},
       {0, 0.115, 0},
       Vec3::UnitY(),
       0.30,
       0.62,
       {points("lowest", 0xC3CCD2, 0.0022, "lowest position"),
        points("highest", 0x81939F, 0.0022, "highest position"), points("proxy", 0x146BAB, 0.01, "proxy")}}));
}

void add_panels(Figure& figure, const Handshake& shake) {
  const std::pair<double, double> time_range{0.3, 2.8};
  const auto over_time = [&](const char* title, const char* y_label, std::vector<Curve> curves, int row,
                             int column) {
    for (Curve& curve : curves) curve.x = "time";
    figure.panels.push_back(
        plot(title, "time (s)", y_label, std::move(curves), {.at = {{row, column}}, .x_range = time_range}));
  };
  const double bound_m = largest_gap_m(shake, sink_on_palm_m(shake));
  figure.tables.push_back(
      table_of("bounds", "bound on the gap to the moving hand",
               {{"time", "s", "simulated time"}, {"high", "m", "upper bound"}, {"low", "m", "lower bound"}},
               {{time_range.first, bound_m, -bound_m}, {time_range.second, bound_m, -bound_m}}));
  add_picture(figure, shake);
  over_time("Pressed by a HIP that follows the frames", "displacement (m)",
            {{"pressed", "", "hand", CurveStyle::line, "true hand"},
             {"pressed", "", "hip", CurveStyle::dashed, "HIP"},
             {"pressed", "", "proxy", CurveStyle::line, "proxy"}},
            0, 1);
  over_time("Gap between the proxy's ball and the hand", "gap (m)",
            {{"bounds", "", "high", CurveStyle::line, "bound"},
             {"bounds", "", "low", CurveStyle::line, "bound"},
             {"pressed", "", "gap", CurveStyle::line, "to the moving hand"},
             {"pressed", "", "gap_at_capture", CurveStyle::line, "to the hand at capture"},
             {"pressed", "", "exact_gap", CurveStyle::line, "the same, exact sensor"}},
            1, 0);
  over_time("Force on the pressing HIP", "force (N)", {{"pressed", "", "force", CurveStyle::line, ""}}, 1, 1);
  over_time("A passive hand is shaken", "displacement (m)",
            {{"passive", "", "hand", CurveStyle::line, "true hand"},
             {"passive", "", "hip", CurveStyle::dashed, "HIP"}},
            2, 0);
  over_time("Force on the passive hand", "force (N)", {{"passive", "", "force", CurveStyle::line, ""}}, 2, 1);
}

Figure handshake_figure(FigureContext& context, Figure figure, const std::vector<std::string>& hand) {
  const Handshake shake = handshake_with(context, hand);
  figure.tables = {
      run_table("pressed", "pressed by a HIP that follows the frames", shake.pressed, &shake.exact,
                shake.motion),
      run_table("passive", "a passive hand, held at a position", shake.passive, nullptr, shake.motion),
      summary_table(shake)};
  add_panels(figure, shake);
  add_claims(figure, shake);
  return figure;
}

constexpr const char* kShakeCaption =
    "shakes up and down by 3 cm, three times in 2 s, before a simulated Kinect at half of its "
    "resolution. First the HIP presses 10 mm into the palm, as the newest frame shows it. Between two "
    "frames the proxy stays where it is and the hand moves on: this is most of the gap between the "
    "proxy's ball and the true hand. Against the hand at the capture of the newest frame the gap is the "
    "error of the sensor; with a sensor without noise and rounding it is that of the renderer alone. "
    "Below: a simulated hand with mass wants to stay at a position in the palm, and is shaken.";

}  // namespace

Figure figure_handshake(FigureContext& context) {
  return handshake_figure(
      context,
      {"handshake", "Remote handshake",
       "The remote handshake of 1.1. The built-in hand `fork` " + std::string(kShakeCaption)},
      {});
}

Figure figure_handshake_human(FigureContext& context) {
  return handshake_figure(
      context,
      {"handshake-human", "Remote handshake with a human hand",
       "The figure handshake with the mesh of a human hand. The hand " + std::string(kShakeCaption)},
      {"scenario.mesh=meshes/hand_closed.obj", "scenario.mesh_rotation_deg=[-90, 0, 0]"});
}

}  // namespace remote_touch
