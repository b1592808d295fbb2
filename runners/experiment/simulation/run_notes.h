// Notes on a run: their kinds, and those on the hand and the surface, on fixture rules and on the slave.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/points/point_cloud.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/hand/trajectory.h"
#include "scenarios/scene/scenario.h"

namespace remote_touch {

class NeighbourSearch;
struct Trace;

// The kinds of notes on runs. A sweep stores one bit for each kind instead of the texts of the notes.

struct NoteKind {
  const char* name;     // Note::kind
  const char* meaning;  // a text for counts over many runs, the same for every note of the kind
};

// Kind i has bit i of the dataset `notes`. The order is part of the file format of sweeps, so new kinds are
// appended, at most 64. Kind 0 includes all kinds that are not in the list, for example from scenarios of
// other programs.
const std::vector<NoteKind>& note_kinds();
std::vector<std::string> note_kind_names();

// Returns the bits of the kinds of these notes; 0 without notes.
std::uint64_t note_bits(const std::vector<Note>& notes);

// Returns name and meaning, such as "no contact: no point was touched and no force was felt". Returns the
// name alone for a kind that is not in the list.
std::string text_of_kind(const std::string& name);

// Checks whether the hand stays on the surface that the camera sees, in runs whose motion was planned on
// depth images.

class SurfaceWatch {
 public:
  // Both must outlive the watch. scenario: without faults, because the trajectory was planned on it.
  SurfaceWatch(const Scenario& scenario, const Trajectory& trajectory)
      : scenario_(scenario), trajectory_(trajectory) {}

  // Compares the hand at the time of a tick with the newest frame that was captured until then.
  void add(const Vec3& hand_W, double time_s);

  // Returns up to three notes. "behind the surface": in some ticks the hand was farther behind the surface at
  // its pixel than the motion plans at most. "off the surface": in some ticks the motion was meant to touch,
  // but nothing was measured around the hand's pixel, the hand was outside the image, or the hand was farther
  // in front of the surface than planned. "hand jumped": from one tick to the next the hand moved farther
  // than the motion does while the surface is at rest. Returns no notes for motions that are not planned on
  // images.
  std::vector<Note> notes() const;

 private:
  const PointCloud* image_at(double time_s);
  void add_step(const Vec3& hand_W, double time_s, double max_step_m);

  const Scenario& scenario_;
  const Trajectory& trajectory_;
  int frame_ = -1;  // number of the frame that was read last
  std::shared_ptr<const NeighbourSearch> points_;
  std::optional<PointCloud> copy_;
  const PointCloud* cloud_ = nullptr;  // the cloud in points_ or copy_
  RigidTransform X_CW_ = RigidTransform::Identity();

  std::size_t ticks_ = 0, off_ = 0, behind_ = 0;
  double first_off_s_ = 0, first_behind_s_ = 0, deepest_m_ = 0, allowed_m_ = 0;
  std::optional<Vec3> last_W_;  // the hand in the tick before
  std::size_t jumps_ = 0;
  double first_jump_s_ = 0, first_jump_m_ = 0, longest_jump_m_ = 0;
};

// Returns the depth of the surface that an image shows at p_C, a position in the camera's frame. It is the
// median of the depths that were measured within a radius around the pixel of p_C. The radius is reach_m at
// the depth of p_C, but at least 1 pixel and at most 32 pixels. Returns NaN if nothing was measured there, or
// if p_C is outside the image or not in front of the camera. X_CW: the world in the camera's frame.
double shown_depth(const PointCloud& cloud, const RigidTransform& X_CW, const Vec3& p_C, double reach_m);

// Notes on fixture rules without an effect.

// Returns a note "nothing selected" for each rule that selects no point of the first frame and none of the
// last, whatever its schedule. first, last: null if no frame arrived. Returns no notes if the points of one
// of these frames are not stored.
std::vector<Note> fixture_notes(const FixtureAssignment& fixtures,
                                const std::shared_ptr<const NeighbourSearch>& first,
                                const std::shared_ptr<const NeighbourSearch>& last);

// Notes on a slave that could not do what its run is about.

// Returns these notes; none for a run without a slave.
// - "slave without surface": the true surface was not known wherever the slave was, or its normal was not
//   known in some tick in which the slave was behind it.
// - "slave without command": the slave never started; or it received no command after its first one although
//   others were meant for it; or it touched, and the hand, which was to feel it, felt no force.
// - "slave starts in contact": the slave was behind the true surface when it was put at its first command, so
//   that the largest force on it, and all that follows from it, is that of this start.
// - "slave loop gains energy": the device gave the hand more than 5 J, as an unstable loop does, while it
//   returned the force on the slave.
std::vector<Note> slave_notes(const Trace& trace);

// Returns notes "setting without effect" on an experiment with a slave:
// - it has fixtures, but the feedback is not rendered. The HIP is then sent to the slave, and the hand does
//   not feel the renderer, so that no fixture holds anything back;
// - hand is simulated and should feel forces of the slave, but there is no section operator: the hand then
//   follows its path, whatever the device exerts. The hand of a recorded session gives no such note.
std::vector<Note> slave_setting_notes(const Experiment& experiment, Experiment::Hand hand);

// Returns a sentence on the first contact of the slave and the largest force on it, or on how near it came to
// the true surface. Empty if there is no slave, or if the surface was not known where it was.
std::string slave_summary(const Trace& trace);

}  // namespace remote_touch
