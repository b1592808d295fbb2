// Runs in which a hand presses a point of a true object, and the errors of renderer and camera at the
// contact.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "analysis/measures/no_value.h"
#include "core/kernels/kernels.h"
#include "runners/evaluation/figures/truth/recording_window.h"
#include "runners/experiment/catalog/experiment.h"

namespace remote_touch {

// The renderer that touches a recording, and how its frames are processed before.
struct Toucher {
  std::string name;            // text for titles
  std::string renderer;        // JSON
  std::string depth_pipeline;  // JSON; empty: none
  double rest_distance_m = 0;  // distance of the reported position from a surface that it touches
};

// Returns the experiment of a run over the recording. The hand moves with the true object. It comes to the
// point from 30 mm outwards within three frames, stays 10 mm behind the true surface for twelve, and comes
// again. The run ends 0.1 s after the last frame of the window. scenario: that section as JSON.
Experiment pressing_experiment(const nlohmann::ordered_json& scenario, const RecordingWindow& window,
                               const Toucher& toucher);

// Runs the experiment on the window in place of its scenario. Returns the contact point in the last tick of
// each frame, world frame: rest_distance_m from the reported position, against the renderer's own normal. It
// is NaN if nothing is touched, or if the points are touched from behind, which the camera does not see. Each
// press has a renderer of its own, because a proxy that popped through would stay behind the points. Pre: the
// experiment has no fixtures, guidance, changes, operator or device. Several threads may use one window.
std::vector<Vec3> contact_points(const Experiment& experiment, const RecordingWindow& window,
                                 double rest_distance_m, const Kernels& kernels);

// The errors at a contact point. Both are NaN if the contact point or one of the surfaces is unknown.
struct ContactError {
  double renderer_m = kNoValue;  // height of the contact point over the measured surface
  double camera_m = kNoValue;    // height of the measured surface over the true one, at the contact point
  double total_m() const { return renderer_m + camera_m; }  // height of the contact point over the true one
};
// Returns the errors in each frame. Pre: contacts_W has one contact point for each frame of the window.
std::vector<ContactError> contact_errors(const std::vector<Vec3>& contacts_W, const RecordingWindow& window);

// Makes the errors NaN in every frame in which they are NaN in one of the runs, so that runs are compared
// over the same frames. Pre: all runs have the same number of frames.
void keep_common_frames(std::vector<std::vector<ContactError>>& runs);

// Statistics of values over the frames in which they are known; NaN if there are none.
struct ErrorStatistics {
  double frames = 0, rms_m = kNoValue, mean_m = kNoValue;
};
using ErrorValue = double (*)(const ContactError&);
// offset_m is added to each value.
ErrorStatistics statistics_of(const std::vector<ContactError>& errors, ErrorValue value, double offset_m = 0);
// Returns the rms change of the value from one frame to the next, divided by the square root of 2: the
// standard deviation of errors that are independent in each frame. NaN if no two successive values are known.
double frame_noise_m(const std::vector<ContactError>& errors, ErrorValue value);

inline double renderer_error_m(const ContactError& error) {
  return error.renderer_m;
}
inline double camera_error_m(const ContactError& error) {
  return error.camera_m;
}
inline double total_error_m(const ContactError& error) {
  return error.total_m();
}

}  // namespace remote_touch
