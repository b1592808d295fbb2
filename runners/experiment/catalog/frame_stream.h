// The path of a frame from a scenario to a renderer: its depth image is filtered and gets normals, fixtures
// are assigned to its points, and it arrives late, at irregular times, or not at all.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/dissertation/depth/depth_pipeline.h"
#include "core/dissertation/virtual_fixtures/fixture_rules.h"
#include "core/points/noise.h"
#include "core/rendering/renderer.h"
#include "runners/experiment/sessions/sensor_frame.h"
#include "scenarios/simulated/scenario.h"

namespace remote_touch {

struct ExperimentConfiguration;

// Refuses a run whose frames lack what its renderer, fixture rules or guidance need. The message is one line
// that says what to add. check_needs() checks the first frame before the run starts. RendererNeeds checks
// every frame, because the frames of a recording may differ.

// The needs of one renderer. A renderer without needs accepts every frame.
class RendererNeeds {
 public:
  RendererNeeds() = default;
  RendererNeeds(std::string renderer, std::vector<FrameNeed> needs)
      : renderer_(std::move(renderer)), needs_(std::move(needs)) {}
  // Throws InputError for a frame whose points have no normals or are unorganised, if the renderer needs
  // normals or organised points. A frame without points is accepted. If normals are needed, at least one of
  // the measured points of frame 0 must have one.
  void check(const Frame& frame) const;

 private:
  std::string renderer_;
  std::vector<FrameNeed> needs_;
};

// Returns the needs that the catalog lists for the renderer.
std::vector<FrameNeed> renderer_needs(const ExperimentConfiguration& configuration);

// Checks the first frame of the scenario before a run. Throws InputError. fixtures: the fixtures of the
// configuration.
void check_needs(const ExperimentConfiguration& configuration, const FixtureAssignment& fixtures,
                 const Scenario& scenario);
// Checks the renderer's needs against what a live sensor reports before its first frame. Throws InputError.
void check_needs(const ExperimentConfiguration& configuration, const SensorView& view);

// Latency, jitter and loss of frames between capture and arrival. They are independent for each frame and
// drawn from the run's noise key.
struct Transport {
  double latency_s = 0;         // shortest time from capture to arrival
  double jitter_s = 0;          // maximum added delay, uniformly distributed; frames may overtake each other
  double drop_probability = 0;  // probability that a frame never arrives
};

// Processing of a frame's points before they are sent.
struct FrameProcessing {
  std::unique_ptr<DepthProcessor> depth;  // null: the points are sent as the scenario gives them
  FixtureAssignment fixtures;
  RendererNeeds needs = {};  // the renderer's needs; the caller of fill() checks them

  bool changes_points() const { return depth || !fixtures.empty(); }
  // Adds points and guidance targets to the frame. off: the fixtures that are off, one bit each. Throws
  // InputError if there is a depth pipeline and the cloud is not a depth image, or if a fixture rule cannot
  // be applied to it.
  void fill(Frame& frame, PointCloud cloud, std::uint64_t off) const;
  // The same with the cloud cloud_of(sensed, view, X_WC).
  void fill(Frame& frame, const SensorFrame& sensed, const SensorView& view, const RigidTransform& X_WC,
            std::uint64_t off) const;

 private:
  void apply_fixtures(Frame& frame, PointCloud cloud, std::uint64_t off) const;
};

// 64-bit hash of a frame's points and its time of capture.
std::uint64_t frame_hash(const PointCloud& cloud, double captured_s);

class FrameStream {
 public:
  // The scenario must outlive the stream. The last frame is repeated at the frame rate, unless the scenario
  // ends (Scenario::ends()). A repetition is a frame of its own: it has the next number, its own time of
  // capture, latency and loss, and the points of the last frame. A scene with one frame only, which never
  // changes, is sent once, unless fixtures change with time, or frames can be lost or overtake each other.
  // hash_frames: computes every point of every frame, for newest_hash(). generate_all_points: computes every
  // point, with the same bits, before a frame is passed on, so that measured durations do not contain the
  // generation of noise.
  FrameStream(const Scenario& scenario, FrameProcessing processing, const Transport& transport,
              const NoiseKey& key, bool hash_frames, bool generate_all_points = false);

  // Passes the frames that have arrived by time_s to the receiver, in order of arrival, with the true surface
  // for oracles. Throws InputError if a frame cannot be read, has no depth image to be processed, or lacks
  // what the renderer needs, or if a fixture rule cannot be applied to it. pre: times never decrease.
  void deliver_until(double time_s, FrameReceiver& receiver);
  const FixtureAssignment& fixtures() const { return processing_.fixtures; }
  // Hash of the newest frame delivered; 0 before the first or without hash_frames.
  std::uint64_t newest_hash() const { return hash_; }

 private:
  struct FrameInTransit {
    double arrives_s;
    int frame;
  };
  bool exists(int frame) const;
  int source_frame(int frame) const;  // the scenario's frame that this one shows
  double captured_s(int frame) const;
  void send(int frame);
  void fill(Frame& frame);  // adds its points and targets
  std::shared_ptr<const NeighbourSearch> points_of(int source) const;
  std::uint64_t hash_of(int frame, const NeighbourSearch& points) const;

  const Scenario& scenario_;
  std::shared_ptr<const TrueSurface> truth_;
  FrameProcessing processing_;
  Transport transport_;
  NoiseKey key_;
  bool hash_frames_, generate_all_points_;
  int next_ = 0;  // the next frame to be sent
  std::vector<FrameInTransit> in_transit_;
  std::shared_ptr<const NeighbourSearch> repeated_;  // points of the last repeated frame; null before it
  std::uint64_t hash_ = 0;
};

}  // namespace remote_touch
