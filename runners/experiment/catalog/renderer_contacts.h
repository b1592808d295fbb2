// The rest distance of each renderer: how far its position is from the surface that it touches, see
// rendered_contact.h. A new renderer adds one function here; tests/runners/experiment/catalog/
// renderer_contacts_test.cpp presses it on a flat cloud.
#pragma once

#include "core/beyond/tracked_surface/tracked_sheet_renderer.h"
#include "core/dissertation/proxy/proxy_parameters.h"
#include "core/rivals/averaged_proxy_renderer.h"
#include "core/rivals/density_proxy_renderer.h"
#include "core/rivals/god_object_renderer.h"
#include "core/rivals/implicit_surface_renderer.h"
#include "core/rivals/oracle_proxy_renderer.h"
#include "core/rivals/penalty_renderer.h"
#include "core/rivals/surfel_renderer.h"
#include "runners/experiment/catalog/rendered_contact.h"
#include "runners/experiment/tool_files/loaded_spheres.h"
#include "runners/experiment/tool_files/loaded_tool.h"

namespace remote_touch {

// Spacing of the points of most scenes (Grid). The surface of metaballs depends on the spacing: their rest
// distance is computed for this one. Where points are closer or wider apart, the difference counts as an
// error of the method.
inline constexpr double kReferenceSpacing_m = 0.0015;

inline RenderedContact rendered_contact(const ProxyParameters& p) {
  return {p.contact_radius_m(), 0, p.contact_radius_m()};
}
// A sheet that is fitted to the points holds the ball, also between them.
inline RenderedContact rendered_contact(const TrackedSheetParameters& p) {
  return {p.proxy.contact_radius_m()};
}
inline RenderedContact rendered_contact(const OracleProxyParameters& p) {
  return rendered_contact(p.proxy);
}
inline RenderedContact rendered_contact(const AveragedProxyParameters& p) {
  return rendered_contact(p.proxy);
}
// Whatever its radius is, it reports where a ball of the nominal one would be. Its radius grows with the
// spacing of the points, so that it does not fall through between them.
inline RenderedContact rendered_contact(const DensityProxyParameters& p) {
  return {p.proxy.contact_radius_m()};
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
// Surfels lie in the plane of the points, metaballs around the points. At the height h R over a plane of
// points of spacing s the sum of the weights is pi R^2 / s^2 times the integral of w(q) over q^2, from h^2
// to 1. The rest distance is the height at which this sum is T, by bisection; 0 where the sum is less than T
// even on the plane.
RenderedContact rendered_contact(const ImplicitSurfaceParameters& p);
// A tool has a shape, not a radius: not known.
RenderedContact rendered_contact(const LoadedTool::Settings&);
RenderedContact rendered_contact(const LoadedTrackedTool::Settings&);
RenderedContact rendered_contact(const LoadedToolPenalty::Settings&);
RenderedContact rendered_contact(const LoadedToolGodObject::Settings&);
RenderedContact rendered_contact(const LoadedSpheres::Settings&);

}  // namespace remote_touch
