// The tally of the runs of a cell; a sweep, or a part of one, that keeps it instead of the values of its
// runs; and its file.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/storage/hdf5_reader.h"
#include "analysis/sweeps/sweep_result.h"
#include "analysis/trace/columns.h"

namespace remote_touch {

// The exact sum of doubles, which does not depend on the order of the terms.

// The sum is kept as a short list of doubles; added exactly they give the sum. Adding a double changes the
// list without a rounding. Source: J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast
// robust geometric predicates", Discrete & Computational Geometry 18 (1997), theorem 10. Most sums fit into
// three doubles, which are added to from the largest down. Only what these cannot hold goes to a list like
// Shewchuk's. Sums above 2^1022 are exact, too: whole multiples of 2^1023 are counted apart.
class UnroundedSum {
 public:
  // pre: the value is finite.
  void add(double value);
  // Adds the square of a finite value: its rounded square and, by std::fma, the rest. This is exact if value
  // is 0 or |value| is at least 2^-485 (1e-146). The square of a smaller value is rounded to a multiple of
  // 2^-1074, the least double. If the rounded square is infinite, |value| >= 2^512 (1.34e154), the sum
  // becomes infinite and remains so. In both cases the result depends on the values alone, not on their
  // order.
  void add_square(double value);
  // Adds a product of finite values. Exact if it is 0, or at least 2^-968 in magnitude; else it is rounded as
  // a square is. pre: the rounded product is finite.
  void add_product(double a, double b);
  void add(const UnroundedSum& other);

  // Returns the sum, correctly rounded to nearest (even), so infinity if it is above the largest double. The
  // sum of nothing is +0.
  double value() const;
  // True after the square of a value was too large.
  bool is_infinite() const { return is_infinite_; }

  // Returns value(), then the rounded rest, and so on until nothing is left; empty if the sum is 0. Equal
  // sums have equal parts, and the exact sum of the parts is the sum. At most 42. If value() is infinite, the
  // parts are: that infinity; a whole number u; and the parts of the sum minus u 2^1023, which is in
  // (-2^1022, 2^1022]. They are infinity alone if is_infinite().
  std::vector<double> parts() const;
  // Returns nothing unless the numbers are what parts() returns for some sum.
  static std::optional<UnroundedSum> from_parts(std::span<const double> parts);

  bool operator==(const UnroundedSum& other) const { return parts() == other.parts(); }

 private:
  std::array<double, 3> largest_{};  // their exact sum counts; they may overlap
  std::vector<double> others_;  // the rest that largest_ cannot hold: nonoverlapping, by increasing magnitude
  std::int64_t units_ = 0;      // multiples of 2^1023
  bool is_infinite_ = false;
};

// Counts of values in fixed narrow buckets, from which quantiles follow with a known error.

// The bucket of a double is its sign, its exponent and the first 5 bits of its mantissa, so that nothing is
// rounded. There are 32 buckets of equal width from each power of two to the next. Buckets are numbered in
// the order of their values: 0 holds 0 and -0 only; b > 0 holds the doubles whose bits, shifted right by 47,
// are b - 1; -b holds their negatives. The sketch of values does not depend on their order.
class QuantileSketch {
 public:
  // Number of the bucket of a finite value.
  static std::int32_t bucket_of(double value);
  // Returns the middle of a bucket. It differs from each value v in the bucket by at most |v| / 64 (1.6 %),
  // because the bucket is 1/32 of the power of two at or below |v| wide. Below 2^-1022 it differs by at most
  // 2^-1028 instead. The middle of bucket 0 is 0.
  static double middle_of(std::int32_t bucket);

  // pre: the value is finite.
  void add(double value);
  void add(const QuantileSketch& other);

  std::int64_t count() const;  // number of values
  // Approximates x_k of the sorted values x_1 .. x_n, k = max(1, ceil(p n)), by the middle of its bucket.
  // This is the inverse of the empirical distribution function: type 1 of Hyndman and Fan, Sample quantiles
  // in statistical packages, The American Statistician 50 (1996). The product p n is rounded to a double. NaN
  // without values. pre: 0 <= p <= 1.
  double quantile(double p) const;
  // Returns the bucket that has x_k; 0 without values.
  std::int32_t bucket_at(double p) const;

