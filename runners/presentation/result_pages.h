// Pages that show results: one or two traces, or a sweep.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "analysis/storage/trace_comparison.h"
#include "analysis/sweeps/sweep_result.h"
#include "core/kernels/kernels.h"
#include "runners/presentation/shown_run.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {

// A page of the viewer below a size limit: one self-contained HTML file, which reads nothing else.

// The viewer's script and style, which the build made from runners/presentation/page and embedded in
// the program. Both empty in a program that was built without Node.
std::string_view viewer_script();
std::string_view viewer_style();

// Returns an HTML page of the viewer: its script and style, what to show as JSON, and numbers, compressed.
// json: names the arrays in bytes as PackedArrays::add() does. Throws InputError without viewer_script().
std::string page_file(const std::string& title, const std::string& json, const std::string& bytes);

// Returns the bytes as a page stores them: gzip, then Base64.
std::string gzip_base64(const std::string& bytes);

struct ViewOptions {
  std::size_t max_bytes = 20'000'000;       // size of the page; points are left out until it fits
  std::filesystem::path claims = {};        // a claims.json, for shown_claims(); empty: none
  const Kernels* kernels = nullptr;         // pre: set
  const std::atomic<bool>* stop = nullptr;  // when set, ends with Interrupted
};

struct ViewPage {
  std::string html;
  std::string shown;  // number of shown points in words, a line for each run
};

// Shows the runs and the entries of `page`. numbers: arrays that `page` already names. Throws InputError,
// about the first run, if the page would be too large without any points, and in a program that was built
// without the viewer (see viewer_script()).
ViewPage view_page(const std::string& title, const std::vector<std::unique_ptr<ShownRun>>& runs,
                   const Json& page, const PackedArrays& numbers, const ViewOptions& options);

// An event of a run that is worth looking at.
struct TraceEvent {
  std::size_t tick;
  const char* kind;  // one of the kinds below, or "divergence", see ShownRun
  std::string text;  // sentence for the reader
};

// Returns the events in the order of their ticks:
//   pop-through    the proxy's centre passes through the true surface to its back, see contact_measures.h
//   first contact  the first tick with a contact
//   slave contact  the first tick with a force of the scene on the slave
//   hardest hit    the first tick with the largest force of the scene on the slave
//   force jump     the largest change of the force from one tick to the next
//   largest force  the first tick with the largest force
//   not converged  the first tick of each spell in which a tick ended before the proxy or tool had converged,
//                  at most 50
//   task           a step of the task began or ended
// steps: what the steps of the task do, for the text; may be fewer than there are. held_depth_m: see
// renderer.h.
std::vector<TraceEvent> trace_events(const ColumnSource& trace, const std::vector<std::string>& steps = {},
                                     double held_depth_m = 0);

// A page that shows one or two stored traces: the scene, the hand, the proxy or tool and the force in 3-D,
// and the columns as plots.

// Returns the claims of the figure whose experiment was run, which a page shows beside the run: `run fig4.12`
// belongs to figure 4.12. claims: the claims.json of `remote-touch figure`; empty: none. The result is a list
// of objects with claim, paper, measured, unit, criterion and verdict. It is empty for a run of another
// experiment, or with other settings. Throws InputError if the file is not a list of claims.
Json shown_claims(const std::filesystem::path& claims, const TextAttributes& run);

// traces: one, or two to compare. Frames are made again from the stored configurations. Throws InputError,
// naming the file, for a file that is no trace or of a live run, and as ShownRun and view_page() do.
ViewPage trace_page(const std::vector<std::filesystem::path>& traces, const ViewOptions& options);

// A page that shows a sweep: its map, and some of its runs, which are run again.

// Returns the runs of a sweep that a page shows if no cells are named: at most `max` runs whose measure is
// above the threshold, evenly spread over the grid, in ascending order. They are the failures nearest to the
// limit: the first failed run of each cell in which most runs failed and that has a neighbour in which most
// did not. A neighbour is the next cell along an axis that has finished runs. If no cell has such a
// neighbour, any cells with a failed run are used. If no run failed, returns the runs with the smallest and
// the largest value. Empty only if no run is done.
std::vector<std::size_t> default_runs(const SweepResult& result, const std::vector<double>& measure,
                                      double threshold, std::size_t max);

inline constexpr std::size_t kRunsOfSweepPage = 6;  // maximum if no cells are named

// cells: texts that cell_of() reads. The page shows the first failed run of each, or its first finished run
// if none failed. Empty: see default_runs(), with the measure that the sweep refines, else popped_through,
// else its first measure. Throws InputError if the file is not a finished sweep, if the sweep does not have a
// cell or has not run it, and as ShownRun and view_page() do.
ViewPage sweep_page(const std::filesystem::path& file, const std::vector<std::string>& cells,
                    const ViewOptions& options);

}  // namespace remote_touch
