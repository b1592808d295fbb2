// A folder into which figures are written, and the texts that are printed about them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runners/evaluation/figures/tools/figure_form.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/interfaces/cli/figure_runs.h"
#include "runners/interfaces/cli/progress.h"

namespace remote_touch {

class FigureFolder {
 public:
  // The runs must outlive it. Throws InputError if a file that it would write is there already and is no
  // result of this program.
  FigureFolder(const CommandLine& line, const std::string& folder, const std::vector<FigureRun>& runs);
  ~FigureFolder();

  // make_figures() calls finish() and report().
  void finish(std::size_t run, const FigureContext& context, Figure figure);
  // Prints the lines of the figures in the order of the figures, whichever was made first.
  void report(const FigureProgress& progress, Progress& shown);

  // Returns kCheckFailed if a claim failed. Otherwise returns kBadInput if no figure was made, and kDone if
  // one was. Also prints on standard error which figures were not made, and why.
  int exit_code() const;

 private:
  std::filesystem::path file_of(const std::string& figure) const {
    return folder_ / ("fig" + figure + ".h5");
  }
  std::filesystem::path progress_file() const { return folder_ / "progress.json"; }
  void write_progress(const FigureProgress& progress);

  const CommandLine& line_;
  std::filesystem::path folder_;
  const std::vector<FigureRun>& runs_;
  ClaimsFile claims_;
  std::vector<std::string> printed_;
  std::size_t next_ = 0;
  bool all_hold_ = true;
  int made_ = 0;
  std::string not_made_;
  std::string written_;
};

}  // namespace remote_touch
