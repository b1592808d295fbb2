#include "scenarios/objects/mesh_scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/points/point_cloud.h"
#include "scenarios/files/input_files.h"
#include "scenarios/objects/mesh_object.h"

namespace remote_touch {
namespace {

constexpr int kBandRows = 16;           // rows of the image that one thread draws at a time
constexpr double kNearest_m = 1e-6;     // nearer surfaces are not drawn
constexpr double kBoxMargin_px = 1e-6;  // exceeds the rounding errors of projected corners
// Sixteen times the relative rounding error of one operation. An edge function of corners up to M and of a
// ray with |r_x| + |r_y| + |r_z| = R is off by less than kRounding M^2 R: its coefficients are off by 4 M^2
// and the sum of its three products by 6 M^2 R such errors at most.
constexpr double kRounding = 0x1p-49;

// The rays of all pixels: (x[u], y[v], 1).
struct Rays {
  std::vector<double> x, y;
  double max_sum = 1;  // largest |x| + |y| + 1

  explicit Rays(const CameraIntrinsics& camera) {
    double max_x = 0, max_y = 0;
    for (int u = 0; u < camera.width; ++u) {
      x.push_back((u - camera.cx) / camera.fx);
      max_x = std::max(max_x, std::abs(x.back()));
    }
    for (int v = 0; v < camera.height; ++v) {
      y.push_back((v - camera.cy) / camera.fy);
      max_y = std::max(max_y, std::abs(y.back()));
    }
    max_sum += max_x + max_y;
  }
};

// A rectangle of pixels, ends included.
struct Box {
  int first_u = 0, last_u = -1, first_v = 0, last_v = -1;

  bool is_empty() const { return first_u > last_u || first_v > last_v; }
};

// The bounds of projected points, in pixels.
struct Bounds {
  double min_u = std::numeric_limits<double>::infinity(), max_u = -min_u, min_v = min_u, max_v = -min_u;

  void add(double u, double v) {
    min_u = std::min(min_u, u), max_u = std::max(max_u, u);
    min_v = std::min(min_v, v), max_v = std::max(max_v, v);
  }
  // Returns the pixels between the bounds that are in the image.
  Box box(const CameraIntrinsics& camera) const {
    const auto first = [](double min, int size) {
      return static_cast<int>(std::clamp(std::ceil(min - kBoxMargin_px), 0.0, 1.0 * size));
    };
    const auto last = [](double max, int size) {
      return static_cast<int>(std::clamp(std::floor(max + kBoxMargin_px), -1.0, size - 1.0));
    };
    return {first(min_u, camera.width), last(max_u, camera.width), first(min_v, camera.height),
            last(max_v, camera.height)};
  }
};

// A mesh in the camera frame.
struct SeenMesh {
  const RasterMesh& mesh;
  std::vector<Vec3> vertices_C;
  std::vector<double> u, v;  // projections of the vertices before the camera
  double slack = 0;          // bound on the rounding errors of edge functions
  double volume_slack = 0;   // bound on the rounding errors of a . (b x c)

  SeenMesh(const RasterMesh& seen, const CameraIntrinsics& camera, double max_ray_sum) : mesh(seen) {
    const int count = static_cast<int>(mesh.vertices_O.size());
    const auto size = static_cast<std::size_t>(count);
    vertices_C.resize(size), u.resize(size), v.resize(size);
    const Eigen::Matrix3d R = mesh.X_CO.linear();
    const Vec3 t = mesh.X_CO.translation();
    double max = 0;
#pragma omp parallel for schedule(static) reduction(max : max)
    for (int k = 0; k < count; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const Vec3 p = R * mesh.vertices_O[i] + t;
      vertices_C[i] = p;
      max = std::max({max, std::abs(p.x()), std::abs(p.y()), std::abs(p.z())});
      if (p.z() < kNearest_m) continue;
      u[i] = camera.fx * p.x() / p.z() + camera.cx;
      v[i] = camera.fy * p.y() / p.z() + camera.cy;
    }
    slack = kRounding * max * max * max_ray_sum;
    volume_slack = 2 * kRounding * max * max * max;
  }

