// The errors of renderer and camera on one true object, and their tables and panels.
#pragma once

#include <string>
#include <vector>

#include "analysis/figures/figure.h"
#include "runners/evaluation/figures/truth/compared_settings.h"
#include "runners/evaluation/figures/truth/depth_errors.h"
#include "runners/evaluation/figures/truth/true_contacts.h"

namespace remote_touch {

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