  // Buckets with their counts, increasing. from_pairs() returns nothing unless pairs() may return the list.
  std::vector<std::pair<std::int32_t, std::int64_t>> pairs() const;
  static std::optional<QuantileSketch> from_pairs(
      const std::vector<std::pair<std::int32_t, std::int64_t>>& pairs);

  bool operator==(const QuantileSketch&) const = default;

 private:
  std::vector<std::int32_t> buckets_;  // increasing
  std::vector<std::int64_t> counts_;   // counts of these buckets; above 0
};

// The tally of one measure in the runs of a cell.

// Equal values in any order, and in any parts that are added to each other, give equal bits.
struct MeasureTally {
  std::int64_t values = 0;    // number of finite values; least, greatest, sums and sketch are of these only
  std::int64_t unknown = 0;   // NaN
  std::int64_t infinite = 0;  // infinity of either sign
  double least = std::numeric_limits<double>::infinity();  // infinity and -infinity without values
  double greatest = -std::numeric_limits<double>::infinity();
  UnroundedSum sum,
      squares;  // sums of the values and of their squares; add_square() states the range of the latter
  QuantileSketch sketch;

  void add(double value);  // any double; -0 counts as 0
  void add(const MeasureTally& other);

  // Returns the rounded sum divided by the number of values; NaN without values.
  double mean() const;
  // Returns (n sum of squares - (sum)^2) / (n (n - 1)). The numerator is rounded once, so nothing cancels.
  // NaN with fewer than two values, or if the sum or the sum of squares is above the largest double (values
  // of 1e154). Deviations below 1e-146 are lost.
  double variance() const;
  double standard_deviation() const;
  // Returns the quantile of QuantileSketch, clipped to least .. greatest. It differs by at most 1.6 % from
  // the value that it approximates, x_k of the sorted values. p = 0 gives least and p = 1 greatest. NaN
  // without values.
  double quantile(double p) const;

  // Checks a tally of unknown origin. Returns what contradicts what, such as "the extremes are outside the
  // sketch"; empty if it is consistent.
  std::string contradiction() const;
  bool operator==(const MeasureTally&) const = default;
};

// The layout that all tallies of one sweep have.
struct TallyLayout {
  std::size_t measures = 0;    // number of measures
  std::size_t note_kinds = 0;  // number of kinds of notes, at most 64
  std::vector<std::size_t>
      events;  // the measures whose runs are listed, increasing; empty for keep = "tally"
};

// Runs with a note of one kind.
struct NoteTally {
  std::int64_t runs = 0;
  std::uint64_t first = 0;  // lowest number of such a run; without meaning (0) if there is none

  bool operator==(const NoteTally&) const = default;
};

// The same runs, in any order and in any parts that are added to each other, give equal bits. Numbers of runs
// are those of SweepResult: cell times replicates plus replicate. The caller adds no run twice.
struct CellTally {
  CellTally() = default;
  explicit CellTally(const TallyLayout& layout)
      : measures(layout.measures), notes(layout.note_kinds), events(layout.events.size()) {}

  std::int64_t done = 0;
  std::int64_t failed = 0;
  std::uint64_t first_failed = 0;  // lowest number of a failed run; without meaning (0) if none failed
  std::string first_error;         // why that run failed
  std::vector<MeasureTally> measures;
  std::vector<NoteTally> notes;  // one for each kind
  // One list for each of the layout's events: the numbers of the runs in which it is above 0.5, increasing.
  std::vector<std::vector<std::uint64_t>> events;

  std::int64_t runs() const { return done + failed; }
  // Adds a run that was done. values: one for each measure; NaN if unknown. note_bits: bit i is set if the
  // run has a note of kind i. pre: the tally was made for this layout.
  void add_done(const TallyLayout& layout, std::uint64_t run, std::span<const double> values,
                std::uint64_t note_bits);
  // Adds a run that failed. It counts in no measure and has no notes.
  void add_failed(std::uint64_t run, const std::string& error);
  // pre: both tallies were made for the same layout.
  void add(const CellTally& other);

  // Checks a tally of unknown origin. Returns what contradicts what, such as "the runs of a note exceed the
  // finished runs"; empty if it is consistent.
  std::string contradiction() const;
  bool operator==(const CellTally&) const = default;
};

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
//   MEASURE/far_buckets/cell, bucket, values    buckets with another offset
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
