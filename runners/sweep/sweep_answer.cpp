#include "runners/sweep/sweep_answer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "analysis/sweeps/event_limits.h"
#include "analysis/sweeps/sweep_means.h"
#include "analysis/tally/tally_means.h"
#include "core/parameters/input_error.h"
#include "runners/sweep/answer_panels.h"
#include "runners/sweep/tally_outline.h"
#include "scenarios/text_files/json_text.h"

namespace remote_touch {

namespace {

// The subject of a question: a sweep with its runs, or a tally.
struct Asked {
  const SweepResult& result;  // only the outline if it is a tally
  std::function<EventLimits(const LimitQuestion&)> limits;
  std::function<Table(const std::string& measure, const TableAxes& axes)> means;
  std::function<Table(const std::string& measure, std::size_t between, const TableAxes& axes)> differences;
  std::string event;  // event of default_event()
  // Number of finished runs, and of those in which the measure of that number is unknown (NaN).
  std::function<std::pair<std::int64_t, std::int64_t>(std::size_t measure)> unknown;
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
std::size_t axis_along(const SweepResult& result, const std::string& along) {
  if (!along.empty()) {
    const std::size_t axis = number_of_column(result.axes, along, "along");
    if (has_numbers(result.axes[axis]) && result.axes[axis].length() > 1) return axis;
    throw InputError("along " + along, "expected an axis of at least two numbers");
  }
  for (std::size_t axis = result.axes.size(); axis-- > 0;)
    if (has_numbers(result.axes[axis]) && result.axes[axis].length() > 1) return axis;
  throw InputError("along", "no axis has two numbers: expected a sweep with one, or no limit");
}

std::size_t axis_between(const SweepResult& result, const std::string& between) {
  if (!between.empty()) {
    const std::size_t axis = number_of_column(result.axes, between, "between");
    if (result.axes[axis].length() > 1) return axis;
    throw InputError("between " + between, "expected an axis of at least two values");
  }
  for (std::size_t axis = 0; axis < result.axes.size(); ++axis)
    if (!has_numbers(result.axes[axis]) && result.axes[axis].length() > 1) return axis;
  throw InputError("between", "no axis has names: expected one of " + joined(names_of(result.axes), ", "));
}

// Returns the numbers of the axes `by`, in the order of the sweep; all if none is named.
std::vector<std::size_t> axes_by(const SweepResult& result, const std::vector<std::string>& by) {
  std::vector<std::size_t> axes;
  for (const std::string& name : by) axes.push_back(number_of_column(result.axes, name, "by"));
  if (by.empty())
    for (std::size_t axis = 0; axis < result.axes.size(); ++axis) axes.push_back(axis);
  std::sort(axes.begin(), axes.end());
  axes.erase(std::unique(axes.begin(), axes.end()), axes.end());
  return axes;
}

std::string limit_sentence(const SweepResult& result, const LimitQuestion& limit, bool rises) {
  char text[80];
  std::snprintf(text, sizeof text, " is above %.6g in %.6g %% of the runs. ", limit.threshold,
                100 * limit.level);
  return "Limit: the " + result.axes[limit.along].name + " at which " + limit.measure + text +
         "Along the axis the event becomes " + (rises ? "more" : "less") + " probable. ";
}

// Returns a sentence with the number of runs in which it is unknown whether the event happened; empty if it
// is known in all.
std::string unknown_sentence(const Asked& asked, const std::string& event, std::size_t measure) {
  const auto [done, unknown] = asked.unknown(measure);
  if (unknown == 0) return {};
  return event + " is unknown in " + std::to_string(unknown) + " of " + std::to_string(done) +
         " runs; a run in which it is unknown counts as a run without the event. ";
}

void add_limits(Figure& figure, const Asked& asked, const SweepQuestion& question, const std::string& event) {
  const SweepResult& result = asked.result;
  const std::size_t measure = number_of_column(result.measures, event, "limit");
  if (!(question.level > 0 && question.level < 1))
    throw InputError("level " + std::to_string(question.level), "expected a probability between 0 and 1");
  const LimitQuestion limit{event, question.threshold, axis_along(result, question.along), question.level};
  const auto [table, rises] = asked.limits(limit);
  figure.caption += limit_sentence(result, limit, rises) + unknown_sentence(asked, event, measure);
  figure.tables.push_back(table);
  add_answer_panel(figure, {table, result.axes.size() - 1, "limit", "limit_low", "limit_high"});
}

void add_means(Figure& figure, const Asked& asked, const std::vector<std::string>& measures,
               const TableAxes& axes) {
  const SweepResult& result = asked.result;
  for (const std::string& measure : measures) {
    number_of_column(result.measures, measure, "mean");
    const Table table = asked.means(measure, axes);
    figure.tables.push_back(table);
    add_answer_panel(figure, {table, axes.by.size(), "mean", "low", "high"});
  }
  if (!measures.empty() && !result.round.empty() && axes.by.size() < result.axes.size())
    figure.caption += "The sweep was refined: a mean over several cells counts only those that have runs. ";
}

void add_differences(Figure& figure, const Asked& asked, const SweepQuestion& question, TableAxes axes) {
  const SweepResult& result = asked.result;
  const std::size_t between = axis_between(result, question.between);
  std::erase(axes.by, between);
  const Column& axis = result.axes[between];
  const bool common =
      std::find(axes.common_noise.begin(), axes.common_noise.end(), between) != axes.common_noise.end();
  figure.caption += "Differences: from " + axis.name + " = " + axis_text(axis, 0) +
                    ", in pairs of runs with the same replicate" +
                    (common ? " and the same noise" : ", whose noise is independent") +
                    "; p is that of the sign test for an event, else of Student's t test with a "
                    "correction for skewness; adjusted_p: after Holm, for the rows of a table. ";
  for (const std::string& measure : question.differences) {
    number_of_column(result.measures, measure, "difference");
    const Table table = asked.differences(measure, between, axes);
    figure.tables.push_back(table);
    add_answer_panel(figure, {table, axes.by.size() + 1, "mean", "low", "high"});
  }
}

bool names_no_measure(const SweepQuestion& question) {
  return question.limit.empty() && question.means.empty() && question.differences.empty();
}

// Returns the event whose limit the question wants; an empty text if it wants none.
std::string event_of(const Asked& asked, const SweepQuestion& question) {
  const SweepResult& result = asked.result;
  if (!question.limit.empty()) return question.limit;
  const bool has_axis = std::any_of(result.axes.begin(), result.axes.end(), [](const Column& axis) {
    return has_numbers(axis) && axis.length() > 1;
  });
  if (question.along.empty() && !(names_no_measure(question) && has_axis)) return {};
  const std::string& event = asked.event;
  if (event.empty() && !question.along.empty())
    throw InputError(
        "along " + printable(question.along),
        "no run has popped_through, tool_popped_through or slave_touched: expected the measure of an event as "
        "limit");
  return event;
}

void refuse_options_without_effect(const SweepQuestion& question, bool has_limit) {
  if (!question.between.empty() && question.differences.empty())
    throw InputError("between " + printable(question.between), "without effect: expected also a difference");
  if (!has_limit && (question.level != 0.5 || question.threshold != 0.5))
    throw InputError("level and above", "without effect: expected also a limit");
  if (!question.by.empty() && question.means.empty() && question.differences.empty() &&
      !names_no_measure(question))
    throw InputError("by", "without effect: expected also a mean or a difference");
}

// Returns the numbers of the axes whose values have common noise, from the configuration of the sweep.
std::vector<std::size_t> axes_with_common_noise(const Json& config, std::size_t count) {
  std::vector<std::size_t> numbers;
  const Json axes = config.is_object() ? config.value("axes", Json::array()) : Json::array();
  for (std::size_t i = 0; axes.is_array() && i < std::min(axes.size(), count); ++i)
    if (axes[i].is_object() && axes[i].value("common_noise", axes[i].contains("variants")))
      numbers.push_back(i);
  return numbers;
}

}  // namespace

namespace {

// Returns the first measure of default_event() that has a value in some run; empty if there is none.
// is_known: called with the number of a measure; true if that measure has a value in some run.
template <class IsKnown>
std::string first_event(const std::vector<Column>& measures, const IsKnown& is_known) {
  for (std::size_t i = 0; i < measures.size(); ++i)
    for (const char* name : {"popped_through", "tool_popped_through", "slave_touched"})
      if (measures[i].name == name && is_known(i)) return name;
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
  const SweepResult& result = asked.result;
  const Json json = parse_json(config, "the configuration of the sweep");
  Figure figure{kAnswerName, json.is_object() ? json.value("title", std::string()) : "", {}};
  const std::string event = event_of(asked, question);
  refuse_options_without_effect(question, !event.empty());
  if (!event.empty()) add_limits(figure, asked, question, event);
  const TableAxes axes{axes_by(result, question.by), axes_with_common_noise(json, result.axes.size())};
  add_means(figure, asked, names_no_measure(question) ? names_of(result.measures) : question.means, axes);
  if (!question.differences.empty()) add_differences(figure, asked, question, axes);
  if (!figure.caption.empty()) figure.caption.pop_back();
  return figure;
}

[[noreturn]] void refuse_without_runs() {
  throw InputError("the sweep", "has no finished run: expected at least one");
}

[[noreturn]] void refuse_for_tally(const std::string& what, const std::string& why) {
  throw InputError(what, why + ": expected a sweep with \"keep\": \"runs\"");
}

std::size_t number_of_event(const SweepTally& tally, const LimitQuestion& question) {
  const std::size_t measure = number_of_column(tally.measures, question.measure, "limit");
  if (!is_event(tally.measures[measure]) || question.threshold != 0.5)
    refuse_for_tally("limit " + question.measure,
                     "a tally counts only the events themselves, at the threshold 0.5");
  return measure;
}

void require_no_pooled_noise(const SweepTally& tally, const TableAxes& axes) {
  for (const std::size_t axis : axes.common_noise)
    if (std::find(axes.by.begin(), axes.by.end(), axis) == axes.by.end())
      refuse_for_tally(
          "by", "a tally does not know which runs had the same noise on the axis " + tally.axes[axis].name);
}

}  // namespace

Figure sweep_answer(const SweepResult& result, const std::string& config, const SweepQuestion& question) {
  if (result.runs_in(RunState::done).empty()) refuse_without_runs();
  return answer_of(
      {result, [&](const LimitQuestion& limit) { return event_limits(result, limit); },
       [&](const std::string& measure, const TableAxes& axes) { return sweep_means(result, measure, axes); },
       [&](const std::string& measure, std::size_t between, const TableAxes& axes) {
         return sweep_differences(result, measure, between, axes);
       },
       default_event(result),
       [&](std::size_t measure) {
         const std::vector<std::size_t> done = result.runs_in(RunState::done);
         const auto& values = std::get<std::vector<double>>(result.measures[measure].values);
         const auto is_unknown = [&](std::size_t place) { return std::isnan(values[place]); };
         return std::pair<std::int64_t, std::int64_t>(done.size(),
                                                      std::count_if(done.begin(), done.end(), is_unknown));
       }},
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
  const SweepResult outline = outline_of(tally);
  const auto limits = [&](const LimitQuestion& limit) {
    const std::size_t measure = number_of_event(tally, limit);
    return event_limits(outline, {[&](std::size_t cell) { return event_count(tally, measure, cell); }},
                        limit);
  };
  const auto means = [&](const std::string& measure, const TableAxes& axes) {
    require_no_pooled_noise(tally, axes);
    return tally_means(tally, outline, number_of_column(tally.measures, measure, "mean"), axes.by);
  };
  const std::string event = first_event(tally.measures, [&](std::size_t measure) {
    return std::any_of(tally.tallies.begin(), tally.tallies.end(),
                       [&](const CellTally& cell) { return cell.measures[measure].values > 0; });
  });
  const auto unknown = [&](std::size_t measure) {
    std::pair<std::int64_t, std::int64_t> counts;
    for (const CellTally& cell : tally.tallies)
      counts.first += cell.done, counts.second += cell.measures[measure].unknown;
    return counts;
  };
  return answer_of({outline, limits, means, {}, event, unknown}, config, question);
}

}  // namespace remote_touch
