// The largest stable stiffness with a tool, of its rotation, with another hand, other frame rates and noise,
// and the energy that the hand gets at frame updates, with each sign of the velocity term of (4.15).
#include <cmath>
#include <string>

#include "analysis/trace/force_fidelity.h"
#include "analysis/trace/interval_estimates.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/studies/wall_limit.h"

namespace remote_touch {

namespace {

constexpr double kDamping_Ns_per_m = 0.5;
constexpr const char* kDamperCurve = "wall_damper";

// A plane at rest that is seen again and again.
std::string plane(double frame_rate_hz) {
  return R"(scenario={"name": "moving-shape", "columns": 60, "rows": 60, "normals": true, "rise_s": 3.5,
                     "frame_rate_hz": )" +
         std::to_string(frame_rate_hz) + "}";
}

// The value of what varies in a curve, and the limit for it.
struct Width {
  double value;
  WallLimit limit;
};
struct WidthCurve {
  std::string name, title, axis, unit;
  std::vector<Width> widths = {};
};

Experiment plane_run(std::vector<std::string> settings, double stiffness_N_per_m) {
  settings.push_back("renderer.stiffness_N_per_m=" + std::to_string(stiffness_N_per_m));
  settings.push_back("operator.stiffness_N_per_m=" + std::to_string(stiffness_N_per_m / 4));
  return Experiment::load("virtual-wall", settings);
}

// The wall of a hand whose spring has a quarter of its stiffness.
SampledWall wall_of(double damping, int delay_ticks, double mass_kg = 0.3) {
  return {.mass_kg = mass_kg, .damping_Ns_per_m = damping, .spring_share = 0.25, .delay_ticks = delay_ticks};
}

WallLimit limit_of(std::vector<std::string> settings, const SampledWall& wall) {
  settings.push_back("device.delay_ticks=" + std::to_string(wall.delay_ticks));
  return {[settings](double stiffness_N_per_m) { return plane_run(settings, stiffness_N_per_m); }, wall};
}

std::string device_damping(double damping_Ns_per_m) {
  return "device.damping_Ns_per_m=" + std::to_string(damping_Ns_per_m);
}

// The tool is a plate 10 mm thick that the hand lays flat on the plane.
WidthCurve tool_curve(int delay_ticks) {
  WidthCurve curve{"tool_delay_" + std::to_string(delay_ticks),
                   "tool, delay of " + std::to_string(delay_ticks) + " ms", "damping", "N s/m"};
  for (const double damping : {0.2, 0.5, 1.0})
    curve.widths.push_back(
        {damping,
         limit_of({R"(renderer={"name": "tool", "tool_mesh": "slab-10"})", plane(30),
                   "trajectory.waypoints=[[0, 0.012, 0, 0], [0, -0.002, 0, 0.01]]", device_damping(damping)},
                  wall_of(damping, delay_ticks))});
  return curve;
}

// The hand lays the plate flat on the plane and then turns about an axis in the plane. The plane holds the
// plate, so the rotation is a wall with the stiffness of the rotational coupling. The stiffness along the
// normal is below its own limit, 4000 or 364 N/m.
WallLimit turn_limit(double damping_Nms_per_rad, int delay_ticks) {
  constexpr double kStiffness_N_per_m = 200, kDeviceDamping_Ns_per_m = 2;
  const std::vector<std::string> settings{
      R"(renderer={"name": "tool", "tool_mesh": "slab-10"})",
      plane(30),
      R"(trajectory={"name": "poses", "poses": [[0, 0.012, 0, 0, 0, 0, 0], [0, -0.002, 0, 0, 0, 0, 1.2],
                                                [0, -0.002, 0, 0, 0, 2, 0]]})",
      device_damping(kDeviceDamping_Ns_per_m),
      "device.rotational_damping_Nms_per_rad=" + std::to_string(damping_Nms_per_rad),
      "operator.rotational_damping_Nms_per_rad=0",
      "device.delay_ticks=" + std::to_string(delay_ticks)};
  const auto run = [=](double stiffness_Nm_per_rad) {
    const double radius_m = std::sqrt(stiffness_Nm_per_rad / kStiffness_N_per_m);
    std::vector<std::string> all = settings;
    all.push_back("renderer.gyration_radius_m=" + std::to_string(radius_m));
    all.push_back("operator.rotational_stiffness_Nm_per_rad=" + std::to_string(stiffness_Nm_per_rad / 4));
    return plane_run(all, kStiffness_N_per_m);
  };
  constexpr double kInertia_kg_m2 = 1e-3;
  return {run, wall_of(damping_Nms_per_rad, delay_ticks, kInertia_kg_m2)};
}

