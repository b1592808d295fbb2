// Equation (4.15): the force between the updates of a cloud that moves at a constant velocity, for the three
// readings of its sign.
#include "analysis/trace/force_measures.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"

namespace remote_touch {

namespace {

Experiment steady_rise(const std::string& sign) {
  return Experiment::from_json(R"({
    "title": "a noise-free plane rises at 0.1 m/s under a HIP that keeps its depth",
    "scenario": {"name": "moving-lift", "noise_sigma_m": 0, "rise_s": 2, "acceleration_s": 0},
    "renderer": {"name": "proxy"},
    "trajectory": {"name": "press", "press_at_s": 0.5, "depth_m": 0.03, "surface": "moving"},
    "duration_s": 1.9})",
                               "eq4.15", {"renderer.velocity_force=" + sign});
}

// (4.13) sets a negative estimate to 0, "since there is no risk for pop through", so (4.15) has no term here.
Experiment steady_fall() {
  return Experiment::from_json(R"({
    "title": "a noise-free plane recedes at 0.1 m/s from a HIP that keeps its depth",
    "scenario": {"name": "moving-lift", "noise_sigma_m": 0, "wait_s": 0.2, "start_depth_m": 0,
                 "start_velocity_m_per_s": -0.1, "rise_s": 2, "acceleration_s": 0},
    "renderer": {"name": "proxy"},
    "trajectory": {"name": "press", "start_m": [0, 0.02, 0], "press_at_s": 0.1, "depth_m": 0.03,
                   "surface": "moving"},
    "duration_s": 1.9})",
                               "eq4.15");
}

// Returns the part of the trace from 1 s on, when the velocity estimate has settled.
Trace settled(const Trace& trace) {
  Trace part;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    if (trace.time_s[i] < 1.0) continue;
    RenderOutput out;
    out.proxy_W = trace.proxy_position_m[i], out.force_N = trace.force_N[i],
    out.frame_index = trace.frame_index[i];
    part.append(trace.time_s[i], {trace.hip_position_m[i]}, out,
                {trace.signed_distance_m[i], trace.slave_distance_m[i], 0});
  }
  return part;
}

Table force_table(const std::string& name, const Trace& trace) {
  TableRows rows;
  for (std::size_t i = 0; i < trace.length(); ++i) rows.push_back({trace.time_s[i], trace.force_N[i].norm()});
  return table_of(name, "force with the term " + name,
                  {{"time", "s", "simulated time"}, {"force", "N", "magnitude of the force"}}, rows);
}

}  // namespace

Figure figure_eq4_15(FigureContext& context) {
  Figure figure{"eq4.15", "Force between updates",
                "A noise-free plane rises at 0.1 m/s under a HIP that keeps its depth, so the true force "
                "is constant. The velocity term of (4.15) as printed (plus), left out (none), and with "
                "the sign that removes the jump (minus)."};
  // Three frames.
  figure.panels = {
      plot("A plane that rises at 0.1 m/s", "time (s)", "force (N)", {}, {.x_range = {{1.0, 1.1}}})};
  std::vector<double> jump;
  const std::pair<const char*, const char*> readings[] = {
      {"plus", "plus (as printed)"}, {"none", "no term"}, {"minus", "minus (used)"}};
  for (const auto& [sign, label] : readings) {
    const Trace trace = settled(context.run(steady_rise(sign)));
    jump.push_back(max_force_jump_N(trace));
    figure.tables.push_back(force_table(sign, trace));
    figure.panels[0].curves.push_back({sign, "time", "force", CurveStyle::line, label});
  }
  // The plane jumps by v / f_c, and in the same tick the HIP follows it by v / f_h. The printed sign doubles
  // the jump.
  constexpr double kJump_N = 600 * 0.1 * (1.0 / 30 - 1.0 / 1000), kRounding_N = 1e-6;
  const Claims claims(figure);
  claims.at_most(
      "with the minus sign the force does not jump at the frames of a surface that rises at 0.1 m/s: jump",
      jump[2], kRounding_N, "N", "smooth");
  claims.differs(
      "with the printed plus sign the force jumps at the frames of a surface that rises at 0.1 m/s: jump",
      jump[0], 2 * kJump_N - kRounding_N, 2 * kJump_N + kRounding_N, "N", "smooth");
  claims.between(
      "without the velocity term the force jumps at the frames of a surface that rises at 0.1 m/s: jump",
      jump[1], kJump_N - kRounding_N, kJump_N + kRounding_N, "N");
  claims.differs(
      "with the minus sign the force jumps at the frames of a surface that recedes, because v_hat is "
      "never below 0 (4.13): jump",
      max_force_jump_N(settled(context.run(steady_fall()))), kJump_N - kRounding_N, kJump_N + kRounding_N,
      "N", "smooth");
  return figure;
}

}  // namespace remote_touch
