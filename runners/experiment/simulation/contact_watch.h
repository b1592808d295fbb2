// Watches where a renderer first touches the points, where the hand starts, and where the proxy passes to the
// wrong side. Writes notes on runs in which the points or the frames could not hold the proxy.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "analysis/measures/surface_side.h"
#include "core/kernels/kernels.h"
#include "core/rendering/renderer.h"
#include "runners/experiment/catalog/rendered_contact.h"
#include "scenarios/interface/note.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

class NeighbourSearch;
struct Trace;

class ContactWatch {
 public:
  using Points = std::shared_ptr<const NeighbourSearch>;

  // held_depth_m: how far behind the true surface the renderer holds its proxy, see held_depth_m().
  explicit ContactWatch(double held_depth_m = 0) : side_(held_depth_m) {}

  // Must be called after each tick of a run without a tool. points: the newest frame that the renderer has;
  // null before the first. proxy_distance_m: distance of the proxy to the true surface, NaN if it is not
  // known.
  void add(double time_s, const Vec3& hand_W, const RenderOutput& out, const Points& points,
           double proxy_distance_m = std::numeric_limits<double>::quiet_NaN());
  bool has_contact() const { return contact_.has_value(); }

  // Returns a note "wide spacing" if a ball passes between the points at the first contact, or where the
  // proxy came nearest to them if there was no contact, or where the proxy passed the true surface. See
  // widest_gap(). Searches points up to 6 ball radii away. pre: ball_radius_m > 0.
  std::vector<Note> spacing_notes(double ball_radius_m, const Kernels& kernels) const;

  // Returns a note "starts in contact" if, at the tick of the first frame, the hand is behind the true
  // surface or nearer to it than rest_distance_m, and points are there too. If the true surface is not known,
  // a point must be nearer to the hand than rest_distance_m. rest_distance_m: see RenderedContact, 0 or more.
  std::vector<Note> start_notes(const Scenario& scenario, double rest_distance_m,
                                const Kernels& kernels) const;

  // Returns a note "lost at the first touch" if the proxy is behind the true surface at the end, passed it
  // before a third frame came after the first contact, and the surface moved towards the proxy. Case 1 and
  // case 2 of analysis/theory/first_touch.h lose the proxy at the first and second frame after the touch.
  // After two frames the proxy has an estimate of the velocity. ball_radius_m: as in spacing_notes().
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

// Returns a note "starts in contact" if a tool touches points in the first tick with a frame.
std::vector<Note> tool_start_notes(const Trace& trace);

}  // namespace remote_touch
