// A tally of a sweep in HDF5.
#pragma once

#include <filesystem>
#include <string>

#include "analysis/storage/hdf5_reader.h"
#include "analysis/sweeps/sweep_tally.h"

namespace remote_touch {

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
