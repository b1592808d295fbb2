#include "runners/interfaces/cli/tally_summary.h"

#include <algorithm>
#include <cstdio>

#include "core/parameters/input_error.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/interfaces/cli/sweep_summary.h"
#include "runners/sweep/sweep_notes.h"
#include "runners/sweep/tally_outline.h"

namespace remote_touch {

namespace {

constexpr std::size_t kMaxFailedCells = 20;  // that are printed

std::string text_of(const MeasureTally& all, const std::string& units) {
  if (all.values == 0) return "no value in any run";
  char text[200];
  std::snprintf(text, sizeof text, "mean %-10.6g %.6g .. %.6g %s, median %.3g", all.mean(), all.least,
                all.greatest, units.c_str(), all.quantile(0.5));
  if (all.unknown + all.infinite == 0) return text;
  return text + (", of " + std::to_string(all.values)) + " of " +
         std::to_string(all.values + all.unknown + all.infinite) + " runs";
}

void print_failures(const SweepTally& tally, const SweepResult& outline) {
  std::size_t printed = 0, cells = 0;
  for (const CellTally& cell : tally.tallies) {
    if (cell.failed == 0) continue;
    ++cells;
    if (++printed > kMaxFailedCells) continue;
    std::printf("  failed: %lld runs of a cell, the first: %s: %s\n", static_cast<long long>(cell.failed),
                option_of_run(outline, static_cast<std::size_t>(cell.first_failed)).c_str(),
                cell.first_error.c_str());
  }
  if (cells > kMaxFailedCells) std::printf("  and %zu more cells, in /tally/errors\n", cells - kMaxFailedCells);
}

}  // namespace

int print_summary(const std::string& file, const SweepTally& tally, const std::string& digest) {
  const SweepResult outline = outline_of(tally);
  CellTally all(tally.layout());
  for (const CellTally& cell : tally.tallies) all.add(cell);
  std::printf("%s: %s cells, %lld runs done, %lld failed", printable(file).c_str(),
              extent_text(outline).c_str(), static_cast<long long>(all.done),
              static_cast<long long>(all.failed));
  if (const std::uint64_t others = tally.run_count() - tally.held.count(); others > 0)
    std::printf(", %llu not made here", static_cast<unsigned long long>(others));
  std::printf(", digest %s\n", digest.c_str());
  for (std::size_t i = 0; i < all.measures.size(); ++i)
    std::printf("  %-20s %s\n", tally.measures[i].name.c_str(),
                text_of(all.measures[i], tally.measures[i].units).c_str());
  for (const std::string& line : note_lines(tally)) std::printf("  note: %s\n", line.c_str());
  print_failures(tally, outline);
  return all.failed == 0 ? kDone : kCheckFailed;
}

}  // namespace remote_touch
