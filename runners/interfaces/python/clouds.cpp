#include "runners/interfaces/python/clouds.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/kernels/point_kernels.h"
#include "core/parameters/parameter.h"
#include "core/points/point_cloud.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/interfaces/python/bindings.h"
#include "runners/interfaces/python/long_work.h"

namespace remote_touch {

namespace py = pybind11;

namespace {

// Returns a read-only array that shares the memory of a column of the cloud and keeps the cloud alive.
template <class Number>
py::object view(const std::vector<Number>& column, const py::object& owner) {
  py::array_t<Number> array(static_cast<py::ssize_t>(column.size()), column.data(), owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

template <auto kColumn>
py::object column_view(const py::object& self) {
  return view(self.cast<const PythonCloud&>().shown->*kColumn, self);
}

// Returns None if the cloud has no such column. A cloud without points has none of them.
template <auto kColumn>
py::object optional_column_view(const py::object& self) {
  if ((self.cast<const PythonCloud&>().shown->*kColumn).empty()) return py::none();
  return column_view<kColumn>(self);
}

py::array_t<double> rows_of(const std::vector<double>& x, const std::vector<double>& y,
                            const std::vector<double>& z) {
  py::array_t<double> rows({static_cast<py::ssize_t>(x.size()), py::ssize_t{3}});
  double* p = rows.mutable_data();
  for (std::size_t i = 0; i < x.size(); ++i, p += 3) p[0] = x[i], p[1] = y[i], p[2] = z[i];
  return rows;
}

// Throws InputError for a normal whose length is not 1, because the method multiplies by normals as unit
// vectors.
void require_unit_length(const PythonPoints& normals, const std::string& subject) {
  for (std::size_t i = 0; i < normals.x.size(); ++i) {
    const double length = std::hypot(normals.x[i], normals.y[i], normals.z[i]);
    if (!(std::abs(length - 1) > 1e-3)) continue;  // NaN: there is none
    throw InputError(subject + ": row " + std::to_string(i), "expected a normal of length 1, or three NaN");
  }
}

std::unique_ptr<PythonCloud> make_cloud(const py::object& points, const py::object& normals,
                                        const py::object& colour, const py::object& fixture_radius_m,
                                        const py::object& stiffness_N_per_m, int columns) {
  const auto named = [](const char* name) { return [name] { return std::string("Cloud: ") + name; }; };
  PointCloud cloud;
  PythonPoints xyz = points_of(points, named("points"));
  const std::size_t n = xyz.x.size();
  cloud.x = std::move(xyz.x), cloud.y = std::move(xyz.y), cloud.z = std::move(xyz.z);
  if (!normals.is_none()) {
    PythonPoints given = points_of(normals, named("normals"));
    if (given.x.size() != n) throw InputError("Cloud: normals", "expected one for each point");
    require_unit_length(given, "Cloud: normals");
    cloud.nx = std::move(given.x), cloud.ny = std::move(given.y), cloud.nz = std::move(given.z);
  }
  if (!colour.is_none()) cloud.colour = colours_of(colour, n, named("colour"));
  if (!fixture_radius_m.is_none())
    cloud.fixture_radius_m = lengths_of(fixture_radius_m, n, false, named("fixture_radius_m"));
  if (!stiffness_N_per_m.is_none())
    cloud.stiffness_N_per_m = lengths_of(stiffness_N_per_m, n, true, named("stiffness_N_per_m"));
  if (columns < 0 || (columns > 0 && n % static_cast<std::size_t>(columns) != 0))
    throw InputError("Cloud: columns = " + std::to_string(columns),
                     "expected 0, or a number that divides the number of points");
  cloud.grid_columns = columns;
  return std::make_unique<PythonCloud>(std::move(cloud));
}

CloudClass bind_cloud(py::module_& module) {
  using PC = PointCloud;
  CloudClass made(module, "Cloud", "A point cloud; it does not change.");
  made.def(py::init(&make_cloud), py::arg("points"), py::kw_only(), py::arg("normals") = py::none(),
           py::arg("colour") = py::none(), py::arg("fixture_radius_m") = py::none(),
           py::arg("stiffness_N_per_m") = py::none(), py::arg("columns") = 0)
      .def("__len__", [](const PythonCloud& cloud) { return cloud.shown->size(); })
      .def_property_readonly("x", &column_view<&PC::x>, "m, world frame; not copied")
      .def_property_readonly("y", &column_view<&PC::y>)
      .def_property_readonly("z", &column_view<&PC::z>)
      .def_property_readonly("nx", &optional_column_view<&PC::nx>, "unit normals, or None")
      .def_property_readonly("ny", &optional_column_view<&PC::ny>)
      .def_property_readonly("nz", &optional_column_view<&PC::nz>)
      .def_property_readonly("colour", &optional_column_view<&PC::colour>,
                             "0xRRGGBB, 0xFF000000 where it is not known; or None")
      .def_property_readonly("fixture_radius_m", &optional_column_view<&PC::fixture_radius_m>)
      .def_property_readonly("stiffness_N_per_m", &optional_column_view<&PC::stiffness_N_per_m>)
      .def_property_readonly("columns", [](const PythonCloud& cloud) { return cloud.shown->columns(); })
      .def_property_readonly(
          "points", [](const PythonCloud& c) { return rows_of(c.shown->x, c.shown->y, c.shown->z); },
          "Rows of x, y, z: a new array each time.")
      .def_property_readonly("normals", [](const PythonCloud& c) -> py::object {
        if (!c.shown->has_normals()) return py::none();
        return rows_of(c.shown->nx, c.shown->ny, c.shown->nz);
      });
  py::class_<PythonFrame, PythonCloud, std::shared_ptr<PythonFrame>>(module, "Frame",
                                                                     "A cloud of the stream.")
      .def_readonly("index", &PythonFrame::index)
      .def_readonly("captured_s", &PythonFrame::captured_s)
      .def_readonly("arrives_s", &PythonFrame::arrives_s);
  return made;
}

std::uint64_t unsigned_of(const py::object& value, int bits, const char* subject) {
  const auto number = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
  const std::uint64_t read = number ? PyLong_AsUnsignedLongLong(number.ptr()) : 0;
  const bool is_unreadable = PyErr_Occurred() != nullptr;
  if (is_unreadable) PyErr_Clear();
  if (is_unreadable || (bits < 64 && read >> bits != 0))
    throw InputError(subject, "expected an integer of " + std::to_string(bits) + " bits, 0 or more");
  return read;
}

void bind_device(py::module_& module) {
  py::class_<DeviceState>(module, "Device", "Where the hand is: the haptic interface point (HIP).")
      .def(py::init(
               [](const py::object& position_m, const py::object& orientation, const py::object& buttons) {
                 DeviceState device;
                 device.position_W = vector_of(position_m, [] { return "Device: position_m"; });
                 if (!orientation.is_none())
                   device.orientation_W = quaternion_of(orientation, [] { return "Device: orientation"; });
                 device.buttons = static_cast<std::uint32_t>(unsigned_of(buttons, 32, "Device: buttons"));
                 return device;
               }),
           py::arg("position_m"), py::arg("orientation") = py::none(), py::arg("buttons") = 0)
      .def_property_readonly("position_m", [](const DeviceState& d) { return array_of(d.position_W); })
      .def_property_readonly("orientation", [](const DeviceState& d) { return array_of(d.orientation_W); })
      .def_readonly("buttons", &DeviceState::buttons);
}

py::array_t<double> normals_of(const NoiseKey& key, int use, std::uint32_t frame, std::uint32_t count) {
  std::vector<std::uint32_t> index(count);
  for (std::uint32_t i = 0; i < count; ++i) index[i] = i;
  std::vector<double> x(count), y(count), z(count);
  chosen_python_kernels().noise.normals(noise_stream(key, static_cast<NoiseUse>(use), frame), index.data(),
                                        count, x.data(), y.data(), z.data());
  return rows_of(x, y, z);
}

py::array_t<double> uniforms_of(const NoiseKey& key, int use, std::uint32_t frame, std::uint32_t count) {
  const NoiseStream stream = noise_stream(key, static_cast<NoiseUse>(use), frame);
  py::array_t<double> rows({static_cast<py::ssize_t>(count), py::ssize_t{4}});
  double* p = rows.mutable_data();
  for (std::uint32_t i = 0; i < count; ++i, p += 4) {
    const std::array<double, 4> numbers = uniforms(stream, i);
    std::copy(numbers.begin(), numbers.end(), p);
  }
  return rows;
}

// The names of the uses, in the order of NoiseUse.
constexpr const char* kUses[] = {"point_position", "depth",           "transport",     "motion",
                                 "colour",         "dropout",         "sensor_point",  "sensor_frame",
                                 "sensor_ray",     "command_channel", "force_channel", "registration"};

int use_of(const py::object& given) {
  const auto refuse = [&]() -> int {
    std::string known;
    for (const char* name : kUses) known += std::string(name) + ", ";
    throw InputError("use = " + std::string(py::str(given)),
                     "expected " + known + "or a number from 12 to 15");
  };
  if (py::isinstance<py::str>(given)) {
    const auto* const found = std::find(std::begin(kUses), std::end(kUses), given.cast<std::string>());
    return found == std::end(kUses) ? refuse() : static_cast<int>(found - std::begin(kUses));
  }
  if (!py::isinstance<py::int_>(given)) return refuse();
  const auto number = given.cast<long>();
  return number >= static_cast<long>(std::size(kUses)) && number <= 15 ? static_cast<int>(number) : refuse();
}

template <auto kMake>
auto checked() {
  return [](const NoiseKey& key, const py::object& use, std::int64_t frame, std::int64_t count) {
    if (frame < 0 || frame >= 1 << 28)
      throw InputError("frame = " + std::to_string(frame), "expected 0 to 268435455");
    if (count < 0 || count > 100'000'000)
      throw InputError("count = " + std::to_string(count), "expected 0 to 100000000");
    return kMake(key, use_of(use), static_cast<std::uint32_t>(frame), static_cast<std::uint32_t>(count));
  };
}

void bind_noise(py::module_& module) {
  py::class_<NoiseKey>(module, "NoiseKey", "What the random numbers of a run are made from.")
      .def(py::init([](const py::object& seed, const py::object& cell, const py::object& replicate) {
             return NoiseKey{unsigned_of(seed, 64, "NoiseKey: seed"), unsigned_of(cell, 32, "NoiseKey: cell"),
                             unsigned_of(replicate, 32, "NoiseKey: replicate")};
           }),
           py::arg("seed") = 1, py::arg("cell") = 0, py::arg("replicate") = 0)
      .def_readonly("seed", &NoiseKey::seed)
      .def_readonly("cell", &NoiseKey::cell)
      .def_readonly("replicate", &NoiseKey::replicate)
      .def("normals", checked<normals_of>(), py::arg("use"), py::arg("frame"), py::arg("count"),
           "Standard normals: count rows of three.")
      .def("uniforms", checked<uniforms_of>(), py::arg("use"), py::arg("frame"), py::arg("count"),
           "Numbers uniform in (0, 1): count rows of four.");
}

std::unique_ptr<PythonScene> make_scene(const std::string& name, const std::string& settings,
                                        const NoiseKey& key) {
  const AloneInThread alone;
  const auto factory = find_entry(scenarios(), name, "scene").make();
  read_parameters(parse_json(settings, "scene"), factory->settings(), "scene");
  const std::string problem = factory->validate();
  if (!problem.empty()) throw InputError("scene." + problem);
  return std::make_unique<PythonScene>(factory->build(key, chosen_python_kernels()));
}

int checked_frame(const Scenario& scenario, int frame) {
  if (frame < 0 || frame >= scenario.frame_count())
    throw InputError("frame = " + std::to_string(frame),
                     "expected 0 to " + std::to_string(scenario.frame_count() - 1));
  return frame;
}

SceneClass bind_scene(py::module_& module) {
  SceneClass made(module, "Scene", "A scenario that answers queries.");
  made.def(py::init(&make_scene), py::arg("name"), py::arg("settings"), py::arg("key"))
      .def_property_readonly("frame_rate_hz", [](const PythonScene& s) { return (*s).frame_rate_hz(); })
      .def_property_readonly("frame_count", [](const PythonScene& s) { return (*s).frame_count(); })
      .def(
          "captured_s",
          [](const PythonScene& s, int frame) { return (*s).captured_s(checked_frame(*s, frame)); },
          py::arg("frame"))
      .def(
          "newest_frame", [](const PythonScene& s, double time_s) { return (*s).newest_frame(time_s); },
          py::arg("time_s"))
      .def(
          "cloud",
          [](const PythonScene& s, int frame) {
            const AloneInThread alone;
            return std::make_shared<PythonCloud>((*s).cloud(checked_frame(*s, frame)));
          },
          py::arg("frame"))
      .def(
          "signed_distance",
          [](const PythonScene& s, const py::object& p, double time_s) {
            return (*s).signed_distance(vector_of(
                                            p, [] { return "signed_distance: p"; }, Allowed::any),
                                        time_s);
          },
          py::arg("p"), py::arg("time_s"))
      .def(
          "surface_height",
          [](const PythonScene& s, double x, double z, double time_s) {
            return (*s).surface_height(x, z, time_s);
          },
          py::arg("x"), py::arg("z"), py::arg("time_s"));
  return made;
}

}  // namespace

PythonFrame::PythonFrame(const Frame& frame, const Kernels& kernels)
    : index(frame.index), captured_s(frame.captured_s), arrives_s(frame.arrives_s) {
  source = frame.points;
  shown = &frame.points->every_point(kernels, own);
}

PointCloud cloud_of(const py::handle& value, const Subject& subject) {
  PointCloud cloud;
  if (py::isinstance<PythonCloud>(value)) {
    cloud = *value.cast<const PythonCloud&>().shown;
  } else {
    PythonPoints xyz = points_of(value, subject);
    cloud.x = std::move(xyz.x), cloud.y = std::move(xyz.y), cloud.z = std::move(xyz.z);
  }
  if (is_far_from_origin(cloud)) throw InputError(subject(), far_from_origin("all points are"));
  return cloud;
}

const Scenario& PythonScene::operator*() const {
  if (scenario_ == nullptr) throw InputError("scene", "its run has ended: expected a use during the run");
  return *scenario_;
}

void bind_clouds(py::module_& module) {
  CloudClass cloud = bind_cloud(module);
  bind_device(module);
  bind_noise(module);
  SceneClass scene = bind_scene(module);
  bind_images(module, cloud, scene);
}

}  // namespace remote_touch
