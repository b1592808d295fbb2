// The second task on recorded images: an organ model is forbidden, a yellow dragon is where guidance leads.
#include <cmath>
#include <limits>

#include "analysis/measures/interval_estimates.h"
#include "analysis/trace/column.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/parts/figure_pictures.h"
#include "runners/evaluation/figures/valve_task.h"

namespace remote_touch {

namespace {

constexpr double kOrganRegion_m = 0.02;
constexpr double kButtonPressed_s = 3, kButtonPushed_s = 2.8;
constexpr std::size_t kClearanceStride = 20;  // ticks from one measurement of the clearance to the next

// Frames as the renderer receives them: filtered and with their regions. The newest one is kept, because many
// ticks use the same frame. The recording is played to and fro.
class RegionFrames {
 public:
  RegionFrames(const Experiment& experiment, const Kernels& kernels)
      : scenario_(experiment.build_scenario(kernels)), processing_(experiment.build_processing(kernels)) {}

  const PointCloud& of(int frame) {
    if (frame == frame_) return cloud_;
    frame_ = frame;
    cloud_ = scenario_->cloud(frame);
    if (processing_.depth) processing_.depth->process(cloud_);
    processing_.fixtures.assign(cloud_, scenario_->captured_s(frame));
    return cloud_;
  }

 private:
  std::unique_ptr<Scenario> scenario_;
  FrameProcessing processing_;
  int frame_ = -1;
  PointCloud cloud_;
};

// Returns the smallest distance of the tool's vertices to the points with a region in the frame in use, over
// every 20th tick, if the tool touches in it. NaN if it touches in none of them.
double min_point_distance_m(const ValveTask& task, const Kernels& kernels) {
  RegionFrames frames(task.experiment, kernels);
  const Trace& t = task.trace;
  double min = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < t.length(); i += kClearanceStride) {
    if (t.contact_count[i] == 0) continue;
    const PointCloud& cloud = frames.of(t.frame_index[i]);
    for (std::size_t k = 0; k < cloud.size(); ++k) {
      if (!(cloud.fixture_radius_m[k] > 0)) continue;
      const Vec3 p_W = cloud.point(k);
      if (!((p_W - t.proxy_position_m[i]).norm() < task.tool->reach_m + min)) continue;
      const Vec3 p_T = t.tool_orientation[i].conjugate() * (p_W - t.proxy_position_m[i]);
      for (const Vec3& vertex : task.tool->mesh.vertices) min = min_or_nan(min, (vertex - p_T).norm());
    }
  }
  return std::isinf(min) ? kNoValue : min;
}

// Returns the largest distance of a goal of guidance from the first one; NaN if guidance is never active.
double goal_wander_m(const Trace& t) {
  std::vector<Vec3> goals;
  for (std::size_t i = 0; i < t.length(); ++i)
    if (t.guidance_active[i]) goals.push_back(t.guidance_goal_m[i]);
  std::vector<double> distances_m;
  for (const Vec3& goal : goals) distances_m.push_back((goal - goals.front()).norm());
  return max_of(distances_m);
}

void add_claims(Figure& figure, const ValveTask& task, const Kernels& kernels) {
  const Trace& t = task.trace;
  const Claims claims(figure), checks(figure, "", &Claim::set_up);
  claims.at_least("the region of the organ pushes the tool back: force",
                  t.force_N[tick_of(t, kButtonPushed_s)].norm(), 1, "N");
  claims.at_least(
      "the tool stays out of the regions of 20 mm while it touches: smallest distance of a vertex of "
      "its mesh to a point with a region",
      min_point_distance_m(task, kernels), kOrganRegion_m - 1e-3, "m");
  claims.at_most("the goal hardly moves while the camera rests: largest distance", goal_wander_m(t), 0.002,
                 "m");
  const std::vector<SequenceEntry> log = sequence_log(t);
  claims.at_most("the task misses no step: number of missed steps", t.sequence_missed.back(), 0, "steps");
  claims.between("the task has ended: steps that are done or missed at the end", t.sequence_step.back(), 1, 1,
                 "steps");
  add_task_claims(figure, task);
  checks.between("guidance is activated when the button is pressed: time", log.empty() ? 0 : log[0].began_s,
                 kButtonPressed_s, kButtonPressed_s + 1e-9, "s");
}

// Returns the points nearer than the wall behind, from every second pixel of every second row.
std::vector<std::size_t> cloud_samples(const PointCloud& cloud) {
  const auto width = static_cast<std::size_t>(cloud.image->camera.width);
  return chosen_points(cloud, [&](std::size_t i) {
    return cloud.z[i] < 0.9 && std::abs(cloud.x[i]) < 0.3 && i % 2 == 0 && i / width % 2 == 0;
  });
}

void add_pictures(Figure& figure, const Kernels& kernels, const ValveTask& task) {
  const Trace& t = task.trace;
  const std::string name = task.name;
  const PointCloud cloud = processed_cloud(task.experiment, kernels, 0);
  figure.tables.push_back(
      cloud_table(name + "_cloud", "points of the first frame", cloud, cloud_samples(cloud)));
  add_tool_tables(figure, name, task.tool->mesh, t, {tick_of(t, kButtonPushed_s), t.length() - 1});
  const Scene scene{{-0.28, -0.38, 0.12}, {0.1, 0, 0.5}, -Vec3::UnitY(), 0.5, 0.8, {}};
  for (std::size_t instant = 0; instant < 2; ++instant) {
    Scene seen = scene;
    seen.parts = tool_in_cloud(name, instant, 0.003);
    figure.panels.push_back(scene_panel(instant == 0 ? "Pushed towards the organ" : "At the dragon",
                                        static_cast<int>(instant), 1, seen));
  }
}

}  // namespace

Figure figure_7_5_recorded(FigureContext& context) {
  const std::vector<ValveTask> tasks = run_tasks(context, {{"desk", "recorded desk", "fig7.5-recorded"}});
  const ValveTask& task = tasks[0];
  Figure figure{
      "7.5-recorded", "Forbidden and guiding colours in recorded images",
      "Five frames of a camera at rest, played to and fro at 10 Hz. Points with the organ's colour have "
      "regions of 20 mm; yellow points define the goal. A simulated operator pushes a valve key towards the "
      "organ, presses the button at 3 s and relaxes. Hand, device and tool are simulated; the images are "
      "real."};
  figure.tables.push_back(task_table(task));
  figure.tables.push_back(sequence_table(task));
  figure.panels = {plot("Force", "time (s)", "force (N)",
                        {{task.name, "time", "force", CurveStyle::line, ""}}, {{{0, 0}}}),
                   plot("Torque", "time (s)", "torque (N m)",
                        {{task.name, "time", "torque", CurveStyle::line, ""}}, {{{1, 0}}})};
  add_pictures(figure, context.kernels(), task);
  add_claims(figure, task, context.kernels());
  return figure;
}

}  // namespace remote_touch