WidthCurve turn_curve(int delay_ticks) {
  WidthCurve curve{"turn_delay_" + std::to_string(delay_ticks),
                   "rotation of the tool, delay of " + std::to_string(delay_ticks) + " ms", "damping",
                   "N m s/rad"};
  for (const double damping : {5e-4, 1e-3, 2e-3})
    curve.widths.push_back({damping, turn_limit(damping, delay_ticks)});
  return curve;
}

WidthCurve mass_curve() {
  WidthCurve curve{"mass", "mass of the hand", "mass", "kg"};
  for (const double mass_kg : {0.1, 0.3, 1.0})
    curve.widths.push_back(
        {mass_kg, limit_of({"operator.mass_kg=" + std::to_string(mass_kg), device_damping(kDamping_Ns_per_m)},
                           wall_of(kDamping_Ns_per_m, 0, mass_kg))});
  return curve;
}

// A damper of the wall, with a delay and a velocity over several ticks: the lighter the hand, the less does
// the law hold, because the damper is late, too.
WidthCurve damper_curve() {
  WidthCurve curve{kDamperCurve, "mass of the hand, damper of the wall", "mass", "kg"};
  for (const double mass_kg : {0.1, 0.2, 0.5, 1.0}) {
    SampledWall wall = wall_of(2, 3, mass_kg);
    wall.wall_damping_Ns_per_m = 10, wall.velocity_ticks = 5;
    curve.widths.push_back(
        {mass_kg,
         limit_of({"operator.mass_kg=" + std::to_string(mass_kg), device_damping(wall.damping_Ns_per_m),
                   "device.contact_damping_Ns_per_m=10", "device.velocity_ticks=5"},
                  wall)});
  }
  return curve;
}

// The damper of the hand acts at once and adds to that of the device.
WidthCurve hand_curve() {
  WidthCurve curve{"hand", "damping of the hand", "damping", "N s/m"};
  for (const double damping : {0.0, 0.25, 0.5, 1.0})
    curve.widths.push_back({damping, limit_of({"operator.damping_Ns_per_m=" + std::to_string(damping),
                                               device_damping(kDamping_Ns_per_m)},
                                              wall_of(kDamping_Ns_per_m + damping, 0))});
  return curve;
}

WidthCurve rate_curve() {
  WidthCurve curve{"rate", "frame rate", "frame_rate", "Hz"};
  for (const double rate_hz : {15.0, 30.0, 60.0})
    curve.widths.push_back({rate_hz, limit_of({plane(rate_hz), device_damping(kDamping_Ns_per_m)},
                                              wall_of(kDamping_Ns_per_m, 0))});
  return curve;
}

std::vector<WidthCurve> width_curves(FigureContext& context) {
  std::vector<WidthCurve> curves{tool_curve(0), tool_curve(5), turn_curve(0), turn_curve(5),
                                 mass_curve(),  hand_curve(),  rate_curve(),  damper_curve()};
  std::vector<WallLimit*> limits;
  for (WidthCurve& curve : curves)
    for (Width& width : curve.widths) limits.push_back(&width.limit);
  bisect(context, limits);
  return curves;
}

// --- energy at frame updates ---

constexpr const char* kSigns[] = {"minus", "plus", "none"};
constexpr int kSeeds = 4;

struct Energy {
  double value;   // value of what varies
  double mean_J;  // mean over the seeds of the energy per frame update
};

// A hand rests 10 mm deep on a plane, at rest or shaken.
Experiment resting_hand(const std::string& sign, double noise_m, double rate_hz, double shake_m, int seed) {
  return Experiment::load("virtual-wall",
                          {plane(rate_hz), "scenario.noise_sigma_m=" + std::to_string(noise_m),
                           "scenario.shake_amplitude_m=" + std::to_string(shake_m), "scenario.shake_hz=1",
                           R"(renderer={"name": "proxy", "velocity_force": ")" + sign + "\"}",
                           R"(operator={"mass_kg": 0.3, "stiffness_N_per_m": 400, "damping_Ns_per_m": 10})",
                           "trajectory.waypoints=[[0, 0.03, 0, 0], [0, -0.01, 0, 0.1]]", "duration_s=2.4",
                           "seed=" + std::to_string(seed)});
}

struct EnergyCurve {
  std::string sign, over;  // over: noise, rate or shaken
  std::vector<Energy> energies = {};
};

