// Measures of runs with a tool (chapters 6 and 7) and with guidance. A measure is NaN if the run has no tool,
// or no guidance.
#pragma once

namespace remote_touch {

struct Trace;

double max_torque_Nm(const Trace& trace);
// Contacts: points that touch the tool, or pairs of a sphere of the tool and a region; mean and maximum over
// the ticks.
double mean_contact_count(const Trace& trace);
double max_contact_count(const Trace& trace);
// Active constraints of (6.5).
double mean_active_constraints(const Trace& trace);
double max_active_constraints(const Trace& trace);
// Groups of touching points.
double max_contact_clusters(const Trace& trace);
// Depth of the deepest point of the newest frame in the tool, m: maximum over the ticks.
double max_tool_penetration_m(const Trace& trace);
// Gap between the tool and the nearest point or region, m, negative inside the tool: minimum over the ticks
// that have a nearest point or region; NaN if there is no such tick.
double min_clearance_m(const Trace& trace);
// Collision detections in a tick.
double mean_detections(const Trace& trace);
double max_detections(const Trace& trace);
// Fraction of the ticks that ended before the tool had converged.
double exhausted_fraction(const Trace& trace);
// Lag of the tool behind the device: distance of the tool's centre of mass from the HIP, m, and angle between
// their orientations, rad.
double mean_tool_lag_m(const Trace& trace);
double max_tool_lag_m(const Trace& trace);
double mean_tool_lag_rad(const Trace& trace);
double max_tool_lag_rad(const Trace& trace);

// Fraction of the ticks with an active guidance fixture whose target is visible.
double guidance_fraction(const Trace& trace);
// Distance of the tool, or of the proxy, from the goal of guidance at the last tick with active guidance, m,
// and angle between tool and goal, rad. NaN if no tick has active guidance; the angle is NaN also without a
// tool.
double guidance_error_m(const Trace& trace);
double guidance_error_rad(const Trace& trace);

}  // namespace remote_touch
