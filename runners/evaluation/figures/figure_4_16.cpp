// Fig 4.16: the proxy over a ramp and a box seen by a depth camera, simulated and recorded.
#include <algorithm>
#include <cmath>

#include "analysis/trace/contact_measures.h"
#include "analysis/trace/measures.h"
#include "core/kernels/isa.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/parts/fixture_run.h"

namespace remote_touch {

namespace {

// Positions along one axis and heights along another, of HIP and proxy, and the force.
Table path_table(const std::string& name, const Trace& t, int scan, int up) {
  return {
      name,
      "paths of HIP and proxy, and the force",
      {{"time", "s", "simulated time", t.time_s},
       {"proxy_along", "m", "proxy along the scan", along(scan, t.proxy_position_m)},
       {"proxy_up", "m", "proxy across the scan", along(up, t.proxy_position_m)},
       {"hip_along", "m", "HIP along the scan", along(scan, t.hip_position_m)},
       {"hip_up", "m", "HIP across the scan", along(up, t.hip_position_m)},
       {"force", "N", "magnitude of the force", norms(t.force_N)},
       {"signed_distance", "m", "distance of the proxy's centre to the true surface", t.signed_distance_m}}};
}

// The first frame's points within a slice around the scan.
template <class InSlice>
Table slice_table(const std::string& name, const PointCloud& cloud, int along, int up, InSlice&& in_slice) {
  TableRows rows;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 p = cloud.point(i);
    if (p.allFinite() && in_slice(p)) rows.push_back({p[along], p[up]});
  }
  return table_of(name, "points of the first frame near the scan",
                  {{"along", "m", "along the scan"}, {"up", "m", "across the scan"}}, rows);
}

// Returns the share of the ticks in which the HIP is held back and the true side is known, among all ticks in
// which it is held back. Nothing is claimed about the other ticks. NaN if the HIP is never held back.
double known_fraction(const Trace& trace) {
  return mean_where(
      trace.length(), [&](std::size_t i) { return pressing(trace, i, kContactRadius_m); },
      [&](std::size_t i) { return std::isnan(trace.signed_distance_m[i]) ? 0 : 1; });
}

void add_claims(Figure& figure, const std::string& where, const Trace& trace) {
  const std::string prefix = where.empty() ? "" : where + ": ";
  add_side_claim(figure, prefix, trace);
  add_sound_claims(figure, prefix, trace);
  Claims(figure, prefix, &Claim::set_up)
      .at_least("the true side of the surface is known in most touching ticks: fraction of them",
                known_fraction(trace), 0.7, "fraction");
}

// Returns the limits of an axis around a path, so that points far away do not shrink the path in the picture.
std::pair<double, double> around(const Trace& trace, int axis) {
  Numbers places = along(axis, trace.hip_position_m), proxy = along(axis, trace.proxy_position_m);
  places.insert(places.end(), proxy.begin(), proxy.end());
  return {min_of(places) - 0.03, max_of(places) + 0.03};
}

void add_panels(Figure& figure, const std::string& title, const std::string& table, const std::string& slice,
                const std::string& along, const std::string& up) {
  figure.panels.push_back(plot(title, along, up,
                               {{slice, "along", "up", CurveStyle::dots, "points, first frame"},
                                {table, "hip_along", "hip_up", CurveStyle::dashed, "HIP"},
                                {table, "proxy_along", "proxy_up", CurveStyle::line, "proxy"}},
                               {.equal_aspect = true}));
  figure.panels.push_back(
      plot("Force", along, "force (N)", {{table, "hip_along", "force", CurveStyle::line, ""}}));
}

}  // namespace