std::vector<EnergyCurve> energy_curves(FigureContext& context) {
  std::vector<EnergyCurve> curves;
  std::vector<Experiment> runs;
  const auto add = [&](EnergyCurve& curve, double value, double noise_m, double rate_hz, double shake_m) {
    curve.energies.push_back({value, 0});
    for (int seed = 1; seed <= kSeeds; ++seed)
      runs.push_back(resting_hand(curve.sign, noise_m, rate_hz, shake_m, seed));
  };
  for (const char* sign : kSigns) {
    EnergyCurve noise{sign, "noise"}, rate{sign, "rate"}, shaken{sign, "shaken"};
    for (const double noise_m : {0.0, 0.0005, 0.001, 0.003}) add(noise, noise_m, noise_m, 30, 0);
    for (const double rate_hz : {15.0, 30.0, 60.0}) add(rate, rate_hz, 0.001, rate_hz, 0);
    for (const double rate_hz : {15.0, 30.0, 60.0}) add(shaken, rate_hz, 0, rate_hz, 0.01);
    for (EnergyCurve* curve : {&noise, &rate, &shaken}) curves.push_back(std::move(*curve));
  }
  const std::vector<double> energy_J = context.measure(runs, mean_energy_per_update_J);
  auto next = energy_J.begin();
  for (EnergyCurve& curve : curves)
    for (Energy& energy : curve.energies)
      energy.mean_J = mean(std::vector<double>(next, next + kSeeds)), next += kSeeds;
  return curves;
}

const EnergyCurve& curve_of(const std::vector<EnergyCurve>& all, const std::string& sign,
                            const std::string& over) {
  for (const EnergyCurve& curve : all)
    if (curve.sign == sign && curve.over == over) return curve;
  return all.front();
}

// --- the figure ---

Panel width_panel(Figure& figure, const std::vector<const WidthCurve*>& curves, const std::string& title,
                  const std::string& x_label, const std::string& unit = "N/m") {
  Panel panel{title, x_label, "largest stable stiffness (" + unit + ")"};
  for (const WidthCurve* curve : curves) {
    const bool has_damper = curve->name == kDamperCurve;
    figure.tables.push_back(table_over<Width>(
        curve->name, "limits over " + curve->title, curve->widths,
        {{curve->axis, curve->unit, curve->title, [](const Width& w) { return w.value; }},
         {"stiffness", unit, "largest stable stiffness", [](const Width& w) { return w.limit.middle(); }},
         {"expected", unit, "limit of a linear wall, law", [](const Width& w) { return w.limit.expected(); }},
         {"exact", unit, "limit of a linear wall, eigenvalues",
          [](const Width& w) { return w.limit.exact(); }}}));
    panel.curves.push_back({curve->name, curve->axis, "expected", CurveStyle::line,
                            curve != curves.front() ? ""
                            : has_damper            ? "(b + B) / (T / 2 + delay)"
                                                    : "b / (T / 2 + delay)"});
    if (has_damper) panel.curves.push_back({curve->name, curve->axis, "exact", CurveStyle::dashed, "exact"});
    panel.curves.push_back({curve->name, curve->axis, "stiffness", CurveStyle::dots,
                            curves.size() > 1 ? curve->title : "measured"});
  }
  return panel;
}

Panel energy_panel(Figure& figure, const std::vector<EnergyCurve>& all, const std::string& over,
                   const std::string& title, const std::string& x_label, const ColumnName& axis) {
  Panel panel{title, x_label, "energy per update (mJ)"};
  for (const char* sign : kSigns) {
    const std::string name = std::string("energy_") + over + "_" + sign;
    const EnergyCurve& curve = curve_of(all, sign, over);
    figure.tables.push_back(table_over<Energy>(
        name, "energy that the hand gets at a frame update, velocity_force = " + std::string(sign),
        curve.energies,
        {{axis.name, axis.units, axis.long_name, [](const Energy& e) { return e.value; }},
         {"energy_mJ", "mJ", "mean energy per update", [](const Energy& e) { return 1e3 * e.mean_J; }}}));
    panel.curves.push_back({name, axis.name, "energy_mJ", CurveStyle::line, sign});
  }
  return panel;
}

Panel noise_panel(Figure& figure, const std::vector<NoisyWall>& walls) {
  figure.tables.push_back(table_over<NoisyWall>(
      "noise", "largest stiffness of a calm hand over the noise", walls,
      {{"noise", "m", "standard deviation of the noise", [](const NoisyWall& w) { return w.noise_m; }},
       {"plane_noise", "m", "standard deviation of the height of the rendered plane",
        [](const NoisyWall& w) { return w.plane_noise_m; }},
       {"stiffness", "N/m", "largest stiffness of a calm hand",
        [](const NoisyWall& w) { return w.stiffness_N_per_m; }},
       {"expected", "N/m", "theory for this height",
        [](const NoisyWall& w) { return w.expected_N_per_m; }}}));
  return plot("Noise of the points: a calm hand", "noise (m)", "largest stiffness (N/m)",
              {{"noise", "noise", "expected", CurveStyle::line, "noise through a linear wall"},
               {"noise", "noise", "stiffness", CurveStyle::dots, "measured"}});
}

double largest_error(const std::vector<NoisyWall>& walls) {
  std::vector<double> errors;
  for (const NoisyWall& wall : walls)
    errors.push_back(std::abs(wall.stiffness_N_per_m / wall.expected_N_per_m - 1));
  return max_of(errors);
}

