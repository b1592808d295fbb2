// The data of one run that a page shows, as JSON that names arrays of numbers.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "analysis/comparison/compared_columns.h"
#include "analysis/storage/hdf5_file.h"
#include "core/kernels/kernels.h"
#include "core/points/vector.h"
#include "runners/presentation/pages/shown_meshes.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {

// A trace, stored or in memory, and what is known of it.
struct RunSource {
  std::string name;  // name on the page and in errors: a file, or a run of a sweep
  std::shared_ptr<const ColumnSource> columns;
  TextAttributes attributes;  // config must be one of them
  std::string note = {};      // remark for the reader of the page
  std::string claims = "[]";  // JSON, see shown_claims()
};

class ShownRun {
 public:
  // Throws InputError, about the name, when the configuration cannot be run, or its recording is missing or
  // is not the one that was read.
  ShownRun(RunSource source, const Kernels& kernels, const std::atomic<bool>* stop);
  ~ShownRun();

  const RunSource& source() const;
  std::string title() const;
  std::size_t frame_count() const;  // number of frames in use, at least 1

  // The part of the scene that is shown. Initially it is the region of the action: the positions of HIP and
  // proxy or tool, and slave, and some room around them. The first json() fixes it.
  const BoundingBox& box_W() const;
  void set_box(const BoundingBox& box_W);

  // Adds the first tick with any difference from another run to the events. Throws InputError if the runs
  // have different tick rates, because the page pairs their ticks.
  void mark_divergence_from(const ShownRun& other);

  // The first call makes the frames of the run again; later calls leave out points. wanted_others: see
  // ShownPointsRule; for each frame, and no more than in the first call.
  Json json(PackedArrays& numbers, std::size_t wanted_others);
  // A line about the points that the last json() contained.
  const std::string& shown() const;
  // Remark for the reader, valid after json(); empty: none.
  const std::string& note() const;

 private:
  struct State;
  const std::unique_ptr<State> state_;
};

}  // namespace remote_touch
