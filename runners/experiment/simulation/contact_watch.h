// Watches where a renderer first touches the points, where the hand starts, and where the proxy passes to the
// wrong side. Writes notes on runs in which the points or the frames could not hold the proxy.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/trace/contact_measures.h"
#include "core/kernels/kernels.h"
#include "core/points/vector.h"
#include "core/rendering/renderer.h"
#include "scenarios/scene/scenario.h"

namespace remote_touch {

class NeighbourSearch;
struct Trace;

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