  // Returns the part of the image that may show the triangle. Empty if the camera does not see it.
  Box box(const std::array<int, 3>& triangle, const CameraIntrinsics& camera) const {
    const Vec3 &a = vertices_C[triangle[0]], &b = vertices_C[triangle[1]], &c = vertices_C[triangle[2]];
    const double nearest = std::min({a.z(), b.z(), c.z()}), farthest = std::max({a.z(), b.z(), c.z()});
    if (farthest < kNearest_m) return {};
    // Six times the volume of the tetrahedron of the camera's centre and the triangle; negative if the camera
    // sees the outside.
    const double volume = a.dot(b.cross(c));
    if (std::abs(volume) <= volume_slack || (mesh.is_closed && volume > 0)) return {};
    Bounds bounds;
    if (nearest >= kNearest_m)
      for (const int corner : triangle) bounds.add(u[corner], v[corner]);
    else
      add_clipped({a, b, c}, camera, bounds);
    return bounds.box(camera);
  }

 private:
  // Adds the corners of the part of a triangle that is before the plane z = kNearest_m.
  static void add_clipped(const std::array<Vec3, 3>& corners, const CameraIntrinsics& camera,
                          Bounds& bounds) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 &from = corners[i], &to = corners[(i + 1) % 3];
      const bool is_before = from.z() >= kNearest_m;
      if (is_before)
        bounds.add(camera.fx * from.x() / from.z() + camera.cx, camera.fy * from.y() / from.z() + camera.cy);
      if (is_before == (to.z() >= kNearest_m)) continue;
      const Vec3 p = from + (kNearest_m - from.z()) / (to.z() - from.z()) * (to - from);
      bounds.add(camera.fx * p.x() / kNearest_m + camera.cx, camera.fy * p.y() / kNearest_m + camera.cy);
    }
  }
};

struct VisibleTriangle {
  int mesh, triangle;
  Box box;
};

// Draws a triangle into the rows first_v to last_v of the image.
void draw(const VisibleTriangle& visible, const SeenMesh& seen, const Rays& rays, int first_v, int last_v,
          RasterImage& image) {
  const std::array<int, 3>& corners = seen.mesh.triangles[static_cast<std::size_t>(visible.triangle)];
  const Vec3* a = &seen.vertices_C[corners[0]];
  const Vec3* b = &seen.vertices_C[corners[1]];
  const Vec3* c = &seen.vertices_C[corners[2]];
  if (a->dot(b->cross(*c)) > 0) std::swap(b, c);  // the camera sees the back
  const Vec3 at_a = c->cross(*b), at_b = a->cross(*c), at_c = b->cross(*a);
  const double za = a->z(), zb = b->z(), zc = c->z(), slack = seen.slack;
  const Box& box = visible.box;
  for (int v = std::max(box.first_v, first_v); v <= std::min(box.last_v, last_v); ++v) {
    const double y = rays.y[v];
    const double row_a = at_a.y() * y + at_a.z(), row_b = at_b.y() * y + at_b.z(),
                 row_c = at_c.y() * y + at_c.z();
    const std::size_t row = static_cast<std::size_t>(v) * rays.x.size();
    bool has_begun = false;  // the covered pixels of a row are neighbours
    for (int u = box.first_u; u <= box.last_u; ++u) {
      const double x = rays.x[u];
      const double ea = at_a.x() * x + row_a, eb = at_b.x() * x + row_b, ec = at_c.x() * x + row_c;
      if (ea < -slack || eb < -slack || ec < -slack) {
        if (has_begun) break;
        continue;
      }
      has_begun = true;
      const double wa = std::max(ea, 0.0), wb = std::max(eb, 0.0), wc = std::max(ec, 0.0);
      const double sum = wa + wb + wc;
      if (sum <= 4 * slack) continue;  // edge-on
      const double z = (wa * za + wb * zb + wc * zc) / sum;
      const std::size_t i = row + static_cast<std::size_t>(u);
      if (z < kNearest_m || z >= image.depth.z_m[i]) continue;  // false while the pixel is NaN
      image.depth.z_m[i] = z, image.mesh[i] = visible.mesh, image.triangle[i] = visible.triangle;
    }
  }
}

