// The sheet of surface near a proxy in one frame: how it is found alone, registered to a prediction, and
// searched without its noise.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "core/beyond/tracked_surface/height_fit.h"
#include "core/beyond/tracked_surface/height_map.h"
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

}  // namespace remote_touch
