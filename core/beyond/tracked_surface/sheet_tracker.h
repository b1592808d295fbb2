// Finds the sheet of surface in front of a proxy and follows it from frame to frame. A tool has several
// trackers, each with a position on the tool as its proxy: sheet_patches.h.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "core/beyond/tracked_surface/height_fit.h"
#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "core/points/neighbour_search.h"

namespace remote_touch {

// Settings of the search for a sheet, and of the noise reduction of its points.
struct SheetSettings {
  double gate_m = 0.015, initial_gate_m = 0.035, max_gate_m = 0.075;
  int max_missed_frames = 1;
  bool denoise = true;
};

Parameters parameters(SheetSettings& s);
std::string validate(const SheetSettings& s);

// Search for the sheet of surface that is nearest to a proxy, in one frame alone.

struct FoundSheet {
  PatchFrame frame;             // its origin lies on the sheet, its normal points to the proxy's side
  std::optional<double> sigma;  // standard deviation of the noise, contact radii; none: too few points
  double known = 0;             // radius around the origin in which the sheet was seen, contact radii
};

// Work buffers of a search.
struct AcquisitionBuffers {
  GatheredPoints& gathered;
  PatchPoints& points;
  HeightFit& fit;
};

// Searches for the mode of the heights along a normal that is nearest to the proxy. The first normal is (4.1)
// over a wide reach; the next ones are those of the plane through the points of the mode. Returns no sheet if
// there are too few points, or if no surface faces the proxy.
std::optional<FoundSheet> find_sheet(const NeighbourSearch& frame, const Vec3& proxy_W,
                                     double contact_radius_m, const Kernels& kernels,
                                     const AcquisitionBuffers& buffers);

// Registration of the points of a frame to the map that predicts the sheet.

// The height of the sheet above the prediction is height + slope_u u + slope_v v, in contact radii.
struct SheetShift {
  double height = 0, slope_u = 0, slope_v = 0;
};

// Only points within this distance of the proxy, along the patch, determine the shift; contact radii.
inline constexpr double kRegistrationReach = 6;

// Computes the shift, at most gate in either direction, from the profiles of two frames. A robust plane
// through the residuals then refines it. profile: that of the previous frame. pre: points.set_residuals() was
// called.
SheetShift register_sheet(const PatchPoints& points, const HeightProfile& profile, const PatchPlace& proxy,
                          double gate, double half_range, double sigma);

// Search over the points that a tracked sheet shows of a frame: the points in its region without their noise,
// and the points outside it unchanged. It is filled anew for every frame, without an allocation if reserve()
// was called for as many points. reserve() keeps the points that it holds.
class SheetSearch final : public NeighbourSearch {
 public:
  void reserve(std::size_t points, bool with_radius, bool with_stiffness);
  // Starts a new frame, with no points in the region. buffer: work buffer for points of the frame while
  // gather() runs. It has columns for radius and stiffness even if the frame has none.
  void start(const PatchRegion& region, std::shared_ptr<const NeighbourSearch> frame,
             std::shared_ptr<GatheredPoints> buffer);
  // Adds a point of the frame, given by its row in `gathered`, at the position where it is shown.
  void add(const PatchPlace& place, const GatheredPoints& gathered, std::size_t row);
  void finish();

  void gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const override;
  std::size_t size() const override { return frame_->size(); }
  bool has_fixture_radius() const override { return frame_->has_fixture_radius(); }
  bool has_regions() const override { return frame_->has_regions(); }
  bool has_stiffness() const override { return frame_->has_stiffness(); }
  double max_fixture_radius_m() const override { return frame_->max_fixture_radius_m(); }

 private:
  static constexpr int kCells = 20;  // number along each side of the region
  struct Columns {
    Buffer<double> x, y, z, radius, stiffness;
    Buffer<std::uint32_t> index;
  };
  int cell_along(double coordinate) const;

  PatchRegion region_;
  std::shared_ptr<const NeighbourSearch> frame_;
  std::shared_ptr<GatheredPoints> buffer_;
  Columns added_, sorted_;  // added_: in the order of add(); sorted_: cell by cell
  Buffer<std::uint32_t> cell_of_;
  std::size_t count_ = 0;
  std::array<std::uint32_t, kCells * kCells + 1> start_{};
};

// Position of the proxy. pressing: a surface holds the proxy back.
struct ProxyPosition {
  Vec3 p_W = Vec3::Zero();
  bool pressing = false;
};

// The points of a frame to show, and the motion that the proxy must follow; world frame.
struct SheetUpdate {
  std::shared_ptr<const NeighbourSearch> points;  // null: the sheet is missing, but not yet dropped
  Vec3 displacement_m = Vec3::Zero();
  double velocity_m_per_s = 0;
  Vec3 normal_W = Vec3::Zero();
};

// The class of a point of the newest frame. A point in its region belongs to the sheet, to another surface,
// or is a stray. A point of the sheet is moved onto it along the patch's normal.
struct ShownPoint {
  enum class Kind { outside, sheet, surface, stray };
  Kind kind = Kind::outside;
  Vec3 p_W = Vec3::Zero(), normal_W = Vec3::Zero();  // position and normal on the sheet
  double weight = 0;    // points of the sheet: 1 in the middle of the patch, falling to 0 at its border
  double residual = 0;  // height of the measured point above the sheet, contact radii
};

class SheetTracker {
 public:
  // search: SheetUpdate::points holds the points to show, and a proxy is kept at the distance of its
  // fixtures. points: SheetUpdate::points is the frame itself, or null, and shown() classifies each point.
  enum class Shows { search, points };

