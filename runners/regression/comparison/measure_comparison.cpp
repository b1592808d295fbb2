#include "runners/regression/comparison/measure_comparison.h"

#include <algorithm>

#include "analysis/trace/trace.h"
#include "runners/experiment/catalog.h"

namespace remote_touch {

namespace {

struct Measured {
  std::size_t ticks = 0;
  std::vector<std::optional<double>> values = {};  // none where a measure does not apply
};

std::optional<Measured> measured(const ColumnSource& source) {
  const auto trace = trace_of([&](const std::string& name) {
    return source.has(name) ? std::optional(source.column(name)) : std::nullopt;
  });
  if (!trace) return std::nullopt;
  Measured result{trace->length()};
  for (const Measure& measure : measures())
    result.values.push_back(applies(measure, *trace) ? std::optional(measure.of(*trace)) : std::nullopt);
  return result;
}

}  // namespace

std::optional<std::vector<ValueComparison>> compare_measures(const ColumnSource& baseline,
                                                             const ColumnSource& candidate,
                                                             const Tolerances& tolerances) {
  const auto before = measured(baseline);
  const auto now = before ? measured(candidate) : std::nullopt;
  if (!now || now->ticks != before->ticks || now->ticks == 0) return std::nullopt;
  std::vector<ValueComparison> all;
  for (std::size_t i = 0; i < measures().size(); ++i) {
    const Measure& measure = measures()[i];
    const std::optional<double>&b = before->values[i], &c = now->values[i];
    if (!b || !c) continue;
    const Tolerance tolerance = tolerance_of(tolerances, measure.name);
    all.push_back({measure.name, measure.unit, measure.better, tolerance, *b, *c,
                   judged(*b, *c, measure.better, tolerance)});
  }
  const bool same_outcome = std::none_of(all.begin(), all.end(), [](const ValueComparison& measure) {
    return is_outcome(measure.name) && measure.judgement != Judgement::equal;
  });
  for (ValueComparison& measure : all)
    if (!same_outcome && !is_outcome(measure.name) && measure.judgement != Judgement::equal)
      measure.judgement = Judgement::changed;
  return all;
}

}  // namespace remote_touch
