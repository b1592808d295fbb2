// The judgement of a measure that was compared.
#pragma once

#include <string>

#include "analysis/measures/better.h"
#include "analysis/trace/tolerance.h"

namespace remote_touch {

enum class Judgement {
  equal,          // within the tolerance
  within_margin,  // sweeps only: the intervals of the differences lie within the margins
  better,
  worse,
  changed,   // no direction: the measure has none, a number was or became NaN, or the outcomes differ
  undecided  // sweeps only: too few runs, or both ways alike
};
bool is_change(Judgement judgement);  // better, worse or changed
// "equal", "within_margin", "better", ...
const char* name_of(Judgement judgement);

// Judges one number: equal, better, worse or changed. A number that was or became NaN has changed.
Judgement judged(double baseline, double candidate, Better better, const Tolerance& tolerance);

// A measure of one run, before and now.
struct ValueComparison {
  std::string name, units;
  Better better = Better::neither;
  Tolerance tolerance;
  double baseline = 0, candidate = 0;
  Judgement judgement = Judgement::equal;
};

}  // namespace remote_touch
