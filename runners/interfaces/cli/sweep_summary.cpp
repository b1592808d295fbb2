#include "runners/interfaces/cli/sweep_summary.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "analysis/sweeps/sweep_file.h"
#include "analysis/sweeps/sweep_tally.h"
#include "core/parameters/parameter.h"
#include "runners/interfaces/cli/program.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep_answer.h"

namespace remote_touch {

namespace {

constexpr std::size_t kMaxFailures = 20;  // number that is printed

}  // namespace

std::string extent_text(const SweepGrid& grid) {
  std::string text;
  for (const Column& axis : grid.axes) text += (text.empty() ? "" : " x ") + std::to_string(axis.length());
  return text;
}

// Counts that were there come from lower runs.
void SweepSummary::add_notes(const std::vector<NoteCount>& counts) {
  for (const NoteCount& count : counts) {
    const auto same = std::find_if(notes_.begin(), notes_.end(),
                                   [&](const NoteCount& each) { return each.kind == count.kind; });
    if (same == notes_.end())
      notes_.push_back(count);
    else
      same->runs += count.runs;
  }
}

void SweepSummary::add(const SweepResult& block) {
  const std::vector<std::size_t> done = block.runs_in(RunState::done);
  const std::vector<std::size_t> failed = block.runs_in(RunState::failed);
  held_ += block.held_count(), done_ += done.size(), failed_ += failed.size();
  elsewhere_ += block.runs_in(RunState::elsewhere).size();
  for (const std::int32_t round : block.round) rounds_ = std::max(rounds_, round + 1);
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    const auto& values = std::get<std::vector<double>>(block.measures[i].values);
    Range& range = ranges_[i];
    for (const std::size_t place : done) {
      const double value = values[place];
      if (!std::isfinite(value)) continue;
      range.low = std::min(range.low, value), range.high = std::max(range.high, value), range.sum += value;
      ++range.count;
    }
  }
  for (std::size_t i = 0; i < failed.size() && failures_.size() < kMaxFailures; ++i) {
    const std::size_t run = block.run_at(failed[i]);
    failures_.push_back("--cell " + cell_text(block, block.cell_of(run)) + " --replicate " +
                        std::to_string(block.replicate_of(run)) + ": " + block.error[failed[i]]);
  }
  add_notes(note_counts(block));
}

// "mean 0.25  0 .. 1 1, of 4 of 5 runs". Runs whose value is not finite are left out, because an unknown
// outcome is neither 0 nor 1. The text then states the number of runs in the mean.
std::string SweepSummary::text_of(const Range& range, const std::string& units) const {
  if (range.count == 0) return "no value in any run";
  const std::string text =
      formatted("mean %-10.6g %.6g .. %.6g %s", range.sum / static_cast<double>(range.count), range.low,
                range.high, units.c_str());
  if (range.count == done_) return text;
  return text + formatted(", of %zu of %zu runs", range.count, done_);
}

int SweepSummary::print(const std::string& file, const std::string& digest) const {
  std::printf("%s: %s cells, %zu runs done, %zu failed", printable(file).c_str(), extent_text(grid_).c_str(),
              done_, failed_);
  if (rounds_ > 0) std::printf(" in %d rounds", rounds_);
  const std::size_t elsewhere = elsewhere_ + (rounds_ == 0 ? grid_.run_count() - held_ : 0);
  if (elsewhere > 0) std::printf(", %zu in other shards", elsewhere);
  std::printf(", digest %s\n", digest.c_str());
  for (std::size_t i = 0; done_ > 0 && i < ranges_.size(); ++i) {
    const Column& measure = grid_.measures[i];
    std::printf("  %-20s %s\n", measure.name.c_str(), text_of(ranges_[i], measure.units).c_str());
  }
  for (const std::string& line : note_lines(grid_, notes_, done_)) std::printf("  note: %s\n", line.c_str());
  for (const std::string& failure : failures_) std::printf("  failed: %s\n", failure.c_str());
  if (failed_ > failures_.size())
    std::printf("  and %zu more, in the dataset /sweep/error\n", failed_ - failures_.size());
  return failed_ == 0 ? kDone : kCheckFailed;
}

void print_equal_runs(const SweepGrid& grid, const std::string& config) {
  constexpr std::size_t kMostCells = 1'000'000;
  if (grid.replicates == 1 || grid.cell_count() > kMostCells) return;
  const CellStreams streams = streams_of(grid, config);
  std::size_t fixed = 0, first = 0;
  for (std::size_t cell = grid.cell_count(); cell-- > 0;)
    if (streams.doubt.empty() && streams.is_fixed(cell)) ++fixed, first = cell;
  if (fixed > 0)
    std::printf(
        "  note: %zu of %zu cells draw no random numbers: their %d replicates are equal, and analyse "
        "counts them as one run (the first: --cell %s)\n",
        fixed, grid.cell_count(), grid.replicates, cell_text(grid, first).c_str());
}

int print_summary(const std::string& file, const SweepResult& result) {
  SweepSummary summary(grid_of(result));
  summary.add(result);
  return summary.print(file, digest(result));
}

std::string measure_text(const MeasureTally& all, const std::string& units) {
  if (all.values == 0) return "no value in any run";
  const std::string text = formatted("mean %-10.6g %.6g .. %.6g %s, median %.3g", all.mean(), all.least,
                                     all.greatest, units.c_str(), all.quantile(0.5));
  if (all.unknown + all.infinite == 0) return text;
  return text + ", of " + std::to_string(all.values) + " of " +
         std::to_string(all.values + all.unknown + all.infinite) + " runs";
}

namespace {

void print_failures(const SweepTally& tally) {
  std::size_t cells = 0;
  for (const CellTally& cell : tally.tallies) {
    if (cell.failed == 0 || ++cells > kMaxFailures) continue;
    std::printf("  failed: %lld runs of one cell; the first is %s: %s\n", static_cast<long long>(cell.failed),
                option_of_run(tally, static_cast<std::size_t>(cell.first_failed)).c_str(),
                cell.first_error.c_str());
  }
  if (cells > kMaxFailures) std::printf("  and %zu more cells, in /tally/errors\n", cells - kMaxFailures);
}

}  // namespace

int print_summary(const std::string& file, const SweepTally& tally) {
  const CellTally all = tally.over_all_cells();
  std::printf("%s: %s cells, %lld runs done, %lld failed", printable(file).c_str(),
              extent_text(tally).c_str(), static_cast<long long>(all.done),
              static_cast<long long>(all.failed));
  if (const std::uint64_t others = tally.run_count() - tally.held.count(); others > 0)
    std::printf(", %llu not made here", static_cast<unsigned long long>(others));
  std::printf(", digest %s\n", digest(tally).c_str());
  for (std::size_t i = 0; i < all.measures.size(); ++i)
    std::printf("  %-20s %s\n", tally.measures[i].name.c_str(),
                measure_text(all.measures[i], tally.measures[i].units).c_str());
  for (const std::string& line : note_lines(tally)) std::printf("  note: %s\n", line.c_str());
  print_failures(tally);
  return all.failed == 0 ? kDone : kCheckFailed;
}

}  // namespace remote_touch
