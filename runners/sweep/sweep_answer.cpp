#include "runners/sweep/sweep_answer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "analysis/sweeps/sweep_means.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {
namespace {

using Indices = std::vector<std::size_t>;

// Returns the indices that a cell has on some of the axes.
Indices chosen(const Indices& indices, const std::vector<std::size_t>& axes) {
  Indices some;
  for (const std::size_t axis : axes) some.push_back(indices[axis]);
  return some;
}

// Returns the axes one of whose paths is as asked.
template <class IsAsked>
std::vector<std::size_t> axes_with(const std::vector<SweepAxis>& axes, IsAsked&& is_asked) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const std::vector<std::string> paths = axes[i].paths();
    if (std::any_of(paths.begin(), paths.end(), is_asked)) numbers.push_back(i);
  }
  return numbers;
}

// Returns the seed of the runs of a cell; `seed` where no axis sets one.
std::uint64_t seed_of(std::uint64_t seed, const std::vector<SweepAxis>& axes, const Indices& indices) {
  for (std::size_t i = 0; i < axes.size(); ++i)
    for (const auto& [path, value] : axes[i].settings[indices[i]])
      if (path == "seed") seed = value.get<std::uint64_t>();
  return seed;
}

CellStreams known_streams(const SweepGrid& grid, const std::string& config) {
  const std::string label = "the configuration of the sweep";
  const Json json = parse_json(config, label);
  const Json refine = json.value("refine", Json::object());
  const std::vector<SweepAxis> axes =
      read_axes(json, label, refine.is_object() ? refine.value("levels", 0) : 0);
  const Json experiment = read_experiment(json, label, {});
  const auto has_length = [](const SweepAxis& a, const Column& b) { return a.length() == b.length(); };
  if (!std::equal(axes.begin(), axes.end(), grid.axes.begin(), grid.axes.end(), has_length))
    throw InputError(label, "has other axes: expected those of the sweep");
  const std::vector<std::size_t> of_draws = axes_with(axes, may_change_streams);
  const std::vector<std::size_t> of_seed =
      axes_with(axes, [](const std::string& path) { return path == "seed"; });
  const std::uint64_t common_seed = Experiment::from_json(experiment).settings().key.seed;
  std::map<Indices, RandomStreams> known;
  std::map<std::uint64_t, std::size_t> seeds;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> first_cell;  // key: seed and noise cell
  CellStreams streams;
  const std::size_t cells = grid.cell_count();
  streams.draws.reserve(cells), streams.noise_cell.reserve(cells), streams.seed.reserve(cells);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    Indices indices = grid.axis_indices(cell);
    const auto [draws, is_new] = known.try_emplace(chosen(indices, of_draws));
    if (is_new) {
      Json own = experiment;
      for (std::size_t i = 0; i < axes.size(); ++i)
        for (const auto& [path, value] : axes[i].settings[indices[i]]) set_value(own, path, value, path);
      draws->second = random_streams(Experiment::from_json(own));
    }
    streams.draws.push_back(draws->second);
    const std::uint64_t seed = seed_of(common_seed, axes, indices);
    streams.seed.push_back(seeds.try_emplace(seed, seeds.size()).first->second);
    for (std::size_t i = 0; i < axes.size(); ++i)
      if (axes[i].common_noise) indices[i] = 0;
    std::size_t noise_cell = grid.cell_at(indices);
    if (!of_seed.empty())
      noise_cell = first_cell.try_emplace({streams.seed.back(), noise_cell}, cell).first->second;
    streams.noise_cell.push_back(noise_cell);
  }
  return streams;
}

// True if the cell has several finished runs, and they are equal to the last bit in all measures.
bool has_equal_runs(const SweepResult& result, std::size_t cell) {
  if (result.state.empty()) return false;  // an outline has no runs
  std::optional<std::size_t> first;
  std::size_t done = 0;
  for (int replicate = 0; replicate < result.replicates; ++replicate) {
    const auto place = result.place_of(result.run(cell, replicate));
    if (!place || result.state[*place] != RunState::done) continue;
    ++done;
    if (!first) first = place;
    for (const Column& measure : result.measures) {
      const auto& values = std::get<std::vector<double>>(measure.values);
      if (std::bit_cast<std::uint64_t>(values[*place]) != std::bit_cast<std::uint64_t>(values[*first]))
        return false;
    }
  }
  return done > 1;
}

