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
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"

namespace remote_touch {

// The lift of fig4.12 and the sweeps on it, 4.3.2.
inline constexpr Lift kLift{0.00499, 30, 0.1, 10};
inline constexpr int kRiseFrames = 15;

// A setting of an experiment.
std::string seed_setting(int seed);
// Returns 1 for each lift that popped through, and 0 for the others. Throws InputError if one is unknown.
std::vector<double> known_pop_throughs(FigureContext& context, const std::vector<Experiment>& lifts);
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

// A share of lifts that another implementation computed too, and how far two such shares may differ by
// chance.
struct SharedLifts {
  double survived = 0;  // share in the other implementation
  double variance = 0;  // variance of one lift about its node's probability
  double nodes = 0, lifts_a_node = 0;
  // Returns the standard error of the difference to a share over as many nodes, with our_lifts_a_node lifts
  // at each. One lift with a variance of 1 is added, so that the error is not 0 if no lift differed from the
  // other lifts of its node.
  double standard_error(double our_lifts_a_node) const;
};
// Differences in standard errors that chance exceeds once in a thousand: for one comparison, and for the
// largest of n. Normal distribution, two-sided.
inline constexpr double kByChance = 3.3, kByChanceOf6 = 3.8, kByChanceOf25 = 4.1;
// Claims that a share differs from the other implementation's by no more than chance allows.
void claim_agrees(const Claims& claims, const std::string& claim, double measured, const SharedLifts& other,
                  double our_lifts_a_node, const std::string& paper = "-");
// Returns the largest magnitude in the column `difference_in_standard_errors`. NaN if a value is NaN, or if
// there is none.
double max_apart(const Table& table);
// Returns a share of lifts in the second implementation, which made one lift at each node. place:
// "/map/whole", or "/map/coarse" (every third noise and second acceleration).
SharedLifts second_fraction(const std::string& place);

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
