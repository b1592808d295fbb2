// Step 2 of 5.2: "use some method for assigning values of r_f,i and k_s,i to each point". A rule selects
// points of a frame and assigns values to them; a FixtureAssignment applies rules in order.
#pragma once

#include <string>
#include <vector>

#include "core/geometry/point_cloud.h"
#include "core/parameters/parameter.h"

namespace remote_touch {

// The effect of a rule: it keeps the tool away from its points, or guides the tool to them.
enum class FixtureRole { forbidden, guidance };

// The values that a rule assigns to the points that it selects, and the schedule of its strength. The members
// have another meaning in a guidance rule, which leaves r_f and k_s unchanged. Its points define a target,
// see GuidanceTarget. Its radius is the distance at which the goal counts as reached. Its stiffness is that
// of the spring (-1: that of GuidanceSettings).
struct FixtureValues {
  double radius_m = 0.02;         // r_f of (5.2); -1: not changed
  double stiffness_N_per_m = -1;  // k_s of (5.3); -1: not changed
  // Rows of time in seconds and strength in [0, 1]. The strength is linear between rows, jumps where two rows
  // have the same time, and is constant before the first row and after the last. Empty: always 1.
  std::vector<double> schedule{};
  FixtureRole role = FixtureRole::forbidden;
  std::string label{};  // name of the rule in a sequence
};

Parameters parameters(FixtureValues& v);
std::string validate(const FixtureValues& v);

class FixtureRule {
 public:
  explicit FixtureRule(const FixtureValues& values) : values_(values) {}
  virtual ~FixtureRule() = default;

  // Throws InputError if the frame lacks data that the rule needs: colours, or an image.
  virtual void require(const PointCloud& /*cloud*/) const {}
  // Returns the weight of the rule for each point, from 0 (no effect) to 1; 0 for a point that was not
  // measured. Throws as require().
  virtual std::vector<double> weights(const PointCloud& cloud) const = 0;

  const FixtureValues& values() const { return values_; }
  // Returns the value of the schedule, which locks, unlocks and fades the rule as a whole.
  double strength(double time_s) const;
  bool changes_with_time() const;

 private:
  FixtureValues values_;
};

}  // namespace remote_touch