// is_equal: called with a cell if the configuration does not tell; true if its runs are known to be equal.
template <class IsEqual>
CellStreams streams(const SweepGrid& grid, const std::string& config, IsEqual&& is_equal) {
  try {
    return known_streams(grid, config);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    CellStreams careful;
    for (std::size_t cell = 0; cell < grid.cell_count(); ++cell) {
      const bool is_fixed = is_equal(cell);
      careful.draws.push_back({!is_fixed, !is_fixed});
    }
    careful.noise_cell.assign(careful.draws.size(), 0), careful.seed.assign(careful.draws.size(), 0);
    careful.doubt =
        "The configuration of the sweep does not tell which runs share random numbers: runs of one replicate "
        "count as one, and so do equal runs of a cell.";
    return careful;
  }
}

}  // namespace

CellStreams streams_of(const SweepResult& result, const std::string& config) {
  return streams(result, config, [&](std::size_t cell) { return has_equal_runs(result, cell); });
}

CellStreams streams_of(const SweepGrid& grid, const std::string& config) {
  return streams(grid, config, [](std::size_t) { return false; });
}

namespace {

using Axes = std::vector<std::size_t>;  // numbers of axes

// The subject of a question: a sweep with its runs, or a tally.
struct Asked {
  const SweepGrid& grid;
  const CellStreams& streams;
  bool is_refined;
  std::function<EventLimits(const LimitQuestion&)> limits;
  std::function<Table(const LimitQuestion&, std::size_t between, LimitComparison)> limit_comparisons;
  std::function<Table(const std::string& measure, const Axes& by)> means;
  std::function<Table(const std::string& measure, std::size_t between, const Axes& by)> differences;
  std::string event;  // event of default_event()
};

bool has_numbers(const Column& axis) {
  return std::holds_alternative<std::vector<double>>(axis.values);
}

// Returns the number of the column with this name. Throws InputError, about the part of the question.
std::size_t number_of_column(const std::vector<Column>& columns, const std::string& name, const char* part) {
  const auto found =
      std::find_if(columns.begin(), columns.end(), [&](const Column& column) { return column.name == name; });
  if (found == columns.end())
    throw InputError(std::string(part) + " " + printable(name),
                     "expected one of " + joined(names_of(columns), ", "));
  return static_cast<std::size_t>(found - columns.begin());
}

// Returns the axis along which a limit is looked for.
std::size_t axis_along(const SweepGrid& grid, const std::string& along) {
  if (!along.empty()) {
    const std::size_t axis = number_of_column(grid.axes, along, "along");
    if (has_numbers(grid.axes[axis]) && grid.axes[axis].length() > 1) return axis;
    throw InputError("along " + along, "expected an axis of at least two numbers");
  }
  for (std::size_t axis = grid.axes.size(); axis-- > 0;)
    if (has_numbers(grid.axes[axis]) && grid.axes[axis].length() > 1) return axis;
  throw InputError("along", "no axis has two numbers: expected a sweep with one, or no limit");
}

// Returns the axis between whose first and other values something is compared.
std::size_t axis_between(const SweepGrid& grid, const std::string& between) {
  if (!between.empty()) {
    const std::size_t axis = number_of_column(grid.axes, between, "between");
    if (grid.axes[axis].length() > 1) return axis;
    throw InputError("between " + between, "expected an axis of at least two values");
  }
  for (std::size_t axis = 0; axis < grid.axes.size(); ++axis)
    if (!has_numbers(grid.axes[axis]) && grid.axes[axis].length() > 1) return axis;
  throw InputError("between", "no axis has names: expected one of " + joined(names_of(grid.axes), ", "));
}

// Returns the numbers of the axes `by`, in the order of the sweep; all if none is named.
Axes axes_by(const SweepGrid& grid, const std::vector<std::string>& by) {
  Axes axes;
  for (const std::string& name : by) axes.push_back(number_of_column(grid.axes, name, "by"));
  if (by.empty())
    for (std::size_t axis = 0; axis < grid.axes.size(); ++axis) axes.push_back(axis);
  std::sort(axes.begin(), axes.end());
  axes.erase(std::unique(axes.begin(), axes.end()), axes.end());
  return axes;
}

// rises: the direction that the runs show, or that the question states.
std::string limit_sentence(const SweepGrid& grid, const LimitQuestion& limit,
                           const std::optional<bool>& rises) {
  const std::string text =
      formatted(" is above %.6g in %.6g %% of the runs. ", limit.threshold, 100 * limit.level);
  const std::string direction =
      !rises
          ? "The runs do not show whether the event becomes more or less probable along the axis, so there "
            "is no limit: state it as direction \"rises\" or \"falls\". "
          : "Along the axis the event becomes " + std::string(*rises ? "more" : "less") + " probable" +
                (limit.rises ? ", as stated. " : ". ");
  return "Limit: the " + grid.axes[limit.along].name + " at which " + limit.measure + text + direction;
}

std::optional<bool> direction_in(const SweepQuestion& question) {
  if (question.direction.empty()) return std::nullopt;
  if (question.direction != "rises" && question.direction != "falls")
    throw InputError("direction " + printable(question.direction), "expected rises or falls");
  return question.direction == "rises";
}

bool are_above_0(const Column& axis) {
  const auto& x = std::get<std::vector<double>>(axis.values);
  return std::all_of(x.begin(), x.end(), [](double value) { return value > 0; });
}

void add_limits(Figure& figure, const Asked& asked, const SweepQuestion& question, const std::string& event) {
  const SweepGrid& grid = asked.grid;
  number_of_column(grid.measures, event, "limit");
  if (!(question.level > 0 && question.level < 1))
    throw InputError("level " + std::to_string(question.level), "expected a probability between 0 and 1");
  if (!std::isfinite(question.threshold)) throw InputError("above", "expected a finite number");
  LimitQuestion limit{event, question.threshold, axis_along(grid, question.along), question.level,
                      direction_in(question)};
  const auto [table, rises] = asked.limits(limit);
  figure.caption += limit_sentence(grid, limit, rises);
  figure.tables.push_back(table);
  add_answer_limits(figure, table, grid.axes.size() - 1, grid.axes[limit.along]);
  if (question.between.empty()) return;
  const std::size_t between = axis_between(grid, question.between);
  if (between == limit.along && question.differences.empty())
    throw InputError("between " + question.between, "is the axis of the limit: expected another axis");
  if (between == limit.along) return;
  limit.rises = rises;
  figure.tables.push_back(asked.limit_comparisons(limit, between, LimitComparison::difference));
  if (are_above_0(grid.axes[limit.along]))
    figure.tables.push_back(asked.limit_comparisons(limit, between, LimitComparison::ratio));
  figure.caption += "Differences of limits: from " + grid.axes[between].name + " = " +
                    axis_text(grid.axes[between], 0) +
                    "; the ends of their intervals do not belong to them, and a difference of less than two "
                    "steps of the axis can rarely be shown. ";
}

void add_means(Figure& figure, const Asked& asked, const std::vector<std::string>& measures, const Axes& by) {
  const SweepGrid& grid = asked.grid;
  for (const std::string& measure : measures) {
    number_of_column(grid.measures, measure, "mean");
    const Table table = asked.means(measure, by);
    figure.tables.push_back(table);
    add_answer_panel(figure, table, by.size());
  }
  if (!measures.empty() && asked.is_refined && by.size() < grid.axes.size())
    figure.caption += "The sweep was refined: a mean over several cells counts only those that have runs. ";
}

// Returns what the random numbers of the two runs of a pair have in common, in all pairs.
const char* noise_of_pairs(const Asked& asked, std::size_t between) {
  const CellStreams& streams = asked.streams;
  bool are_fixed = true, is_common = true, are_independent = true;
  for (std::size_t cell = 0; cell < asked.grid.cell_count(); ++cell) {
    std::vector<std::size_t> indices = asked.grid.axis_indices(cell);
    if (indices[between] == 0) continue;
    indices[between] = 0;
    const std::size_t first = asked.grid.cell_at(indices);
    are_fixed &= streams.is_fixed(cell) && streams.is_fixed(first);
    is_common &= streams.noise_cell[cell] == streams.noise_cell[first];
    are_independent &= streams.are_independent({first, cell});
  }
  if (are_fixed) return ", which draw no random number. ";
  if (is_common) return " and the same noise. ";
  return are_independent ? ", whose noise is independent. " : ", some of which share random numbers. ";
}

void add_differences(Figure& figure, const Asked& asked, const SweepQuestion& question, Axes by) {
  const SweepGrid& grid = asked.grid;
  const std::size_t between = axis_between(grid, question.between);
  std::erase(by, between);
  const Column& axis = grid.axes[between];
  figure.caption += "Differences: from " + axis.name + " = " + axis_text(axis, 0) +
                    ", in pairs of runs with the same replicate" + noise_of_pairs(asked, between);
  for (const std::string& measure : question.differences) {
    number_of_column(grid.measures, measure, "difference");
    const Table table = asked.differences(measure, between, by);
    figure.tables.push_back(table);
    add_answer_panel(figure, table, by.size() + 1);
  }
}

bool names_no_measure(const SweepQuestion& question) {
  return question.limit.empty() && question.means.empty() && question.differences.empty();
}

// Returns the event whose limit the question wants; an empty text if it wants none.
std::string event_of(const Asked& asked, const SweepQuestion& question) {
  const SweepGrid& grid = asked.grid;
  if (!question.limit.empty()) return question.limit;
  const bool has_axis = std::any_of(grid.axes.begin(), grid.axes.end(), [](const Column& axis) {
    return has_numbers(axis) && axis.length() > 1;
  });
  if (question.along.empty() && !(names_no_measure(question) && has_axis)) return {};
  const std::string& event = asked.event;
  if (event.empty() && !question.along.empty())
    throw InputError(
        "along " + printable(question.along),
        "no measure of an event has a value in some run: expected the measure of an event as limit");
  return event;
}

void refuse_options_without_effect(const SweepQuestion& question, bool has_limit) {
  if (!question.between.empty() && question.differences.empty() && question.limit.empty())
    throw InputError("between " + printable(question.between),
                     "without effect: expected also a difference or a limit");
  if (!has_limit && (question.level != 0.5 || question.threshold != 0.5 || !question.direction.empty()))
    throw InputError("level, above and direction", "without effect: expected also a limit");
  if (!question.by.empty() && question.means.empty() && question.differences.empty() &&
      !names_no_measure(question))
    throw InputError("by", "without effect: expected also a mean or a difference");
}

// Returns the first measure of default_event() that has a value in some run; empty if there is none.
// is_known: called with the number of a measure; true if that measure has a value in some run.
template <class IsKnown>
std::string first_event(const std::vector<Column>& measures, const IsKnown& is_known) {
  for (std::size_t i = 0; i < measures.size(); ++i)
    if (is_event(measures[i]) && is_known(i)) return measures[i].name;
  return {};
}

}  // namespace