// Appends the visible triangles of a mesh to the bands of rows that they may cover.
void sort_into_bands(int mesh, const SeenMesh& seen, const CameraIntrinsics& camera,
                     std::vector<std::vector<VisibleTriangle>>& bands) {
  const int count = static_cast<int>(seen.mesh.triangles.size());
  std::vector<Box> boxes(static_cast<std::size_t>(count));
#pragma omp parallel for schedule(static)
  for (int t = 0; t < count; ++t)
    boxes[static_cast<std::size_t>(t)] = seen.box(seen.mesh.triangles[static_cast<std::size_t>(t)], camera);
  for (int t = 0; t < count; ++t) {
    const Box& box = boxes[static_cast<std::size_t>(t)];
    if (box.is_empty()) continue;
    for (int band = box.first_v / kBandRows; band <= box.last_v / kBandRows; ++band)
      bands[static_cast<std::size_t>(band)].push_back({mesh, t, box});
  }
}

std::vector<RasterMesh> posed(std::span<const SceneMesh> meshes, const RigidTransform& X_CW, double time_s) {
  std::vector<RasterMesh> seen;
  for (const SceneMesh& mesh : meshes) {
    const MeshDistance& shape = *mesh.object.shape;
    seen.push_back({shape.vertices(), shape.triangles(), X_CW * mesh.path.at(time_s), mesh.object.is_closed});
  }
  return seen;
}

// Returns the cosine of the angle between the ray and the normal of each pixel's triangle; 1 where there is
// none.
std::vector<double> cosines(const RasterImage& image, const std::vector<RasterMesh>& meshes,
                            const CameraIntrinsics& camera) {
  std::vector<double> cosine(image.mesh.size(), 1);
#pragma omp parallel for schedule(static)
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const std::size_t i = static_cast<std::size_t>(v) * camera.width + u;
      if (image.mesh[i] < 0) continue;
      const RasterMesh& mesh = meshes[static_cast<std::size_t>(image.mesh[i])];
      const auto& [a, b, c] = mesh.triangles[static_cast<std::size_t>(image.triangle[i])];
      const Vec3& from = mesh.vertices_O[a];
      const Vec3 normal_O = (mesh.vertices_O[b] - from).cross(mesh.vertices_O[c] - from);
      const Vec3 ray_O = mesh.X_CO.linear().transpose() * unproject(camera, u, v, 1);
      cosine[i] = std::abs(normal_O.dot(ray_O)) / std::sqrt(normal_O.squaredNorm() * ray_O.squaredNorm());
    }
  return cosine;
}

std::vector<std::uint32_t> colours(const RasterImage& image, std::span<const SceneMesh> meshes) {
  std::vector<std::uint32_t> colour;
  const bool any = std::ranges::any_of(meshes, [](const SceneMesh& mesh) { return mesh.colour.has_value(); });
  if (!any) return colour;
  colour.assign(image.mesh.size(), 0);
  for (std::size_t i = 0; i < colour.size(); ++i)
    if (image.mesh[i] >= 0)
      colour[i] = meshes[static_cast<std::size_t>(image.mesh[i])].colour.value_or(kNoColour);
  return colour;
}

constexpr double kReach_m = 1;

// Returns the time from which all bodies rest; 0 if none of them moves.
double end_of_motion(const std::vector<SceneMesh>& meshes, const PosePath& camera) {
  double end_s = 0;
  const auto add = [&end_s](const PosePath& path) {
    if (path.poses().size() > 1) end_s = std::max(end_s, path.duration_s());
  };
  for (const SceneMesh& mesh : meshes) add(mesh.path);
  add(camera);
  return end_s;
}

}  // namespace