  SheetTracker(const SheetSettings& settings, double contact_radius_m, const Kernels& kernels,
               Shows shows = Shows::search);
  // Reserves memory for frames of this number of points. Allocates only if the capacity is smaller.
  void reserve(std::size_t points, bool with_radius, bool with_stiffness);

  // Processes a new frame, interval_s after the one before.
  SheetUpdate on_frame(std::shared_ptr<const NeighbourSearch> frame, const ProxyPosition& proxy,
                       double interval_s);
  // Stores a frame for requery() while the proxy has no position yet. Returns the frame unchanged.
  std::shared_ptr<const NeighbourSearch> keep(std::shared_ptr<const NeighbourSearch> frame);
  // Returns true if the proxy has left the middle of the patch; without a sheet, if it has moved by a contact
  // radius. False while the sheet is missing.
  bool must_requery(const Vec3& proxy_W) const;
  // Drops a missing sheet and searches for one in the newest frame. No allocation.
  SheetUpdate reacquire(const Vec3& proxy_W);
  // Starts with a sheet that is known to pass near a position with this normal. The patch keeps the normal.
  // sigma: estimate of its noise, contact radii. No allocation.
  void begin(const Vec3& foot_W, const Vec3& normal_W, double sigma);
  // Updates the patch around the proxy's new position, from the newest frame's points. No allocation.
  SheetUpdate requery(const ProxyPosition& proxy);

  bool changes_points() const { return tracks_ && sigma_ >= kUntouched && s_.denoise; }

  // The sheet in the newest frame in which it was seen, if there is one; lengths in contact radii.
  bool tracks() const { return tracks_; }
  const PatchRegion& region() const { return region_; }
  const HeightMap& map() const { return map_; }
  double sigma() const { return sigma_; }
  // Returns the height of a position above the sheet, along the patch's normal; NaN if the map has no height
  // there.
  double clearance(const Vec3& p_W) const;
  // Returns the motion of the sheet at a position in the newest frame, along the patch's normal. It is 0 if
  // it is below the resolution of positions. It is NaN if it is not known, for example because the sheet was
  // not seen in the previous frame.
  double moved(const Vec3& p_W) const;
  // Returns the standard error of that motion; infinite if no plane is near.
  double moved_error(const Vec3& p_W) const;
  ShownPoint shown(const Vec3& p_W) const;
  // Returns the typical number of members in a square of one contact radius.
  double density() const { return fit_.typical_density(); }

 private:
  static constexpr double kUntouched = 0.01;  // noise below this, in contact radii, is not removed
  void gather(double half_height);
  const PatchFrame& patch() const { return region_.frame; }
  void reserve_for_newest();
  double half_height() const;
  void forget();
  void restart(const Vec3& proxy_W);
  void grow(const PatchFrame& frame, double known, const Vec3& proxy_W);
  bool is_of_other_surface(const ProxyPosition& proxy) const;
  void recentre(const Vec3& middle_W);
  void level();
  double predicted_shift(double interval_s) const;
  bool follow(const Vec3& proxy_W);
  double find_members(const PatchPlace& proxy);
  void fit_map(double weight_of_new_noise);
  double exit_distance(const Vec3& proxy_W) const;
  double proxy_displacement(const ProxyPosition& proxy, double clearance_before) const;
  double velocity(const Vec3& proxy_W, double clearance_before, double interval_s);
  double contact_distance(const PatchPlace& proxy) const;
  std::shared_ptr<const NeighbourSearch> show(const Vec3& proxy_W);

  const SheetSettings s_;
  const double unit_m_;
  const Kernels& kernels_;
  const Shows shows_;
  std::shared_ptr<const NeighbourSearch> newest_;
  std::shared_ptr<GatheredPoints> gathered_ = std::make_shared<GatheredPoints>(),
                                  buffer_ = std::make_shared<GatheredPoints>();
  std::shared_ptr<SheetSearch> shown_[2] = {std::make_shared<SheetSearch>(), std::make_shared<SheetSearch>()};
  int present_ = 0;

  bool tracks_ = false;
  bool keeps_normal_ = false;
  PatchRegion region_;
  HeightMap map_;
  struct {
    PatchFrame frame;
    HeightMap map;
    bool known = false;
  } before_;  // position of the sheet before the newest frame, over the same patch
  HeightFit fit_;
  PatchPoints points_;
  StrayPoints strays_;
  std::vector<PatchPlace> sheet_;  // the members at their shown positions
  HeightProfile profile_;
  double sigma_ = 0;
  double up_ = 0, down_ = 0;  // largest distances of members above and below the sheet
  double shift_ = 0, shift_before_ = 0, shift_error_ = 0, interval_s_ = 0;
  int age_ = 0, missed_ = 0;     // number of measured shifts; number of frames without the sheet
  double pressed_distance_ = 1;  // contact_distance() when the sheet was last seen
  bool nearer_stray_ = false;
  Vec3 query_position_W_ = Vec3::Zero();
  std::optional<Vec3> last_proxy_W_;  // position at the previous frame
};

}  // namespace remote_touch
