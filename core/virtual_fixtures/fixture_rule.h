// Step 2 of 5.2: "use some method for assigning values of r_f,i and k_s,i to each point". A rule picks points
// of a frame and says what they get; rules follow each other in a FixtureAssignment.
#pragma once

#include <string>
#include <vector>

#include "core/cloud/point_cloud.h"
#include "core/parameters/parameter.h"

namespace remote_touch {

// What its points are for: to be kept away from, or to be led to.
enum class FixtureRole { forbidden, guidance };

// What every rule gives to the points that it picks, and when. A guidance rule leaves r_f and k_s as they
// are: its points tell a target, see GuidanceTarget; its radius is how near to the goal counts as there, its
// stiffness that of the spring (-1: that of GuidanceSettings).
struct FixtureValues {
  double radius_m = 0.02;         // r_f of (5.2); -1: left as it is
  double stiffness_N_per_m = -1;  // k_s of (5.3); -1: left as it is
  // Rows of time in seconds and strength in [0, 1]: even change between them, a jump where two have the same
  // time, the first before all, the last after all. Empty: always 1.
  std::vector<double> schedule{};
  FixtureRole role = FixtureRole::forbidden;
  std::string label{};  // by which a sequence names it
};

Parameters parameters(FixtureValues& v);
std::string validate(const FixtureValues& v);

class FixtureRule {
 public:
  explicit FixtureRule(const FixtureValues& values) : values_(values) {}
  virtual ~FixtureRule() = default;

  // How far the rule counts for each point, from 0, not at all, to 1; 0 for a point that was not measured.
  // Throws InputError when the frame lacks what the rule needs: colours, or an image.
  virtual std::vector<double> weights(const PointCloud& cloud) const = 0;

  const FixtureValues& values() const { return values_; }
  // Of the schedule; locks, unlocks and fades the rule as a whole.
  double strength(double time_s) const;
  bool changes_with_time() const;

 private:
  FixtureValues values_;
};

}  // namespace remote_touch