std::string default_event(const SweepResult& result) {
  return first_event(result.measures, [&](std::size_t measure) {
    const auto& values = std::get<std::vector<double>>(result.measures[measure].values);
    return std::any_of(values.begin(), values.end(), [](double value) { return !std::isnan(value); });
  });
}

namespace {

Figure answer_of(const Asked& asked, const std::string& config, const SweepQuestion& question) {
  const SweepGrid& grid = asked.grid;
  const Json json = parse_json(config, "the configuration of the sweep");
  Figure figure{kAnswerName, json.is_object() ? json.value("title", std::string()) : "", {}};
  const std::string event = event_of(asked, question);
  refuse_options_without_effect(question, !event.empty());
  if (!event.empty()) add_limits(figure, asked, question, event);
  const Axes by = axes_by(grid, question.by);
  add_means(figure, asked, names_no_measure(question) ? names_of(grid.measures) : question.means, by);
  if (!question.differences.empty()) add_differences(figure, asked, question, by);
  figure.caption += adjust_together(figure.tables);
  if (!asked.streams.doubt.empty()) figure.caption += asked.streams.doubt + " ";
  if (!figure.caption.empty()) figure.caption.pop_back();
  return figure;
}

[[noreturn]] void refuse_without_runs() {
  throw InputError("the sweep", "has no finished run: expected at least one");
}

[[noreturn]] void refuse_for_tally(const std::string& what, const std::string& why,
                                   const std::string& instead = "") {
  throw InputError(what, why + ": expected " + instead + "a sweep with \"keep\": \"runs\"");
}

std::size_t number_of_event(const SweepTally& tally, const LimitQuestion& question) {
  const std::size_t measure = number_of_column(tally.measures, question.measure, "limit");
  if (!is_event(tally.measures[measure]) || question.threshold != 0.5)
    refuse_for_tally("limit " + question.measure,
                     "a tally counts only the events themselves, at the threshold 0.5");
  return measure;
}

}  // namespace