double largest_error(const WidthCurve& curve, double (WallLimit::*ratio)() const) {
  std::vector<double> errors;
  for (const Width& width : curve.widths) errors.push_back(std::abs((width.limit.*ratio)() - 1));
  return max_of(errors);
}

// Returns the smallest amount by which the hand gets more energy with the sign `more` than with `less`, mJ.
double least_excess_mJ(const std::vector<EnergyCurve>& all, const std::string& more, const std::string& less,
                       const std::string& over) {
  std::vector<double> excess;
  const EnergyCurve &a = curve_of(all, more, over), &b = curve_of(all, less, over);
  for (std::size_t i = 0; i < a.energies.size(); ++i)
    excess.push_back(1e3 * (a.energies[i].mean_J - b.energies[i].mean_J));
  return min_of(excess);
}

}  // namespace

Figure figure_device_width(FigureContext& context) {
  Figure figure{
      "device-width", "Stable stiffness and energy of a rendered plane",
      "(a) to (f): the largest stiffness at which no oscillation grows (dots) and the limit of a "
      "linear wall (line), with a tool of six degrees of freedom along the normal and in rotation, and with "
      "the proxy over the hand and the frame rate. (f): with a damper of 10 N s/m of the wall, whose velocity "
      "is measured over 5 ticks, a light hand is less stable than the law (line); the eigenvalues of the "
      "sampled loop give the exact limit (dashed). (g): the largest stiffness at which noise moves a resting "
      "hand by not more than 0.4 mm (rms). (h) to (j): energy that a resting hand gets from one frame update "
      "to the next, with each sign of the velocity term of (4.15). Simulated."};
  figure.source = "the theory of sampled walls";
  const std::vector<WidthCurve> widths = width_curves(context);
  const std::vector<NoisyWall> noisy = noisy_walls(context, {0.0001, 0.00025, 0.0005, 0.001});
  const std::vector<EnergyCurve> energies = energy_curves(context);
  figure.panels = {
      width_panel(figure, {&widths[0], &widths[1]}, "A plate held flat", "damping of the device (N s/m)"),
      width_panel(figure, {&widths[2], &widths[3]}, "A plate held flat, in rotation",
                  "rotational damping of the device (N m s/rad)", "N m/rad"),
      width_panel(figure, {&widths[4]}, "Mass of the hand", "mass (kg)"),
      width_panel(figure, {&widths[5]}, "Damping of the hand", "damping of the hand (N s/m)"),
      width_panel(figure, {&widths[6]}, "Frame rate", "frame rate (Hz)"),
      width_panel(figure, {&widths[7]}, "Damper of the wall, delay of 3 ms", "mass (kg)"),
      noise_panel(figure, noisy),
      energy_panel(figure, energies, "noise", "Plane at rest, 30 Hz", "noise (m)",
                   {"noise", "m", "standard deviation of the noise"}),
      energy_panel(figure, energies, "rate", "Plane at rest, noise of 1 mm", "frame rate (Hz)",
                   {"frame_rate", "Hz", "frame rate"}),
      energy_panel(figure, energies, "shaken", "Plane shaken by 10 mm at 1 Hz", "frame rate (Hz)",
                   {"frame_rate", "Hz", "frame rate"})};
  place_in_rows(figure, 2);
  for (const WidthCurve& curve : widths) {
    const Claims claims(figure, curve.title + ": ");
    if (curve.name != kDamperCurve) {
      claims.at_most("the largest stable stiffness is b / (T / 2 + delay): largest relative difference",
                     largest_error(curve, &WallLimit::ratio), 0.05, "fraction");
      continue;
    }
    claims.at_most("the largest stable stiffness is that of the eigenvalues: largest relative difference",
                   largest_error(curve, &WallLimit::exact_ratio), 0.05, "fraction");
    claims.at_least(
        "the law (b + B) / (T / 2 + delay) is too high for the lightest hand: relative difference",
        1 - curve.widths.front().limit.ratio(), 0.3, "fraction");
  }
  // Four runs of 6 s know the motion to about a tenth, and the contact may open at times.
  Claims(figure, "noise of the points: ")
      .at_most("the largest stiffness of a calm hand is that of a linear wall: largest relative difference",
               largest_error(noisy), 0.3, "fraction");
  const Claims claims(figure, "the velocity term of (4.15): ");
  claims.at_least(
      "plane shaken: the printed sign gives the hand more energy than the other one: smallest excess",
      least_excess_mJ(energies, "plus", "minus", "shaken"), 0, "mJ");
  claims.at_least("noise of 1 mm: the sign that suits a motion costs energy: smallest excess over no term",
                  least_excess_mJ(energies, "minus", "none", "rate"), 0, "mJ");
  return figure;
}

}  // namespace remote_touch
