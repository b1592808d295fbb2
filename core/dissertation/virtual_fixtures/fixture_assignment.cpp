#include "core/dissertation/virtual_fixtures/fixture_assignment.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/parameters/input_error.h"

namespace remote_touch {
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
      if (std::none_of(weights.begin(), weights.end(), [](double weight) { return weight > 0; }))
        numbers.push_back(i);
    });
  return numbers;
}

bool FixtureAssignment::changes_with_time() const {
  return switches_ || std::any_of(rules_.begin(), rules_.end(),
                                  [](const auto& rule) { return rule->changes_with_time(); });
}

}  // namespace remote_touch
