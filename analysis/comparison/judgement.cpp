#include "analysis/comparison/judgement.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

bool is_change(Judgement judgement) {
  return judgement == Judgement::better || judgement == Judgement::worse || judgement == Judgement::changed;
}

const char* name_of(Judgement judgement) {
  constexpr const char* kNames[] = {"equal", "within_margin", "better", "worse", "changed", "undecided"};
  return kNames[static_cast<int>(judgement)];
}

bool needs_contact(const std::string& measure) {
  constexpr const char* kOthers[] = {"guidance_",
                                     "rms_slave_",
                                     "slave_anticipation",
                                     "rms_force_error",
                                     "relative_force_error",
                                     "force_direction_error",
                                     "false_contact_fraction",
                                     "lost_contact_fraction"};
  return !is_outcome(measure) && std::none_of(std::begin(kOthers), std::end(kOthers),
                                              [&](const char* other) { return measure.starts_with(other); });
}

Judgement judge_value(double baseline, double candidate, Better better, const Tolerance& tolerance) {
  if (within(tolerance, baseline, candidate)) return Judgement::equal;
  // A difference that may be rounding has no direction.
  constexpr double kRounding = 1e-9;
  const double most = std::max(std::abs(baseline), std::abs(candidate));
  if (std::isfinite(most) && std::abs(candidate - baseline) <= kRounding * most) return Judgement::changed;
  const double before = badness(baseline, better), now = badness(candidate, better);
  if (better == Better::neither || std::isnan(before) || std::isnan(now) || before == now)
    return Judgement::changed;
  return now < before ? Judgement::better : Judgement::worse;
}

}  // namespace remote_touch
