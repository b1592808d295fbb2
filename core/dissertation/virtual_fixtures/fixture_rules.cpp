#include "core/dissertation/virtual_fixtures/fixture_rules.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/parameters/parameter.h"
#include "core/points/point_cloud.h"

namespace remote_touch {

Parameters parameters(FixtureValues& v) {
  return {
      {"radius_m", &v.radius_m, -1, 1,
       "radius r_f of the forbidden regions around the points (5.2); -1: do not change"},
      {"stiffness_N_per_m", &v.stiffness_N_per_m, -1, 10000,
       "stiffness k_s of the points (5.3); -1: do not change (default: stiffness of the renderer)"},
      {"schedule", Rows{{"time_s", "strength"}, &v.schedule}, 0, 86400,
       "strength of the rule, 0 to 1, over the time of capture; linear between rows; no rows: always 1"},
      {"role", choice(v.role, {"forbidden", "guidance"}), 0, 0,
       "forbidden: keep the tool away from the points; guidance: pull the hand towards their mean (radius_m: distance at which the goal is reached; stiffness_N_per_m: of the spring)"},
      {"label", &v.label, 0, 0, "name of the rule for the steps of a sequence"},
  };
}

std::string validate(const FixtureValues& v) {
  if (v.radius_m < 0 && v.radius_m != -1)
    return "radius_m = " + std::to_string(v.radius_m) + ": expected 0 or more, or -1";
  if (v.stiffness_N_per_m < 0 && v.stiffness_N_per_m != -1)
    return "stiffness_N_per_m = " + std::to_string(v.stiffness_N_per_m) + ": expected 0 or more, or -1";
  if (v.role == FixtureRole::guidance && v.radius_m <= 0)
    return "radius_m = " + std::to_string(v.radius_m) + ": expected above 0 for role = guidance";
  return validate_schedule(v.schedule, "schedule", "strength");
}

double FixtureRule::strength(double time_s) const {
  return scheduled(values_.schedule, time_s);
}

bool FixtureRule::changes_with_time() const {
  for (std::size_t i = 1; i < values_.schedule.size(); i += 2)
    if (values_.schedule[i] != values_.schedule[1]) return true;
  return false;
}

Parameters parameters(Everywhere::Settings& s) {
  return parameters(s.values);
}

std::string validate(const Everywhere::Settings& s) {
  return validate(s.values);
}

std::vector<double> Everywhere::weights(const PointCloud& cloud) const {
  std::vector<double> weights(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) weights[i] = cloud.point(i).allFinite() ? 1 : 0;
  return weights;
}

Parameters parameters(HalfSpace::Settings& s) {
  const Parameters own = {
      {"point_m", &s.point_m, -100, 100, "a point of the plane, world frame"},
      {"normal", &s.normal, -1e6, 1e6, "direction into the half-space; any length"},
      {"transition_m", &s.transition_m, 0, 100,
       "the weight of the rule rises linearly from 0 to 1 over this distance from the plane; 0: a step"},
  };
  return appended(parameters(s.values), own);
}

std::string validate(const HalfSpace::Settings& s) {
  if (!(s.normal.norm() > 1e-9)) return "normal: expected longer than 0";
  return validate(s.values);
}

HalfSpace::HalfSpace(const Settings& settings)
    : FixtureRule(settings.values),
      point_W_(settings.point_m),
      normal_W_(settings.normal.normalized()),
      transition_m_(settings.transition_m) {}

std::vector<double> HalfSpace::weights(const PointCloud& cloud) const {
  std::vector<double> weights(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double height = (cloud.point(i) - point_W_).dot(normal_W_);  // NaN fails every comparison
    const bool inside = height >= 0;
    weights[i] = !inside ? 0 : height < transition_m_ ? height / transition_m_ : 1;
  }
  return weights;
}

Parameters parameters(HueRange::Settings& s) {
  const Parameters own = {
      {"from_deg", &s.from_deg, 0, 360, "first hue: 0 red, 120 green, 240 blue"},
      {"to_deg", &s.to_deg, 0, 360, "last hue; below from_deg the range goes through 0"},
      {"min_saturation", &s.min_saturation, 0, 1, "minimum saturation; grey points have no hue"},
      {"min_lightness", &s.min_lightness, 0, 1, "minimum lightness; the hue of dark points is noise"},
      {"max_lightness", &s.max_lightness, 0, 1, "maximum lightness"},
  };
  return appended(parameters(s.values), own);
}

std::string validate(const HueRange::Settings& s) {
  if (s.min_lightness > s.max_lightness)
    return "min_lightness = " + std::to_string(s.min_lightness) +
           ": expected up to max_lightness = " + std::to_string(s.max_lightness);
  return validate(s.values);
}

bool HueRange::contains(std::uint32_t rgb) const {
  if (rgb == kNoColour) return false;
  const HueSaturationLightness colour = hue_saturation_lightness(rgb);
  if (colour.saturation < settings_.min_saturation || colour.lightness < settings_.min_lightness ||
      colour.lightness > settings_.max_lightness)
    return false;
  const bool above = colour.hue_deg >= settings_.from_deg, below = colour.hue_deg <= settings_.to_deg;
  return settings_.from_deg <= settings_.to_deg ? above && below : above || below;
}

void HueRange::require(const PointCloud& cloud) const {
  if (cloud.colour.empty() && cloud.size() > 0)
    throw InputError("hue-range", "the frame has no colours: expected coloured frames");
}

std::vector<double> HueRange::weights(const PointCloud& cloud) const {
  require(cloud);
  std::vector<double> weights(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    weights[i] = cloud.point(i).allFinite() && contains(cloud.colour[i]) ? 1 : 0;
  return weights;
}

Parameters parameters(NearPoint::Settings& s) {
  const Parameters own = {
      {"point_m", &s.point_m, -100, 100, "centre of the selection, world frame"},
      {"row", &s.row, -1, 4095, "image row of the centre of the selection; -1: use point_m"},
      {"column", &s.column, -1, 4095, "image column of the centre; -1: use point_m"},
      {"inner_radius_m", &s.inner_radius_m, 0, 100,
       "points within this distance of the centre have weight 1"},
      {"falloff_m", &s.falloff_m, 0, 100,
       "beyond inner_radius_m the weight falls linearly to 0 over this distance"},
  };
  return appended(parameters(s.values), own);
}

std::string validate(const NearPoint::Settings& s) {
  if ((s.row < 0) != (s.column < 0)) return "row and column: expected both 0 or more, or both -1";
  return validate(s.values);
}

namespace {

// Returns the point of the pixel that is nearest to (u, v) among those with a depth; NaN if there is none.
Vec3 nearest_measured(const PointCloud& cloud, const CameraIntrinsics& camera, int u, int v) {
  const auto seen = [&](int x, int y) { return cloud.point(static_cast<std::size_t>(y) * camera.width + x); };
  if (seen(u, v).allFinite()) return seen(u, v);
  Vec3 nearest = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  long long min = std::numeric_limits<long long>::max();
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const long long dx = x - u, dy = y - v, squared = dx * dx + dy * dy;
      if (squared < min && seen(x, y).allFinite()) nearest = seen(x, y), min = squared;
    }
  }
  return nearest;
}

}  // namespace

