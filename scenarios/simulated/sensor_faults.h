// Faults that a depth sensor adds to the frames of any scenario: noise along its rays, rounded depths, flying
// points and outliers, lost points, repeated and late frames, and rows that are read one after the other.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "core/points/noise.h"
#include "core/points/point_cloud.h"
#include "scenarios/simulated/scenario.h"

namespace remote_touch {

// Noise along the viewing rays as depth sensors have it: it grows with the square of the distance, and it is
// correlated between neighbouring points and between successive frames.
struct RayNoise {
  double sigma_m = 0;        // standard deviation at a distance of 1 m; it is sigma_m (distance / 1 m)^2
  double correlation_m = 0;  // pitch of the square lattice across the view that carries the noise
  double memory = 0;         // correlation of the noise of successive frames (-)
};

// Returns one standard normal for each point of a frame. positions: position of each point across the view,
// in x and z, in the unit of correlation_m. A point that was not measured is NaN there, and its noise is NaN
// if correlation_m is above 0.
//
// Without correlation_m every point has independent noise. Otherwise the noise of the lattice's nodes is
// interpolated bilinearly and scaled to standard deviation 1 everywhere. The noise of two points that are
// farther apart than two pitches along x or z is independent. Throws InputError if correlation_m is so small
// against the cloud that the lattice would have more than 2^24 nodes.
//
// The noise x_j of frame j with memory m has the law of x_j = m x_(j-1) + (1 - m^2)^(1/2) w_j with
// independent w: the correlation of two frames is m^|i - j|, from the first frame on (to 1e-8). It is not
// computed by this recursion, so that a frame needs no other frames.
std::vector<double> standard_noise(const RayNoise& noise, const PointCloud& positions, const NoiseKey& key,
                                   int frame, const Kernels& kernels);

// Faults are applied in this order. A point can get several faults, but an outlier is not also a flying
// point. Points move along view_direction, and their depth is measured along it. In a cloud with an image
// layout points move along their own rays instead; noise grows with the distance from the camera, and the
// rounded depth is that along the camera's axis, as in a depth image.
struct SensorFaults {
  Vec3 view_direction{0, -1, 0};  // viewing direction of the sensor, world frame; any length
  double repeat_probability = 0;  // probability that a frame repeats the previous one
  double rolling_shutter_s = 0;   // time in which the rows of a frame are read
  RayNoise ray_noise;
  double sensor_distance_m = 1;  // distance from the origin, against view_direction; not used for images
  double flying_probability = 0, max_flying_distance_m = 0.02;
  double outlier_probability = 0, max_outlier_distance_m = 0.05;
  double quantisation_m = 0;
  double hole_fraction = 0, hole_radius_m = 0.005;
  double dropout_probability = 0;
  double late_probability = 0, late_delay_s = 0.05;
};

Parameters parameters(SensorFaults& s);
std::string validate(const SensorFaults& s);
// Returns the parameters that turn on the faults that draw random numbers.
std::vector<std::string> random_faults();
// Returns true if one of these faults depends on view_direction in a cloud without an image layout.
bool use_view_direction(const SensorFaults& s);

// Frames are a pure function of the scenario, the settings, the noise key and the frame's number. If every
// fault is 0, they are the scenario's bit for bit. A lost point becomes NaN in all three coordinates, so that
// points keep their numbers. The ground truth, and everything else that the sensor reports, is that of the
// scenario.
class FaultySensor final : public Scenario {
 public:
  // Throws std::invalid_argument for settings that validate() refuses.
  FaultySensor(std::unique_ptr<const Scenario> scenario, const SensorFaults& settings, const NoiseKey& key,
               const Kernels& kernels);

  double frame_rate_hz() const override { return scenario_->frame_rate_hz(); }
  // If faults make frames of the same surface differ, in their points or in their delay, the sensor delivers
  // more frames after the scenario's last one, unless the scenario ends.
  int frame_count() const override;
  double captured_s(int frame) const override;
  bool ends() const override { return scenario_->ends(); }
  const Scenario& without_faults() const override { return *scenario_; }
  std::vector<Phase> phases() const override { return scenario_->phases(); }
  std::string input() const override { return scenario_->input(); }
  std::vector<Note> input_notes() const override { return scenario_->input_notes(); }
  std::optional<RigidTransform> sensor_pose() const override { return scenario_->sensor_pose(); }
  FrameDelivery delivery(int frame) const override;
  std::shared_ptr<const NeighbourSearch> points(int frame) const override;
  PointCloud cloud(int frame) const override;
  double signed_distance(const Vec3& p_W, double time_s) const override {
    return scenario_->signed_distance(p_W, time_s);
  }
  // The surface as the camera measured it, before the simulated faults.
  std::optional<double> measured_distance(const Vec3& p_W, double time_s) const override {
    return scenario_->measured_distance(p_W, time_s);
  }
  Vec3 true_normal(const Vec3& p_W, double time_s) const override {
    return scenario_->true_normal(p_W, time_s);
  }
  std::optional<Vec3> plane_normal(double time_s) const override { return scenario_->plane_normal(time_s); }
  double truth_time_s(double time_s) const override { return scenario_->truth_time_s(time_s); }
  std::string truth_text() const override { return scenario_->truth_text(); }
  std::vector<PosedMesh> true_meshes(double time_s) const override { return scenario_->true_meshes(time_s); }
  double surface_height(double x, double z, double time_s) const override {
    return scenario_->surface_height(x, z, time_s);
  }

 private:
  struct ViewCoordinates {  // a cloud projected along the viewing direction
    PointCloud positions;
    std::vector<double> hole_radius;
    std::vector<std::uint32_t> measured;
  };
  int content_frame(int frame) const;   // the frame whose content this frame shows
  int scenario_frame(int frame) const;  // the scenario's frame for it: the last one if there is none
  Vec3 viewing_direction(const PointCloud& cloud, const Vec3& p_W) const;
  void shear(PointCloud& cloud, double captured_s) const;
  Vec3 normal_at(const Vec3& p_W, double time_s) const;
  Vec3 earlier_position(const Vec3& p_W, double now_s, double then_s, const Vec3* ray) const;
  void add_ray_noise(PointCloud& cloud, const PointCloud& positions, int frame) const;
  void displace(PointCloud& cloud, int frame) const;
  ViewCoordinates view_coordinates(const PointCloud& cloud) const;
  void cut_holes(PointCloud& cloud, const ViewCoordinates& coordinates, int frame) const;
  void drop_points(PointCloud& cloud, int frame) const;

  const std::unique_ptr<const Scenario> scenario_;
  const SensorFaults settings_;
  const NoiseKey key_;
  const Kernels& kernels_;
};

}  // namespace remote_touch
