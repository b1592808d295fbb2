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
  changed,   // neither: no direction, a number was or became NaN, equally good, or another outcome
  undecided  // sweeps only: too few runs, or similar numbers of better and worse runs
};
bool is_change(Judgement judgement);  // better, worse or changed
// "equal", "within_margin", "better", ...
const char* name_of(Judgement judgement);

// Judges one number: equal, better, worse or changed. A number that was or became NaN is changed, and so is
// one that differs by at most 1e-9 of itself, which may be rounding.
Judgement judge_value(double baseline, double candidate, Better better, const Tolerance& tolerance);

// True for a measure that says nothing about a run without any contact, such as the greatest depth in the
// tool. False for outcomes, and for measures of guidance, of the slave's motion and of an expected force.
bool needs_contact(const std::string& measure);

// A measure of one run, in the baseline and in the candidate.
struct ValueComparison {
  std::string name, units;
  Better better = Better::neither;
  Tolerance tolerance;
  double baseline = 0, candidate = 0;
  Judgement judgement = Judgement::equal;
};

}  // namespace remote_touch
