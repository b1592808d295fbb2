// A folder that figures are written into, and what is said of them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runners/interfaces/cli/claims_file.h"
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

  // The two calls of make_figures().
  void finish(std::size_t run, const FigureContext& context, Figure figure);
  // Prints the lines of the figures in the order of the figures, whichever was made first.
  void report(const FigureProgress& progress, Progress& shown);

  // A claim that failed comes before all else. What was not made is said on the standard error too; where
  // that is all, nothing was done.
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
