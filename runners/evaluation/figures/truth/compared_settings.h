// The things compared on true objects: renderers, and settings of what filters depth images.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "analysis/measures/no_value.h"
#include "core/dissertation/depth/depth_pipeline.h"
#include "runners/evaluation/figures/truth/true_contacts.h"

namespace remote_touch {

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

}  // namespace remote_touch
