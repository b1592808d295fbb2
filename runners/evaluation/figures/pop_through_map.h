// Maps of lifts, noise against acceleration, in units of r_c: the parts that figures 4.13, 4.13-replicated
// and bounds have in common.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/sweeps/sweep_result.h"
#include "analysis/theory/surface_contacts.h"
#include "analysis/trace/curve_fits.h"
#include "runners/evaluation/figures/figure_recipe.h"

namespace remote_touch {

// The lift of fig4.12 and the sweeps on it, 4.3.2.
inline constexpr Lift kLift{0.00499, 30, 0.1, 10};
inline constexpr int kRiseFrames = 15;

// A setting of an experiment.
std::string seed_setting(int seed);
// Returns the share of lifts without noise that did not pop through, over n x n positions of the grid under
// the proxy. Throws InputError if one is unknown.
double survived_over_phases(FigureContext& context, std::size_t n, double acceleration_m_per_s2,
                            const std::vector<std::string>& overrides = {});
// Returns the critical acceleration without noise, (4.14), at 8 x 8 positions, bisected between these two.
inline constexpr double kSurvives = 4.3, kPops = 4.6;  // m/s^2
Table critical_over_phases(FigureContext& context);
// Returns the share of the lifts that did not pop through.
double survived_share(FigureContext& context, const std::vector<Experiment>& lifts);

// Returns the mean over the cells of a map whose outcome is known: with strong noise a proxy may end beside
// the surface. NaN if more than 1 % are unknown.
double share_of_known(const std::vector<double>& survived);

inline const ColumnName kNoiseColumn{"noise", "r_c", "standard deviation of the noise"},
    kAccelerationColumn{"acceleration", "r_c/s^2", "acceleration of the lift"};
// Returns a table with one row for each cell: noise (r_c), acceleration (r_c/s^2), survived (fraction), its
// exact interval, runs.
Table map_table(const std::string& name, const SweepResult& result);
// Returns the cells in which more than half of the lifts survived.
Table survivors(const std::string& name, const Table& map);

// Returns the fraction of lifts that survived in 5 x 5 regions of a map: acceleration from 0, 300, 600, 898,
// 1150 r_c/s^2, and for each of these noise from 0, 0.5, 1, 1.5, 2 r_c. NaN for a region without cells.
Table region_table(const std::string& name, const Table& map);

// Returns the largest magnitude in the column `difference_in_standard_errors`. NaN if a value is NaN, or if
// there is none.
double max_apart(const Table& table);

// Returns a table with noise from 0 to 3 r_c, for curves over it.
Table noise_table(const std::string& name, const std::string& title);
// Adds a bound as a column in r_c/s^2 to a table with a column noise in r_c.
void add_bound(Table& table, const std::string& column, const std::string& meaning,
               const std::function<double(double noise_m)>& bound_m_per_s2);
double printed_bound(double noise_m);  // (4.25) with (4.23), (4.24), m/s^2

Table bound_table();  // printed_bound() over noise, named "bound"

// Returns a panel for a map: x noise, y acceleration, with the same ranges in all figures.
Panel map_panel(const std::string& title, std::vector<Curve> curves);
// Returns a map of a table of survivors(), with the printed bound if `bound` is set.
Panel survivor_panel(const std::string& title, const std::string& table, bool bound = true);

}  // namespace remote_touch
