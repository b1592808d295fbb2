#include "runners/evaluation/verification/relation_variations.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <utility>

#include "core/kernels/isa.h"

namespace remote_touch::vary {

namespace {

// True if the renderer needs the images of the clouds, which a search by grid removes.
bool needs_its_images(const Variation& run) {
  return run.contact_model.uses_camera &&
         std::any_of(run.scene.views.begin(), run.scene.views.end(),
                     [](const CloudView& view) { return view.cloud.image.has_value(); });
}

// False if a cloud has the column already.
bool add_column(Variation& run, std::vector<double> PointCloud::*column, double value) {
  for (CloudView& view : run.scene.views) {
    if (!(view.cloud.*column).empty()) return false;
    (view.cloud.*column).assign(view.cloud.size(), value);
  }
  return true;
}

bool soften(Variation& run) {
  change_units(run, {1, 1, 0.5});
  return true;
}

// True for a renderer that measures how the points move from frame to frame, as a sheet does.
bool tracks_frames(const Variation& run) {
  return run.contact_model.depends_on_axes && !run.contact_model.uses_camera;
}

bool points_are_stiff(const Variation& run) {
  return !run.scene.views.front().cloud.stiffness_N_per_m.empty();
}

constexpr int kTicksAfter = 16;  // half way to the next view

// Expects that the first tick at or after the arrival of each of these views reports a dropped frame.
void expect_dropped(Variation& run, const std::vector<std::size_t>& views) {
  for (const std::size_t view : views) {
    std::size_t tick = 0;
    while (tick < run.expected.size() && run.scene.time_s(tick) < run.scene.views[view].arrives_s) ++tick;
    if (tick == run.expected.size()) return;
    run.expected[tick].status = std::max(run.expected[tick].status, RenderStatus::stale_frame_dropped);
  }
}

// Returns a view that must not be used. Its index and its points differ from those of every real view, so
// that its use would change the outputs.
CloudView stale(CloudView view, double captured_s, double shift_m) {
  view.index += 1000;
  view.captured_s = captured_s;
  view.cloud.image.reset();
  for (double& x : view.cloud.x) x += shift_m;
  for (double& y : view.cloud.y) y -= shift_m;
  return view;
}

// Each view is followed by itself, captured again half a period later. It keeps its index, because it is the
// same view.
void send_more_often(Variation& run, std::size_t first) {
  const double period_s = kTicksAfter / run.scene.haptic_rate_hz;
  follow_views(run, first, kTicksAfter, [=](CloudView view, const CloudView&) {
    view.captured_s += period_s;
    return view;
  });
}

}  // namespace

bool repeat(Variation&) {
  return true;
}

bool other_instructions(Variation& run) {
  const bool oldest = std::string(run.kernels->isa) == kernels_for(Isa::x86_64).isa;
  run.kernels = &kernels_for(oldest ? best_isa() : Isa::x86_64);
  return true;
}

// --- the points ---

bool search_all_points(Variation& run) {
  if (needs_its_images(run)) return false;
  replace_search(run, 0);
  return true;
}

bool use_other_grid(Variation& run) {
  if (needs_its_images(run)) return false;
  replace_search(run, 2.7 * run.scene.cell_m);
  return true;
}

bool shuffle(Variation& run) {
  if (run.contact_model.depends_on_point_order || needs_its_images(run)) return false;
  replace_search(run, 0);
  reorder(run, [](int size) {
    std::vector<int> order(static_cast<std::size_t>(size));
    std::iota(order.begin(), order.end(), 0);
    std::mt19937 random(1);  // its numbers are the same everywhere; those of std::shuffle are not
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random() % i]);
    return order;
  });
  return true;
}

bool add_missing(Variation& run) {
  if (run.contact_model.depends_on_point_order || needs_its_images(run)) return false;
  replace_search(run, run.scene.cell_m);
  reorder(run, [](int size) {
    std::vector<int> order{-1};
    for (int i = 0; i < size; ++i) {
      order.push_back(i);
      if (i % 7 == 3) order.push_back(-1);
    }
    return order;
  });
  return true;
}

