#include "core/tool/disk_contact.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

namespace {

constexpr int kLines = 2;               // one for an edge of the tool, two for a corner
constexpr int kCuts = 4;                // of a line
constexpr double kGrazing = 0.2;        // a disk at a smaller angle to the gradient is met at its edge
constexpr double kStep_m = 2e-4;        // lower edges are climbed, not run into
constexpr double kBlindGradient = 0.5;  // shorter, and the field is at a ridge: it has no direction

Vec3 slope_in_plane(const SurfaceDisk& disk, const FieldSample& at) {
  return at.gradient_T - at.gradient_T.dot(disk.n_T) * disk.n_T;
}

// Down the field in the plane of the disk, to the lowest place of a line that begins at `place`. Along a line
// the field of a convex tool is convex, and over an edge nearly a pair of lines: where the tangents at the
// ends meet is a better end (Kelley's cutting planes). Returns whether it went anywhere.
bool slide(const VoxelTool& tool, const SurfaceDisk& disk, DiskPlace& place) {
  const Vec3 along = slope_in_plane(disk, place.at);
  const double steep = along.norm();
  if (steep < kFlatSlope) return false;
  const Vec3 start_T = place.p_T, way_T = -along / steep, offset = start_T - disk.p_T;
  // to the rim: |offset + t way| = radius
  const double ahead = offset.dot(way_T), inside = disk.radius_m * disk.radius_m - offset.squaredNorm();
  struct End {
    double t;
    FieldSample at;
    double slope;
  };
  const auto end = [&](double t) {
    const FieldSample at = sample_field(tool, start_T + t * way_T);
    return End{t, at, at.gradient_T.dot(way_T)};
  };
  End low{0, place.at, -steep}, high = end(std::sqrt(std::max(0.0, ahead * ahead + inside)) - ahead);
  place.at_rim = high.slope < -kFlatSlope && high.at.distance_m < low.at.distance_m;
  for (int cut = 0; cut < kCuts && !place.at_rim && high.slope - low.slope > kFlatSlope; ++cut) {
    const double meet = (low.at.distance_m - high.at.distance_m + high.slope * high.t - low.slope * low.t) /
                        (high.slope - low.slope);
    if (!(meet > low.t && meet < high.t)) break;
    const End between = end(meet);
    (between.slope < 0 ? low : high) = between;
  }
  const End& best = high.at.distance_m <= low.at.distance_m ? high : low;
  place.p_T = start_T + best.t * way_T;
  place.at = best.at;
  // On an edge the gradients of both sides make up one without a slope along the line: it alone tells the
  // side of a disk that is met at a grazing angle.
  if (!place.at_rim && low.slope < 0 && high.slope > low.slope) {
    const double share = std::clamp(high.slope / (high.slope - low.slope), 0.0, 1.0);
    place.at.gradient_T = share * low.at.gradient_T + (1 - share) * high.at.gradient_T;
  }
  return best.t > 0;
}

// A flat tool on a flat surface: disks beside it lie in the plane of its face, and would be walls to its
// sides. Where the field rises as the place leaves the plane, no more of the tool is there than a step of
// kStep_m: +1 or -1, the side that the tool is on; 0 where it reaches on.
double side_of_flush(const VoxelTool& tool, const SurfaceDisk& disk, const DiskPlace& place) {
  const auto leaves = [&](double side) {
    const Vec3 beyond = place.p_T - side * kStep_m * disk.n_T;
    return sample_field(tool, beyond).distance_m - place.at.distance_m > 0.5 * kStep_m;
  };
  const bool front = leaves(1), back = leaves(-1);
  return front == back ? 0 : front ? 1 : -1;
}

// Which side of the disk the tool is on, +1 where the sensor is; 0 where the disk meets the tool edge-on.
double side_of(const VoxelTool& tool, const SurfaceDisk& disk, const DiskPlace& place, double known_side) {
  const bool inside = place.at.distance_m < 0;
  if (inside && known_side != 0) return known_side;
  const double facing = -place.at.gradient_T.dot(disk.n_T), steep = place.at.gradient_T.norm();
  // Deep inside, at a ridge of the field, nothing tells; at a corner of the tool it is short too.
  if (place.at.distance_m < -tool.grid.size_m && steep < kBlindGradient) return 1;
  if (std::abs(facing) <= kGrazing * steep) return 0;
  return facing < 0 ? -1 : 1;
}

}  // namespace

double lower_bound_m(const SurfaceDisk& disk) {
  if (!disk.has_normal()) return disk.at.distance_m;
  return disk.at.distance_m - disk.radius_m * slope_in_plane(disk, disk.at).norm();
}

DiskPlace nearest_place(const VoxelTool& tool, const SurfaceDisk& disk) {
  DiskPlace place{disk.p_T, disk.at};
  if (!disk.has_normal() || !(disk.radius_m > 0)) return place;
  for (int line = 0; line < kLines && slide(tool, disk, place) && !place.at_rim; ++line) continue;
  return place;
}

ToolContact disk_contact(const VoxelTool& tool, const SurfaceDisk& disk, double near_m, double known_side) {
  const double lower_m = lower_bound_m(disk);
  const bool searched = lower_m <= near_m;
  const DiskPlace place = searched ? nearest_place(tool, disk) : DiskPlace{disk.p_T, disk.at};
  return disk_contact(tool, disk, place, searched ? place.at.distance_m : lower_m, searched, known_side);
}

ToolContact disk_contact(const VoxelTool& tool, const SurfaceDisk& disk, const DiskPlace& place,
                         double distance_m, bool searched, double known_side) {
  double side = disk.has_normal() ? side_of(tool, disk, place, known_side) : 0;
  const bool known = place.at.distance_m < 0 && known_side != 0;
  bool as_plane = side != 0 && ((searched && !place.at_rim) || known);
  if (!as_plane && searched && disk.has_normal()) {
    const double flush = side_of_flush(tool, disk, place);
    if (flush != 0) side = flush, as_plane = true;
  }
  const double steep = place.at.gradient_T.norm();
  Vec3 out = steep > 0 ? Vec3(-place.at.gradient_T / steep) : Vec3(Vec3::UnitY());
  if (as_plane) out = side * disk.n_T;
  return {place.p_T, out, -distance_m, side};
}

}  // namespace remote_touch
