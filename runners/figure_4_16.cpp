// Fig 4.16: the proxy over a ramp and a box seen by a depth camera, simulated and recorded.
#include <cmath>

#include "analysis/contact_point.h"
#include "analysis/measures.h"
#include "runners/figures.h"

namespace remote_touch {

namespace {

constexpr double kContactRadius_m = 0.005;

// Positions along one axis and heights along another, of HIP and proxy, and the force.
Table path_table(const std::string& name, const Trace& trace, int along, int up) {
  std::vector<double> proxy_along, proxy_up, hip_along, hip_up, force;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    proxy_along.push_back(trace.proxy(i)[along]), proxy_up.push_back(trace.proxy(i)[up]);
    hip_along.push_back(trace.hip(i)[along]), hip_up.push_back(trace.hip(i)[up]);
    force.push_back(trace.force(i).norm());
  }
  Table table{name, "paths of HIP and proxy, and the force", {}};
  table.add("time", "s", "simulated time", trace.time_s);
  table.add("proxy_along", "m", "proxy along the scan", proxy_along);
  table.add("proxy_up", "m", "proxy across the scan", proxy_up);
  table.add("hip_along", "m", "HIP along the scan", hip_along);
  table.add("hip_up", "m", "HIP across the scan", hip_up);
  table.add("force", "N", "magnitude of the force", force);
  return table;
}

// The first frame's points within a slice around the scan.
template <class InSlice>
Table slice_table(const std::string& name, const PointCloud& cloud, int along, int up, InSlice&& in_slice) {
  std::vector<double> x, y;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 p = cloud.point(i);
    if (p.allFinite() && in_slice(p)) x.push_back(p[along]), y.push_back(p[up]);
  }
  Table table{name, "points of the first frame near the scan", {}};
  table.add("along", "m", "along the scan", x), table.add("up", "m", "across the scan", y);
  return table;
}

// Share of the ticks with a known truth whose proxy centre lies behind the surface.
double wrong_side_share(const Trace& trace) {
  std::size_t known = 0, wrong = 0;
  for (const double distance : trace.signed_distance_m) {
    if (std::isnan(distance)) continue;
    ++known;
    wrong += distance < 0 ? 1 : 0;
  }
  return known == 0 ? std::nan("") : static_cast<double>(wrong) / static_cast<double>(known);
}

void add_claims(Figure& figure, const std::string& where, const Trace& trace, bool at_rest) {
  const std::string prefix = where.empty() ? "" : where + ": ";
  if (at_rest)
    figure.claims.push_back(claim_at_most(figure.name,
                                          prefix + "ticks with the proxy on the wrong side of the surface",
                                          "none", wrong_side_share(trace), 0, "share"));
  figure.claims.push_back(claim_at_most(figure.name, prefix + "ticks with a number that is not finite",
                                        "none", non_finite_share(trace), 0, "share"));
  figure.claims.push_back(claim_at_most(figure.name,
                                        prefix + "ticks in which the HIP was held back without force", "none",
                                        share_without_force(trace, kContactRadius_m), 0, "share"));
}

void add_panels(Figure& figure, const std::string& title, const std::string& table, const std::string& slice,
                const std::string& along, const std::string& up) {
  figure.panels.push_back({title,
                           along,
                           up,
                           true,
                           {{slice, "along", "up", CurveStyle::dots, "points, first frame"},
                            {table, "hip_along", "hip_up", CurveStyle::dashed, "HIP"},
                            {table, "proxy_along", "proxy_up", CurveStyle::line, "proxy"}},
                           {},
                           {}});
  figure.panels.push_back(
      {"Force", along, "force (N)", false, {{table, "hip_along", "force", CurveStyle::line, ""}}, {}, {}});
}

}  // namespace

Figure figure_4_16(const Laboratory& laboratory) {
  const Experiment experiment = Experiment::load("fig4.16");
  const Trace trace = laboratory.run(experiment);
  const PointCloud cloud = experiment.build_scenario(kernels_for(Isa::x86_64))->cloud(0);
  Figure figure{
      "4.16",
      "Ramp and box, simulated depth camera",
      "A simulated depth camera (quantised, noisy, with holes at depth edges) looks at a ramp and a box on a "
      "table; the HIP moves along z, 1 cm below the true surface. Top: paths of HIP and proxy. Bottom: "
      "force.",
      {path_table("path", trace, 2, 1),
       slice_table("slice", cloud, 2, 1, [](const Vec3& p) { return std::abs(p.x()) < 0.0015; })},
      {},
      {}};
  add_panels(figure, "Paths over the table", "path", "slice", "z (m)", "y (m)");
  figure.panels[0].x_range = figure.panels[1].x_range = std::pair(-0.40, 0.26);
  add_claims(figure, "", trace, true);
  return figure;
}

Figure figure_4_16_recorded(const Laboratory& laboratory) {
  struct Run {
    const char *experiment, *table, *title;
    bool at_rest;
  };
  const Run runs[] = {{"fig4.16-recorded", "still", "box and organ model, camera at rest", true},
                      {"fig4.16-moving", "moving", "organ model, camera moved by hand", false},
                      {"fig4.16-boxes", "boxes", "two boxes on a table, one cloud held", true}};
  Figure figure{
      "4.16-recorded",
      "Recorded depth images and clouds",
      "The experiment of Fig 4.16 on recordings: the HIP scans along an image row, 1 cm behind the surface "
      "of the "
      "first frame; x to the right, z away from the camera. The truth is the measurement itself: a plane "
      "through the pixels around the proxy.",
      {},
      {},
      {}};
  for (const Run& run : runs) {
    const Experiment experiment = Experiment::load(run.experiment);
    const Trace trace = laboratory.run(experiment);
    const PointCloud cloud = experiment.build_scenario(kernels_for(Isa::x86_64))->cloud(0);
    const double slope =
        trace.hip(trace.length() / 2).y() / trace.hip(trace.length() / 2).z();  // of the scanned row
    figure.tables.push_back(path_table(run.table, trace, 0, 2));
    figure.tables.push_back(slice_table(std::string(run.table) + "_slice", cloud, 0, 2, [&](const Vec3& p) {
      return std::abs(p.y() - slope * p.z()) < 0.001;
    }));
    add_panels(figure, run.title, run.table, std::string(run.table) + "_slice", "x (m)", "z (m)");
    add_claims(figure, run.title, trace, run.at_rest);
  }
  return figure;
}

}  // namespace remote_touch
