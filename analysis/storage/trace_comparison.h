// Comparison of two traces: columns to compare, what differs between two of them, from which tick on, and in
// which situation it began.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "analysis/storage/hdf5_reader.h"
#include "analysis/storage/result_file.h"
#include "analysis/trace/columns.h"

namespace remote_touch {

// Columns to compare: in a file, read one at a time as needed, or in memory.
class ColumnSource {
 public:
  virtual ~ColumnSource() = default;
  virtual std::vector<std::string> column_names() const = 0;  // order: as stored and hashed
  virtual Column column(const std::string& name) const = 0;
  // Rows first .. first + count - 1; pre: they exist.
  virtual Column rows(const std::string& name, std::size_t first, std::size_t count) const = 0;

  bool has(const std::string& name) const;
};

// Columns below a group of a file.
class StoredColumns : public ColumnSource {
 public:
  std::vector<std::string> column_names() const override { return column_names_; }
  Column column(const std::string& name) const override { return hdf5_.column(group_ + name); }
  Column rows(const std::string& name, std::size_t first, std::size_t count) const override {
    return hdf5_.rows(group_ + name, first, count);
  }
  const TextAttributes& attributes() const { return hdf5_.attributes(); }

 protected:
  StoredColumns(Hdf5Reader hdf5, std::string group) : hdf5_(std::move(hdf5)), group_(std::move(group)) {}
  Hdf5Reader hdf5_;
  std::string group_;  // with a slash at its end
  std::vector<std::string> column_names_;
};

// Throws InputError for a file that is not a trace, has another version of the layout, or was changed since
// it was written.
class StoredTrace final : public StoredColumns {
 public:
  explicit StoredTrace(Hdf5Reader hdf5);
  explicit StoredTrace(const std::filesystem::path& file) : StoredTrace(Hdf5Reader(file)) {}
  std::vector<std::uint64_t> running_hash() const;  // kRunningHash
};

// The tables of a figure; columns are named table/column.
class StoredFigure final : public StoredColumns {
 public:
  explicit StoredFigure(Hdf5Reader hdf5);
};

class ColumnsInMemory final : public ColumnSource {
 public:
  explicit ColumnsInMemory(std::vector<Column> columns) : all_(std::move(columns)) {}
  std::vector<std::string> column_names() const override { return names_of(all_); }
  Column column(const std::string& name) const override { return find(name); }
  Column rows(const std::string& name, std::size_t first, std::size_t count) const override;

 private:
  const Column& find(const std::string& name) const;
  std::vector<Column> all_;
};

// Deviations of the values of one column from those of another.

// A row is a number or a vector. Its deviation is the length of the difference, in the column's units. The
// row is inside the tolerance if the deviation is at most absolute + relative * |row of the baseline|.
//
// Numbers are compared as in trace.h. Names (enumerations), texts and hashes are outside unless they are
// equal. Different types, widths, units, value names or lengths are a problem. Columns of different types or
// widths are not compared further; otherwise the rows that both have are compared nevertheless. Two columns
// without rows are the same.
struct ColumnComparison {
  std::string name, units;
  Tolerance tolerance;
  std::string problem = {};  // empty: none
  std::size_t baseline_rows = 0, candidate_rows = 0;
  std::size_t rows = 0;         // rows compared
  std::size_t outside = 0;      // rows outside the tolerance
  std::size_t not_numbers = 0;  // rows outside because of a NaN, an infinity or a difference that overflows
  double max = 0, rms = 0;      // largest and rms finite deviation, in units; 0 for names, texts and hashes
  std::optional<std::size_t> first_difference = {}, first_outside = {};

