#include "runners/evaluation/verification/metamorphic_checks.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <utility>

#include "core/parameters/parameter.h"

namespace remote_touch {
namespace {

std::optional<Dimension> known_dimension(const std::string& name) {
  if (const Unit* const unit = unit_of(name)) return unit->dimension;
  if (name.find('_') == std::string::npos) return Dimension{};
  return std::nullopt;
}

double power(double base, int exponent) {
  double value = 1;
  for (int i = 0; i < std::abs(exponent); ++i) value *= base;
  return exponent < 0 ? 1 / value : value;
}

// Changes one parameter.
struct Changer {
  const Parameter& p;
  const UnitChange& change;

  void multiply(double& value, const std::string& name) const {
    const double factor = change.factor(dimension_of(name)), changed = value * factor;
    if (!(changed >= p.low && changed <= p.high)) {
      std::ostringstream subject, problem;
      subject << p.name << " = " << value;
      problem << "a check multiplies it by " << factor << ": expected a product from " << p.low << " to "
              << p.high;
      throw InputError(subject.str(), problem.str());
    }
    value = changed;
  }
  void keep_integer() const {
    if (change.factor(known_dimension(p.name).value_or(Dimension{})) == 1) return;
    throw InputError(p.name, "an integer cannot follow a change of units: expected a real number");
  }

  void operator()(double* value) const { multiply(*value, p.name); }
  void operator()(Vec3* value) const {
    for (double& coordinate : *value) multiply(coordinate, p.name);
  }
  void operator()(const Rows& rows) const {
    for (std::size_t i = 0; i < rows.values->size(); ++i)
      multiply((*rows.values)[i], rows.columns[i % rows.columns.size()]);
  }
  void operator()(const int*) const { keep_integer(); }
  void operator()(const std::uint64_t*) const { keep_integer(); }
  void operator()(const bool*) const {}
  void operator()(const std::string*) const {}
  void operator()(const Choice&) const {}
};

template <class Change>
void change_points(PointCloud& cloud, Change change) {
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 p = change(cloud.point(i));
    cloud.x[i] = p.x(), cloud.y[i] = p.y(), cloud.z[i] = p.z();
  }
}

template <class Change>
void change_normals(PointCloud& cloud, Change change) {
  if (!cloud.has_normals()) return;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 n = change(cloud.normal(i));
    cloud.nx[i] = n.x(), cloud.ny[i] = n.y(), cloud.nz[i] = n.z();
  }
}

void multiply(std::vector<double>& values, double factor) {
  for (double& value : values) value *= factor;
}

void change_units(CloudView& view, const UnitChange& change) {
  view.captured_s *= change.time, view.arrives_s *= change.time;
  change_points(view.cloud, [&](const Vec3& p) { return Vec3(change.length * p); });
  multiply(view.cloud.fixture_radius_m, change.length);
  multiply(view.cloud.stiffness_N_per_m, change.factor({-1, 0, 1}));
  if (view.cloud.image) view.cloud.image->X_WC.translation() *= change.length;
}

void change_units(RenderOutput& out, const UnitChange& change) {
  out.proxy_W *= change.length, out.nearest_distance_m *= change.length,
      out.frame_correction_m *= change.length;
  out.slave_W *= change.length;
  out.force_N *= change.force;
  out.surface_velocity_m_per_s *= change.factor({1, -1, 0});
  if (!out.tool) return;
  out.tool->torque_Nm *= change.factor({1, 0, 1});
  out.tool->tool_penetration_m *= change.length;
}

template <class Value>
std::vector<Value> picked(const std::vector<Value>& column, const std::vector<int>& order, Value missing) {
  if (column.empty()) return {};
  std::vector<Value> out;
  for (const int i : order) out.push_back(i < 0 ? missing : column[static_cast<std::size_t>(i)]);
  return out;
}

// Rotation vectors and torques are axial vectors. A mirror keeps their component along its axis and reverses
// the others.
Vec3 mirrored_axial(Vec3 v, int axis) {
  v = -v;
  v[axis] = -v[axis];
  return v;
}

Eigen::Quaterniond mirrored(const Eigen::Quaterniond& q, int axis) {
  Eigen::Quaterniond other = q;
  other.vec() = mirrored_axial(q.vec(), axis);
  return other;
}

}  // namespace

double UnitChange::factor(const Dimension& dimension) const {
  return power(length, dimension.length) * power(time, dimension.time) * power(force, dimension.force);
}

Dimension dimension_of(const std::string& name) {
  if (const auto dimension = known_dimension(name)) return *dimension;
  std::string endings;
  for (const Unit& unit : known_units()) endings += std::string(" ") + unit.ending;
  throw InputError(name,
                   "ends in no known unit: expected" + endings + ", or no underscore for a pure number");
}

void change_units(const Parameters& parameters, const UnitChange& change) {
  for (const Parameter& p : parameters) std::visit(Changer{p, change}, p.value);
}

double max_length_m(const Parameters& parameters) {
  double max = 0;
  for (const Parameter& p : parameters)
    if (double* const* value = std::get_if<double*>(&p.value);
        value && dimension_of(p.name) == Dimension{1, 0, 0})
      max = std::max(max, std::abs(**value));
  return max;
}

