// An experiment: a resolved configuration, and all that is built from it.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "analysis/sweeps/sweep_result.h"
#include "runners/experiment/catalog/configuration.h"
#include "runners/experiment/hand/teleoperation.h"
#include "runners/experiment/settings/changed_settings.h"
#include "scenarios/simulated/scenario.h"

namespace remote_touch {

// The parts of an experiment that begin at a set time, apart from the motions of the scene and of the hand.

// Returns a phase for each change of the renderer, for each part of a fixture's schedule in which the
// strength changes, and for each step of the sequence with a not_before_s above 0.
std::vector<Phase> setting_phases(const ExperimentConfiguration& configuration);

// Returns a phase for each button press of the simulated operator, and for each part of the schedule in which
// the grip changes. Returns none if there is no operator.
std::vector<Phase> operator_phases(const ExperimentConfiguration& configuration);

// A setting that may change while the experiment runs live.
struct LiveParameter {
  enum class Of { renderer, scenario };
  std::string name;  // path as in --set: renderer.stiffness_N_per_m
  std::string help;
  double value = 0;  // value in the experiment; 0 or 1 for a switch
  double low = 0, high = 0;
  bool is_switch = false;
  Of of = Of::renderer;
};

class Experiment {
 public:
  // Reads JSON text; label names the source in errors. Overrides are "key=value" and are applied last; the
  // title names them (changed_settings.h). Throws InputError for settings that are invalid in themselves or
  // do not fit each other, and for an override that a later one discards. check_needs() and the build
  // functions check what depends on the scene and on files.
  static Experiment from_json(const std::string& text, const std::string& label,
                              const std::vector<std::string>& overrides = {});
  static Experiment from_json(const nlohmann::ordered_json& configuration);
  // Reads an experiment of data/experiments by its name, a JSON file, or a recorded live session, which is
  // run again. An error in the text of a file begins with the name of that file; an error in an override does
  // not name a file.
  static Experiment load(const std::string& name_or_file, const std::vector<std::string>& overrides = {});

  const RunSettings& settings() const { return configuration_.run; }
  const std::vector<SequenceStep>& sequence() const { return configuration_.sequence; }
  const std::vector<RendererChange>& changes() const { return configuration_.changes; }
  std::string to_json() const;  // complete: every parameter, one line
  // Returns the value of a setting in the first tick, for a path like "renderer.r1_m": the value in the
  // configuration, or the value of a change at 0 s. Returns null if there is none.
  nlohmann::ordered_json value_at_start(const std::string& path) const;
  // Returns the recordings that a run reads, as named in the configuration; the file system is not searched.
  // Adds the files of the scene of a recorded live session if there is a slave, which it reads. except: keys
  // of sections that this run does not read.
  std::vector<InputPart> inputs(const std::vector<std::string>& except = {}) const;

