#include "analysis/comparison/judgement.h"

#include <cmath>

namespace remote_touch {

bool is_change(Judgement judgement) {
  return judgement == Judgement::better || judgement == Judgement::worse || judgement == Judgement::changed;
}

const char* name_of(Judgement judgement) {
  constexpr const char* kNames[] = {"equal", "within_margin", "better", "worse", "changed", "undecided"};
  return kNames[static_cast<int>(judgement)];
}

Judgement judge_value(double baseline, double candidate, Better better, const Tolerance& tolerance) {
  if (within(tolerance, baseline, candidate)) return Judgement::equal;
  const double before = badness(baseline, better), now = badness(candidate, better);
  if (better == Better::neither || std::isnan(before) || std::isnan(now) || before == now)
    return Judgement::changed;
  return now < before ? Judgement::better : Judgement::worse;
}

}  // namespace remote_touch