void change_units(Variation& variation, const UnitChange& change) {
  MetamorphicScene& scene = variation.scene;
  scene.start_s *= change.time, scene.haptic_rate_hz /= change.time, scene.cell_m *= change.length;
  for (Vec3& hip : scene.hip_W) hip *= change.length;
  for (CloudView& view : scene.views) change_units(view, change);
  for (RenderOutput& out : variation.expected) change_units(out, change);
  variation.units = change;
}

void move_rigidly(Variation& variation, const RigidTransform& motion) {
  const Eigen::Quaterniond rotation(motion.linear());
  for (Vec3& hip : variation.scene.hip_W) hip = motion * hip;
  for (Eigen::Quaterniond& device : variation.scene.device_WH) device = rotation * device;
  for (CloudView& view : variation.scene.views) {
    change_points(view.cloud, [&](const Vec3& p) { return Vec3(motion * p); });
    change_normals(view.cloud, [&](const Vec3& n) { return Vec3(motion.linear() * n); });
    if (view.cloud.image) view.cloud.image->X_WC = motion * view.cloud.image->X_WC;
  }
  const auto turn = [&](Vec3& direction) { direction = motion.linear() * direction; };
  for (RenderOutput& out : variation.expected) {
    out.proxy_W = motion * out.proxy_W, out.slave_W = motion * out.slave_W;
    turn(out.force_N), turn(out.normal_W), turn(out.frame_correction_m);
    if (out.tool) turn(out.tool->torque_Nm), out.tool->orientation_W = rotation * out.tool->orientation_W;
  }
}

void mirror(Variation& variation, int axis) {
  const auto flip = [axis](Vec3& v) { v[axis] = -v[axis]; };
  replace_search(variation, variation.scene.cell_m);
  for (Vec3& hip : variation.scene.hip_W) flip(hip);
  for (Eigen::Quaterniond& device : variation.scene.device_WH) device = mirrored(device, axis);
  for (CloudView& view : variation.scene.views) {
    change_points(view.cloud, [&](Vec3 p) { return flip(p), p; });
    change_normals(view.cloud, [&](Vec3 n) { return flip(n), n; });
  }
  for (RenderOutput& out : variation.expected) {
    flip(out.proxy_W), flip(out.force_N), flip(out.normal_W), flip(out.frame_correction_m), flip(out.slave_W);
    if (!out.tool) continue;
    out.tool->torque_Nm = mirrored_axial(out.tool->torque_Nm, axis);
    out.tool->orientation_W = mirrored(out.tool->orientation_W, axis);
  }
}

void replace_search(Variation& variation, double cell_m) {
  variation.scene.cell_m = cell_m;
  for (CloudView& view : variation.scene.views) {
    view.cloud.grid_columns = view.cloud.columns();
    view.cloud.image.reset();
  }
}

void reorder(Variation& variation, const std::function<std::vector<int>(int size)>& order) {
  constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
  for (CloudView& view : variation.scene.views) {
    PointCloud& cloud = view.cloud;
    const std::vector<int> from = order(static_cast<int>(cloud.size()));
    cloud.grid_columns = 0;
    cloud.x = picked(cloud.x, from, kMissing), cloud.y = picked(cloud.y, from, kMissing);
    cloud.z = picked(cloud.z, from, kMissing);
    cloud.nx = picked(cloud.nx, from, kMissing), cloud.ny = picked(cloud.ny, from, kMissing);
    cloud.nz = picked(cloud.nz, from, kMissing);
    cloud.fixture_radius_m = picked(cloud.fixture_radius_m, from, 0.0);
    cloud.stiffness_N_per_m = picked(cloud.stiffness_N_per_m, from, 0.0);
    cloud.colour = picked(cloud.colour, from, 0u);
  }
}

void add_points(Variation& variation, const std::vector<Vec3>& points_W) {
  for (CloudView& view : variation.scene.views) {
    PointCloud& cloud = view.cloud;
    for (const Vec3& p : points_W) {
      if (cloud.has_normals())
        cloud.append(p, Vec3::UnitY());
      else
        cloud.append(p);
      if (!cloud.fixture_radius_m.empty()) cloud.fixture_radius_m.push_back(0);
      if (!cloud.stiffness_N_per_m.empty())
        cloud.stiffness_N_per_m.push_back(cloud.stiffness_N_per_m.front());
      if (!cloud.colour.empty()) cloud.colour.push_back(0);
    }
  }
}

std::vector<std::size_t> follow_views(
    Variation& variation, std::size_t first, int ticks,
    const std::function<CloudView(const CloudView& view, const CloudView& previous)>& make) {
  MetamorphicScene& scene = variation.scene;
  std::vector<CloudView> views;
  std::vector<std::size_t> followers;
  for (std::size_t i = 0; i < scene.views.size(); ++i) {
    const CloudView& view = scene.views[i];
    views.push_back(view);
    if (i < first) continue;
    followers.push_back(views.size());
    views.push_back(make(view, scene.views[i == 0 ? 0 : i - 1]));
    views.back().arrives_s = view.arrives_s + ticks / scene.haptic_rate_hz;
  }
  scene.views = std::move(views);
  return followers;
}

}  // namespace remote_touch
