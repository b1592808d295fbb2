// The depth pipeline of core/dissertation/depth in OpenCL C 1.2. The kernels do the operations of
// core/kernels/depth_kernels.cpp, and of the hues of core/dissertation/virtual_fixtures, for each pixel in the
// same order, so that the bits are the same. A change of one must be made in the other too;
// tests/runners/libraries compares them.
//
// A work item is a pixel. Images have rows of `stride` pixels. Pixels beyond the camera's width are holes.
// Integer inputs, and the columns of the cloud, have rows of the camera's `width`. The columns lie one after
// another: x y z nx ny nz r_f k_s. The planes of depths have a border of holes around them as well. Only the
// depths are stored as planes: the point is z (ray_x, ray_y, 1). The build options are FILTER_HALF and
// NORMAL_HALF, half the windows' widths, and DIVIDE_IN_DOUBLE if single division and root are not rounded
// correctly.
//
// The code uses no vectors and nothing that C++ lacks, because the test double of an OpenCL library compiles
// it as C++.
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#pragma OPENCL FP_CONTRACT OFF

#define BORDER 7  // half of the largest window
#define NOWHERE 1e12f
#define THINNEST 1e-4f
#define MAX_DEPTH_M 1000.0

// Double has more than twice the digits of single, plus two. So a quotient or a root that is rounded first to
// double and then to single equals the one that is rounded once.
#ifdef DIVIDE_IN_DOUBLE
float divided(float a, float b) { return (float)((double)a / (double)b); }
float root(float a) { return (float)sqrt((double)a); }
#else
float divided(float a, float b) { return a / b; }
float root(float a) { return sqrt(a); }
#endif

// If an argument is NaN, smaller() and larger() return b, as the processor's instructions do.
float smaller(float a, float b) { return a < b ? a : b; }
float larger(float a, float b) { return a > b ? a : b; }
int measured(double z_m) { return (z_m > 0) & (z_m < MAX_DEPTH_M); }

size_t in_plane(size_t u, size_t v, size_t plane_stride) {
  return (v + BORDER) * plane_stride + BORDER + u;
}

// Returns the value if it is there, otherwise NaN. It is always the same NaN, because devices differ in the
// NaN that an operation gives.
double or_none(int is_there, double value) { return is_there ? value : as_double(0x7ff8000000000000UL); }

// Converts a sensor's numbers to depths along the optical axis, through the points in the base frame, as
// cloud_from_depth() and DepthProcessor::frame_of() compute them. The sums are in the order of Eigen. camera:
// cx, cy, fx, fy; X: a row-major 3 x 4 matrix, then the third row of its inverse.
__kernel void units_to_depths(__global const unsigned short* restrict units, double metres_per_unit,
                              int width, __global const double* restrict camera, __constant double* X,
                              __global double* restrict depth_m) {
  const size_t u = get_global_id(0), v = get_global_id(1), stride = get_global_size(0);
  if (u >= (size_t)width) return;
  const unsigned short count = units[v * width + u];
  const double z = count * metres_per_unit;
  const double x = ((double)u - camera[0]) * z / camera[2], y = ((double)v - camera[1]) * z / camera[3];
  const double x_W = (X[0] * x + X[1] * y) + (X[2] * z + X[3]);
  const double y_W = (X[4] * x + X[5] * y) + (X[6] * z + X[7]);
  const double z_W = (X[8] * x + X[9] * y) + (X[10] * z + X[11]);
  depth_m[v * stride + u] = or_none(count > 0, (X[12] * x_W + (X[13] * y_W + X[14] * z_W)) + X[15]);
}

__kernel void depths_to_plane(__global const double* restrict depth_m, double scale,
                              __global float* restrict z) {
  const size_t u = get_global_id(0), v = get_global_id(1), stride = get_global_size(0);
  const double depth = depth_m[v * stride + u];
  z[in_plane(u, v, stride + 2 * BORDER)] = measured(depth) ? (float)(depth * scale) : NOWHERE;
}

// (7.2)
float gaussian(float s) {
  const float end = 0.9083625722727604f, centre = 0.4332450600460519f, lift = 0.9131807121233679f;
  const float y = smaller(s, end), from_centre = y - centre;
  const float p = (end - y) * (from_centre * from_centre + lift);
  const float p2 = p * p, p4 = p2 * p2, p8 = p4 * p4;
  return p8 * p8;
}

