// A parameter sweep: an experiment, axes along which its parameters change, and the measures of every run.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_means.h"
#include "analysis/sweeps/sweep_result.h"
#include "analysis/trace/measures.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/sweep/sweep_parts.h"

namespace remote_touch {

class Sweep {
 public:
  // Reads JSON text: {"title", "experiment", "set", "axes", "replicates", "measures", "refine", "keep"}.
  // label names the source in errors. Overrides "key=value" change the sweep if their path begins with one of
  // its keys, otherwise its experiment; the title names them (changed_settings.h). Cells are resolved and
  // checked: throws InputError for the first cell that cannot be run, and for parts that overwrite each other
  // (sweep_parts.h). Of more than 20000 cells, 20000 that are spread over the grid are checked, and
  // those with each value of an axis and the first values of the others.
  static Sweep from_json(const std::string& text, const std::string& label,
                         const std::vector<std::string>& overrides = {});
  // Reads a sweep of data/sweeps by its name, or a JSON file. An error in the text of a file begins with the
  // name of that file; an error in an override does not name a file.
  static Sweep load(const std::string& name_or_file, const std::vector<std::string>& overrides = {});

  const std::string& title() const;
  SweepGrid outline() const;
  // Returns a result without values, whose runs of the first round are pending. That of a shard is a part
  // with its runs of the first round. Throws InputError if it would have more than 1e7 runs, or if the sweep
  // keeps a tally.
  SweepResult plan(const Shard& shard = {}) const;
  // Returns a part that holds these runs, all pending. Throws InputError unless their numbers increase and
  // belong to runs of the sweep.
  SweepResult part(std::vector<std::uint64_t> runs) const;
  // Returns the experiment of one run. It has the values that the result states for its cell; throws
  // InputError otherwise. The noise key contains cell and replicate, so each run has its own noise. For an
  // axis with common noise the key contains the cell of the first value, so runs that differ only on this
  // axis have the same noise.
  Experiment experiment(std::size_t cell, int replicate) const;
  // Throws InputError, with the name of the file, for a stored result with other axes, measures or
  // replicates: none of its runs belongs to this sweep.
  void require_fits(const SweepGrid& stored, const std::string& file) const;
  // Returns the recordings that the checked cells read, each part once, as named in the configuration.
  const std::vector<InputPart>& inputs() const;
  const std::vector<Measure>& measures() const;
  bool needs_true_contact() const;  // true if one of its measures does
  std::optional<RefinementRule> refinement() const;
  Keep keep() const;
  std::string to_json() const;  // complete: read again, it makes the same sweep
  // Returns the sweep with every every-th value of each axis, see thinned_axis(). The runs have other noise
  // than those of the full sweep.
  Sweep thinned(int every) const;

 private:
  struct Definition;
  std::shared_ptr<const Definition> definition_;
};

}  // namespace remote_touch
