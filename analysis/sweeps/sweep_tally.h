// A sweep, or a part of one, that keeps a tally of each cell instead of the values of its runs, and its file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/storage/hdf5_reader.h"
#include "analysis/sweeps/sweep_result.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

// A set of runs, as ranges of their numbers.

struct RunRange {
  std::uint64_t first = 0, end = 0;  // first .. end - 1

  bool operator==(const RunRange&) const = default;
};

class RunRanges {
 public:
  // Adds the runs first .. end - 1. pre: the set has none of them.
  void add(RunRange range);
  // pre: the sets have no run in common.
  void add(const RunRanges& other);

  // Increasing; between two ranges is at least one run that the set does not have.
  const std::vector<RunRange>& ranges() const { return ranges_; }
  std::uint64_t count() const;  // number of runs
  // Number of runs in this range.
  std::uint64_t count_in(RunRange range) const;
  // Returns the first range of runs in both sets; an empty one if there is none.
  RunRange first_common(const RunRanges& other) const;
  // Returns the runs of first .. end - 1 that the set does not have.
  RunRanges missing_in(RunRange range) const;

  bool operator==(const RunRanges&) const = default;

 private:
  std::vector<RunRange> ranges_;
};

// The same runs in any order, and in any parts, give an equal tally. The measures of the grid have no values.
struct SweepTally : SweepGrid {
  SweepTally() = default;
  SweepTally(SweepGrid grid, bool with_events) : SweepGrid(std::move(grid)), keeps_events(with_events) {}

  bool keeps_events = false;         // keep = "events": the numbers of the runs in which an event happened
  std::vector<std::uint64_t> cells;  // the cells of which there are runs, increasing
  std::vector<CellTally> tallies;    // one for each of these cells
  RunRanges held;                    // the runs in the tallies, done or failed

  bool is_whole() const { return held.count() == run_count(); }
  RunRanges missing() const { return held.missing_in({0, run_count()}); }
  CellTally over_all_cells() const;                     // the sum of the tallies
  const CellTally* tally_of(std::uint64_t cell) const;  // null if there is no run of the cell
  // The events are the measures for which is_event() is true, if keeps_events.
  TallyLayout layout() const;

  // Adds one run, see CellTally. Throws std::invalid_argument if the tally has it already, or if there is no
  // such run. layout: what layout() returns.
  void add_done(const TallyLayout& layout, std::uint64_t run, std::span<const double> values,
                std::uint64_t note_bits);
  void add_failed(const TallyLayout& layout, std::uint64_t run, const std::string& error);

  // Returns why the other tally cannot be added, for example "runs 12 to 15 are in both"; empty if it can.
  std::string obstacle(const SweepTally& other) const;
  // Adds another part of the same sweep. Throws InputError with the obstacle; then nothing is changed.
  void add(SweepTally other);

  // Checks a tally of unknown origin. Returns what contradicts what, such as "the runs of a note exceed the
  // finished runs"; empty if it is consistent.
  std::string contradiction() const;

 private:
  CellTally& tally_for(const TallyLayout& layout, std::uint64_t run);
};

// Returns the outcomes of an event in the finished runs of a cell. pre: the measure of that number is an
// event (is_event()).
EventCounts event_counts(const SweepTally& tally, std::size_t measure, std::uint64_t cell);

// Returns the number of finished runs of a cell with a note. If there are several kinds of notes, it is that
// of the most frequent kind: a tally does not know how many runs have two kinds.
std::int64_t noted_runs(const SweepTally& tally, std::uint64_t cell);

// The arrays in which a tally is stored. For tally_file.cpp only.

// The names of all columns are paths below /tally.
struct TallyArrays {
  struct Array {
    Column column;
    std::vector<std::string> axes;  // names of scales, the last runs fastest
  };
  struct Group {
    std::string name;
    std::vector<Column> columns;  // columns of equal length; their names are within the group
  };
  std::vector<Column> scales;
  std::vector<Array> arrays;
  std::vector<Group> groups;
};

TallyArrays arrays_of(const SweepTally& tally);

// A tally of a sweep in HDF5.

// Root attributes: schema (kind "tally"), axes, measures, measure_units and measure_meanings (a line for
// each), replicates, keep ("tally" or "events"), digest, and those of the caller. The group /tally has the
// axes as dimension scales, and arrays over all axes; in a part without runs of some cells they are arrays
// over `cell`, the numbers of the cells that it has:
//   held_runs                  first and last of each range of runs that were made, one after the other: one
//                              range if the sweep is whole. The only array that is not over cells.
//   runs, failed               number of runs that were made, failed ones included; number of failed runs
//   note_runs, note_first      over note_kind, too: number of runs with such a note, and the first of them
//   MEASURE/values             number of finite values
//   MEASURE/unknown, infinite  number of NaN, of infinities; absent if there are none in any cell
//   MEASURE/least, greatest, mean               of the finite values; NaN without such values
//   MEASURE/standard_deviation                  of them; NaN with fewer than two; rounded to 16 bits
//   MEASURE/sum, sum_of_squares                 over `part`, too: UnroundedSum::parts(), filled up with 0
//   MEASURE/median_bucket, bucket_values        the sketch: number of values in the bucket median_bucket +
//                                               bucket_offset, over bucket_offset, too
// and groups of lists, which are absent if they are empty:
//   MEASURE/far_buckets/cell, bucket, values    buckets with another offset; see cell_tally.h
//   MEASURE/events/run         the runs in which the event happened, increasing (keep "events")
//   errors/run, error          of each cell with failed runs the first of them, and why it failed
// Numbers of cells and runs are those of SweepTally.

// SHA-256 of the names and values of all datasets: axes, held runs, and everything that is counted.
std::string digest(const SweepTally& tally);

// Writes the file and returns its digest. Equal tallies are equal bytes. attributes: configuration and
// provenance. Throws InputError if the file cannot be written, or if an axis or a measure has the name of
// another one or of a dataset (is_free_in_tallies()). pre: there is a run, and nothing contradicts
// (SweepTally::contradiction()).
std::string write_tally(const std::filesystem::path& file, const SweepTally& tally,
                        const TextAttributes& attributes);
// True if an axis or a measure may have that name.
bool is_free_in_tallies(const std::string& name);

bool is_tally(const TextAttributes& of_root);  // attributes of the root of a file
bool is_tally(const Hdf5Reader& file);

// The root attribute that states why some runs of the tally are known to be wrong; absent if none is.
inline constexpr const char* kDistrusted = "distrusted";
// Returns one line that warns of the wrong runs of such a tally; empty for any other result.
std::string distrust_of(const TextAttributes& attributes);
// Returns why a command that needs single runs or a figure does not accept a tally: "is a tally, which keeps
// no runs", with the warning of distrust_of(). Empty for any other result.
std::string tally_refusal(const TextAttributes& attributes);
// Throws InputError, which names the file, if some runs of the tally are known to be wrong. Call it before
// runs are added to a tally, and before a tally becomes a part of another result.
void require_trusted(const std::filesystem::path& file, const TextAttributes& attributes);

struct StoredTally {
  SweepTally tally;
  TextAttributes attributes;  // attributes of the caller of write_tally()
};
// Throws InputError, one line, for a file that is not a tally, or was changed since it was written.
StoredTally read_tally(const Hdf5Reader& file);

}  // namespace remote_touch