RasterImage depth_raster(const CameraIntrinsics& camera, std::span<const RasterMesh> meshes) {
  const std::size_t pixels = camera.pixels();
  RasterImage image{{camera.width, camera.height, {}}, {}, {}};
  image.depth.z_m.assign(pixels, std::numeric_limits<double>::quiet_NaN());
  image.mesh.assign(pixels, -1), image.triangle.assign(pixels, -1);
  const Rays rays(camera);
  const int band_count = (camera.height + kBandRows - 1) / kBandRows;
  std::vector<std::vector<VisibleTriangle>> bands(static_cast<std::size_t>(band_count));
  std::vector<SeenMesh> seen;
  seen.reserve(meshes.size());
  for (const RasterMesh& mesh : meshes) {
    seen.emplace_back(mesh, camera, rays.max_sum);
    sort_into_bands(static_cast<int>(seen.size()) - 1, seen.back(), camera, bands);
  }
#pragma omp parallel for schedule(dynamic)
  for (int band = 0; band < band_count; ++band)
    for (const VisibleTriangle& visible : bands[static_cast<std::size_t>(band)])
      draw(visible, seen[static_cast<std::size_t>(visible.mesh)], rays, band * kBandRows,
           std::min((band + 1) * kBandRows, camera.height) - 1, image);
  return image;
}

MeshCamera::MeshCamera(const DepthSensorSettings& settings, std::optional<PosePath> X_WC, const NoiseKey& key,
                       const Kernels& kernels)
    : sensor_(settings, key, kernels),
      needs_cosines_(settings.sensor != DepthSensorKind::simple),
      X_WC_(X_WC ? *std::move(X_WC) : PosePath(sensor_.pose())) {}

SceneView MeshCamera::view(std::span<const SceneMesh> meshes, double time_s) const {
  const std::vector<RasterMesh> seen = posed(meshes, X_WC_.at(time_s).inverse(), time_s);
  RasterImage image = depth_raster(sensor_.intrinsics(), seen);
  const std::vector<double> cosine =
      needs_cosines_ ? cosines(image, seen, sensor_.intrinsics()) : std::vector<double>{};
  return sensor_.view(std::move(image.depth), cosine, colours(image, meshes));
}

PointCloud MeshCamera::cloud(const SceneView& view, int frame, double time_s) const {
  PointCloud cloud =
      cloud_from_depth(sensor_.measured_depth(view, frame), sensor_.intrinsics(), X_WC_.at(time_s));
  cloud.colour = view.ideal.colour;
  return cloud;
}

Parameters parameters(MeshScene::Settings& s) {
  const Parameters own = {
      {"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames of the camera per second, f_c"},
      {"duration_s", &s.duration_s, 0, 1e4,
       "objects and camera stop at this time; 0: at the ends of their paths"},
  };
  return appended(own, parameters(s.sensor));
}

MeshScene::MeshScene(const Settings& settings, std::vector<SceneMesh> meshes,
                     const std::optional<PosePath>& camera_path, const NoiseKey& key, const Kernels& kernels)
    : settings_(settings),
      meshes_(std::move(meshes)),
      camera_(settings.sensor, camera_path, key, kernels),
      camera_has_path_(camera_path.has_value()),
      motion_ends_s_(end_of_motion(meshes_, camera_.path())) {
  if (settings.duration_s > 0) motion_ends_s_ = std::min(motion_ends_s_, settings.duration_s);
  for (const SceneMesh& mesh : meshes_) objects_.push_back(mesh.object);
  if (motion_ends_s_ == 0) still_view_ = camera_.view(meshes_, 0);
}

int MeshScene::frame_count() const {
  constexpr int kMax = std::numeric_limits<int>::max();
  if (camera_.noisy()) return kMax;
  const double moving_frames = std::ceil(motion_ends_s_ * settings_.frame_rate_hz - 1e-6);
  return static_cast<int>(std::min(moving_frames + 1, 1.0 * kMax));
}

