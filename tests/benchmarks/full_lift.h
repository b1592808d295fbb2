// Lifts in which every point of every frame is made, with the loop and the renderer of the real lifts.
#pragma once

#include <functional>
#include <memory>

#include "analysis/trace/trace.h"
#include "core/search/neighbour_search.h"
#include "runners/experiment/catalog/experiment.h"
#include "scenarios/synthetic/lifts.h"

namespace remote_touch::benchmarks {

// Makes the points of a frame, which the renderer receives instead of scenario.points(frame).
using MakeFrame = std::function<std::shared_ptr<const NeighbourSearch>(const Scenario& scenario, int frame)>;

// Returns the trace of simulate(), bit for bit, if make_frame gives the same points. pre: no latency;
// duration_s is set.
Trace simulate_with(const Experiment& experiment, const Kernels& kernels, const MakeFrame& make_frame);

// The reference: the frame's whole cloud, searched point by point.
std::shared_ptr<const NeighbourSearch> whole_cloud(const Scenario& scenario, int frame);

// NoisyGridSearch without its laziness: the same generator makes the noise of all points of a frame at once.
// Only the points are stored.
MakeFrame all_noise(const MovingLift::Settings& scene, const NoiseKey& key, const Kernels& kernels);

}  // namespace remote_touch::benchmarks
