// From a frame to its columns of r_f and k_s, (5.2) and (5.3).
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/cloud/point_cloud.h"
#include "core/virtual_fixtures/fixture_rule.h"
#include "core/virtual_fixtures/fixture_switches.h"
#include "core/virtual_fixtures/guidance_target.h"
#include "core/virtual_fixtures/hue_range.h"

namespace remote_touch {

class FixtureAssignment {
 public:
  FixtureAssignment() = default;
  // switches: forbidden rules that are off are skipped; null: all are on.
  explicit FixtureAssignment(std::vector<std::unique_ptr<const FixtureRule>> rules,
                             std::shared_ptr<const FixtureSwitches> switches = nullptr)
      : rules_(std::move(rules)), switches_(std::move(switches)) {}

  // Throws InputError when the cloud lacks what a rule needs, also one that is off or of strength 0.
  void require(const PointCloud& cloud) const;

  // Fills the columns of the cloud. They start with the cloud's own values; without a column r_f is 0 and k_s
  // the renderer's own. Then each forbidden rule in turn moves the values of its points towards its own, by
  // its weight for the point times its strength at captured_s, so a later rule overrides an earlier one. A
  // point without its own stiffness takes the rule's at once. Without rules nothing is changed. Throws
  // InputError as FixtureRule::weights().
  void assign(PointCloud& cloud, double captured_s) const { assign(cloud, captured_s, off()); }
  // The same with these forbidden rules off, as off() returned them earlier.
  void assign(PointCloud& cloud, double captured_s, std::uint64_t off) const;
  std::uint64_t off() const { return switches_ ? switches_->off() : 0; }

  // What assign() does, as numbers that an OpenCL device can apply: where every rule is a HueRange in the
  // role forbidden. None: there is another rule, or no rule at all.
  std::optional<HueSteps> hue_steps(double captured_s, std::uint64_t off) const;

  // The targets of all guidance rules in their order, each with the rule's strength; at strength 0 it is not
  // visible. Throws as assign().
  std::vector<GuidanceTarget> targets(const PointCloud& cloud, double captured_s) const;

  // The numbers of the rules that select no point of the cloud: all its weights are 0. Throws as assign().
  std::vector<std::size_t> without_points(const PointCloud& cloud) const;

  bool empty() const { return rules_.empty(); }
  // Two frames of the same cloud can get different values.
  bool changes_with_time() const;

 private:
  std::vector<std::unique_ptr<const FixtureRule>> rules_;
  std::shared_ptr<const FixtureSwitches> switches_;
};

}  // namespace remote_touch
