#include "analysis/sweeps/sweep_means.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include "analysis/trace/curve_fits.h"
#include "analysis/trace/interval_estimates.h"

namespace remote_touch {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kPMeaning = "p value of the null hypothesis that there is no difference";
constexpr const char* kAdjustedMeaning = "p value after Holm's adjustment over all tests of the answer";

double mean_of_known(const std::vector<double>& values) {
  return mean_where(
      values.size(), [&](std::size_t i) { return !std::isnan(values[i]); },
      [&](std::size_t i) { return values[i]; });
}

EventCounts counts_of(const std::vector<double>& values) {
  EventCounts counts;
  for (const double value : values)
    ++(std::isnan(value) ? counts.unknown : value > 0.5 ? counts.events : counts.without);
  return counts;
}

// A row's clusters with the values of their runs.
struct ValueClusters {
  std::vector<RunCluster> clusters;
  std::vector<std::vector<double>> values;
  bool by_replicate = false, are_fixed = true;
  std::int64_t runs = 0, unknown = 0;

  template <class ValueOf>
  ValueClusters(std::vector<RunCluster> of_row, bool is_by_replicate, ValueOf&& value_of)
      : clusters(std::move(of_row)), by_replicate(is_by_replicate) {
    for (const RunCluster& cluster : clusters) {
      are_fixed &= cluster.is_fixed;
      std::vector<double>& own = values.emplace_back();
      for (const std::size_t run : cluster.runs) {
        own.push_back(value_of(run));
        ++runs, unknown += std::isnan(own.back()) ? 1 : 0;
      }
    }
  }
};

Estimate exact_estimate(const ValueClusters& row) {
  Estimate e;
  std::vector<double> means;
  for (const std::vector<double>& values : row.values) means.push_back(mean_of_known(values));
  e.value = mean_of_known(means), e.method = kExactMethod;
  e.clusters = static_cast<std::int64_t>(row.clusters.size()), e.unknown = row.unknown;
  return e;
}

Estimate fraction_estimate(const ValueClusters& row) {
  std::vector<EventCounts> counts;
  for (const std::vector<double>& values : row.values) counts.push_back(counts_of(values));
  return row.are_fixed ? exact_fraction(sum_of(counts)) : estimated_fraction(counts);
}

Estimate mean_estimate(const ValueClusters& row) {
  std::map<std::pair<bool, std::size_t>, Stratum> strata;  // a fixed cell is a stratum of its own
  for (std::size_t i = 0; i < row.clusters.size(); ++i) {
    const RunCluster& cluster = row.clusters[i];
    const std::size_t key = cluster.is_fixed ? i : row.by_replicate ? 0 : cluster.noise_cell;
    Stratum& stratum = strata[{cluster.is_fixed, key}];
    stratum.is_fixed = cluster.is_fixed;
    stratum.numbers.push_back(mean_of_known(row.values[i]));
  }
  std::vector<Stratum> all;
  for (auto& [key, stratum] : strata) all.push_back(std::move(stratum));
  Estimate e = estimated_mean(all);
  e.unknown = row.unknown;
  return e;
}

// pair_of: the values of the two runs of a pair, named by the run of the second.
template <class PairOf>
Estimate pair_estimate(const ValueClusters& row, bool is_event, PairOf&& pair_of) {
  if (row.clusters.empty()) return {};
  if (row.are_fixed) return exact_estimate(row);
  if (is_event) {
    std::vector<std::vector<OutcomePair>> pairs;
    for (const RunCluster& cluster : row.clusters) {
      pairs.emplace_back();
      for (const std::size_t run : cluster.runs) pairs.back().push_back(pair_of(run));
    }
    return estimated_event_difference(pairs);
  }
  std::vector<double> means;
  for (const std::vector<double>& own : row.values) means.push_back(mean_of_known(own));
  Estimate e = estimated_difference(means);
  e.unknown = row.unknown;
  return e;
}

void note_clusters(Estimate& e, const ValueClusters& row, const SweepResult& result,
                   const CellStreams& streams, const CellGroup& group, const char* what) {
  e.add_note(equal_runs_note(streams, group.cells, [&](std::size_t cell) {
    return event_counts(result, std::get<std::vector<double>>(result.measures[0].values), cell).runs();
  }));
  note_shared(e, row.runs, static_cast<std::int64_t>(row.clusters.size()), what);
}

const Column& measure_column(const SweepGrid& grid, const std::string& measure) {
  return *std::ranges::find_if(grid.measures, [&](const Column& column) { return column.name == measure; });
}

// Returns the cell with another place on one axis.
std::size_t moved(const SweepResult& result, std::size_t cell, std::size_t axis, std::size_t place) {
  std::vector<std::size_t> indices = result.axis_indices(cell);
  indices[axis] = place;
  return result.cell_at(indices);
}

Column* with_meaning(Table& table, const char* meaning) {
  for (Column& column : table.columns)
    if (column.long_name == meaning) return &column;
  return nullptr;
}

}  // namespace

