// The data of one run that a page shows, as JSON that names arrays of numbers.
#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "analysis/comparison/compared_columns.h"
#include "analysis/storage/hdf5_file.h"
#include "core/kernels/kernels.h"
#include "core/points/vector.h"
#include "runners/presentation/pages/shown_meshes.h"
#include "scenarios/files/text_file.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

// The true surface around the action, where the scene is a height field: its height over a grid at some
// times. It is the surface from which the column signed_distance measures.
struct TrueHeights {
  static constexpr int kColumns = 41;  // along x and along z
  // true: the truth is the surface at the last capture, which stays until the next of these times. false: the
  // surface moves evenly from one of these times to the next.
  bool stays = false;
  std::vector<double> time_s;   // one, where the surface does not move
  std::vector<float> height_m;  // y; x runs fastest, then z, then time; NaN: not known
  // The largest difference between the drawn sheet and the surface that was found: half-way between the times
  // (if the surface moves evenly between them), and half-way between the nodes at three of the times. m.
  // It is no bound: elsewhere the sheet may be off by more.
  double error_m = 0;
  bool empty() const { return height_m.empty(); }
};

// time_s: the times of the ticks, at least one. Returns an empty result if the height is known nowhere. A
// surface that moves evenly has at most 200 times, and up to 600 if the sheet would be off by more than 0.2
// mm half-way between them. One that stays has all times at which it changes, but at most 2000.
TrueHeights true_heights(const Scenario& scenario, const BoundingBox& box_W, std::span<const double> time_s);

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
