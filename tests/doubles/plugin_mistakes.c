/* Libraries that are no plug-ins, or bad ones: which mistake is chosen when this file is compiled. */
#include <math.h>
#include <stddef.h>

#include "runners/interfaces/plugins/remote_touch_plugin.h"

static double stiffness(const double* values) { return values[0]; }
static void* create(const double* values, double rate_hz, char* problem, size_t size) {
  (void)values, (void)rate_hz, (void)problem, (void)size;
  return NULL;
}
static void destroy(void* renderer) { (void)renderer; }
static int32_t on_frame(void* renderer, const remote_touch_frame* frame, char* problem, size_t size) {
  (void)renderer, (void)frame, (void)problem, (void)size;
  return 0;
}
static int32_t step(void* renderer, const remote_touch_device* device, double time_s, remote_touch_output* output,
                    char* problem, size_t size) {
  (void)renderer, (void)device, (void)time_s, (void)output, (void)problem, (void)size;
  return 0;
}

const remote_touch_renderer* remote_touch_plugin(uint32_t version, size_t size, size_t number) {
  static remote_touch_setting setting = {"a_m", "a length", 1, 0, 2, 0};
  static remote_touch_renderer renderer;
  const remote_touch_renderer complete = {.name = "mistaken",
                                          .summary = "a renderer with a mistake, for tests",
                                          .degrees_of_freedom = 3,
                                          .contact_model = REMOTE_TOUCH_POINTS,
                                          .setting_count = 1,
                                          .settings = &setting,
                                          .max_stiffness_N_per_m = stiffness,
                                          .create = create,
                                          .destroy = destroy,
                                          .on_frame = on_frame,
                                          .step = step};
  renderer = complete;
  (void)size;
#if MISTAKE == 0 /* of another version */
  if (version != REMOTE_TOUCH_PLUGIN_VERSION + 1) return NULL;
#elif MISTAKE == 1
  renderer.name = NULL;
#elif MISTAKE == 2
  renderer.degrees_of_freedom = 4;
#elif MISTAKE == 3
  renderer.step = NULL;
#elif MISTAKE == 4
  setting.value = NAN;
#elif MISTAKE == 5
  setting.is_live = 1;
#elif MISTAKE == 6
  renderer.name = "proxy";
#elif MISTAKE == 7
  renderer.settings = NULL;
#elif MISTAKE == 8
  renderer.contact_model = 99;
#endif
  (void)version;
  return number == 0 ? &renderer : NULL;
}