std::string name_beside(const Table& table, const std::string& name) {
  const bool is_taken =
      std::ranges::any_of(table.columns, [&](const Column& column) { return column.name == name; });
  return is_taken ? name + "_of_answer" : name;
}

void note_unknown(Estimate& e, std::int64_t runs, bool is_event, const std::string& what) {
  if (e.unknown == 0) return;
  const std::string all = " of " + std::to_string(runs) + " " + what;
  if (!is_event)
    e.add_note("of " + std::to_string(runs - e.unknown) + all + " that have a value");
  else if (20 * e.unknown > runs)
    e.add_note(std::to_string(e.unknown) + all + " unknown");
}

void note_shared(Estimate& e, std::int64_t runs, std::int64_t clusters, const char* what) {
  if (clusters < runs)
    e.add_note(std::to_string(runs) + " " + what + " share random numbers and count as " +
               std::to_string(clusters));
}

std::vector<std::int64_t> noted_runs(const SweepResult& result, const std::vector<CellGroup>& groups) {
  std::vector<std::int64_t> counts;
  if (result.notes.empty()) return counts;
  for (const CellGroup& group : groups) {
    std::int64_t& count = counts.emplace_back(0);
    for (const std::size_t cell : group.cells)
      for (int replicate = 0; replicate < result.replicates; ++replicate)
        count += result.notes[result.run(cell, replicate)] != 0 ? 1 : 0;
  }
  return counts;
}

void add_estimates(Table& table, const std::vector<Estimate>& estimates, const EstimateTexts& texts,
                   const std::vector<std::int64_t>& noted) {
  const auto numbers_of = [&](double Estimate::*member) {
    std::vector<double> values;
    for (const Estimate& e : estimates) values.push_back(e.*member);
    return values;
  };
  const auto counts_of_rows = [&](std::int64_t Estimate::*member) {
    std::vector<std::int64_t> counts;
    for (const Estimate& e : estimates) counts.push_back(e.*member);
    return counts_in_column(counts);
  };
  const auto texts_of_rows = [&](std::string Estimate::*member) {
    std::vector<std::string> all;
    for (const Estimate& e : estimates) all.push_back(e.*member);
    return all;
  };
  const auto add = [&](const std::string& name, const std::string& unit, const std::string& meaning,
                       Values values) {
    table.columns.push_back({name_beside(table, name), unit, meaning, std::move(values)});
  };
  add("value", texts.unit, texts.value, numbers_of(&Estimate::value));
  add("low", texts.unit, "lower end of its 95 % interval; NaN: open, or no interval",
      numbers_of(&Estimate::low));
  add("high", texts.unit, "upper end of its 95 % interval; NaN: open, or no interval",
      numbers_of(&Estimate::high));
  add("runs", "1", texts.runs, counts_of_rows(&Estimate::clusters));
  add("unknown", "1", "number of runs whose value is unknown", counts_of_rows(&Estimate::unknown));
  if (!noted.empty()) add("noted_runs", "1", "number of finished runs with a note", counts_in_column(noted));
  add("method", "1", "how the interval was computed", texts_of_rows(&Estimate::method));
  if (texts.has_tests) {
    const std::vector<double> p = numbers_of(&Estimate::p);
    add("p", "1", kPMeaning, p);
    add("adjusted_p", "1", kAdjustedMeaning, holm_adjusted(p));
  }
  add("note", "1", "what the row lacks, and why", texts_of_rows(&Estimate::note));
}