void NearPoint::require(const PointCloud& cloud) const {
  if (settings_.row < 0) return;
  if (!cloud.image)
    throw InputError("near-point: row, column",
                     "the frame is not an image: expected a scenario with a camera");
  const CameraIntrinsics& camera = cloud.image->camera;
  if (settings_.row >= camera.height || settings_.column >= camera.width)
    throw InputError("near-point: row, column", "expected below " + std::to_string(camera.height) + " and " +
                                                    std::to_string(camera.width));
}

Vec3 NearPoint::picked(const PointCloud& cloud) const {
  require(cloud);
  if (settings_.row < 0) return settings_.point_m;
  return nearest_measured(cloud, cloud.image->camera, settings_.column, settings_.row);
}

std::vector<double> NearPoint::weights(const PointCloud& cloud) const {
  const Vec3 centre = picked(cloud);
  std::vector<double> weights(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double beyond = (cloud.point(i) - centre).norm() - settings_.inner_radius_m;
    if (beyond <= 0)
      weights[i] = 1;
    else if (beyond < settings_.falloff_m)
      weights[i] = 1 - beyond / settings_.falloff_m;
  }
  return weights;
}

namespace {

// Interpolates between `from` (weight 0) and `to` (weight 1). A weight of 1 returns exactly `to`.
double drawn(double from, double to, double weight) {
  return weight == 1 ? to : from + weight * (to - from);
}

// Returns the stiffness from which a rule fades in where a point has none: the renderer's own, or that of the
// rule if the renderer's is not known.
double first_stiffness(double own_N_per_m, const FixtureValues& values) {
  return std::isnan(own_N_per_m) ? values.stiffness_N_per_m : own_N_per_m;
}

void apply(const FixtureRule& rule, double strength, double own_stiffness_N_per_m, PointCloud& cloud) {
  const FixtureValues& values = rule.values();
  const std::vector<double> weights = rule.weights(cloud);
  const bool stiff = values.stiffness_N_per_m >= 0;
  if (stiff && cloud.stiffness_N_per_m.empty())
    cloud.stiffness_N_per_m.assign(cloud.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double weight = weights[i] * strength;
    if (!(weight > 0)) continue;
    if (values.radius_m >= 0)
      cloud.fixture_radius_m[i] = drawn(cloud.fixture_radius_m[i], values.radius_m, weight);
    if (!stiff) continue;
    double& stiffness = cloud.stiffness_N_per_m[i];
    const double from = std::isnan(stiffness) ? first_stiffness(own_stiffness_N_per_m, values) : stiffness;
    stiffness = drawn(from, values.stiffness_N_per_m, weight);
  }
}

// Calls act(). If it throws an InputError, another one is thrown that names rule i.
template <class Act>
void about_rule(std::size_t i, const Act& act) {
  try {
    act();
  } catch (const InputError& error) {
    throw InputError("fixtures." + std::to_string(i), error.what());
  }
}

}  // namespace