bool add_far(Variation& run) {
  if (needs_its_images(run)) return false;
  constexpr double kSceneRadius_m = 0.5, kReaches = 10;
  const Vec3 middle = run.scene.hip_W.front();
  const double distance = kSceneRadius_m + kReaches * run.reach_m;
  std::vector<Vec3> points;
  for (int i = 0; i < 27; ++i) {
    const int x = i % 3 - 1, y = i / 3 % 3 - 1, z = i / 9 - 1;
    if (i != 13) points.push_back(middle + distance * Vec3(x, y, z));
  }
  replace_search(run, run.scene.cell_m);
  add_points(run, points);
  return true;
}

bool add_radius_column(Variation& run) {
  return add_column(run, &PointCloud::fixture_radius_m, 0);
}

// A point whose stiffness is NaN has the stiffness of the renderer.
bool add_empty_stiffness_column(Variation& run) {
  return add_column(run, &PointCloud::stiffness_N_per_m, std::numeric_limits<double>::quiet_NaN());
}

bool add_stiffness_column(Variation& run) {
  return run.stiffness_N_per_m && add_column(run, &PointCloud::stiffness_N_per_m, *run.stiffness_N_per_m);
}

// --- space, time and force ---

bool mirror_axis(Variation& run, int axis) {
  if (run.contact_model.depends_on_axes || !run.can_be_mirrored) return false;
  remote_touch::mirror(run, axis);
  return true;
}

// A method that needs the direction to the sensor can be moved together with its camera.
bool move(Variation& run) {
  if (run.contact_model.depends_on_axes && !needs_its_images(run)) return false;
  RigidTransform motion = RigidTransform::Identity();
  motion.linear() = Eigen::Quaterniond(0.6, 0.3, -0.5, 0.4).normalized().toRotationMatrix();
  motion.translation() = Vec3(0.31, -0.42, 0.27);
  move_rigidly(run, motion);
  return true;
}

bool speed_up(Variation& run) {
  change_units(run, {1, 0.5, 1});
  return true;
}

bool change_renderer_only(Variation& run) {
  if (!points_are_stiff(run) || !run.stiffness_N_per_m) return false;
  run.other_stiffness_N_per_m = 0.5 * *run.stiffness_N_per_m;
  return true;
}

bool soften_renderer(Variation& run) {
  return !points_are_stiff(run) && soften(run);
}

bool soften_points(Variation& run) {
  return points_are_stiff(run) && soften(run);
}

bool start_later(Variation& run) {
  constexpr double kLater_s = 1024;
  run.scene.start_s += kLater_s;
  for (CloudView& view : run.scene.views) view.captured_s += kLater_s, view.arrives_s += kLater_s;
  return true;
}

// --- the stream ---

bool send_twice(Variation& run) {
  const double shift_m = run.reach_m;
  expect_dropped(run, follow_views(run, 0, kTicksAfter, [=](const CloudView& view, const CloudView&) {
                   return stale(view, view.captured_s, shift_m);
                 }));
  return true;
}

bool send_late(Variation& run) {
  const double shift_m = run.reach_m;
  expect_dropped(run,
                 follow_views(run, 1, kTicksAfter, [=](const CloudView& view, const CloudView& previous) {
                   return stale(previous, 0.5 * (previous.captured_s + view.captured_s), shift_m);
                 }));
  return true;
}

// A step to the side over bumps has a component along the normal, which (4.13) interprets as a motion of the
// cloud.
bool double_rate(Variation& run) {
  if (tracks_frames(run)) return false;
  if (!run.scene.cloud_rests || run.scene.hip_rests) return false;
  send_more_often(run, 0);
  run.until_velocity = true;
  return true;
}

bool double_rate_at_rest(Variation& run) {
  if (tracks_frames(run)) return false;
  if (!run.scene.cloud_rests || !run.scene.hip_rests) return false;
  send_more_often(run, 1);
  return true;
}

}  // namespace remote_touch::vary
