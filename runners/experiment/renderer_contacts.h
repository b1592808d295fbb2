// The one place that says how far the position of each renderer rests off the surface that it touches, see
// rendered_contact.h. A new renderer has one more function here; tests/runners/experiment/
// renderer_contacts_test.cpp presses it on a flat cloud.
#pragma once

#include "core/proxy/proxy_parameters.h"
#include "core/rivals/averaged_proxy_renderer.h"
#include "core/rivals/density_proxy_renderer.h"
#include "core/rivals/god_object_renderer.h"
#include "core/rivals/implicit_surface_renderer.h"
#include "core/rivals/oracle_proxy_renderer.h"
#include "core/rivals/penalty_renderer.h"
#include "core/rivals/surfel_renderer.h"
#include "core/tracked_sheet/tracked_sheet_renderer.h"
#include "runners/experiment/rendered_contact.h"
#include "runners/tool_files/loaded_spheres.h"
#include "runners/tool_files/loaded_tool.h"

namespace remote_touch {

// Spacing of the points of most scenes (Grid). The surface of metaballs depends on it: at this one their rest
// distance is what it should be, and where points are closer or wider apart the difference is the method's
// error.
inline constexpr double kReferenceSpacing_m = 0.0015;

inline RenderedContact rendered_contact(const ProxyParameters& p) {
  return {p.contact_radius_m()};
}
inline RenderedContact rendered_contact(const TrackedSheetParameters& p) {
  return rendered_contact(p.proxy);
}
inline RenderedContact rendered_contact(const OracleProxyParameters& p) {
  return rendered_contact(p.proxy);
}
inline RenderedContact rendered_contact(const AveragedProxyParameters& p) {
  return rendered_contact(p.proxy);
}
// Whatever its radius is, it reports where a ball of the nominal one would be.
inline RenderedContact rendered_contact(const DensityProxyParameters& p) {
  return rendered_contact(p.proxy);
}
inline RenderedContact rendered_contact(const SurfelParameters&) {
  return {};
}
inline RenderedContact rendered_contact(const PenaltyParameters& p) {
  return {p.contact_radius_m, p.stiffness_N_per_m};
}
inline RenderedContact rendered_contact(const GodObjectParameters& p) {
  return {p.surface_offset_m};
}
// Surfels lie in the plane of the points, metaballs around them: over a plane of density 1 / s^2 the sum of
// weights is pi R^2 / s^2 times the integral of w over the square of the distance, in units of R, from that
// of the height on. The height at which this is T, by bisection; 0 where even on the plane it is less.
RenderedContact rendered_contact(const ImplicitSurfaceParameters& p);
// A tool has a shape, not a radius: not known.
RenderedContact rendered_contact(const LoadedTool::Settings&);
RenderedContact rendered_contact(const LoadedToolPenalty::Settings&);
RenderedContact rendered_contact(const LoadedSpheres::Settings&);

}  // namespace remote_touch
