// Strength (a speed, an angle, an acceleration) up to which a surface carries a tool, by each contact rule;
// shared by figures tool-lifts and tool-shapes.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "analysis/storage/result_file.h"
#include "analysis/sweeps/sweep_result.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "scenarios/simulated/shape.h"

namespace remote_touch {

enum class Carrier { voxels, look_ahead, continuous };
struct CarrierName {
  Carrier rule;
  const char *column, *label;
};
inline constexpr CarrierName kCarriers[] = {{Carrier::voxels, "voxels", "as printed"},
                                            {Carrier::look_ahead, "look_ahead", "look-ahead"},
                                            {Carrier::continuous, "continuous", "continuous"}};
inline std::string column_of(Carrier rule) {
  return kCarriers[static_cast<std::size_t>(rule)].column;
}

// A sweep with the measure tool_popped_through. Its last axis is the rule, in the order of kCarriers. The
// axis before it is a strength, rising. A setting is a combination of values of the axes before these two.
class CarrySweep {
 public:
  explicit CarrySweep(SweepResult result) : result_(std::move(result)) {}
  std::size_t settings() const { return result_.cell_count() / (strengths().size() * std::size(kCarriers)); }
  const std::vector<double>& strengths() const {
    return std::get<std::vector<double>>(result_.axes.at(result_.axes.size() - 2).values);
  }
  // Value of a numeric axis for each setting.
  std::vector<double> values(std::size_t axis) const;
  EventCounts lost(std::size_t setting, std::size_t strength, Carrier rule) const;
  struct Limit {
    // Every run is carried up to this strength; NaN: none is known.
    double carried = std::numeric_limits<double>::quiet_NaN();
    double lost = std::numeric_limits<double>::infinity();      // the next strength; infinite: no run is lost
    double all_lost = std::numeric_limits<double>::infinity();  // all runs are lost from here on
  };
  Limit limit(std::size_t setting, Carrier rule) const;

 private:
  std::size_t cell(std::size_t setting, std::size_t strength, Carrier rule) const {
    return (setting * strengths().size() + strength) * std::size(kCarriers) + static_cast<std::size_t>(rule);
  }

  SweepResult result_;
};

// Returns the number of rows in which a limit is not between two columns: a run is lost below `low`, or
// carried above `high`, or `low` or `high` is NaN. `carried` is NaN where nothing is carried.
double count_rows_apart(const Table& table, const std::string& carried, const std::string& lost,
                        const std::string& low, const std::string& high);

// Returns the limit that is derived for a rule, in the units of the measured limits.
using DerivedLimit = std::function<double(Carrier rule, double setting)>;
// Returns the derived limits (columns *_bound) as table NAME_bounds, at evenly spaced values of the setting.
// limits: table NAME, whose first column is the setting, in rising order.
Table derived_table(const Table& limits, const DerivedLimit& derived, int samples);

struct LimitLabels {
  std::string x, y;
};
// Adds a panel over the setting, and derived_table(). The derived limits are dashed. The strengths up to
// which every run is carried (columns *_carried of `limits`) are dots, with a bar to the next strength, at
// which a run is lost (*_first_lost). derived_samples: more than 20, as lines of fewer samples have markers.
void add_limit_panel(Figure& figure, const Table& limits, const DerivedLimit& derived,
                     const LimitLabels& labels, const PanelFrame& frame, int derived_samples = 61);

// Distances by which one frame may move an edge, a corner, a ball or a plane against the plate of figure
// tool-shapes, by each contact rule: the closed forms of analysis/theory/surface_contacts.h for what counts
// as inside by that rule.

// Settings of the sweeps tool-shape-*, tool-walls and tool-wall-sides.
inline constexpr double kJumpFrames_hz = 30, kHalfPlate_m = 0.02, kPlate_m = 0.01;
inline constexpr double kSlope_deg = 30, kRadius_m = 0.04;  // used where they are not an axis

// Jump along the thickness of the plate. least_m and most_m enclose bound_m because there is a point only
// every 1.5 mm, and because look-ahead holds the disks of points.
struct Jump {
  double least_m = 0, bound_m = 0, most_m = 0;
};

// An edge that turns in the same frame, or is tilted; slope 0: a plane.
Jump on_edge(Carrier rule, double thickness_m, double slope_deg, double turn_deg = 0);
Jump on_corner(Carrier rule, double thickness_m, double slope_deg);
Jump on_ball(Carrier rule, double thickness_m, double radius_m);
// A plane against the tool's extent along its normal.
Jump on_plane(Carrier rule, double extent_m);
// Jump after which half of the runs are lost, with noise on x, y and z; the plate is kPlate_m thick.
Jump on_noise(Carrier rule, Shape::Kind kind, double sigma_m);
// Returns bound_m of on_noise() alone, in a third of its time.
double noise_bound_m(Carrier rule, Shape::Kind kind, double sigma_m);

}  // namespace remote_touch
