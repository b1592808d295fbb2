/* A library that has a renderer for every number. */
#include <stddef.h>

#include "runners/interfaces/plugins/remote_touch_plugin.h"

static double stiffness(const double* values) {
  (void)values;
  return 1;
}
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
  static const remote_touch_renderer renderer = {.name = "endless",
                                                 .summary = "a renderer for every number, for tests",
                                                 .degrees_of_freedom = 3,
                                                 .contact_model = REMOTE_TOUCH_POINTS,
                                                 .max_stiffness_N_per_m = stiffness,
                                                 .create = create,
                                                 .destroy = destroy,
                                                 .on_frame = on_frame,
                                                 .step = step};
  (void)version, (void)size, (void)number;
  return &renderer;
}
