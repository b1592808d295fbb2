// What a page shows of one run, as JSON that names arrays of numbers.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "analysis/comparison/column_source.h"
#include "analysis/storage/hdf5_file.h"
#include "core/geometry/bounding_box.h"
#include "core/kernels/kernels.h"
#include "runners/view/packed_arrays.h"
#include "scenarios/text_files/json_text.h"

namespace remote_touch {

// A trace, stored or in memory, and what is known of it.
struct RunSource {
  std::string name;  // on the page and in errors: a file, or a run of a sweep
  std::shared_ptr<const ColumnSource> columns;
  TextAttributes attributes;  // of which config must be there
  std::string note = {};      // what the reader must know of it
  std::string claims = "[]";  // JSON, as shown_claims() gives them
};

class ShownRun {
 public:
  // Throws InputError, about the name, when the configuration cannot be run, or its recording is missing or
  // is not the one that was read.
  ShownRun(RunSource source, const Kernels& kernels, const std::atomic<bool>* stop);
  ~ShownRun();

  const RunSource& source() const;
  std::string title() const;
  std::size_t frame_count() const;  // in use, at least 1

  // The part of the scene that is shown. At first the action: where HIP and proxy or tool are, and some room.
  // Settled with the first json().
  const BoundingBox& box_W() const;
  void set_box(const BoundingBox& box_W);

  // Adds the first tick with any difference from another run to the events.
  void mark_divergence_from(const ShownRun& other);

  // The first call makes the frames of the run again; later calls leave out points. max_others: see
  // ShownPointsRule, of each frame, no more than in the first call.
  Json json(PackedArrays& numbers, std::size_t max_others);
  // Which points the last json() had, in a line.
  const std::string& shown() const;
  // What the reader must know, after json(); empty: nothing.
  const std::string& note() const;

 private:
  struct State;
  const std::unique_ptr<State> state_;
};

}  // namespace remote_touch
