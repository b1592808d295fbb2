// Notes on a run: their kinds, and those on the hand and the surface, on contacts, on fixture rules and on
// the slave.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/trace/contact_measures.h"
#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/kernels/kernels.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "core/rendering/frames_and_outputs.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/hand/trajectory.h"
#include "scenarios/simulated/scenario.h"

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

// Gaps between the points of a surface through which a ball passes, 4.2.1.

struct PointGap {
  double radius_m = 0;      // radius of the widest gap at the position; 0: no ball passes there
  bool is_decided = false;  // false: only points farther away can show whether there is a (wider) gap
};

// Returns the widest gap at a position through which a ball passes.
//
// The points are projected onto their plane (least squares). A gap is a disk that has no point in its
// interior and is held by points all around: in whatever direction it moves, it meets one of them. A ball
// passes through the gap if its radius is smaller than that of the disk. The gap is at the position if the
// disk contains the projected position. Four points at the corners of a square of side s leave a gap of
// radius s / sqrt(2), so that the limit for a square grid is s = sqrt(2) ball_radius_m. A gap beside the
// surface, beyond its border, is none, because points do not hold the disk all around.
//
// points: all points of the frame within known_m of the position, m. A gap that reaches farther is not
// decided. Nothing is decided if there are fewer than three points, or if they lie on a line.
PointGap widest_gap(const std::vector<Vec3>& points, const Vec3& position, double ball_radius_m,
                    double known_m);

// Watches where a renderer first touches the points, where the hand starts, and where the proxy passes to the
// wrong side. Writes notes on runs in which the points or the frames could not hold the proxy.
class ContactWatch {
 public:
  using Points = std::shared_ptr<const NeighbourSearch>;

  // held_depth_m: how far behind the true surface the renderer holds its proxy, see held_depth_m().
  explicit ContactWatch(double held_depth_m = 0) : side_(held_depth_m) {}

  // Must be called after each tick of a run without a tool. points: the newest frame that the renderer has;
  // null before the first. proxy_distance_m: distance of the proxy by which the run is judged, see
  // judged_distance_m(); NaN if it is not known.
  void add(double time_s, const Vec3& hand_W, const RenderOutput& out, const Points& points,
           double proxy_distance_m = std::numeric_limits<double>::quiet_NaN());
  bool has_contact() const { return contact_.has_value(); }

  // Returns a note "wide spacing" if a ball passes between the points at the first contact, or where the
  // proxy came nearest to them if there was no contact, or where the proxy passed the true surface. See
  // widest_gap(). Searches points up to 6 ball radii away.
  std::vector<Note> spacing_notes(double ball_radius_m, const Kernels& kernels) const;

  // Returns a note "starts in contact" if, at the tick of the first frame, the hand is behind the true
  // surface or nearer to it than rest_distance_m, and points are there too. If the true surface is not known,
  // a point must be nearer to the hand than rest_distance_m. rest_distance_m: see RenderedContact, 0 or more.
  std::vector<Note> start_notes(const Scenario& scenario, double rest_distance_m,
                                const Kernels& kernels) const;

  // Returns a note "lost at the first touch" if the proxy is behind the true surface at the end, passed it
  // before a third frame came after the first contact, and the surface moved towards the proxy. Case 1 and
  // case 2 of analysis/theory/surface_contacts.h lose the proxy at the first and second frame after the
  // touch. After two frames the proxy has an estimate of the velocity. ball_radius_m: as in spacing_notes().
  std::vector<Note> first_touch_notes(const Scenario& scenario, double ball_radius_m,
                                      const Kernels& kernels) const;

 private:
  struct Site {
    double time_s;
    Vec3 position_W;
    Points points;
  };
  struct Crossing {
    Site site;
    bool touched;  // there was a contact before
    int frames;    // number of frames that came after the first contact
  };
  std::optional<Site> start_, contact_, nearest_;
  SurfaceSide side_;
  std::optional<Crossing> crossing_;  // set from the tick in which the proxy popped through until it is back
  double nearest_m_ = std::numeric_limits<double>::infinity();
  int frame_ = -1, frames_ = 0;  // newest frame; frames since the contact
};

// Follows a position through the walls of true objects. The distance to a mesh has a sign, but behind the
// middle of a wall the nearest surface is that of the other side: the position seems to come out in front
// again. It passes the middle of a wall where the normal of the nearest surface turns round from one tick to
// the next.
class WallWatch {
 public:
  // Parameter what: the position in words, such as "the hand". The scenario must outlive the watch.
  WallWatch(const Scenario& scenario, std::string what);

  // Must be called in each tick. Returns the distance of the position from the true surface, or NaN if it has
  // passed the middle of a wall: it then has no side. Scenes whose truth is not one of meshes have no walls.
  double side_m(const Vec3& position_W, double signed_distance_m, double time_s);
  // Returns a note "thin object" if the position passed the middle of a wall.
  std::vector<Note> notes() const;

 private:
  const Scenario& scenario_;
  const std::string what_;
  const bool has_walls_;
  std::optional<Vec3> outside_W_;    // the newest position outside of the objects
  std::optional<Vec3> last_normal_;  // normal of the nearest surface in the tick before, inside of an object
  Vec3 outward_ = Vec3::Zero();      // the side from which it came into the first wall
  int walls_ = 0;                    // walls between that side and the position
  double first_s_ = 0, half_m_ = 0;  // time and depth at the first middle of a wall
  bool has_passed_ = false;
};

// Returns a note "starts in contact" if a tool touches points in the first tick with a frame.
std::vector<Note> tool_start_notes(const Trace& trace);

}  // namespace remote_touch