// (7.1): computes the change of each depth by the filter, in units of raw_z, and the plane of the filtered
// depths.
__kernel void filter_depths(__global const double* restrict depth_m, __global const float* restrict ray_x,
                            __global const float* restrict ray_y, __global const float* restrict raw_z,
                            double change_unit_m, double smooth_scale, __global float* restrict change,
                            __global float* restrict smooth_z) {
  const size_t u = get_global_id(0), v = get_global_id(1), stride = get_global_size(0);
  const size_t plane_stride = stride + 2 * BORDER, here = in_plane(u, v, plane_stride);
  __global const float* const rays_x = ray_x + BORDER + u;
  __global const float* const rays_y = ray_y + BORDER + v;
  const float z0 = raw_z[here], x0 = z0 * rays_x[0], y0 = z0 * rays_y[0];
  float sum = 0, total = 1;
#define PAIR(J, I)                                                              \
  {                                                                             \
    const float z = raw_z[here + (J) * (ptrdiff_t)plane_stride + (I)];          \
    const float dx = z * rays_x[I] - x0, dy = z * rays_y[J] - y0, dz = z - z0;  \
    const float phi = gaussian(dx * dx + dy * dy + dz * dz);                    \
    sum += phi * dz;                                                            \
    total += phi;                                                               \
  }
  // The order of the sums is that of filter_row(): rows below, the row itself, rows above.
#pragma unroll
  for (int j = 1; j <= FILTER_HALF; ++j) {
    PAIR(j, 0)
#pragma unroll
    for (int i = 1; i <= FILTER_HALF; ++i) {
      PAIR(j, -i)
      PAIR(j, i)
    }
  }
#pragma unroll
  for (int i = 1; i <= FILTER_HALF; ++i) {
    PAIR(0, -i)
    PAIR(0, i)
  }
#pragma unroll
  for (int j = 1; j <= FILTER_HALF; ++j) {
    PAIR(-j, 0)
#pragma unroll
    for (int i = 1; i <= FILTER_HALF; ++i) {
      PAIR(-j, -i)
      PAIR(-j, i)
    }
  }
#undef PAIR
  const float more = divided(sum, total);
  const double depth = depth_m[v * stride + u];
  change[v * stride + u] = more;
  smooth_z[here] = measured(depth) ? (float)((depth + change_unit_m * more) * smooth_scale) : NOWHERE;
}

// The moments in sheared coordinates, as in depth_kernels.cpp.
typedef struct {
  float one, i, j, ii, ij, jj;
} Sums;
typedef struct {
  float one, i, ii;
} RowSums;
typedef struct {
  float xx, xy, xz, yy, yz, zz;
} Symmetric;

// Wendland's psi / 4, (4.2).
float wendland(float squared) {
  const float u = larger(1.0f - root(squared), 0.0f);
  const float u2 = u * u;
  return (u2 * u2) * (1.25f - u);
}

void add_pair(RowSums* sums, float across, float left, float right) {
  const float both = left + right;
  sums->one += both;
  sums->i += across * (right - left);
  sums->ii += (across * across) * both;
}

void add_row(Sums* sums, const RowSums row, float j) {
  sums->one += row.one;
  sums->i += row.i;
  sums->ii += row.ii;
  sums->j += j * row.one;
  sums->ij += j * row.i;
  sums->jj += (j * j) * row.one;
}

float product(float of_w, float of_k, float of_l, float z) { return (of_w * z + 2.0f * of_k) * z + of_l; }

Symmetric covariance(const Sums w, const Sums k, const Sums l, float z, float ray_x, float ray_y, float step_x,
                     float step_y) {
  const float each = divided(1.0f, w.one);
  const float x = (w.i * z + k.i) * step_x * each, y = (w.j * z + k.j) * step_y * each, d = k.one * each;
  const float xx = product(w.ii, k.ii, l.ii, z) * (step_x * step_x) * each - x * x;
  const float xy = product(w.ij, k.ij, l.ij, z) * (step_x * step_y) * each - x * y;
  const float yy = product(w.jj, k.jj, l.jj, z) * (step_y * step_y) * each - y * y;
  const float xd = (k.i * z + l.i) * step_x * each - x * d, yd = (k.j * z + l.j) * step_y * each - y * d;
  const float dd = l.one * each - d * d;
  const float xz = xd + ray_x * dd, yz = yd + ray_y * dd;
  const Symmetric m = {xx + ray_x * (xd + xz), xy + ray_x * yd + ray_y * xz, xz, yy + ray_y * (yd + yz), yz, dd};
  return m;
}

Symmetric adjugate(const Symmetric m) {
  const Symmetric a = {m.yy * m.zz - m.yz * m.yz, m.xz * m.yz - m.xy * m.zz, m.xy * m.yz - m.xz * m.yy,
                       m.xx * m.zz - m.xz * m.xz, m.xy * m.xz - m.yz * m.xx, m.xx * m.yy - m.xy * m.xy};
  return a;
}

typedef struct {
  float x, y, z;
  int is_plane;
} Normal;

