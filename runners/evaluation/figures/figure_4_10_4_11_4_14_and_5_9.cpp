// Fig 4.10: the proxy on a flat grid, and the HIP below it. Fig 5.9: the proxy keeps the distance of a
// forbidden region from a beating organ. Both are pictures of one tick of a run. Fig 4.11 and 4.14: its path
// over a flat grid, and over sharp corners.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "analysis/theory/surface_contacts.h"
#include "analysis/trace/contact_measures.h"
#include "core/kernels/kernels.h"
#include "core/mesh/triangle_mesh.h"
#include "core/points/point_cloud.h"
#include "runners/evaluation/figures/figure_pictures.h"
#include "runners/evaluation/figures/figure_recipe.h"

namespace remote_touch {

namespace {

constexpr double kHipRadius_m = 0.002, kNormalArrow_m = 0.02;
// An arrow: sides around it, radius of its shaft, radius and length of its head.
constexpr int kArrowSides = 12;
constexpr double kShaft_m = 0.0005, kHead_m = 0.0013, kHeadLength_m = 0.0045;
constexpr std::uint32_t kPointColour = 0x81939F, kProxyColour = 0x146BAB, kHipColour = 0xC08800,
                        kNormalColour = 0x00A67C, kForceColour = 0xB34C00, kNetColour = 0x452700;

TriangleMesh ball_of(double radius_m) {
  TriangleMesh mesh = find_generated_tool("ball")->make();
  for (Vec3& p : mesh.vertices) p *= radius_m / p.norm();
  return mesh;
}

// Returns an arrow that starts at the origin and points along z. All arrows have the same triangles.
TriangleMesh arrow_of(double length_m) {
  const double neck_m = std::max(0.0, length_m - kHeadLength_m);
  TriangleMesh mesh;
  mesh.vertices.emplace_back(0, 0, 0);
  for (const auto& [radius_m, z] :
       {std::pair(kShaft_m, 0.0), std::pair(kShaft_m, neck_m), std::pair(kHead_m, neck_m)})
    for (int side = 0; side < kArrowSides; ++side) {
      const auto [sine, cosine] = sin_cos(2 * std::numbers::pi * side / kArrowSides);
      mesh.vertices.emplace_back(radius_m * cosine, radius_m * sine, z);
    }
  mesh.vertices.emplace_back(0, 0, length_m);
  const int tip = static_cast<int>(mesh.vertices.size()) - 1;
  const auto corner = [](int ring, int side) { return 1 + ring * kArrowSides + side % kArrowSides; };
  for (int side = 0; side < kArrowSides; ++side) {
    mesh.triangles.push_back({0, corner(0, side + 1), corner(0, side)});
    for (int ring = 0; ring < 2; ++ring) {
      const int here = corner(ring, side), above = corner(ring + 1, side + 1);
      mesh.triangles.push_back({here, corner(ring, side + 1), above});
      mesh.triangles.push_back({here, above, corner(ring + 1, side)});
    }
    mesh.triangles.push_back({corner(2, side), corner(2, side + 1), tip});
  }
  return mesh;
}

Table pose_rows(const std::string& name, const Trace& trace, std::size_t tick) {
  const Vec3 &proxy_W = trace.proxy_position_m[tick], &hip_W = trace.hip_position_m[tick];
  const auto row = [](const Vec3& p, const Vec3& direction) {
    // q is the shortest rotation from z to n: scalar part 1 + z . n, vector part z x n, normalised; a half
    // turn about x for n = -z. Eigen's FromTwoVectors() takes 6 s to compile.
    const Vec3 n = direction.normalized();
    const auto q = n.z() <= -1 ? Eigen::Quaterniond(0, 1, 0, 0)
                               : Eigen::Quaterniond(1 + n.z(), -n.y(), n.x(), 0).normalized();
    return std::vector<double>{p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()};
  };
  const Vec3& normal = trace.normal[tick];
  const Vec3 on_proxy_W = proxy_W + kContactRadius_m * normal;
  return table_of(name, "of proxy, HIP, normal and force",
                  {{"x", "m", "x of its begin or centre"},
                   {"y", "m", "y of its begin or centre"},
                   {"z", "m", "z of its begin or centre"},
                   {"qw", "1", "orientation"},
                   {"qx", "1", "orientation"},
                   {"qy", "1", "orientation"},
                   {"qz", "1", "orientation"}},
                  {row(proxy_W, Vec3::UnitZ()), row(hip_W, Vec3::UnitZ()), row(on_proxy_W, normal),
                   row(hip_W, trace.force_N[tick])});
}

// Returns the chosen points, and a tick of a trace: the proxy as a ball of radius r_c, the HIP as a smaller
// ball, the normal as an arrow that starts on the proxy, and the force on the hand as an arrow that starts at
// the HIP. Tables are NAME_cloud, NAME_proxy, NAME_hip, NAME_ball_triangles, NAME_normal, NAME_force,
// NAME_bar_triangles (of both arrows) and NAME_poses.
std::vector<Table> proxy_tables(const std::string& name, const PointCloud& cloud,
                                const std::vector<std::size_t>& chosen, const Trace& trace, std::size_t tick,
                                double force_m_per_N) {
  const TriangleMesh proxy = ball_of(kContactRadius_m), normal = arrow_of(kNormalArrow_m);
  return {cloud_table(name + "_cloud", "points around the proxy", cloud, chosen),
          vertex_table(name + "_proxy", proxy),
          vertex_table(name + "_hip", ball_of(kHipRadius_m)),
          triangle_table(name + "_ball_triangles", proxy),
          vertex_table(name + "_normal", normal),
          vertex_table(name + "_force", arrow_of(force_m_per_N * trace.force_N[tick].norm())),
          triangle_table(name + "_bar_triangles", normal),
          pose_rows(name + "_poses", trace, tick)};
}

// Returns the cloud, the proxy, the HIP, the normal and the force. HIP and force are slightly transparent,
// because such parts are seen through the points that hide them. The proxy does not hide the force. point_m:
// diameter of a point.
std::vector<ScenePart> proxy_in_cloud(const std::string& name, double point_m) {
  constexpr double kSeenThrough = 0.9, kHalf = 0.5;
  ScenePart cloud{ScenePart::Kind::points, name + "_cloud", kPointColour, point_m, "points"};
  const auto solid = [&](const char* what, const char* triangles, int row, std::uint32_t colour,
                         double opacity) {
    ScenePart part{ScenePart::Kind::solid, name + "_" + what, colour};
    part.triangles = name + triangles, part.poses = name + "_poses", part.pose_row = row,
    part.label = what == std::string("hip") ? "HIP" : what, part.opacity = opacity;
    return part;
  };
  return {cloud, solid("proxy", "_ball_triangles", 0, kProxyColour, kHalf),
          solid("hip", "_ball_triangles", 1, kHipColour, kSeenThrough),
          solid("normal", "_bar_triangles", 2, kNormalColour, 1),
          solid("force", "_bar_triangles", 3, kForceColour, kSeenThrough)};
}

// Returns the indices of the measured points of a cloud that are at most reach_m from a position.
std::vector<std::size_t> points_near(const PointCloud& cloud, const Vec3& place_W, double reach_m) {
  return chosen_points(cloud, [&](std::size_t i) {
    return cloud.is_measured(i) && (cloud.point(i) - place_W).norm() <= reach_m;
  });
}

// Returns the position over (x, z) on the surface of the forbidden region: the highest position on the
// spheres of radius_m around the chosen points. Its height is NaN if no sphere is there.
Vec3 on_region_5_9(const PointCloud& cloud, const std::vector<std::size_t>& chosen, double radius_m, double x,
                   double z) {
  double height_m = kNoValue;
  for (const std::size_t i : chosen) {
    const Vec3 p = cloud.point(i);
    const double squared = radius_m * radius_m - (p.x() - x) * (p.x() - x) - (p.z() - z) * (p.z() - z);
    const bool is_lower = squared < 0 || p.y() + std::sqrt(squared) <= height_m;
    if (!is_lower) height_m = p.y() + std::sqrt(squared);
  }
  return {x, height_m, z};
}

// Returns the surface of the forbidden region around a position, as a net of lines along x and along z.
Table net_table(const std::string& name, const PointCloud& cloud, const std::vector<std::size_t>& chosen,
                double radius_m, const Vec3& middle_W) {
  constexpr int kLines = 5, kPieces = 10;  // on each side of the middle
  constexpr double kLineApart_m = 0.005, kPiece_m = kLineApart_m * kLines / kPieces;
  TableRows rows;
  const auto at = [&](double x, double z) {
    return on_region_5_9(cloud, chosen, radius_m, middle_W.x() + x, middle_W.z() + z);
  };
  const auto add = [&](const Vec3& begin, const Vec3& end) {
    if (begin.allFinite() && end.allFinite())
      rows.push_back({begin.x(), begin.y(), begin.z(), end.x(), end.y(), end.z()});
  };
  for (int line = -kLines; line <= kLines; ++line)
    for (int piece = -kPieces; piece < kPieces; ++piece) {
      const double aside = line * kLineApart_m, from = piece * kPiece_m, to = from + kPiece_m;
      add(at(from, aside), at(to, aside));
      add(at(aside, from), at(aside, to));
    }
  return table_of(name, "surface of the forbidden region, as line segments",
                  {{"x", "m", "x of the begin"},
                   {"y", "m", "y of the begin"},
                   {"z", "m", "z of the begin"},
                   {"x_end", "m", "x of the end"},
                   {"y_end", "m", "y of the end"},
                   {"z_end", "m", "z of the end"}},
                  rows);
}

constexpr double kInstant_4_10_s = 2.5;  // middle of the phase below the points
constexpr double kShell_4_10_m = 1e-5;   // r_2 - r_c of Table 4.2
constexpr double kSpring_4_10_N_per_m = 600;

constexpr double kInstant_5_9_s = 12, kRegion_5_9_m = 0.02;  // r_f has been 20 mm for 2 s
constexpr double kShell_5_9_m[] = {0.00499, 0.00501};        // r_1 and r_2 of Table 4.2

// Fig 4.11: the HIP moves above, below and above a flat grid.

constexpr double kShell_m = 1e-5;

// First tick in which the HIP is below the surface.
std::size_t jump_tick(const Trace& trace) {
  std::size_t i = 0;
  while (i + 1 < trace.length() && trace.hip_position_m[i].y() >= 0) ++i;
  return i;
}

// Number of steps from the jump until the proxy is within the contact shell, in a run with one step per tick.
double steps_to_contact(const Trace& single) {
  const std::size_t jump = jump_tick(single);
  std::size_t i = jump;
  while (i < single.length() && !(std::abs(single.nearest_distance_m[i] - kContactRadius_m) <= kShell_m)) ++i;
  return static_cast<double>(i - jump + 1);
}

}  // namespace

Figure figure_4_10(FigureContext& context) {
  const Experiment experiment = Experiment::load("fig4.11");
  const Trace trace = context.run(experiment);
  const auto tick = static_cast<std::size_t>(kInstant_4_10_s * experiment.settings().haptic_rate_hz);
  const PointCloud cloud = experiment.build_scenario(context.kernels())->cloud(0);
  const Vec3 &proxy_W = trace.proxy_position_m[tick], &hip_W = trace.hip_position_m[tick];
  Figure figure{
      "4.10", "The proxy on a flat point cloud",
      "The run of figure 4.11 after 2.5 s: the HIP is 5 mm below the grid. The proxy, a ball of radius r_c, "
      "is on the grid and drawn transparent. The upper arrow is the estimated normal, 20 mm long. The lower "
      "arrow is the force on the hand, 5 mm long for 1 N. Points within 25 mm of the proxy are shown."};
  figure.tables = proxy_tables("touch", cloud, points_near(cloud, proxy_W, 0.025), trace, tick, 0.005);
  const Scene scene{
      proxy_W + Vec3(0.05, 0.03, 0.075), proxy_W + Vec3(0, 0.0045, 0), Vec3::UnitY(), 0.064, 0.7,
      proxy_in_cloud("touch", 0.0006)};
  figure.panels = {scene_panel("After 2.5 s", 0, 0, scene)};
  // A ball that touches four points is deepest in the middle between them.
  const double spacing_m = (cloud.point(1) - cloud.point(0)).norm();
  const double sinks_m =
      kContactRadius_m - std::sqrt(kContactRadius_m * kContactRadius_m - spacing_m * spacing_m / 2);
  const double spring_m = (proxy_W - hip_W).norm() - kContactRadius_m;
  const Claims claims(figure);
  claims.between("the proxy rests on the grid: height of its centre over the points", proxy_W.y(),
                 kContactRadius_m - sinks_m - kShell_4_10_m, kContactRadius_m + kShell_4_10_m, "m",
                 "r_c = 0.005, or less between the points");
  claims.between("the force is k_s (|u| - r_c), u from the proxy to the HIP: ratio of the two",
                 trace.force_N[tick].norm() / (kSpring_4_10_N_per_m * spring_m), 1 - 1e-9, 1 + 1e-9, "1",
                 "(4.15), (4.16)");
  return figure;
}

Figure figure_5_9(FigureContext& context) {
  const Experiment experiment = Experiment::load("fig5.8", {"duration_s=12.001"});
  const Trace trace = context.run(experiment);
  const std::size_t tick = trace.length() - 1;
  PointCloud cloud = experiment.build_scenario(context.kernels())->cloud(trace.frame_index[tick]);
  cloud.colour.assign(cloud.size(), kPointColour);  // HIP and force are hard to see on the organ's red
  const Vec3& proxy_W = trace.proxy_position_m[tick];
  const std::vector<std::size_t> near = points_near(cloud, proxy_W, 0.06);
  Figure figure{
      "5.9", "The proxy at the distance of a forbidden region",
      "The run of figure 5.8 after 12 s, simulated camera: the HIP is just inside the beating organ, and "
      "the proxy, a ball of radius r_c, touches the forbidden region, r_f = 20 mm around every point. The "
      "net is the surface of the region, its lines 5 mm apart. The upper arrow is the estimated normal of "
      "the region, 20 mm long. The lower arrow is the force on the hand, 1.5 mm long for 1 N; it starts at "
      "the HIP, which is seen through the points. Points within 60 mm of the proxy are shown."};
  figure.tables = proxy_tables("held", cloud, near, trace, tick, 0.0015);
  figure.tables.push_back(net_table("held_region", cloud, near, kRegion_5_9_m, proxy_W));
  Scene scene{proxy_W + Vec3(0.10, 0.07, 0.19), proxy_W - Vec3(0, 0.02, 0), Vec3::UnitY(), 0.13, 0.75,
              proxy_in_cloud("held", 0.001)};
  ScenePart region{ScenePart::Kind::segments, "held_region", kNetColour};
  region.label = "region";
  scene.parts.insert(scene.parts.begin() + 1, region);
  figure.panels = {scene_panel("After 12 s", 0, 0, scene)};
  Claims(figure, "", &Claim::set_up)
      .between("the picture shows the chosen tick: its time", trace.time_s[tick], kInstant_5_9_s,
               kInstant_5_9_s, "s");
  Claims(figure).between(
      "the proxy stays at the boundary of the forbidden region: distance of its centre to the nearest "
      "point, minus r_f",
      trace.nearest_distance_m[tick], kShell_5_9_m[0], kShell_5_9_m[1], "m", "r_1 to r_2");
  return figure;
}

Figure figure_4_11(FigureContext& context) {
  const Trace trace = context.run("fig4.11");
  // A budget of one step per tick shows, in the tick of the jump, where the first step leads.
  const Trace single = context.run("fig4.11", {"renderer.steps_per_tick=1"});
  const std::size_t jump = jump_tick(trace);
  const auto presses = [&](std::size_t i) { return i > jump && pressing(trace, i, kContactRadius_m); };
  const auto height_m = [&](std::size_t i) { return contact_point(trace, i, kContactRadius_m).y(); };
  const Numbers contact_m = values_where(trace.length(), presses, height_m);

  Figure figure{
      "4.11", "Flat point cloud",
      "A flat 100 x 100 grid. The HIP moves at 2 r_c per second along the plane, for 1 s above it, 3 s "
      "below and 1 s above. Bottom: the contact point sinks a little between the points."};
  figure.tables = {{"heights",
                    "height of HIP and proxy",
                    {{"time", "s", "simulated time", trace.time_s},
                     {"hip_y", "m", "height of the HIP", along(1, trace.hip_position_m)},
                     {"proxy_y", "m", "height of the proxy's centre", along(1, trace.proxy_position_m)}}},
                   {"contact",
                    "height of the contact point",
                    {{"time", "s", "simulated time", where(trace.time_s, presses)},
                     {"contact_y", "m", "height of the contact point", contact_m}}}};
  figure.panels = {plot("Height of HIP and proxy", "time (s)", "y (m)",
                        {{"heights", "time", "hip_y", CurveStyle::dashed, "HIP"},
                         {"heights", "time", "proxy_y", CurveStyle::line, "proxy"}}),
                   plot("Height of the contact point", "time (s)", "y (m)",
                        {{"contact", "time", "contact_y", CurveStyle::line, ""}},
                        {.x_range = {{0, trace.time_s.back()}}})};
  figure.panels[0].x_range = figure.panels[1].x_range;
  const Claims claims(figure);
  claims.between("the contact point ripples over the points of the flat grid: height from peak to peak",
                 max_of(contact_m) - min_of(contact_m), 4.0e-5, 5.7e-5, "m", "5e-5");
  claims.at_most(
      "the proxy reaches the surface in the tick in which the HIP jumps: its distance from contact at "
      "the end of that tick",
      std::abs(trace.nearest_distance_m[jump] - kContactRadius_m), kShell_m, "m", "0");
  claims.at_most(
      "with one step per tick the proxy reaches the surface in the tick in which the HIP jumps: its "
      "distance from contact at the end of that tick",
      std::abs(single.nearest_distance_m[jump] - kContactRadius_m), kShell_m, "m", "1 - 2 steps");
  claims.between("the proxy reaches the surface in 1 to 2 steps after the HIP jumps: number of steps",
                 steps_to_contact(single), 1, 2, "steps", "1 - 2");
  return figure;
}

// Fig 4.14: sharp corners, against what a ball of radius r_c can reach.

namespace {

constexpr double kSampling_m = 1e-5;  // sampling of the exact profile; its corners are multiples of it

// The true profile and its closing with a ball of radius r_c, sampled from x = low on.
struct Oracle {
  double low;
  std::vector<double> heights, closing;

