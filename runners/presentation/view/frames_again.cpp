#include "runners/presentation/view/frames_again.h"

#include <nlohmann/json.hpp>

#include "analysis/trace/trace.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/catalog/frame_stream.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/experiment/settings/stored_configuration.h"
#include "runners/experiment/simulation/simulation.h"
#include "scenarios/text_files/json_text.h"

namespace remote_touch {

namespace {

// Receives the frames in place of the renderer.
class FrameObserver final : public Renderer {
 public:
  explicit FrameObserver(const std::function<void(const Frame&)>& on_frame) : on_frame_(on_frame) {}
  void on_frame(const Frame& frame) override { on_frame_(frame); }
  RenderOutput step(const DeviceState&, double) override { return {}; }

 private:
  const std::function<void(const Frame&)>& on_frame_;
};

}  // namespace

Experiment experiment_of_run(const TextAttributes& trace, const std::string& name) {
  if (!recipe_of(trace) && attribute(trace, "command").find(" live ") != std::string::npos)
    throw InputError(
        name,
        "is of a live run, without its frames: expected the trace that `remote-touch run` makes from its recording");
  Experiment experiment = read_configuration(trace, name, [&] {
    return Experiment::from_json(parse_json(stored_configuration(attribute(trace, "config")), name));
  });
  for (const ChangedInput& input :
       changed_inputs(attribute(trace, "input_digests"), input_hashes(experiment.inputs())))
    throw InputError(name, "its recording " + input.path + " has changed: expected " + input.before +
                               ", found " + input.now);
  return experiment;
}

void replay_frames(const Experiment& experiment, std::span<const double> time_s, const Kernels& kernels,
                   const std::atomic<bool>* stop, const std::function<void(const Frame&)>& on_frame) {
  // A task switches fixtures on and off, at times that are known only from the run itself.
  if (!experiment.sequence().empty()) {
    SimulationOptions options;
    options.kernels = &kernels;
    options.stop = stop;
    options.on_frame = on_frame;
    simulate(experiment, options);
    return;
  }
  FrameObserver observer(on_frame);
  const auto scenario = experiment.build_scenario(kernels);
  FrameProcessing processing = experiment.build_processing(kernels);
  processing.needs = {};  // so that a run of an earlier version, which refused nothing, can be shown too
  FrameStream stream(*scenario, std::move(processing), experiment.settings().transport,
                     experiment.settings().key, false);
  for (const double now_s : time_s) {
    if (stop && *stop) throw Interrupted{};
    stream.deliver_until(now_s, observer);
  }
}

}  // namespace remote_touch
