// Summary of a scorecard's methods over all scenes, and a list of everything in which a method is behind
// others.
#pragma once

#include <string>
#include <vector>

#include "analysis/scorecard/scorecard.h"

namespace remote_touch {

enum class Mark { none, best, worst };
Mark mark_of(const Ranking& ranking, std::size_t method);

// A scene counts as held if more than this fraction of its runs with noise are successes.
inline constexpr double kHeldFraction = 0.9;

// Results of one method over all scenes.
struct MethodSummary {
  int held = 0, best = 0, worst = 0;  // numbers of scenes
  // Mean over the scenes of the fraction of successes, with the interval of estimated_fraction(), as if the
  // scenes were drawn from all possible scenes: for runs with noise, for runs without noise, and for runs
  // with noise by the previous rule. The clusters are the scenes.
  Estimate success, noise_free, old_success;
};
std::vector<MethodSummary> overview(const Scorecard& card);

// Returns which of a card's methods is the one of this project, whose weaknesses behind_table() lists:
// tracked-sheet, or slave-region on a card of teleoperation; tracked-sheet if the card has neither.
std::string own_method(const std::vector<std::string>& methods);

// Something in which a method is behind another one.
struct Weakness {
  std::string scene, what, units;  // "success", "success without noise", or a measure
  std::string other;               // the best of the methods that are ahead
  int ahead = 0;                   // number of methods that are ahead
  double own_mean = 0, other_mean = 0;
  double p = 0;  // corrected for all comparisons of the card; NaN: not tested, as without noise
  bool is_significant = false;  // true if the difference is more than chance
};
// Returns first everything in which other methods are better by more than chance. Then follow the scenes in
// which others succeed more often with noise, but not by more than chance, and those in which others succeed
// more often without noise. Both parts are in the order of the scenes. Empty for a method that the card does
// not have.
std::vector<Weakness> weaknesses(const Scorecard& card, const std::string& method);

// Tables of a result: "overview", with a row for each method, and "behind", with a row for each weakness of
// own_method().
Table overview_table(const Scorecard& card);
Table behind_table(const Scorecard& card);

}  // namespace remote_touch
