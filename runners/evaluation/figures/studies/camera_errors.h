// The errors of renderer and camera on one true object, and their tables and panels.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "analysis/storage/result_file.h"
#include "analysis/trace/interval_estimates.h"
#include "core/dissertation/depth/depth_pipeline.h"
#include "runners/evaluation/figures/studies/depth_errors.h"
#include "runners/evaluation/figures/studies/true_contacts.h"

namespace remote_touch {

// The things compared on true objects: renderers, and settings of what filters depth images.

// The renderers that are compared over the frames: the proxy, the tracked sheet, and a tool: a ball of 10 mm
// radius behind the default depth pipeline.
const std::vector<Toucher>& compared_renderers();

// A setting of what filters depth images before the proxy touches their points.
struct DepthSetting {
  std::string name;
  double window_px = 1;         // width of the spatial filter (7.1); 1: there is none
  double sigma_f_m = kNoValue;  // window of (7.2)
  std::string average;          // setting of the renderer averaged-proxy; empty: nothing filters over time
  bool is_spatial() const { return average.empty(); }
};
const std::vector<DepthSetting>& depth_settings();
// The proxy behind the setting. It does not use normals, so the pipeline computes them in the fastest way.
Toucher toucher_of(const DepthSetting& setting);
// The whole pipeline with the setting. Nothing if the setting is not spatial.
std::optional<DepthPipelineSettings> pipeline_of(const DepthSetting& setting);

// Returns the index of the best setting by a quantity that is smaller for a better one. NaN is never the
// best.
std::size_t best_setting(const std::vector<double>& values);
// The number of spatial settings. They are the first ones in the list.
std::size_t spatial_count();
// The index of the filter of an experiment that does not change it.
std::size_t default_setting();
// The indices of the settings that differ in their window only: no filter, and those with the default
// sigma_f.
std::vector<std::size_t> settings_by_window();

struct TouchedObject {
  std::string table;  // begins the names of its tables
  std::string title;
  double uncertainty_m = 0;  // uncertainty of the truth
  std::vector<double> captured_s;
  std::vector<std::vector<ContactError>> renderers;  // order of compared_renderers()
  // The order is that of depth_settings(); over the frames in which all of them are known.
  std::vector<std::vector<ContactError>> settings;
  std::vector<double> known_frames;  // runs of each setting alone
  std::vector<DepthErrors> points;   // one for each spatial setting, in their order
};

// The quantities by which settings are compared, over the spatial settings in their order.
std::vector<double> contacts_to_measured_m(const TouchedObject& object);
// offset_m moves the truth away from the camera, along the surface's normal.
std::vector<double> contacts_to_true_m(const TouchedObject& object, double offset_m = 0);
std::vector<double> points_to_measured_m(const TouchedObject& object);
std::vector<double> points_to_true_m(const TouchedObject& object);

// Adds tables and a row of panels: the errors over the frames for each renderer, and over the filter's
// window.
void add_object(Figure& figure, const TouchedObject& object, int row);
// Adds tables over all objects: the renderers, the settings, and the best of them; and a row of panels with
// the errors of all points of the objects.
void add_comparisons(Figure& figure, const std::vector<TouchedObject>& objects, int row);

}  // namespace remote_touch
