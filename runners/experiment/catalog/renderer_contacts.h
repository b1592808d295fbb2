// The rest distance of each renderer: how far its position is from the surface that it touches, see
// rendered_contact.h. A new renderer adds one function here; tests/runners/experiment/catalog/
// renderer_contacts_test.cpp presses it on a flat cloud.
#pragma once

#include "core/beyond/tracked_surface/tracked_sheet_renderer.h"
#include "core/dissertation/proxy/proxy_parameters.h"
#include "core/rivals/god_object_renderer.h"
#include "core/rivals/implicit_surface_renderer.h"
#include "core/rivals/mls_surface_renderer.h"
#include "core/rivals/penalty_renderer.h"
#include "core/rivals/proxy_variants.h"
#include "core/rivals/surfel_renderer.h"
#include "runners/experiment/catalog/rendered_contact.h"

namespace remote_touch {

// Spacing of the points of most scenes (Grid). The surface of metaballs depends on the spacing, and their
// rest distance is computed for this one. If the points of a scene are closer or wider apart, the difference
// counts as an error of the method.
inline constexpr double kReferenceSpacing_m = 0.0015;

inline RenderedContact rendered_contact(const ProxyParameters& p) {
  return {p.contact_radius_m(), 0, p.contact_radius_m()};
}
// A sheet that is fitted to the points holds the ball, also between the points, so ball_radius_m is 0.
inline RenderedContact rendered_contact(const TrackedSheetParameters& p) {
  return {p.proxy.contact_radius_m()};
}
inline RenderedContact rendered_contact(const OracleProxyParameters& p) {
  return rendered_contact(p.proxy);
}
inline RenderedContact rendered_contact(const AveragedProxyParameters& p) {
  return rendered_contact(p.proxy);
}
// This renderer reports the position of a ball with the nominal radius, whatever its current radius is. The
// current radius grows with the spacing of the points, so that the ball does not fall through between them:
// ball_radius_m is 0.
inline RenderedContact rendered_contact(const DensityProxyParameters& p) {
  return {p.proxy.contact_radius_m()};
}
inline RenderedContact rendered_contact(const SurfelParameters&) {
  return {};
}
inline RenderedContact rendered_contact(const MlsSurfaceParameters&) {
  return {};
}
inline RenderedContact rendered_contact(const PenaltyParameters& p) {
  return {p.contact_radius_m, p.stiffness_N_per_m};
}
inline RenderedContact rendered_contact(const GodObjectParameters& p) {
  return {p.surface_offset_m};
}
// The rest distance of surfels is 0, because they lie in the plane of the points. Metaballs lie around the
// points: at the height h R over a plane of points of spacing s, the sum of the weights is pi R^2 / s^2 times
// the integral of w(q) over q^2, from h^2 to 1. The rest distance is the height at which this sum is T, found
// by bisection. It is 0 if the sum is less than T even on the plane.
RenderedContact rendered_contact(const ImplicitSurfaceParameters& p);
// Tools have no function here: their rest distance is not known, because a tool has a shape and not a radius.

}  // namespace remote_touch
