/* A renderer in a shared library, in any language that can make C functions:
 *
 *   remote-touch --plugin ./mine.so run fig4.12 --set renderer.name=mine -o mine.h5
 *
 * The library has one function, remote_touch_plugin(), which describes its renderers. This header is all that
 * it needs; it links nothing of remote-touch. Metres, newtons, seconds, world frame; quaternions are w, x, y,
 * z.
 *
 * What every renderer keeps, and runners/evaluation/contract tests: no force in free space; the same calls
 * give the same bits; step() takes no lock and allocates nothing. Several renderers may exist at once, each
 * used by one thread at a time: keep no global state. No function may throw through this interface.
 */
#ifndef REMOTE_TOUCH_PLUGIN_H
#define REMOTE_TOUCH_PLUGIN_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Of this interface. It changes when a structure or a meaning does; libraries of another version are refused.
 */
#define REMOTE_TOUCH_PLUGIN_VERSION 1

/* A number that experiments, sweeps and --set can change, with its range, ends included. */
typedef struct {
  const char* name; /* with its unit: stiffness_N_per_m */
  const char* help; /* one line */
  double value, low, high;
  int32_t is_live; /* 1: may change during a run, see set_values */
} remote_touch_setting;

/* One frame. The arrays have `points` entries each and are valid during the call only. A point that was not
 * measured is NaN in x, y and z. */
typedef struct {
  int32_t index;   /* grows; frames can be lost */
  int32_t columns; /* of an organised frame, stored row by row; 0: unorganised */
  double captured_s, arrives_s;
  size_t points;
  const double *x, *y, *z;
  const double *nx, *ny, *nz;      /* unit normals towards the sensor; null: none */
  const double* fixture_radius_m;  /* of forbidden regions; null: none */
  const double* stiffness_N_per_m; /* of regions, NaN: the renderer's own; null: none */
  const uint32_t* colour;          /* 0xRRGGBB, 0xFF000000: not known; null: none */
  void* prepared;                  /* in on_frame: what prepare returned; null: it was not called */
} remote_touch_frame;

/* The device: the haptic interface point (HIP), the orientation of its handle, its buttons, one bit each. */
typedef struct {
  double position_m[3];
  double orientation[4];
  uint32_t buttons;
} remote_touch_device;

enum { REMOTE_TOUCH_FREE = 0, REMOTE_TOUCH_CONTACT = 1, REMOTE_TOUCH_ENTRENCHED = 2 };
enum {
  REMOTE_TOUCH_OK = 0,
  REMOTE_TOUCH_STALE_FRAME_DROPPED = 1,
  REMOTE_TOUCH_DEGENERATE_NORMAL = 2,
  REMOTE_TOUCH_NO_FRAME = 3,
  REMOTE_TOUCH_DEVICE_NOT_FINITE = 4
};

/* What a tick gives. It comes with the proxy at the HIP and without force, state and status 0, slave_m NaN.
 */
typedef struct {
  double proxy_m[3];
  double force_N[3];            /* on the hand */
  double slave_m[3];            /* commanded position of a slave robot; NaN: none yet */
  double normal[3];             /* of the surface, out of it; zero: not known */
  double frame_correction_m[3]; /* how far new frames moved the proxy since the last tick */
  double surface_velocity_m_per_s;
  double nearest_distance_m; /* of the proxy to the nearest point; infinite: nothing near */
  int32_t state, status;
  int32_t steps, converged, contact_count;
  /* Of a renderer with six degrees of freedom; proxy_m is then the tool's centre of mass. */
  double tool_orientation[4];
  double torque_Nm[3]; /* on the hand, about the HIP */
  int32_t active_constraints, contact_clusters, detections, budget_exhausted;
  double tool_penetration_m;
} remote_touch_output;

/* What constrains the proxy: tests and comparisons depend on it. */
enum {
  REMOTE_TOUCH_POINTS = 0,  /* all points of a cloud */
  REMOTE_TOUCH_REGIONS = 1, /* only forbidden regions around points */
  REMOTE_TOUCH_MESH = 2,    /* triangles between neighbours in an organised frame */
  REMOTE_TOUCH_SHEET = 3,   /* a surface fitted along the world's axes */
  REMOTE_TOUCH_NOTHING = 4, /* points only push: a HIP pressed deeper passes them */
  REMOTE_TOUCH_ORIENTED = 5 /* points, and the direction to the sensor */
};

/* One renderer. `values` are those of its settings, in their order. */
typedef struct {
  const char* name;           /* lower case letters, digits, - and _ */
  const char* summary;        /* one line */
  int32_t degrees_of_freedom; /* 3 or 6 */
  int32_t contact_model;      /* REMOTE_TOUCH_POINTS ... */
  size_t setting_count;
  const remote_touch_setting* settings;
  /* Upper bound of how fast |force| grows with the displacement of the HIP: the live loop's safety depends on
   * it. */
  double (*max_stiffness_N_per_m)(const double* values);
  /* Distance of proxy_m from the surface that it touches; null or NaN: not known, then no contact measures.
   */
  double (*rest_distance_m)(const double* values);
  /* Null if values make no sense together, or there is no memory; then `problem` (of `size` bytes) says why
   * in one line, for values as "reach_m = 2: expected below 1". haptic_rate_hz: how often step is called. It
   * is also called to check values, and what it made destroyed at once. */
  void* (*create)(const double* values, double haptic_rate_hz, char* problem, size_t size);
  void (*destroy)(void* renderer);
  /* Frames will have up to so many points; may be null. */
  void (*reserve)(void* renderer, size_t points);
  /* The slow part of taking a frame, so that on_frame is short; may be null, with release. It may run in
   * another thread while step() runs, so it reads nothing that step() or set_values() write. Returns what
   * on_frame gets as `prepared`, which stays until a later frame was taken; release then frees it. Null: a
   * failure, with `problem`. */
  void* (*prepare)(const void* renderer, const remote_touch_frame* frame, char* problem, size_t size);
  void (*release)(void* prepared);
  /* A new frame, later than all before: the program drops frames that come too late, and reports them in the
   * status. Returns 0; anything else ends the run with `problem`. */
  int32_t (*on_frame)(void* renderer, const remote_touch_frame* frame, char* problem, size_t size);
  /* One tick of the haptic loop. Returns as on_frame does. */
  int32_t (*step)(void* renderer, const remote_touch_device* device, double time_s,
                  remote_touch_output* output, char* problem, size_t size);
  /* Live settings have changed, between two steps; null if none is live. */
  void (*set_values)(void* renderer, const double* values);
} remote_touch_renderer;

/* The function of the library: the renderer of that number, from 0; null after the last. `version` is that of
 * the program; return null for one that you do not know. `size` is sizeof(remote_touch_renderer) there. */
typedef const remote_touch_renderer* (*remote_touch_plugin_function)(uint32_t version, size_t size,
                                                                     size_t number);
#define REMOTE_TOUCH_PLUGIN_FUNCTION "remote_touch_plugin"

#ifdef __cplusplus
}
#endif

#endif
