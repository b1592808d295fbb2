// Parameters that the user changes during a live run. A change is checked outside the haptic loop, and made
// by the loop between two ticks.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runners/experiment/catalog/experiment.h"
#include "runners/live/sensors/scenario_camera.h"

namespace remote_touch {

// A lock-free queue of fixed length from one thread to another. One producer, one consumer. Allocates on
// construction only.
template <class T>
class Ring {
 public:
  // min_capacity: rounded up to a power of two.
  explicit Ring(std::size_t min_capacity) : slots_(std::bit_ceil(min_capacity)) {}

  // The slot to write next, or null if the queue is full; push() passes it on.
  T* next_slot() {
    const std::size_t end = end_.load(std::memory_order_relaxed);
    if (end - start_.load(std::memory_order_acquire) == slots_.size()) return nullptr;
    return &slots_[end & (slots_.size() - 1)];
  }
  void push() { end_.store(end_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

  // The oldest value, or null; pop() removes it.
  T* oldest() {
    const std::size_t start = start_.load(std::memory_order_relaxed);
    if (start == end_.load(std::memory_order_acquire)) return nullptr;
    return &slots_[start & (slots_.size() - 1)];
  }
  void pop() { start_.store(start_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

 private:
  std::vector<T> slots_;
  alignas(64) std::atomic<std::size_t> end_ = 0;
  alignas(64) std::atomic<std::size_t> start_ = 0;
};

// A change of a live parameter. parameter: its number in LiveControls::parameters().
struct ParameterChange {
  std::int32_t parameter = 0;
  double value = 0;
};

// Live parameters that change together, on their way to the haptic loop.
struct ParameterChanges {
  static constexpr std::size_t kMax = 4;
  std::array<ParameterChange, kMax> list;
  std::size_t count = 0;
  std::span<const ParameterChange> all() const { return {list.data(), count}; }
};

class LiveControls {
 public:
  enum class Camera { simulated, other };
  // Only the renderer's parameters can change if the camera is not the experiment's scenario. An experiment
  // with changes of its own has no live parameters.
  LiveControls(const Experiment& experiment, const Kernels& kernels, Camera camera);

  // The parameters of the renderer, in the order of Renderer::live_parameters(), then those of the scenario.
  const std::vector<LiveParameter>& parameters() const { return parameters_; }

  // Their present values: the loop uses them already, or will in one of its next ticks. Only the thread of
  // change() may call it.
  const std::vector<double>& values() const { return values_; }
  bool has_changed() const;
  // Requests changes. Returns an empty text if the loop will make them together, else the reason why not, in
  // one line. Only one thread may call it.
  std::string change(const ParameterChanges& changes);

  // The run uses the following functions.
  Ring<ParameterChanges>& requested() { return requested_; }
  const std::shared_ptr<ShownScenario>& scenario() const { return shown_; }  // null with another camera
  // Refuses a greater stiffness than at the start from now on. A device with motors needs this limit, because
  // it is not known whether a greater stiffness is stable.
  void limit_stiffness() { has_stiffness_limit_ = true; }

 private:
  Experiment checked(const std::vector<double>& values) const;
  bool is_of_scenario(const ParameterChanges& changes) const;

  const Kernels& kernels_;
  const std::string configuration_;
  const double max_stiffness_N_per_m_;
  std::vector<LiveParameter> parameters_;
  std::size_t of_renderer_ = 0;
  std::vector<double> values_;  // now
  std::shared_ptr<ShownScenario> shown_;
  Ring<ParameterChanges> requested_{64};
  std::atomic<bool> has_stiffness_limit_ = false;
};

}  // namespace remote_touch