std::string adjust_together(std::vector<Table>& tables) {
  std::vector<double> all;
  for (Table& table : tables)
    if (const Column* p = with_meaning(table, kPMeaning)) {
      const auto& own = std::get<std::vector<double>>(p->values);
      all.insert(all.end(), own.begin(), own.end());
    }
  const std::int64_t tests = tests_among(all);
  if (tests == 0) return {};
  const std::vector<double> adjusted = holm_adjusted(all);
  auto next = adjusted.begin();
  std::int64_t most = 0;  // pairs of the row with the most of them
  for (Table& table : tables)
    if (Column* column = with_meaning(table, kAdjustedMeaning)) {
      auto& values = std::get<std::vector<double>>(column->values);
      const auto end = next + static_cast<std::ptrdiff_t>(values.size());
      values.assign(next, end), next = end;
      for (const Column& counts : table.columns)
        if (const auto* pairs = std::get_if<std::vector<std::int32_t>>(&counts.values);
            pairs && counts.name.starts_with("runs"))
          for (std::size_t row = 0; row < values.size(); ++row)
            if (!std::isnan(values[row])) most = std::max<std::int64_t>(most, (*pairs)[row]);
    }
  std::string text = "adjusted_p: after Holm, over " +
                     (tests == 1 ? std::string("the only test") : "all " + std::to_string(tests) + " tests") +
                     " of this answer. ";
  const std::int64_t needed = pairs_for_family(tests);
  if (most < needed)
    text += "With so many tests an adjusted p of at most 0.05 needs a row of at least " +
            std::to_string(needed) + " pairs. ";
  return text;
}

namespace {

std::vector<std::int64_t> noted_runs(const SweepTally& tally, const std::vector<CellGroup>& groups) {
  std::vector<std::int64_t> counts;
  if (tally.note_kinds.empty()) return counts;
  for (const CellGroup& group : groups) {
    counts.push_back(0);
    for (const std::size_t cell : group.cells) counts.back() += remote_touch::noted_runs(tally, cell);
  }
  return counts;
}

// estimate_of: returns the estimate of a group of cells.
template <class Kept, class EstimateOf>
Table table_of_means(const Kept& kept, const Column& measure, const std::vector<std::size_t>& by,
                     const EstimateOf& estimate_of) {
  const std::vector<CellGroup> groups = cell_groups(kept, by);
  std::vector<Estimate> estimates;
  for (const CellGroup& group : groups) estimates.push_back(estimate_of(group));
  Table table{"mean_" + measure.name, "mean of " + measure.name, axes_of(kept, by, groups)};
  const std::string what = is_event(measure) ? "fraction: " : "mean: ";
  add_estimates(table, estimates, {measure.units, what + measure.long_name, kRunsMeaning},
                noted_runs(kept, groups));
  return table;
}

}  // namespace

Table sweep_means(const SweepResult& result, const std::string& measure, const std::vector<std::size_t>& by,
                  const CellStreams& streams) {
  const std::vector<double>& values = result.measure(measure);
  const Column& column = measure_column(result, measure);
  return table_of_means(result, column, by, [&](const CellGroup& group) {
    const bool by_replicate = streams.share_replicates(group.cells);
    const ValueClusters row(clusters_of(result, streams, group.cells, by_replicate), by_replicate,
                            [&](std::size_t run) { return values[run]; });
    Estimate e = row.clusters.empty() ? Estimate{}
                 : is_event(column)   ? fraction_estimate(row)
                 : row.are_fixed      ? exact_estimate(row)
                                      : mean_estimate(row);
    note_clusters(e, row, result, streams, group, "runs");
    note_unknown(e, row.runs, is_event(column));
    return e;
  });
}