  Oracle(const Scenario& scenario, double from, double to) : low(from) {
    for (int i = 0; from + i * kSampling_m <= to; ++i)
      heights.push_back(scenario.surface_height(from + i * kSampling_m, 0, 0));
    closing = ball_closing(heights, kSampling_m, kContactRadius_m);
  }
  double at(double x) const {
    const double place = (x - low) / kSampling_m;
    const auto i = static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(closing.size() - 2)));
    return closing[i] + (place - static_cast<double>(i)) * (closing[i + 1] - closing[i]);
  }
};

// Returns the contact points with x in [from, to], in the ticks in which the surface holds the HIP back.
Table contact_table(const Trace& trace, const Oracle& oracle, double from, double to) {
  std::vector<Vec3> contact;
  Numbers error, shell;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    const Vec3 p = contact_point(trace, i, kContactRadius_m);
    if (!pressing(trace, i, kContactRadius_m) || p.x() < from || p.x() > to) continue;
    contact.push_back(p);
    error.push_back(p.y() - oracle.at(p.x()));
    shell.push_back(trace.nearest_distance_m[i] - kContactRadius_m);
  }
  return {"contact",
          "contact point",
          {{"x", "m", "position of the contact point", along(0, contact)},
           {"y", "m", "height of the contact point", along(1, contact)},
           {"error", "m", "height over the exact closing with a ball of r_c", error},
           {"shell", "m", "distance of the nearest point less r_c", shell}}};
}

