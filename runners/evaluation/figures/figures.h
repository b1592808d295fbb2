// The figures that can be reproduced: each runs experiments and hands their traces to analyses.
#pragma once

#include <span>

#include "runners/evaluation/figures/context/figure_context.h"

namespace remote_touch {

// A new figure is one file, its name at the end of this header, and one line in figures.cpp. Those of
// teleoperation and of studies are in folders of their own, with their names in teleoperation_figures.h and
// study_figures.h.
struct FigureEntry {
  const char* name;
  const char* summary;
  MakeFigure* make;
  double expected_s;             // time on one thread, for the order of figures and the time left
  bool has_map = false;          // the map needs most of that time
  int quick_coarse = 1;          // value of coarse for a quick figure
  bool takes_recording = false;  // takes settings of its scenario, such as scenario.path=DIR
};
std::span<const FigureEntry> figures();

MakeFigure figure_4_10, figure_4_11, figure_4_12, figure_4_13, figure_4_13_replicated, figure_4_13_tracked,
    figure_4_14, figure_4_15, figure_4_15_meshes, figure_4_16, figure_4_16_recorded, figure_5_5, figure_5_6,
    figure_latency, figure_5_8, figure_5_8_recorded, figure_5_9, figure_6_2, figure_6_3, figure_6_3_angles,
    figure_6_4, figure_7_1_recorded, figure_7_4, figure_7_5, figure_7_5_guidance, figure_7_5_recorded,
    figure_bounds, figure_camera_error, figure_eq4_15, figure_first_touch, figure_frame_rates,
    figure_handshake, figure_handshake_human, figure_proxy_rates, figure_sensor_models_recorded,
    figure_tool_forces, figure_tool_lifts, figure_tool_shapes, figure_tool_tracked, figure_turbidity;

}  // namespace remote_touch
