// Rules that select the points of a frame: all, a half space, a range of hues, and a ball around a position.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/parameters/parameter.h"
#include "core/points/point_cloud.h"
#include "core/rendering/frames_and_outputs.h"

namespace remote_touch {

// Step 2 of 5.2: "use some method for assigning values of r_f,i and k_s,i to each point". A rule selects
// points of a frame and assigns values to them; a FixtureAssignment applies rules in order.

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

class HueRange;

class FixtureRule {
 public:
  explicit FixtureRule(const FixtureValues& values) : values_(values) {}
  virtual ~FixtureRule() = default;

  // Throws InputError if the frame lacks data that the rule needs: colours, or an image.
  virtual void require(const PointCloud& /*cloud*/) const {}
  // Returns the weight of the rule for each point, from 0 (no effect) to 1; 0 for a point that was not
  // measured. Throws as require().
  virtual std::vector<double> weights(const PointCloud& cloud) const = 0;

  // Returns the rule as one that an OpenCL device can apply; null if it is none.
  virtual const HueRange* as_hue_range() const { return nullptr; }

  const FixtureValues& values() const { return values_; }
  // Returns the value of the schedule, which locks, unlocks and fades the rule as a whole.
  double strength(double time_s) const;
  bool changes_with_time() const;

 private:
  FixtureValues values_;
};

// A rule that selects every measured point of a frame, as in 5.3.3.
class Everywhere final : public FixtureRule {
 public:
  struct Settings {
    FixtureValues values;
  };
  explicit Everywhere(const Settings& settings) : FixtureRule(settings.values) {}
  std::vector<double> weights(const PointCloud& cloud) const override;
};

Parameters parameters(Everywhere::Settings& s);
std::string validate(const Everywhere::Settings& s);

// A rule that selects the points on one side of a plane, as in 5.3.2.
class HalfSpace final : public FixtureRule {
 public:
  struct Settings {
    FixtureValues values;
    Vec3 point_m{0, 0, 0};
    Vec3 normal{1, 0, 0};
    double transition_m = 0;
  };
  explicit HalfSpace(const Settings& settings);
  // The plane itself belongs to the half-space. If transition_m is above 0, the weight rises linearly from 0
  // at the plane to 1 at that distance.
  std::vector<double> weights(const PointCloud& cloud) const override;

 private:
  Vec3 point_W_, normal_W_;
  double transition_m_;
};

Parameters parameters(HalfSpace::Settings& s);
std::string validate(const HalfSpace::Settings& s);

// A rule that selects points by their colour, 7.3.2: the hue marks objects to protect or to guide to.
class HueRange final : public FixtureRule {
 public:
  struct Settings {
    FixtureValues values;
    double from_deg = 340;
    double to_deg = 20;
    double min_saturation = 0.3;
    double min_lightness = 0.1;
    double max_lightness = 0.9;
  };
  explicit HueRange(const Settings& settings) : FixtureRule(settings.values), settings_(settings) {}
  // Throws InputError if the cloud has points but no colours.
  void require(const PointCloud& cloud) const override;
  std::vector<double> weights(const PointCloud& cloud) const override;
  const HueRange* as_hue_range() const override { return this; }
  const Settings& settings() const { return settings_; }

 private:
  bool contains(std::uint32_t rgb) const;

  const Settings settings_;
};

// A HueRange in the role forbidden, with its strength at one moment. A list of these, applied in order, gives
// the same columns of r_f and k_s as FixtureAssignment::assign().
struct HueStep {
  HueRange::Settings range;
  double strength = 1;
  double first_stiffness_N_per_m = 0;  // k_s from which the rule fades in at a point that has none
};
using HueSteps = std::vector<HueStep>;

Parameters parameters(HueRange::Settings& s);
std::string validate(const HueRange::Settings& s);

// A rule that selects the points around a centre: a position in the world, or the point that a pixel has in
// each frame.
class NearPoint final : public FixtureRule {
 public:
  struct Settings {
    FixtureValues values;
    Vec3 point_m{0, 0, 0};
    int row = -1;
    int column = -1;
    double inner_radius_m = 0.05;
    double falloff_m = 0;
  };
  explicit NearPoint(const Settings& settings) : FixtureRule(settings.values), settings_(settings) {}
  // Throws InputError if a pixel is set and the cloud is not an image that contains it.
  void require(const PointCloud& cloud) const override;
  // The weight is 1 up to inner_radius_m from the centre, and then falls linearly to 0 over falloff_m. If the
  // selected pixel has no depth, the nearest pixel (in the image) that has one replaces it. If no pixel has a
  // depth, all weights are 0.
  std::vector<double> weights(const PointCloud& cloud) const override;

 private:
  Vec3 picked(const PointCloud& cloud) const;

  const Settings settings_;
};

Parameters parameters(NearPoint::Settings& s);
std::string validate(const NearPoint::Settings& s);

// Switches that lock and unlock fixtures while a task runs. A fixture is identified by its index in the list
// of rules. The switches are set in the haptic loop and read where frames are processed. A change has an
// effect from the next processed frame on.
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

// Assigns r_f and k_s to the points of a frame, (5.2) and (5.3).
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
