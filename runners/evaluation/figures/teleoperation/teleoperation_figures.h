// The figures of teleoperation: a device with limits, and a slave robot behind a channel.
#pragma once

#include "runners/evaluation/figures/context/figure_context.h"

namespace remote_touch {

MakeFigure figure_anticipation, figure_device_wall, figure_device_width, figure_slave_force_peak,
    figure_slave_lift, figure_slave_packets, figure_slave_region_radius, figure_steer_robot;

}  // namespace remote_touch
