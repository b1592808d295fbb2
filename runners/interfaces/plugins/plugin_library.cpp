#include "runners/interfaces/plugins/plugin_library.h"

#include <dlfcn.h>

#include <cstdio>
#include <filesystem>

#include "core/parameters/input_error.h"
#include "runners/interfaces/plugins/plugin_renderer.h"

namespace remote_touch {

namespace {

constexpr std::size_t kMaxRenderers = 1000, kMaxSettings = 1000;

// Removes the file's name from the start of the loader's text, because the error already has it.
std::string loader_problem(const std::string& file) {
  const char* said = ::dlerror();
  std::string text = said ? said : "cannot be loaded";
  if (text.starts_with(file + ": ")) text.erase(0, file.size() + 2);
  return text;
}

remote_touch_plugin_function function_of(const std::string& file) {
  std::error_code unreachable;
  if (!std::filesystem::is_regular_file(file, unreachable))
    throw InputError("--plugin " + file, "no such file: expected a shared library");
  const std::string path = std::filesystem::absolute(file).string();
  void* library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr)
    throw InputError("--plugin " + file, loader_problem(path) + ": expected a shared library");
  void* address = ::dlsym(library, REMOTE_TOUCH_PLUGIN_FUNCTION);
  if (address == nullptr)
    throw InputError("--plugin " + file, "has no function " REMOTE_TOUCH_PLUGIN_FUNCTION
                                         "(): expected a library as remote_touch_plugin.h describes it");
  return reinterpret_cast<remote_touch_plugin_function>(address);
}

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

void check(const remote_touch_renderer& r, const std::string& file) {
  const auto refuse = [&](const std::string& what) {
    throw InputError("--plugin " + file, (r.name ? std::string(r.name) + ": " : std::string()) + what);
  };
  if (!r.name || !r.summary) refuse("a renderer without name or summary");
  if (r.degrees_of_freedom != 3 && r.degrees_of_freedom != 6) refuse("degrees_of_freedom: expected 3 or 6");
  if (r.contact_model < REMOTE_TOUCH_POINTS || r.contact_model > REMOTE_TOUCH_RESTING_POINTS)
    refuse("contact_model: expected REMOTE_TOUCH_POINTS to REMOTE_TOUCH_RESTING_POINTS");
  const auto require = [&](const char* name, bool is_there) {
    if (!is_there) refuse(std::string("lacks the function ") + name);
  };
  require("max_stiffness_N_per_m", r.max_stiffness_N_per_m != nullptr),
      require("create", r.create != nullptr);
  require("destroy", r.destroy != nullptr), require("on_frame", r.on_frame != nullptr),
      require("step", r.step != nullptr);
  if (!r.prepare != !r.release)
    refuse("has only one of the functions prepare and release: expected both or neither");
  if (r.setting_count > kMaxSettings || (r.setting_count > 0 && !r.settings))
    refuse("settings: expected at most " + std::to_string(kMaxSettings));
  bool any_live = false;
  for (std::size_t i = 0; i < r.setting_count; ++i) {
    const remote_touch_setting& s = r.settings[i];
    if (!s.name || !s.help) refuse("a setting without name or help");
    if (!(s.low <= s.value && s.value <= s.high))
      refuse(std::string(s.name) + " = " + number_text(s.value) + ": expected " + number_text(s.low) +
             " to " + number_text(s.high));
    any_live |= s.is_live != 0;
  }
  if (any_live && !r.set_values) refuse("has live settings and no set_values");
}

}  // namespace

std::vector<RendererEntry> load_plugin(const std::string& file) {
  const remote_touch_plugin_function function = function_of(file);
  const auto renderer_with = [&](std::size_t number) {
    return guarded_call(
        [&] { return "--plugin " + file; },
        [&] { return function(REMOTE_TOUCH_PLUGIN_VERSION, sizeof(remote_touch_renderer), number); });
  };
  std::vector<RendererEntry> entries;
  for (std::size_t number = 0; number < kMaxRenderers; ++number) {
    const remote_touch_renderer* functions = renderer_with(number);
    if (functions == nullptr) break;
    check(*functions, file);
    RendererEntry entry;
    entry.name = functions->name, entry.summary = functions->summary;
    entry.make = [functions] { return plugin_factory(*functions); };
    entry.degrees_of_freedom =
        functions->degrees_of_freedom == 6 ? DegreesOfFreedom::six : DegreesOfFreedom::three;
    entry.contact_model = kContactModels[functions->contact_model];
    entries.push_back(std::move(entry));
  }
  if (entries.size() == kMaxRenderers && renderer_with(kMaxRenderers) != nullptr)
    throw InputError("--plugin " + file,
                     "has too many renderers: expected at most " + std::to_string(kMaxRenderers));
  if (entries.empty())
    throw InputError("--plugin " + file, "has no renderer for version " +
                                             std::to_string(REMOTE_TOUCH_PLUGIN_VERSION) +
                                             " of the interface: expected a library of that version");
  return entries;
}

}  // namespace remote_touch