Figure sweep_answer(const SweepResult& result, const std::string& config, const SweepQuestion& question) {
  if (result.runs_in(RunState::done).empty()) refuse_without_runs();
  const CellStreams streams = streams_of(result, config);
  return answer_of(
      {result, streams, !result.round.empty(),
       [&](const LimitQuestion& limit) { return event_limits(result, limit, streams); },
       [&](const LimitQuestion& limit, std::size_t between, LimitComparison comparison) {
         return limit_comparisons(result, limit, between, streams, comparison);
       },
       [&](const std::string& measure, const Axes& by) { return sweep_means(result, measure, by, streams); },
       [&](const std::string& measure, std::size_t between, const Axes& by) {
         return sweep_differences(result, measure, between, by, streams);
       },
       default_event(result)},
      config, question);
}

Figure sweep_answer(const SweepTally& tally, const std::string& config, const SweepQuestion& question) {
  constexpr std::uint64_t kMaxCells = 10'000'000;  // an answer reads all cells, also those without runs
  if (tally.cell_count() > kMaxCells)
    throw InputError("the tally", "has " + std::to_string(tally.cell_count()) + " cells: expected at most " +
                                      std::to_string(kMaxCells) + " for an analysis");
  if (std::all_of(tally.tallies.begin(), tally.tallies.end(),
                  [](const CellTally& cell) { return cell.done == 0; }))
    refuse_without_runs();
  if (!question.differences.empty())
    refuse_for_tally("difference " + question.differences.front(), "a tally does not keep pairs of runs");
  if (!question.between.empty()) refuse_for_tally("between", "a tally does not keep single runs");
  const CellStreams streams = streams_of(tally, config);
  const auto limits = [&](const LimitQuestion& limit) {
    const std::size_t measure = number_of_event(tally, limit);
    CellCounts counts{[&](std::size_t cell) { return event_counts(tally, measure, cell); }};
    if (!tally.note_kinds.empty()) counts.noted = [&](std::size_t cell) { return noted_runs(tally, cell); };
    return event_limits(tally, counts, limit, streams);
  };
  const auto means = [&](const std::string& measure, const Axes& by) {
    for (const CellGroup& group : cell_groups(tally, by))
      if (!streams.are_independent(group.cells))
        refuse_for_tally("by", "a tally does not know which runs of pooled cells share random numbers",
                         "all axes, or ");
    return sweep_means(tally, measure, by, streams);
  };
  const std::string event = first_event(tally.measures, [&](std::size_t measure) {
    return std::any_of(tally.tallies.begin(), tally.tallies.end(),
                       [&](const CellTally& cell) { return cell.measures[measure].values > 0; });
  });
  return answer_of({tally, streams, false, limits, {}, means, {}, event}, config, question);
}

}  // namespace remote_touch
