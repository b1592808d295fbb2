// Objects whose true surface is a mesh: their poses over time and in files, checks of what a user names, and
// their places in an image.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/mesh/mesh_distance.h"
#include "core/mesh/triangle_mesh.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "scenarios/simulated/scenario.h"

namespace remote_touch {

// The pose of a rigid body as a function of time.

struct StampedPose {
  double time_s = 0;
  RigidTransform X = RigidTransform::Identity();  // frame of the body to its parent frame
};

// Passes through given poses. Between two of them the origin of the body moves on a straight line at constant
// speed, and the body turns about a constant axis, by the shorter way, at constant rate. The bits are the
// same on every machine.
class PosePath {
 public:
  // A body that rests.
  explicit PosePath(const RigidTransform& X);
  // Throws std::invalid_argument unless there is a pose, and the times are finite and strictly increasing.
  explicit PosePath(std::vector<StampedPose> poses);

  // Returns the pose at a time. Before the first time it is the first pose, after the last time the last
  // pose.
  RigidTransform at(double time_s) const;

  // The time of the last pose, from which the body rests.
  double duration_s() const { return poses_.back().time_s; }
  const std::vector<StampedPose>& poses() const { return poses_; }

 private:
  std::vector<StampedPose> poses_;
  std::vector<Vec3> turns_;  // rotation vector from each pose but the last to the next, in the body's frame
};

// Objects whose true surface is a mesh at a pose, and the nearest of them.

struct MeshObject {
  std::string name;
  std::shared_ptr<const MeshDistance> shape;  // frame of the object
  bool is_closed = true;  // false: a sheet, such as a table; nothing is known beyond its border
};

// The true surface nearest to a position, in the frame P of that position.
struct NearestOnObjects {
  double distance_m = std::numeric_limits<double>::quiet_NaN();  // positive outside; NaN: unknown
  // Unit normal of the surface at the nearest point, outwards; NaN: unknown.
  Vec3 normal = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  int object = -1;  // index of the object; -1: unknown
};

// Returns the object with the smallest signed distance to p_P. Outside of closed objects this is the distance
// to their union. Of several objects with that distance it is the first.
//
// X_PO[i] is the pose of objects[i]: its frame O to the frame P. An object is ignored if it has no pose, if
// it is not nearer than reach_m, or if it is open and its nearest point is on its border. The result is
// unknown if all objects are ignored, or if p_P is not finite. Pre: as many poses as objects, reach_m > 0.
NearestOnObjects nearest_on_objects(std::span<const MeshObject> objects,
                                    std::span<const std::optional<RigidTransform>> X_PO, const Vec3& p_P,
                                    double reach_m);

// Replaces the result by objects[i] if that is nearer, by the same rules. Does not allocate. Pre: p_P is
// finite.
void take_nearer(NearestOnObjects& result, std::span<const MeshObject> objects, std::size_t i,
                 const RigidTransform& X_PO, const Vec3& p_P, double reach_m);

// Returns the surfaces of the objects at their poses X_WO. Pre: as many poses as objects.
std::vector<PosedMesh> posed_meshes(std::span<const MeshObject> objects,
                                    std::span<const std::optional<RigidTransform>> X_WO);

// Objects of meshes that a user names: a mesh that cannot be a true surface is refused with the reason.

// The words of messages about a mesh.
struct MeshSubject {
  std::string subject;  // the refused part: the file, or the parameter and its value
  // Advice to a user: these continue the messages about an open mesh, one of clockwise triangles, and one
  // of more than 10 m.
  std::string if_open = {}, if_inverted = {}, if_large = {};
};

// closed: true for a solid, false for a sheet; nothing: as MeshDistance::is_closed() finds.
//
// Throws InputError about the subject in these cases: the mesh has no triangle with an area, or an index or
// vertex that cannot be used; its bounding box has a diagonal above 10 m; it should be closed and is not; or
// it is closed and the triangles of a part run clockwise seen from outside.
MeshObject checked_object(const std::string& name, const TriangleMesh& mesh, std::optional<bool> closed,
                          const MeshSubject& names);

// The places of the surfaces of objects in the image of a camera.

struct SampledPoint {
  Vec3 point, normal;  // frame of the object; the normal is a unit vector, outwards
};

// Returns points that are spread evenly over the area of a surface, the same ones in every call.
std::vector<SampledPoint> surface_samples(const MeshDistance& shape, std::size_t count);

// Returns the index v * width + u of the pixel nearest to the projection of p_C. Returns nothing outside the
// image, and unless p_C is finite and in front of the camera.
std::optional<std::size_t> pixel_of(const CameraIntrinsics& camera, const Vec3& p_C);

// Returns the number of points that are in the image, hidden or not. X_CO: object to camera frame.
std::size_t count_in_image(const std::vector<SampledPoint>& samples, const RigidTransform& X_CO,
                           const CameraIntrinsics& camera);

// Files of poses: one pose for each frame of a recording, or poses with time stamps.

struct PoseFile {
  std::filesystem::path file;
  // One for each line that is no comment, or for each file of a folder; nothing: unknown.
  std::vector<std::optional<RigidTransform>> poses;
  std::vector<double> stamps_s;  // one for each pose, increasing; empty: the poses are those of frames
  bool has_unnamed_quaternions = false;  // no header states the order of the numbers of a quaternion
  std::vector<Note> notes;
};

// Direction of the poses of a camera: camera to world (base) frame, or the inverse.
enum class PoseDirection { camera_to_world, world_to_camera };

enum class PoseLines { of_frames, stamped, either };

// Reads UTF-8 with or without a byte order mark, and lines that end in LF or CR LF. Blanks and tabs separate
// the numbers. Lines that begin with # are comments. A pose is that of a body in its parent frame: x, y and z
// of its origin in metres, and a rotation.
//
// If a comment before the first pose, or the first line, names columns, they are read by these names: `tx ty
// tz` (or x, px), with `qx qy qz qw` or the rows `r00 r01 r02 r10 ... r22` of R, and `t` (or time, timestamp,
// stamp) of stamped poses or `frame`, which counts from 0. Names may end in a unit, "tx_mm" or "t [ms]", see
// input_files.h; columns of other names are not used. Without such names a line of 16 numbers is a 4 x 4
// matrix row by row, and a line of 8 numbers is stamped: `t tx ty tz qx qy qz qw`. A pose whose numbers are
// all nan or infinite is unknown, unless it is stamped. R is replaced by the nearest exact rotation (Higham
// 1986), since a file has few digits, and a quaternion is normalised. If two stamps are equal, the first pose
// is kept, and a note reports it.
//
// Throws InputError about "file:line" in these cases (about the file if it cannot be read or is longer than
// kMaxTextBytes): the names are those of three or more elements of a pose, but not of a whole pose; another
// number of words; a word that is no number; a number that is not finite; an empty line before a pose that
// is not stamped; the last row of a matrix differs from 0 0 0 1 by more than 1e-6; an element of R^T R - I
// is above 1e-3; R mirrors; the norm of a quaternion differs from 1 by more than 1e-2; a translation is above
// kMaxCoordinate_m along an axis; stamps decrease or are above 1e12 s; there are stamps, or none, although
// `expected` says otherwise; a stamped file has no pose.
PoseFile read_poses(const std::filesystem::path& file, PoseLines expected);

// Reads one pose from each file, 4 x 4 numbers in as many lines as it has. Throws as above.
PoseFile read_pose_folder(const std::filesystem::path& folder,
                          const std::vector<std::filesystem::path>& files);

// Returns the pose of a matrix whose upper three rows are these, or nothing if none of its numbers is finite.
// Throws InputError about `where` as read_poses() does.
std::optional<RigidTransform> pose_of_rows(const std::string& where, const std::array<double, 12>& rows);

// Returns the poses at their times after origin_s. Pre: stamped.
PosePath path_of(const PoseFile& poses, double origin_s);

// Returns the time 0 of each of several stamped files. Files of several poses whose times overlap, each with
// another or over others, have one clock, whose 0 is the earliest stamp of all. Otherwise each file counts
// from its first stamp, and a note reports that.
std::vector<double> origins_of_clocks(std::span<const PoseFile* const> files, std::vector<Note>& notes);

// Returns "70 poses over 2.3 s at 30 Hz, 0.412 m long, at most 0.9 m/s". Pre: one pose or more.
std::string motion_text(std::span<const StampedPose> poses);

// Returns notes on poses that are improbable, with their likely cause: faster than 10 m/s, farther than 10 m
// from the origin of the parent frame, less than one or more than 1000 in a second, and, for quaternions
// whose order is not stated, a half turn about x, which is no turn if qw comes first.
std::vector<Note> unusual_poses(const std::string& subject, std::span<const StampedPose> poses,
                                bool has_unnamed_quaternions);

// Another meaning that the numbers of a pose may have, and the pose that they would then be.
struct OtherMeaning {
  const char* text;  // "with the inverse poses"
  RigidTransform (*of)(const RigidTransform& X);
};
// The first one is the inverse.
std::span<const OtherMeaning> other_meanings();

}  // namespace remote_touch
