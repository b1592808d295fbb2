// The contact model of a renderer says what its checks may ask of it.
#pragma once

#include <string>

namespace remote_touch {

// A contact model says which checks of the contract tests and of `verify` apply to a renderer. It does not
// change runs. All values are false for a proxy that is held by all points of a cloud and by the forbidden
// regions around them: every check applies to it. Each true value changes or omits checks.
struct ContactModel {
  // The contract tests give every point a region; `verify` gives a tool only scenes with regions, and mirrors
  // none.
  bool renders_only_regions = false;
  // Points only push: three contract tests hold the HIP 2 to 3 mm above the points.
  bool pressed_hip_passes_through = false;
  bool may_lose_contact = false;        // `touch` asks for a force in 2 % of the ticks, not in half of them
  bool depends_on_point_order = false;  // `verify` does not reorder the points
  bool uses_camera = false;  // `verify` keeps the image layout, which gives the direction to the sensor
  // `verify` does not mirror the scene. It moves only images of a renderer that uses the camera, and doubles
  // the frame rate only if the renderer uses the camera.
  bool depends_on_axes = false;
  bool smooths_creases = false;  // `verify` gives a tool no scene in which walls meet
  // `verify` gives a tool no moving cloud, because rounding decides when the surface passes through the tool.
  bool motion_amplifies_rounding = false;

  // The named models. The name says what holds the proxy; runners/interfaces/plugins/remote_touch_plugin.h
  // gives reasons.
  // NOLINTNEXTLINE(readability-identifier-naming): these are the names of plug-ins and Python.
  static const ContactModel points, regions, mesh, sheet, nothing, oriented, resting_points;
};
inline constexpr ContactModel ContactModel::points{};
inline constexpr ContactModel ContactModel::regions{.renders_only_regions = true};
inline constexpr ContactModel ContactModel::mesh{.may_lose_contact = true, .depends_on_point_order = true};
inline constexpr ContactModel ContactModel::sheet{.depends_on_axes = true, .smooths_creases = true};
inline constexpr ContactModel ContactModel::nothing{.pressed_hip_passes_through = true,
                                                    .may_lose_contact = true};
inline constexpr ContactModel ContactModel::oriented{
    .may_lose_contact = true, .uses_camera = true, .depends_on_axes = true};
inline constexpr ContactModel ContactModel::resting_points{.motion_amplifies_rounding = true};

// The named models, indexed by their number in plug-ins. Python lists the names in the same order.
inline constexpr ContactModel kContactModels[] = {
    ContactModel::points,  ContactModel::regions,  ContactModel::mesh,          ContactModel::sheet,
    ContactModel::nothing, ContactModel::oriented, ContactModel::resting_points};

// Returns the model that is declared for the renderer of that name; `points` if none is.
ContactModel contact_model_of(const std::string& renderer);

// Declares the model of a renderer of a plug-in, of Python or of a program, in place of an earlier one. Has
// no effect on a built-in renderer.
void declare_contact_model(const std::string& renderer, const ContactModel& model);

}  // namespace remote_touch