  // Builds the scenario, with the faults of the sensor if the experiment has any.
  std::unique_ptr<Scenario> build_scenario(const Kernels& kernels) const;
  // Builds the trajectory on the scene without sensor faults. The motion is the same with and without faults,
  // so that the effect of the faults can be seen alone.
  std::unique_ptr<Trajectory> build_trajectory(const Scenario& scenario) const;
  // switches: the switches of the fixtures. The renderer sets them, and the processing of frames reads them.
  // build_fixtures() and build_processing() do not use them without a sequence.
  std::unique_ptr<Renderer> build_renderer(const Kernels& kernels,
                                           std::shared_ptr<FixtureSwitches> switches = nullptr) const;
  FixtureAssignment build_fixtures(std::shared_ptr<const FixtureSwitches> switches = nullptr) const;
  // report: called with one line when an OpenCL device has failed, in the thread that processes frames. If it
  // is empty, the line is printed to standard error.
  FrameProcessing build_processing(const Kernels& kernels,
                                   std::shared_ptr<const FixtureSwitches> switches = nullptr,
                                   const DepthReport& report = {}) const;
  // Must be called before a run. Throws InputError, which says what to add, if the first frame of the
  // scenario lacks a need of the renderer, a fixture rule or guidance. The overload for a live sensor checks
  // only the renderer's needs. Each frame must be checked against FrameProcessing::needs too.
  void check_needs(const Scenario& scenario) const;
  void check_needs(const SensorView& view) const;
  // Adds `depth_device` to the provenance of a result: the name of the OpenCL device that processes its depth
  // images. Adds nothing if the CPU processes them. Must be called after build_processing().
  void add_depth_device(TextAttributes& provenance) const;
  SimulatedHand build_hand() const;
  // Builds the slave and its links. Returns nothing without a slave. touched: the slave touches the true
  // surface of this scenario, which must outlive it; null: nothing. hand: whether passivity control may use
  // the mass in the section operator, which a real hand does not have.
  enum class Hand { simulated, real };
  std::optional<Teleoperation> build_teleoperation(const Scenario* touched,
                                                   Hand hand = Hand::simulated) const;
  // Builds the scene that a slave touches in real time, with a simulated camera: the scenario without the
  // faults of the sensor, or build_recorded_scene() if the scenario is a recorded live session. Returns null
  // if there is no slave, and if the scenario is a recording, because its true surface is read from files.
  std::unique_ptr<const Scenario> build_simulated_scene(const Kernels& kernels) const;
  // Returns null unless there is a slave, and the scenario is a recorded live session whose camera was
  // simulated. Then builds the scene that the camera saw, as build_simulated_scene() does: the session itself
  // has no true surface.
  std::unique_ptr<const Scenario> build_recorded_scene(const Kernels& kernels) const;
  // Returns the dead-band of frames, whose near_m contains the reach of the slave's tool; without a slave,
  // settings with which every frame is passed on.
  FrameDeadBandSettings frame_dead_band() const;
  // Returns the phases in the sections of the experiment itself: changes of the renderer, schedules of
  // fixtures, and steps of the sequence that wait for a time.
  std::vector<Phase> phases() const { return setting_phases(configuration_); }
  // The button presses of the simulated operator, and the changes of the grip.
  std::vector<Phase> operator_phases() const { return remote_touch::operator_phases(configuration_); }
  // Returns an upper bound, over all poses, of how fast |force| grows with the device's displacement: the
  // stiffest spring of the renderer or of a forbidden region, plus the springs of all guidance. If the hand
  // feels a slave instead, it is the stiffness of drive and contact of the slave in series, times the gain.
  double max_stiffness_N_per_m() const;
  // Returns the live parameters of the renderer, in the order of Renderer::live_parameters(), then those of
  // the scenario.
  std::vector<LiveParameter> live_parameters() const;
  // The rest distance, spring and ball radius of the renderer's contact point.
  RenderedContact rendered_contact() const { return configuration_.renderer.factory->contact(); }
  // The settings of the live loop. Offline runs ignore them.
  LiveSettings live() const { return configuration_.live.value_or(LiveSettings{}); }
  SafetyLimits safety() const { return configuration_.safety.value_or(SafetyLimits{}); }

 private:
  // Returns the experiment that was run in a live session with a simulated camera, if the scenario is the
  // recording of it.
  std::optional<Experiment> recorded_experiment() const;
  std::unique_ptr<const Scenario> simulated_scene(const Kernels& kernels) const;

  ExperimentConfiguration configuration_;
};

// The random numbers that a run draws, by its configuration.

// Returns the streams from which runs of the experiment draw: those of their cell if a deviation, jitter or
// probability of the scene, the sensor, the frames or the links is above 0; that of their replicate if the
// slave has a registration error. A scenario of a plug-in, of Python or of a program's own catalog counts as
// one that draws: it may use the noise key as it likes. The motion `random-motion` has a seed of its own, so
// it is the same in all replicates and draws nothing here.
RandomStreams random_streams(const Experiment& experiment);
// True if a change of the setting at this path, as for --set, may change the streams.
bool may_change_streams(const std::string& path);

}  // namespace remote_touch