std::vector<Phase> MeshScene::phases() const {
  if (motion_ends_s_ == 0) return {};
  return {{"the motion of the scene", 0, motion_ends_s_}};
}

// Objects and camera are where their paths are at this time.
double MeshScene::moving_time_s(double time_s) const {
  return std::min(time_s, motion_ends_s_);
}

std::vector<Note> MeshScene::input_notes() const {
  constexpr int kMoments = 30;
  constexpr std::size_t kSamples = 200;
  const int moments = motion_ends_s_ > 0 ? kMoments : 1;
  std::vector<Note> notes;
  for (const SceneMesh& mesh : meshes_) {
    if (!mesh.object.is_closed) continue;
    const std::vector<SampledPoint> samples = surface_samples(*mesh.object.shape, kSamples);
    const auto samples_seen = [&](const auto& meant) {
      std::size_t count = 0;
      for (int i = 0; i < moments; ++i) {
        const double time_s = motion_ends_s_ * i / std::max(1, moments - 1);
        const RigidTransform X_CW = RigidTransform(meant(camera_.path().at(time_s))).inverse();
        count += count_in_image(samples, X_CW * mesh.path.at(time_s), camera_.intrinsics());
      }
      return count;
    };
    if (samples_seen([](const RigidTransform& X) { return X; }) > 0) continue;
    const Vec3 p_C = camera_.path().at(0).inverse() * (mesh.path.at(0) * samples.front().point);
    std::string text =
        mesh.object.name + " is at no time in the image: at the start it is " +
        formatted("at x %.3g, y %.3g, z %.3g m in the frame of the camera", p_C.x(), p_C.y(), p_C.z());
    std::string others;
    std::size_t most = 0;
    for (const OtherMeaning& meaning : other_meanings())
      if (const std::size_t count = camera_has_path_ ? samples_seen(meaning.of) : 0; count > most)
        most = count, others = std::string("; with ") + meaning.text + " of the camera it is in the image";
    text += others;
    notes.push_back({"not in view", text});
  }
  return notes;
}

PointCloud MeshScene::made(int frame) const {
  const double time_s = moving_time_s(captured_s(frame));
  return still_view_ ? camera_.cloud(*still_view_, frame, time_s)
                     : camera_.cloud(camera_.view(meshes_, time_s), frame, time_s);
}

std::shared_ptr<const NeighbourSearch> MeshScene::points(int frame) const {
  return frames_.get(static_cast<std::size_t>(frame), [&] { return make_search(made(frame)); });
}

// The search of an image stores its points in their order.
PointCloud MeshScene::cloud(int frame) const {
  return *points(frame)->stored_cloud();
}

// Returns the poses of all objects, object to world frame.
std::vector<std::optional<RigidTransform>> MeshScene::poses(double time_s) const {
  std::vector<std::optional<RigidTransform>> X_WO;
  X_WO.reserve(meshes_.size());
  for (const SceneMesh& mesh : meshes_) X_WO.push_back(mesh.path.at(moving_time_s(time_s)));
  return X_WO;
}

// Makes no list of poses, because a slave of a live session asks here, and its loop must not allocate.
NearestOnObjects MeshScene::nearest(const Vec3& p_W, double time_s) const {
  NearestOnObjects result;
  if (!p_W.allFinite()) return result;
  for (std::size_t i = 0; i < objects_.size(); ++i)
    take_nearer(result, objects_, i, meshes_[i].path.at(moving_time_s(time_s)), p_W, kReach_m);
  return result;
}

double MeshScene::signed_distance(const Vec3& p_W, double time_s) const {
  return nearest(p_W, time_s).distance_m;
}

// The gradient of the distance is unknown where parts with different normals are equally near.
Vec3 MeshScene::true_normal(const Vec3& p_W, double time_s) const {
  const Vec3 gradient = Scenario::true_normal(p_W, time_s);
  return gradient.allFinite() ? nearest(p_W, time_s).normal : gradient;
}

}  // namespace remote_touch
