// The objects that classes of Python receive and return: clouds, frames, outputs, scenes.
#pragma once

#include <omp.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <optional>

#include "core/kernels/kernels.h"
#include "core/points/noise.h"
#include "core/rendering/frames_and_outputs.h"
#include "runners/interfaces/python/arrays.h"
#include "scenarios/simulated/scenario.h"

namespace remote_touch {

// A cloud that does not change. Its arrays in Python share the memory of its points.
struct PythonCloud {
  std::shared_ptr<const NeighbourSearch> source =
      nullptr;  // keeps what `shown` points to, if that is not `own`
  PointCloud own = {};
  const PointCloud* shown = &own;

  PythonCloud() = default;
  explicit PythonCloud(PointCloud cloud) : own(std::move(cloud)) {}
  PythonCloud(const PythonCloud&) = delete;
  PythonCloud& operator=(const PythonCloud&) = delete;
};

struct PythonFrame : PythonCloud {
  PythonFrame(const Frame& frame, const Kernels& kernels);
  int index;
  double captured_s, arrives_s;
};

// Converts an array of points, or a Cloud. Throws InputError, also for points that are far from the origin.
PointCloud cloud_of(const pybind11::handle& value, const Subject& subject);

// The output that step() returns. Its proxy is the HIP unless it was given.
struct PythonOutput {
  RenderOutput output;
  bool has_proxy = false;
  std::optional<Vec3> torque_Nm = {};
  std::optional<Eigen::Quaterniond> tool_orientation = {};
};

// A scenario of the catalog, for classes of Python. This object owns the scenario, or it refers to one that
// is lent to a trajectory until take_back().
class PythonScene {
 public:
  PythonScene(std::unique_ptr<const Scenario> scenario) : own_(std::move(scenario)), scenario_(own_.get()) {}
  explicit PythonScene(const Scenario& lent) : scenario_(&lent) {}
  const Scenario& operator*() const;  // throws InputError after take_back()
  void take_back() { scenario_ = nullptr; }

 private:
  std::unique_ptr<const Scenario> own_;
  const Scenario* scenario_;
};

// While it exists, this thread works alone: an image is done in milliseconds, and several threads of Python
// do not wait for each other's helpers.
class AloneInThread {
 public:
  AloneInThread() : threads_(omp_get_max_threads()) { omp_set_num_threads(1); }
  ~AloneInThread() { omp_set_num_threads(threads_); }
  AloneInThread(const AloneInThread&) = delete;
  AloneInThread& operator=(const AloneInThread&) = delete;

 private:
  const int threads_;
};

// Adds to these classes what computes with images: cameras, depths, true surfaces. Adds DepthSensor, and
// Stepper, a renderer of the catalog that is stepped by hand.
using CloudClass = pybind11::class_<PythonCloud, std::shared_ptr<PythonCloud>>;
using SceneClass = pybind11::class_<PythonScene, std::shared_ptr<PythonScene>>;
void bind_images(pybind11::module_& module, CloudClass& cloud, SceneClass& scene);
void bind_stepper(pybind11::module_& module);

}  // namespace remote_touch