// The eigenvector of the smallest eigenvalue, towards the sensor.
Normal smallest_eigenvector(Symmetric m, float z, float ray_x, float ray_y) {
  const float scale = divided(1.0f, m.xx + m.yy + m.zz);
  m.xx *= scale;
  m.xy *= scale;
  m.xz *= scale;
  m.yy *= scale;
  m.yz *= scale;
  m.zz *= scale;
  const Symmetric a = adjugate(m);
  const float c1 = a.xx + a.yy + a.zz, c0 = m.xx * a.xx + m.xy * a.xy + m.xz * a.xz;
  float t = 0;
#pragma unroll
  for (int step = 0; step < 4; ++step) {
    const float f = ((t - 1.0f) * t + c1) * t - c0, slope = (3.0f * t - 2.0f) * t + c1;
    const float bend = 6.0f * t - 2.0f;
    t -= divided(3.0f * f, slope + root(larger(4.0f * (slope * slope) - 6.0f * (f * bend), 0.0f)));
  }
  const Symmetric less = {m.xx - t, m.xy, m.xz, m.yy - t, m.yz, m.zz - t};
  const Symmetric b = adjugate(less);
  const int x_max = (b.xx >= b.yy) & (b.xx >= b.zz), y_max = b.yy >= b.zz;
  Normal n;
  n.x = x_max ? b.xx : y_max ? b.xy : b.xz;
  n.y = x_max ? b.xy : y_max ? b.yy : b.yz;
  n.z = x_max ? b.xz : y_max ? b.yz : b.zz;
  const float length = root(n.x * n.x + n.y * n.y + n.z * n.z);
  const float away = n.x * ray_x + n.y * ray_y + n.z;
  const float factor = divided(away > 0.0f ? -1.0f : 1.0f, length);
  n.x *= factor;
  n.y *= factor;
  n.z *= factor;
  n.is_plane = (z < 0.5f * NOWHERE) & (c1 > THINNEST);
  return n;
}

