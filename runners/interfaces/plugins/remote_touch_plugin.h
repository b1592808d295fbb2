/* A renderer in a shared library, in any language that can make C functions:
 *
 *   remote-touch --plugin ./mine.so run fig4.12 --set renderer.name=mine -o mine.h5
 *
 * The library has one function, remote_touch_plugin(), which describes its renderers. This header is all that
 * it needs; it links nothing of remote-touch. Units are metres, newtons and seconds. Vectors are in the world
 * frame. Quaternions are w, x, y, z.
 *
 * Every renderer must obey these rules, which runners/evaluation/contract tests: no force in free space; the
 * same calls give the same bits; step() takes no lock and allocates nothing. Several renderers may exist at
 * once, so keep no global state. One thread at a time uses a renderer, except for prepare(). No function may
 * throw through this interface.
 */
#ifndef REMOTE_TOUCH_PLUGIN_H
#define REMOTE_TOUCH_PLUGIN_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The version of this interface. It changes when a structure or a meaning does. Libraries of another version
 * are refused. */
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
  int32_t index;   /* increases; there are gaps where frames were lost */
  int32_t columns; /* of an organised frame, which is stored row by row; 0: unorganised */
  double captured_s, arrives_s;
  size_t points;
  const double *x, *y, *z;
  const double *nx, *ny, *nz;      /* unit normals towards the sensor; null: none */
  const double* fixture_radius_m;  /* radii of forbidden regions; null: none */
  const double* stiffness_N_per_m; /* stiffness of the regions; NaN: the renderer's own; null: none */
  const uint32_t* colour;          /* 0xRRGGBB; 0xFF000000: not known; null: none */
  void* prepared;                  /* in on_frame: the result of prepare; null: it was not called */
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

/* The output of one tick. step() receives it with these values: proxy_m is the HIP, slave_m is NaN,
 * nearest_distance_m is infinite, tool_orientation is that of the device, and all others are 0. */
typedef struct {
  double proxy_m[3];
  double force_N[3];            /* on the hand */
  double slave_m[3];            /* commanded position of a slave robot; NaN: none yet */
  double normal[3];             /* of the surface, pointing out of it; zero: not known */
  double frame_correction_m[3]; /* how far new frames moved the proxy since the last tick */
  double surface_velocity_m_per_s;
  double nearest_distance_m; /* from the proxy to the nearest point; infinite: nothing near */
  int32_t state, status;
  int32_t steps, converged, contact_count;
  /* Only for a renderer with six degrees of freedom; proxy_m is then the tool's centre of mass. */
  double tool_orientation[4];
  double torque_Nm[3]; /* on the hand, about the HIP */
  int32_t active_constraints, contact_clusters, detections, budget_exhausted;
  double tool_penetration_m;
} remote_touch_output;

/* The contact model, named by what holds the proxy. This value does not change runs: it says what `verify`
 * and the contract tests may ask of the renderer. The check `touch` of `verify` asks for a force in half of
 * the ticks; where it is relaxed, in 2 %. */
enum {
  /* All points of a cloud, and the forbidden regions around them. All checks apply. */
  REMOTE_TOUCH_POINTS = 0,
  /* Only the regions of points with a radius above 0. The contract tests give all points a region. `verify`
   * gives a tool only scenes with regions, and does not mirror them. */
  REMOTE_TOUCH_REGIONS = 1,
  /* Triangles between neighbours in an organised frame. `verify` does not reorder the points. Touch is
   * relaxed, because a moving mesh leaves the HIP behind it. */
  REMOTE_TOUCH_MESH = 2,
  /* A surface fitted in cells along the world's axes. `verify` does not move or mirror the scene, or double
   * its frame rate, because the outputs are then only similar. It gives a tool no scene in which walls
   * meet. */
  REMOTE_TOUCH_SHEET = 3,
  /* Nothing: points only push, and a HIP that is pressed deeper passes them. Three contract tests hold the
   * HIP 2 to 3 mm above the points. Touch is relaxed. */
  REMOTE_TOUCH_NOTHING = 4,
  /* All points, and the direction to the sensor: from the image layout of a frame, which `verify` keeps, or
   * else from a setting in the world's axes. `verify` does not move or mirror the scene, or double its frame
   * rate. Touch is relaxed, because the proxy ignores forbidden regions and meets only the points in their
   * middle. */
  REMOTE_TOUCH_ORIENTED = 5,
  /* All points, but points that a new frame puts into the tool stay in it. `verify` gives a tool only clouds
   * at rest, because rounding decides when a moving surface passes through the tool. */
  REMOTE_TOUCH_RESTING_POINTS = 6
};

/* One renderer. `values`: the values of its settings, in the order of `settings`. */
typedef struct {
  const char* name;           /* lower case letters, digits, - and _ */
  const char* summary;        /* one line */
  int32_t degrees_of_freedom; /* 3 or 6 */
  int32_t contact_model;      /* REMOTE_TOUCH_POINTS ... */
  size_t setting_count;
  const remote_touch_setting* settings;
  /* Returns an upper bound of the growth of |force| with the displacement of the HIP. The safety of the live
   * loop depends on it. */
  double (*max_stiffness_N_per_m)(const double* values);
  /* Returns the distance of proxy_m from the surface that it touches. May be null or return NaN if it is not
   * known; there are no contact measures then. */
  double (*rest_distance_m)(const double* values);
  /* Makes a renderer. Returns null if the values make no sense together, or if there is no memory. It then
   * writes the reason into `problem` (of `size` bytes), in one line. A reason about values is written like
   * "reach_m = 2: expected below 1". haptic_rate_hz: calls of step per second. create is also called to check
   * values, with haptic_rate_hz = 1000 for every experiment; that renderer is destroyed at once. */
  void* (*create)(const double* values, double haptic_rate_hz, char* problem, size_t size);
  void (*destroy)(void* renderer);
  /* Announces that frames will have up to this number of points; may be null. */
  void (*reserve)(void* renderer, size_t points);
  /* Does the slow part of the work on a frame, so that on_frame is short. prepare and release may both be
   * null. prepare may run in another thread while step() runs, so it must read nothing that step() or
   * set_values() write. on_frame receives its result as `prepared`. The result exists at least until on_frame
   * has received a later frame; release then frees it. If prepare fails, it returns null and writes the
   * reason into `problem`. */
  void* (*prepare)(const void* renderer, const remote_touch_frame* frame, char* problem, size_t size);
  void (*release)(void* prepared);
  /* Receives a new frame, captured later than all before. The program drops other frames and reports this in
   * the status. Returns 0; any other value ends the run with `problem`. */
  int32_t (*on_frame)(void* renderer, const remote_touch_frame* frame, char* problem, size_t size);
  /* Makes one tick of the haptic loop. Returns the same as on_frame. */
  int32_t (*step)(void* renderer, const remote_touch_device* device, double time_s,
                  remote_touch_output* output, char* problem, size_t size);
  /* Receives the values after live settings have changed, between two steps; null if none is live. */
  void (*set_values)(void* renderer, const double* values);
} remote_touch_renderer;

/* The function of the library. Returns the renderer of this number, from 0, and null after the last one. It
 * must also return null for a `version` that it does not know; that is the program's version of this
 * interface. `size` is sizeof(remote_touch_renderer) in the program. */
typedef const remote_touch_renderer* (*remote_touch_plugin_function)(uint32_t version, size_t size,
                                                                     size_t number);
#define REMOTE_TOUCH_PLUGIN_FUNCTION "remote_touch_plugin"

#ifdef __cplusplus
}
#endif

#endif