Table profile_table(const Oracle& oracle) {
  const auto x = [&](std::size_t i) { return oracle.low + static_cast<double>(i) * kSampling_m; };
  return every(20, {"profile",
                    "exact profile and its closing",
                    {{"x", "m", "position", each_of(oracle.heights.size(), x)},
                     {"surface_y", "m", "true height", oracle.heights},
                     {"closing_y", "m", "height that a ball of r_c can reach", oracle.closing}}});
}

// Returns the points of the grid row under the path.
Table row_table(const PointCloud& cloud, double path_z) {
  const auto is_under = [&](std::size_t i) { return std::abs(cloud.z[i] - path_z) < 1e-6; };
  return {"points",
          "one row of the grid",
          {{"x", "m", "position", where(cloud.x, is_under)}, {"y", "m", "height", where(cloud.y, is_under)}}};
}

// Returns the position of the proxy when it is nearest to valley_x, the last full valley.
Table valley_table(const Trace& trace, double valley_x) {
  const auto aside_m = [&](const Vec3& p) { return std::abs(p.x() - valley_x); };
  const Vec3& ball = *std::ranges::min_element(trace.proxy_position_m, {}, aside_m);
  return {"ball",
          "the proxy in a valley",
          {{"x", "m", "position", Numbers{ball.x()}}, {"y", "m", "height", Numbers{ball.y()}}}};
}

}  // namespace