void FixtureAssignment::require(const PointCloud& cloud) const {
  for (std::size_t i = 0; i < rules_.size(); ++i) about_rule(i, [&] { rules_[i]->require(cloud); });
}

void FixtureAssignment::assign(PointCloud& cloud, double captured_s, std::uint64_t off) const {
  if (empty()) return;
  if (cloud.fixture_radius_m.empty()) cloud.fixture_radius_m.assign(cloud.size(), 0);
  for (std::size_t i = 0; i < rules_.size(); ++i) {
    if (rules_[i]->values().role != FixtureRole::forbidden || !FixtureSwitches::is_on(off, i)) continue;
    about_rule(i, [&] { apply(*rules_[i], rules_[i]->strength(captured_s), own_stiffness_N_per_m_, cloud); });
  }
}

std::optional<HueSteps> FixtureAssignment::hue_steps(double captured_s, std::uint64_t off) const {
  if (empty()) return std::nullopt;
  HueSteps steps;
  for (std::size_t i = 0; i < rules_.size(); ++i) {
    const auto* const range = rules_[i]->as_hue_range();
    if (range == nullptr || range->values().role != FixtureRole::forbidden) return std::nullopt;
    if (FixtureSwitches::is_on(off, i))
      steps.push_back({range->settings(), range->strength(captured_s),
                       first_stiffness(own_stiffness_N_per_m_, range->values())});
  }
  return steps;
}

std::vector<GuidanceTarget> FixtureAssignment::targets(const PointCloud& cloud, double captured_s) const {
  std::vector<GuidanceTarget> all;
  for (std::size_t i = 0; i < rules_.size(); ++i) {
    if (rules_[i]->values().role != FixtureRole::guidance) continue;
    about_rule(i, [&] {
      const double strength = rules_[i]->strength(captured_s);
      all.push_back(strength > 0 ? guidance_target(cloud, rules_[i]->weights(cloud)) : GuidanceTarget{});
      all.back().strength = strength;
    });
  }
  return all;
}

std::vector<std::size_t> FixtureAssignment::rules_without_points(const PointCloud& cloud) const {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < rules_.size(); ++i)
    about_rule(i, [&] {
      const std::vector<double> weights = rules_[i]->weights(cloud);
      if (std::ranges::none_of(weights, [](double weight) { return weight > 0; })) numbers.push_back(i);
    });
  return numbers;
}

bool FixtureAssignment::changes_with_time() const {
  return switches_ || std::ranges::any_of(rules_, [](const auto& rule) { return rule->changes_with_time(); });
}

}  // namespace remote_touch