// Writes the normals into their columns of the cloud. z_plane: the depths of the points, in units of
// normal_radius_m.
__kernel void plane_normals(__global const float* restrict ray_x, __global const float* restrict ray_y,
                            __global const float* restrict z_plane, float step_x, float step_y,
                            __constant double* X, int width, __global double* restrict columns) {
  const size_t u = get_global_id(0), v = get_global_id(1), stride = get_global_size(0);
  if (u >= (size_t)width) return;
  const size_t plane_stride = stride + 2 * BORDER, here = in_plane(u, v, plane_stride);
  __global const float* const rays_x = ray_x + BORDER + u;
  __global const float* const rays_y = ray_y + BORDER + v;
  const float z0 = z_plane[here], x0 = z0 * rays_x[0], y0 = z0 * rays_y[0];
  Sums w_sums = {0, 0, 0, 0, 0, 0}, k_sums = {0, 0, 0, 0, 0, 0}, l_sums = {0, 0, 0, 0, 0, 0};
  // The order of the rows is that of normals_of_row(): the row itself, rows below, rows above.
#pragma unroll
  for (int row = 0; row <= 2 * NORMAL_HALF; ++row) {
    const int j = row <= NORMAL_HALF ? row : NORMAL_HALF - row;
    __global const float* const in = z_plane + here + j * (ptrdiff_t)plane_stride;
#define WEIGH(I, DZ, PSI)                                              \
  const float z_##PSI = in[I], DZ = z_##PSI - z0;                      \
  const float dx_##PSI = z_##PSI * rays_x[I] - x0, dy_##PSI = z_##PSI * rays_y[j] - y0; \
  const float PSI = wendland(dx_##PSI * dx_##PSI + dy_##PSI * dy_##PSI + DZ * DZ);
    WEIGH(0, dz, there)
    const float middle = row == 0 ? 0.25f : there, k0 = middle * dz;
    RowSums w = {middle, 0, 0}, k = {k0, 0, 0}, l = {k0 * dz, 0, 0};
#pragma unroll
    for (int i = 1; i <= NORMAL_HALF; ++i) {
      WEIGH(-i, dz_left, left)
      WEIGH(i, dz_right, right)
      const float across = (float)i, k_left = left * dz_left, k_right = right * dz_right;
      add_pair(&w, across, left, right);
      add_pair(&k, across, k_left, k_right);
      add_pair(&l, across, k_left * dz_left, k_right * dz_right);
    }
#undef WEIGH
    add_row(&w_sums, w, (float)j);
    add_row(&k_sums, k, (float)j);
    add_row(&l_sums, l, (float)j);
  }
  const Symmetric m = covariance(w_sums, k_sums, l_sums, z0, rays_x[0], rays_y[0], step_x, step_y);
  const Normal n = smallest_eigenvector(m, z0, rays_x[0], rays_y[0]);
  // The length is 1 in single precision; one Newton step makes it 1 in double precision.
  const double x = n.x, y = n.y, along = n.z, one = 1.5 - 0.5 * (x * x + y * y + along * along);
  const size_t column = width * get_global_size(1);
  __global double* const normals = columns + 3 * column;
  const size_t to = v * width + u;
  normals[to] = or_none(n.is_plane, (X[0] * x + X[1] * y + X[2] * along) * one);
  normals[to + column] = or_none(n.is_plane, (X[4] * x + X[5] * y + X[6] * along) * one);
  normals[to + 2 * column] = or_none(n.is_plane, (X[8] * x + X[9] * y + X[10] * along) * one);
}

// Writes the points in the base frame into their columns of the cloud. is_filtered: true if `change` must be
// added to the depths.
__kernel void place_points(__global const double* restrict depth_m, __global const float* restrict change,
                           int is_filtered, double change_unit_m, __global const double* restrict wide_ray_x,
                           __global const double* restrict wide_ray_y, __constant double* X, int width,
                           __global double* restrict columns) {
  const size_t u = get_global_id(0), v = get_global_id(1), here = v * get_global_size(0) + u;
  if (u >= (size_t)width) return;
  const double depth = depth_m[here];
  const double z = is_filtered ? depth + change_unit_m * change[here] : depth;
  const double x = wide_ray_x[u] * z, y = wide_ray_y[v] * z;
  const int is_there = measured(depth);
  const size_t to = v * width + u, column = width * get_global_size(1);
  columns[to] = or_none(is_there, X[0] * x + X[1] * y + X[2] * z + X[3]);
  columns[to + column] = or_none(is_there, X[4] * x + X[5] * y + X[6] * z + X[7]);
  columns[to + 2 * column] = or_none(is_there, X[8] * x + X[9] * y + X[10] * z + X[11]);
}

typedef struct {
  double hue_deg, saturation, lightness;
} Colour;

// Computes the same as hue_saturation_lightness() in core/points/point_cloud.cpp.
Colour colour_of(unsigned int rgb) {
  const int red = rgb >> 16 & 0xFF, green = rgb >> 8 & 0xFF, blue = rgb & 0xFF;
  const int more = red > green ? red : green, less = red < green ? red : green;
  const int high = more > blue ? more : blue, low = less < blue ? less : blue;
  const double chroma = high - low, sum = high + low;
  Colour colour = {0, 0, sum / 510};
  if (high == low) return colour;
  colour.saturation = chroma / (255 - fabs(sum - 255));
  const double sixth = high == red     ? (green - blue) / chroma + (green < blue ? 6 : 0)
                       : high == green ? (blue - red) / chroma + 2
                                       : (red - green) / chroma + 4;
  colour.hue_deg = 60 * sixth;
  return colour;
}

// Interpolates as FixtureAssignment does: weight 1 gives exactly `to`.
double drawn(double from, double to, double weight) {
  return weight == 1 ? to : from + weight * (to - from);
}

// Fills the columns of r_f and k_s by the rules of forbidden regions by hue, 7.3.2. Each step has 8 numbers:
// first and last hue, least saturation, least and greatest lightness, r_f, k_s (below 0: unchanged),
// strength, k_s from which the step fades in at a point that has none. keeps_points: true if the points of the cloud are the measured ones, false if they are those of
// place_points.
__kernel void fixture_columns(__global const unsigned int* restrict rgb,
                              __global const double* restrict depth_m, int keeps_points,
                              __global const double* restrict steps, int count, int width,
                              __global double* restrict columns) {
  const size_t u = get_global_id(0), v = get_global_id(1), to = v * width + u;
  if (u >= (size_t)width) return;
  const double depth = depth_m[v * get_global_size(0) + u];
  // The difference is 0 for finite numbers only.
  const int is_seen = keeps_points ? depth - depth == 0 : measured(depth);
  const int is_there = is_seen & (rgb[to] != 0xFF000000u);  // kNoColour of core/points/point_cloud.h
  const Colour colour = colour_of(rgb[to]);
  double radius = 0, stiffness = or_none(0, 0);
  for (int i = 0; i < count; ++i) {
    __global const double* const step = steps + 9 * i;
    const int above = colour.hue_deg >= step[0], below = colour.hue_deg <= step[1];
    const int in_hues = step[0] <= step[1] ? above & below : above | below;
    const int is_clear = (colour.saturation >= step[2]) & (colour.lightness >= step[3]);
    const double weight = step[7];
    if (!(is_there & in_hues & is_clear & (colour.lightness <= step[4]) & (weight > 0))) continue;
    if (step[5] >= 0) radius = drawn(radius, step[5], weight);
    if (step[6] >= 0) stiffness = drawn(stiffness == stiffness ? stiffness : step[8], step[6], weight);
  }
  const size_t column = width * get_global_size(1);
  columns[to + 6 * column] = radius;
  columns[to + 7 * column] = stiffness;
}