Figure figure_4_14(FigureContext& context) {
  const Experiment experiment = Experiment::load("fig4.14");
  const auto scenario = experiment.build_scenario(kernels_for(Isa::x86_64));
  const Trace trace = context.run(experiment);
  constexpr double kFrom = -0.2, kTo = 0.2;  // the ends of the grid have no neighbours on one side
  const Oracle oracle(*scenario, -0.22, 0.22);
  const Table contact = contact_table(trace, oracle, kFrom, kTo);
  Figure figure{
      "4.14", "Sharp corners",
      "A 300 x 100 cloud shaped as a triangle wave of growing amplitude. Top: the points as a "
      "surface. Middle: a cross-section of the wave and the contact point. Bottom: a part of it, "
      "with the points and the proxy, a ball of radius r_c. Convex corners are rendered sharp; in a "
      "valley the proxy rests on both flanks."};
  const PointCloud cloud = scenario->cloud(0);
  figure.tables = {contact,
                   profile_table(oracle),
                   {"surface",
                    "the points",
                    {{"x", "m", "x of the point", cloud.x},
                     {"y", "m", "height, y", cloud.y},
                     {"z", "m", "z of the point", cloud.z}}},
                   row_table(cloud, trace.hip_position_m[0].z()),
                   valley_table(trace, 0.135)};
  const Curve points{"points", "x", "y", CurveStyle::dots, "points"};
  const Curve line{"contact", "x", "y", CurveStyle::line, "contact point"};
  figure.panels = {
      plot("The point cloud, x, y and z equally scaled", "x (m)", "z (m)",
           {{"surface", "x", "z", CurveStyle::surface, "", 0, "y"}}),
      plot("The whole wave", "x (m)", "y (m)",
           {{"profile", "x", "surface_y", CurveStyle::dashed, "surface"}, line}),
      plot("A part of it", "x (m)", "y (m)",
           {points,
            line,
            {"ball", "x", "y", CurveStyle::circle, "proxy, a ball of radius r_c", kContactRadius_m}},
           {.x_range = {{0.095, 0.175}}, .y_range = {{-0.014, 0.015}}, .equal_aspect = true})};
  const Claims claims(figure);
  const Numbers& error = numbers(contact, "error");
  claims.at_most("the contact point follows the exact closing of the wave with a ball of r_c: rms distance",
                 rms(error), 1e-4, "m", "very well");
  claims.at_most(
      "the contact point follows the exact closing of the wave with a ball of r_c: largest distance",
      max_of(magnitudes(error)), 5e-4, "m");
  claims.at_most("the nearest point is r_c from the proxy: largest difference",
                 max_of(magnitudes(numbers(contact, "shell"))), 2e-5, "m", "1e-5");
  return figure;
}

}  // namespace remote_touch
