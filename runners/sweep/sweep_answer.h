// Answers to the usual questions about a finished sweep, as a figure of tables and curves, and their display.
#pragma once

#include <string>
#include <vector>

#include "analysis/storage/result_file.h"
#include "analysis/sweeps/sweep_result.h"
#include "analysis/sweeps/sweep_tally.h"

namespace remote_touch {

// Curves of the tables of an answer about a sweep.

// Adds a panel to the figure for a table of an answer: first `axes` columns of axes, then those of
// add_estimates(). It has the value over the first axis of numbers, its interval as a band, and a curve for
// each combination of the other axes; without an axis of numbers, dots over an axis of names. Each curve has
// a table of its own, with the rows that have a value. A panel has at most 8 curves: if there are more, the
// longest axis is across, or another axis has a panel for each value; if that does not help, only the first 8
// are drawn, and the title and the caption say so. Adds nothing if no axis has two values.
void add_answer_panel(Figure& figure, const Table& table, std::size_t axes);

// Adds panels in the same way for a table of limits along an axis, with their intervals as bars; an open end
// is an arrow. A limit that is not between the values of the axis is a mark at the end of the axis, with a
// legend entry. A single limit is drawn too. Adds nothing if there is nothing to draw.
void add_answer_limits(Figure& figure, const Table& table, std::size_t axes, const Column& along);

// True if the table is that of one curve, whose rows are also in the table of the answer.
bool is_of_curve(const Figure& figure, const Table& table);

// Returns the value of an axis in a row of a table, without a unit: at most ten digits, or its name.
std::string axis_text(const Column& axis, std::size_t row);

// Returns an answer as text: the caption and each table with names, units and at most 60 rows; "-" stands for
// a value that is not known. Tables of single curves, which repeat rows, are left out. A note states how many
// of the `asked` runs are not finished.
std::string answer_text(const Figure& answer, std::size_t done, std::size_t asked);

// Returns the random streams of all cells of a stored sweep, from the configuration with which the sweep was
// made (JSON): it states every deviation and probability, the axes with common noise, and seeds. So they are
// known for every stored sweep and tally. If the configuration cannot be read, as that of an experiment with
// a scene that only the program that made it knows, `doubt` says so; then runs of one replicate count as one,
// and so do the runs of a cell that are equal in all measures, if they are known.
CellStreams streams_of(const SweepResult& result, const std::string& config);
CellStreams streams_of(const SweepGrid& grid, const std::string& config);

// A question names measures and axes. A question that names no measure asks for the limit of the event that
// default_event() finds and for the means of all measures. Options without an effect are refused.
struct SweepQuestion {
  // Where does an event become more probable than `level` along an axis? Empty `along`: the last axis of at
  // least two numbers. direction: "rises" if the event becomes more probable along the axis, "falls" if less;
  // empty: as the runs show it. With `between`, also: how do the limits differ between the first value of
  // that axis and each other value? See sweep_means.h.
  std::string limit;
  std::string along;
  double threshold = 0.5;
  double level = 0.5;
  // What are the means of these measures for each combination of the axes `by`? Empty `by`: all axes; then a
  // mean is that of one cell. See sweep_means.h.
  std::vector<std::string> means;
  std::vector<std::string> by;
  // How do these measures differ between the first value of the axis `between` and each other value, for each
  // combination of the axes `by`? Empty `between`: the first axis whose values are names.
  std::vector<std::string> differences;
  std::string between;
  std::string direction = {};
};

// Returns the first measure of an event (is_event()) that is known in a run; an empty text if there is none.
std::string default_event(const SweepResult& result);

// The name of the figure that sweep_answer() returns.
inline constexpr const char* kAnswerName = "analysis";

// Returns a figure with the tables `limits`, `limit_difference`, `limit_ratio`, `mean_MEASURE` and
// `difference_MEASURE`, and with panels of them, as add_answer_panel() draws them. All p values are adjusted
// together. The caption states the questions. config: the configuration of the sweep as JSON; its title is
// that of the figure, and it states which runs share random numbers (streams_of()). Throws InputError for a
// name that the sweep does not have, an axis that does not fit, and a sweep without a finished run.
Figure sweep_answer(const SweepResult& result, const std::string& config, const SweepQuestion& question);

// The same for a tally, which keeps neither single runs nor counts for other thresholds. Throws InputError
// also for a difference, for a limit of a measure that is no event or with another threshold than 0.5, for
// means over cells that share random numbers, and for a sweep of more than 1e7 cells.
Figure sweep_answer(const SweepTally& tally, const std::string& config, const SweepQuestion& question);

}  // namespace remote_touch
