#include "runners/experiment/catalog/renderer_contacts.h"

#include <numbers>

namespace remote_touch {

namespace {

// Returns the integral of the weight over q^2, from q = h to q = 1. q: distance in units of R. h: height in
// the same units.
double weight_above(SurfaceWeight weight, double h) {
  if (weight == SurfaceWeight::wyvill) {
    const double a = 1 - h * h;
    return a * a * a * (5.0 / 27 + a / 9);
  }
  const double b = 1 - h, to_fifth = b * b * b * b * b;
  return 2 * to_fifth * (1 - 1.5 * b + b * b * (4.0 / 7));
}

}  // namespace

RenderedContact rendered_contact(const ImplicitSurfaceParameters& p) {
  if (p.surface == SurfaceKind::surfels) return {};
  const double points = std::numbers::pi * (p.support_radius_m / kReferenceSpacing_m) *
                        (p.support_radius_m / kReferenceSpacing_m);
  double low = 0, high = 1;
  for (double middle = 0.5; middle > low && middle < high; middle = 0.5 * (low + high))
    (points * weight_above(p.weight, middle) > p.threshold ? low : high) = middle;
  return {p.support_radius_m * low};
}

}  // namespace remote_touch