  bool is_same() const { return problem.empty() && outside == 0; }
};

ColumnComparison compare_columns(const Column& baseline, const Column& candidate, const Tolerance& tolerance);

// Returns the deviation of every row that both have; none if their types or widths differ. NaN if one has a
// NaN or an infinity and the other does not, or if the difference overflows. For names, texts and hashes it
// is 0 if they are equal, else 1.
std::vector<double> deviations(const Column& baseline, const Column& candidate);

// The running hash of a trace, without the trace. It can be sent to another machine to find the first tick at
// which two runs differ. It has 8 bytes per tick, or less if only every n-th tick is kept.
struct TickHashes {
  std::vector<std::int32_t> tick;   // increasing; the last is the trace's last
  std::vector<std::uint64_t> hash;  // the running hash at that tick (trace.h)
};

// Returns every n-th tick of a trace (n = every), and the last. pre: every > 0.
TickHashes hashes_of_trace(const StoredTrace& trace, int every);

void write_hashes(const std::filesystem::path& file, const TickHashes& hashes,
                  const TextAttributes& provenance);
struct StoredHashes {
  TickHashes hashes;
  TextAttributes attributes;
};
StoredHashes read_hashes(const Hdf5Reader& file);  // throws InputError for any other file
inline StoredHashes read_hashes(const std::filesystem::path& file) {
  return read_hashes(Hdf5Reader(file));
}

// Comparison over the ticks that both have. The runs are equal up to and including tick `same`, and differ
// from tick `different` on. The ticks in between are not stored in both.
struct HashComparison {
  std::size_t compared = 0;
  std::optional<int> same, different;
  bool same_length = false;
  bool is_same() const { return compared > 0 && same_length && !different; }
};
HashComparison compare_hashes(const TickHashes& baseline, const TickHashes& candidate);

// The situation in which two runs begin to differ; the first that applies, in this order. It describes the
// two traces at the first tick at which any value differs, not the reason in the program.
enum class Cause {
  configuration,  // the experiments are not the same
  input,          // the renderer's inputs differ: time, HIP, a frame (points, time of capture), or the truth
  frame_update,   // inputs are the same, and a frame arrived in this tick, or one run did not use it
  state_transition,  // no frame came, and the proxy's state differs, or changed with this tick
  drift              // none of these: within a steady state
};
const char* name_of(Cause cause);

// The first divergent tick.
struct Divergence {
  std::size_t tick = 0;                     // the first with a value outside its tolerance
  double time_s = 0;                        // time of the baseline; NaN if it has none
  std::string quantity;                     // the column, the first in the trace's order
  double deviation = 0;                     // there, in its units; NaN for a NaN or an infinity
  std::size_t first_difference = 0;         // the first tick with any difference, inside or not; at most tick
  Cause cause = Cause::drift;               // configuration if the experiments differ, else the situation
  std::string explanation;                  // one line
  Cause situation = Cause::drift;           // situation at first_difference
  std::string observation;                  // one line: reason for the situation
  std::string frame;                        // one line: the baseline's frame there, and its next
  std::size_t first_row = 0;                // number of the first row below: first_difference - 1, or 0
  std::vector<Column> baseline, candidate;  // rows first_row .. first_difference of the common columns
};

struct TraceComparison {
  // Columns of the baseline, in its order; if the experiments differ, also those that only the candidate has.
  std::vector<ColumnComparison> columns;
  std::vector<std::string> added;        // other columns that only the candidate has: not compared
  std::optional<Divergence> divergence;  // set if a column has a row outside
  bool is_same() const;                  // false also if nothing was compared
};

// Compares the columns of two sources by name; does not search for a divergence. configuration: differences
// between the experiments of both, one text each. A column that only the baseline has is a problem of that
// column. So is one that only the candidate has, unless the experiments are the same: then a later version of
// the program has added it.
TraceComparison compare_by_name(const ColumnSource& baseline, const ColumnSource& candidate,
                                const Tolerances& tolerances, const std::vector<std::string>& configuration);

// Compares two traces by name, and finds their divergence. The running hash is not compared, because it
// follows from the others. At most two columns are in memory at a time.
TraceComparison compare_traces(const ColumnSource& baseline, const ColumnSource& candidate,
                               const Tolerances& tolerances, const std::vector<std::string>& configuration);

// Figure of the deviation between two traces over time.

// One panel for each column that differs, at most 8, in the trace's order. A panel has the decimal logarithm
// of the largest deviation in each of up to 2000 intervals of time (NaN if nothing differs), and a dot at the
// first row outside the tolerance. The caption has the first divergent tick.
Figure deviation_figure(const ColumnSource& baseline, const ColumnSource& candidate,
                        const TraceComparison& comparison);

}  // namespace remote_touch