namespace {

// The runs of a fixed cell are equal, and count as one.
Estimate fraction_of(const SweepTally& tally, std::size_t measure, const CellGroup& group,
                     const CellStreams& streams) {
  EventCounts all;
  bool are_fixed = true;
  for (const std::size_t cell : group.cells) {
    const EventCounts own = event_counts(tally, measure, cell);
    all.add(RunsAtValue{0, own, streams.is_fixed(cell)}.of_one_run_if_fixed().counts);
    are_fixed &= streams.is_fixed(cell) || own.runs() == 0;
  }
  return are_fixed && all.runs() > 0 ? exact_fraction(all) : estimated_fraction(all);
}

Estimate mean_of(const SweepTally& tally, std::size_t measure, const CellGroup& group,
                 const CellStreams& streams) {
  std::vector<StratumMoments> strata;
  bool are_fixed = true;
  for (const std::size_t cell : group.cells)
    if (const CellTally* const own = tally.tally_of(cell)) {
      const MeasureTally& values = own->measures[measure];
      const bool is_fixed = streams.is_fixed(cell);
      const std::int64_t without_value = values.unknown + values.infinite;
      are_fixed &= is_fixed;
      strata.push_back({{static_cast<double>(values.values), values.values > 0 ? values.mean() : 0,
                         values.values > 1 ? values.variance() : 0, 0},
                        is_fixed,
                        is_fixed ? std::min<std::int64_t>(without_value, 1) : without_value});
    }
  Estimate e = estimated_mean(strata, false);
  if (are_fixed && !strata.empty()) e.clusters += e.unknown, e.method = kExactMethod;
  return e;
}

}  // namespace

Table sweep_means(const SweepTally& tally, const std::string& measure, const std::vector<std::size_t>& by,
                  const CellStreams& streams) {
  const Column& column = measure_column(tally, measure);
  const auto number = static_cast<std::size_t>(&column - tally.measures.data());
  const auto done = [&](std::size_t cell) {
    const CellTally* const own = tally.tally_of(cell);
    return own ? own->done : 0;
  };
  return table_of_means(tally, column, by, [&](const CellGroup& group) {
    Estimate e = is_event(column) ? fraction_of(tally, number, group, streams)
                                  : mean_of(tally, number, group, streams);
    std::int64_t runs = 0;
    for (const std::size_t cell : group.cells)
      runs += streams.is_fixed(cell) ? std::min<std::int64_t>(done(cell), 1) : done(cell);
    e.add_note(equal_runs_note(streams, group.cells, done));
    note_unknown(e, runs, is_event(column));
    return e;
  });
}

Table sweep_differences(const SweepResult& result, const std::string& measure, std::size_t between,
                        const std::vector<std::size_t>& by, const CellStreams& streams) {
  const std::vector<double>& values = result.measure(measure);
  const Column& column = measure_column(result, measure);
  std::vector<std::size_t> kept = by;
  kept.push_back(between);
  std::vector<CellGroup> groups = cell_groups(result, kept);
  std::erase_if(groups, [](const CellGroup& group) { return group.indices.back() == 0; });
  CellStreams of_pairs = streams;  // a pair draws what its two runs draw
  for (std::size_t cell = 0; cell < of_pairs.draws.size(); ++cell) {
    const RandomStreams first = streams.draws[moved(result, cell, between, 0)];
    of_pairs.draws[cell].of_cell |= first.of_cell, of_pairs.draws[cell].of_replicate |= first.of_replicate;
  }
  const auto partner = [&](std::size_t run) {
    return result.run(moved(result, result.cell_of(run), between, 0), result.replicate_of(run));
  };
  std::vector<Estimate> estimates;
  for (const CellGroup& group : groups) {
    const bool by_replicate = of_pairs.share_replicates(group.cells);
    std::vector<RunCluster> clusters = clusters_of(result, of_pairs, group.cells, by_replicate);
    for (RunCluster& cluster : clusters)
      std::erase_if(cluster.runs,
                    [&](std::size_t run) { return result.state[partner(run)] != RunState::done; });
    std::erase_if(clusters, [](const RunCluster& cluster) { return cluster.runs.empty(); });
    const ValueClusters row(std::move(clusters), by_replicate, [&](std::size_t run) {
      const double difference = values[run] - values[partner(run)];
      return std::isfinite(difference) ? difference : kNone;
    });
    Estimate e = pair_estimate(row, is_event(column), [&](std::size_t run) {
      return OutcomePair{values[partner(run)], values[run]};
    });
    note_clusters(e, row, result, of_pairs, group, "pairs");
    note_unknown(e, row.runs, is_event(column), "pairs");
    estimates.push_back(std::move(e));
  }
  Table table{"difference_" + measure,
              "difference of " + measure + " from the first value of " + result.axes[between].name,
              axes_of(result, kept, groups)};
  add_estimates(table, estimates,
                {column.units, "mean difference: " + column.long_name,
                 "number of independent pairs; those that share random numbers count as one", true},
                noted_runs(result, groups));
  return table;
}

}  // namespace remote_touch
