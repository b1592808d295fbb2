// A shared library with renderers, see remote_touch_plugin.h.
#pragma once

#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "core/rendering/renderer.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/interfaces/plugins/remote_touch_plugin.h"

namespace remote_touch {

// Adapts a renderer of a shared library to the Renderer interface.

// Makes a call of a library. An exception becomes an InputError of subject(): the interface does not allow
// exceptions, but libraries in C++ can throw them, of any type. Nothing is allocated without an exception.
template <class Subject, class Call>
auto guarded_call(const Subject& subject, Call&& call) {
  try {
    return call();
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(subject(), std::string("threw an exception: ") + error.what());
  } catch (...) {
    throw InputError(subject(), "threw an exception");
  }
}

// All methods except the destructor throw InputError if the library throws; the destructor ignores that.
// prepare(), on_frame() and step() also throw it if the library reports a problem.
class PluginRenderer final : public Renderer {
 public:
  // functions must outlive this object. Throws InputError if the library makes no renderer of these values.
  PluginRenderer(const remote_touch_renderer& functions, const std::vector<double>& values,
                 double haptic_rate_hz, const Kernels& kernels);
  ~PluginRenderer() override;

  void prepare(Frame& frame) const override;
  void reserve(std::size_t points) override;
  void on_frame(const Frame& frame) override;
  Parameters live_parameters() override;
  void parameters_changed() override;
  RenderOutput step(const DeviceState& device, double time_s) override;

 private:
  const remote_touch_renderer& functions_;
  const Kernels& kernels_;
  std::vector<double> values_;
  PointCloud buffer_;  // the points of a frame that is not stored as a cloud
  void* renderer_ = nullptr;
  FrameOrder order_;
  std::shared_ptr<const FramePreparation> prepared_;  // newest frame's result; the library may point into it
};

// Returns a factory with the default values of the settings.
std::unique_ptr<RendererFactory> plugin_factory(const remote_touch_renderer& functions);

// Loads the library and returns the entries of its renderers. It stays loaded until the program ends. Throws
// InputError for a file that is not there or is no such library, for another version of the interface, and
// for a renderer without what the interface requires.
std::vector<RendererEntry> load_plugin(const std::string& file);

}  // namespace remote_touch