Figure figure_4_16(FigureContext& context) {
  const Experiment experiment = Experiment::load("fig4.16");
  const Trace trace = context.run(experiment);
  const PointCloud cloud = experiment.build_scenario(kernels_for(Isa::x86_64))->cloud(0);
  Figure figure{
      "4.16", "Ramp and box, simulated depth camera",
      "A simulated depth camera (quantised, noisy, with holes at depth edges) looks at a ramp and a box "
      "on a table; the HIP moves along z, 10 mm below the true surface, and lifts off over the two steps. "
      "Top: paths of HIP and proxy. Bottom: force."};
  figure.tables = {path_table("path", trace, 2, 1),
                   slice_table("slice", cloud, 2, 1, [](const Vec3& p) { return std::abs(p.x()) < 0.0015; })};
  add_panels(figure, "Paths over the table", "path", "slice", "z (m)", "y (m)");
  figure.panels[0].x_range = figure.panels[1].x_range = around(trace, 2);
  add_claims(figure, "", trace);
  // The same run with a budget of two steps a tick: the share of the ticks in which two steps are enough.
  const Trace two = context.run(Experiment::load("fig4.16", {"renderer.steps_per_tick=2"}));
  Claims(figure).differs(
      "two proxy steps suffice to converge (4.8) in a part of the ticks only: fraction of ticks",
      1 - unconverged_fraction(two), 0.3, 0.5, "fraction", "typically in 1 - 2 (4.3.4)");
  return figure;
}

namespace {

// The HIP scans over a cloud at rest.
void add_scan(Figure& figure, FigureContext& context, int column, const char* name, const std::string& table,
              const std::string& title) {
  const Experiment experiment = Experiment::load(name);
  const Trace trace = context.run(experiment);
  const PointCloud cloud = experiment.build_scenario(kernels_for(Isa::x86_64))->cloud(0);
  const Vec3 middle = trace.hip_position_m[trace.length() / 2];
  const double slope = middle.y() / middle.z();  // slope of the plane through camera and scanned row
  figure.tables.push_back(path_table(table, trace, 0, 2));
  figure.tables.push_back(slice_table(
      table + "_slice", cloud, 0, 2, [&](const Vec3& p) { return std::abs(p.y() - slope * p.z()) < 0.001; }));
  add_panels(figure, title, table, table + "_slice", "x (m)", "z (m)");
  figure.panels.push_back(plot("Proxy to measured surface", "x (m)", "distance (m)",
                               {{table, "hip_along", "signed_distance", CurveStyle::line, ""}},
                               {.y_range = {{-0.002, 0.03}}}));
  const std::size_t first = figure.panels.size() - 3;
  for (std::size_t i = first; i < figure.panels.size(); ++i) {
    figure.panels[i].x_range = around(trace, 0);
    figure.panels[i].grid_position = {i - first, column};
  }
  figure.panels[first].y_range = around(trace, 2);
  figure.panels[first].equal_aspect = false;  // three columns leave no room for it
  add_claims(figure, title, trace);
}

// The HIP presses at one pixel while the camera moves.
void add_moving(Figure& figure, FigureContext& context) {
  const Trace trace = context.run("fig4.16-moving");
  figure.tables.push_back(path_table("moving", trace, 0, 2));
  PanelColumn panels{figure, "moving", "time", "time (s)", 2};
  panels.add("organ model, moving camera", "z (m)",
             {{"hip_up", CurveStyle::dashed, "HIP"}, {"proxy_up", CurveStyle::line, "proxy"}});
  panels.add("Force", "force (N)", {{"force"}});
  panels.add("Proxy to measured surface", "distance (m)", {{"signed_distance"}});
  add_claims(figure, "organ model, moving camera", trace);
}

}  // namespace

Figure figure_4_16_recorded(FigureContext& context) {
  Figure figure{"4.16-recorded", "Recorded depth images and clouds",
                "The experiment of Fig 4.16 on recordings; x to the right, z away from the camera. "
                "Scans: the HIP follows an image row, 10 mm behind the surface of the first frame, and "
                "lifts off over holes and depth edges. The truth is the measurement itself: a plane "
                "through the pixels around the proxy. The proxy also slides across the row, along y, so "
                "in this projection it can lie beside the row's points. Moving camera: the HIP stays 10 "
                "mm behind the newest frame's surface at one pixel, and lifts off while that pixel sees "
                "a hole or an edge."};
  add_scan(figure, context, 0, "fig4.16-recorded", "still", "box and organ model, camera at rest");
  add_scan(figure, context, 1, "fig4.16-boxes", "boxes", "two boxes on a table, one cloud held");
  add_moving(figure, context);
  return figure;
}

}  // namespace remote_touch
