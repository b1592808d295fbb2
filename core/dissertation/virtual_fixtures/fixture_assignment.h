// Assigns r_f and k_s to the points of a frame, (5.2) and (5.3).
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/points/point_cloud.h"
#include "core/rendering/guidance_target.h"

namespace remote_touch {

// Switches that lock and unlock fixtures while a task runs.

// A fixture is identified by its index in the list of rules. The switches are set in the haptic loop and read
// where frames are processed. A change has an effect from the next processed frame on.
class FixtureSwitches {
 public:
  static constexpr std::size_t kMaxCount = 64;

  // One bit for each fixture, set if it is off.
  std::uint64_t off() const { return off_.load(std::memory_order_relaxed); }
  static bool is_on(std::uint64_t off, std::size_t fixture) {
    return fixture >= kMaxCount || (off >> fixture & 1) == 0;
  }
  bool is_on(std::size_t fixture) const { return is_on(off(), fixture); }
  // pre: below kMaxCount
  void set(std::size_t fixture, bool on) {
    const std::uint64_t bit = std::uint64_t{1} << fixture;
    if (on)
      off_.fetch_and(~bit, std::memory_order_relaxed);
    else
      off_.fetch_or(bit, std::memory_order_relaxed);
  }

 private:
  std::atomic<std::uint64_t> off_ = 0;
};

class FixtureAssignment {
 public:
  FixtureAssignment() = default;
  // switches: forbidden rules that are off are skipped; null: all are on. own_stiffness_N_per_m: k_s of the
  // renderer, which points without a stiffness have; NaN: not known.
  explicit FixtureAssignment(std::vector<std::unique_ptr<const FixtureRule>> rules,
                             std::shared_ptr<const FixtureSwitches> switches = nullptr,
                             double own_stiffness_N_per_m = std::numeric_limits<double>::quiet_NaN())
      : rules_(std::move(rules)),
        switches_(std::move(switches)),
        own_stiffness_N_per_m_(own_stiffness_N_per_m) {}

  // Throws InputError if the cloud lacks data that a rule needs, even if that rule is off or has strength 0.
  void require(const PointCloud& cloud) const;

  // Writes the columns of r_f and k_s. They start with the cloud's own values; if the cloud lacks a column,
  // r_f starts at 0 and k_s at the renderer's own. Then each forbidden rule in turn changes the values of the
  // points that it selects: it interpolates between the present value and its own by the weight of the point
  // times the strength of the rule at captured_s. So a later rule overrides an earlier one. If the renderer's
  // own stiffness is not known, a point that has none yet receives that of the rule at once. If there are no
  // rules, the cloud is not changed. Throws InputError like FixtureRule::weights().
  void assign(PointCloud& cloud, double captured_s) const { assign(cloud, captured_s, off()); }
  // Does the same with these forbidden rules off, as off() returned them earlier.
  void assign(PointCloud& cloud, double captured_s, std::uint64_t off) const;
  std::uint64_t off() const { return switches_ ? switches_->off() : 0; }

  // Returns the work of assign() as numbers that an OpenCL device can apply. Returns nullopt if there are no
  // rules, or if a rule is not a HueRange or not in the role forbidden.
  std::optional<HueSteps> hue_steps(double captured_s, std::uint64_t off) const;

  // Returns the targets of all guidance rules in their order, each with the strength of its rule. A target of
  // strength 0 is not visible. Throws as assign().
  std::vector<GuidanceTarget> targets(const PointCloud& cloud, double captured_s) const;

  // Returns the indices of the rules that select no point of the cloud: all their weights are 0. Throws as
  // assign().
  std::vector<std::size_t> rules_without_points(const PointCloud& cloud) const;

  bool empty() const { return rules_.empty(); }
  // True if two frames of the same cloud can get different values.
  bool changes_with_time() const;

 private:
  std::vector<std::unique_ptr<const FixtureRule>> rules_;
  std::shared_ptr<const FixtureSwitches> switches_;
  double own_stiffness_N_per_m_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace remote_touch
