/* A renderer in plain C: a spring above the highest point of a frame. It links nothing.
 *
 *   cc -shared -fPIC -O2 -I PREFIX/include/remote_touch spring_plane.c -o spring_plane.so
 *   remote-touch --plugin ./spring_plane.so run fig4.11 --set renderer.name=spring-plane -o spring.h5
 */
#include <math.h>
#include <runners/interfaces/plugins/remote_touch_plugin.h>
#include <stdio.h>
#include <stdlib.h>

enum { REACH_M, STIFFNESS, SETTINGS };

static const remote_touch_setting settings[SETTINGS] = {
    {"reach_m", "height above the highest point at which the spring begins", 0.005, 0, 1, 0},
    {"stiffness_N_per_m", "stiffness of the spring", 500, 0, 10000, 1}};

typedef struct {
  double values[SETTINGS];
  double top_m, rest_m[3];
  int has_frame;
} Spring;

static void take_values(void* renderer, const double* values) {
  Spring* spring = renderer;
  for (int i = 0; i < SETTINGS; ++i) spring->values[i] = values[i];
}

static double max_stiffness(const double* values) { return values[STIFFNESS]; }

static double rest_distance(const double* values) { return values[REACH_M]; }

static void* create(const double* values, double haptic_rate_hz, char* problem, size_t size) {
  (void)haptic_rate_hz;
  Spring* spring = calloc(1, sizeof *spring);
  if (spring == NULL)
    snprintf(problem, size, "out of memory");
  else
    take_values(spring, values);
  return spring;
}

static int32_t on_frame(void* renderer, const remote_touch_frame* frame, char* problem, size_t size) {
  (void)problem, (void)size;
  Spring* spring = renderer;
  spring->has_frame = 1;
  spring->top_m = -INFINITY;
  for (size_t i = 0; i < frame->points; ++i)
    if (frame->y[i] > spring->top_m) spring->top_m = frame->y[i]; /* never true for a missing point */
  return 0;
}

static int32_t step(void* renderer, const remote_touch_device* device, double time_s, remote_touch_output* output,
                    char* problem, size_t size) {
  (void)time_s, (void)problem, (void)size;
  Spring* spring = renderer;
  const double* hip = device->position_m;
  output->converged = 1;
  if (!isfinite(hip[0]) || !isfinite(hip[1]) || !isfinite(hip[2])) {
    for (int i = 0; i < 3; ++i) output->proxy_m[i] = spring->rest_m[i];
    output->status = REMOTE_TOUCH_DEVICE_NOT_FINITE;
    return 0;
  }
  for (int i = 0; i < 3; ++i) spring->rest_m[i] = hip[i];
  if (!spring->has_frame) {
    output->status = REMOTE_TOUCH_NO_FRAME;
    return 0;
  }
  output->nearest_distance_m = fabs(hip[1] - spring->top_m); /* of the proxy, which is the HIP in free space */
  const double depth_m = spring->top_m + spring->values[REACH_M] - hip[1];
  if (!(depth_m > 0)) return 0;
  output->force_N[1] = spring->values[STIFFNESS] * depth_m;
  output->proxy_m[1] += depth_m;
  output->nearest_distance_m = spring->values[REACH_M];
  output->normal[1] = 1;
  output->state = REMOTE_TOUCH_CONTACT;
  return 0;
}

static const remote_touch_renderer renderer = {.name = "spring-plane",
                                               .summary = "a spring above the highest point of a frame, in C",
                                               .degrees_of_freedom = 3,
                                               .contact_model = REMOTE_TOUCH_NOTHING,
                                               .setting_count = SETTINGS,
                                               .settings = settings,
                                               .max_stiffness_N_per_m = max_stiffness,
                                               .rest_distance_m = rest_distance,
                                               .create = create,
                                               .destroy = free,
                                               .on_frame = on_frame,
                                               .step = step,
                                               .set_values = take_values};

const remote_touch_renderer* remote_touch_plugin(uint32_t version, size_t size, size_t number) {
  const int fits = version == REMOTE_TOUCH_PLUGIN_VERSION && size == sizeof renderer;
  return fits && number == 0 ? &renderer : NULL;
}
