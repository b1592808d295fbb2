#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <nlohmann/json.hpp>

#include "core/dissertation/depth/depth_pipeline.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/mesh_files/loaded_tool.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/interfaces/python/bindings.h"
#include "runners/interfaces/python/clouds.h"
#include "runners/interfaces/python/long_work.h"
#include "runners/libraries/depth_device.h"
#include "scenarios/objects/mesh_scene.h"
#include "scenarios/recordings/recorded_scene.h"
#include "scenarios/simulated/depth_camera.h"

namespace remote_touch {

// Images and true surfaces of scenes, simulated sensors, meshes of tools, and renderers in steps, for
// studies. A scene changes what it keeps of its frames, so its queries hold the interpreter's lock.

namespace py = pybind11;

namespace {

Json json_of(const py::handle& settings, const std::string& subject) {
  return parse_json(py::str(py::module_::import("remote_touch.calls").attr("_json")(settings)), subject);
}

// Settings from the named arguments of a call in Python.
template <class Settings>
Settings settings_of(const py::kwargs& given, const char* subject) {
  Settings settings;
  read_parameters(json_of(given, subject), parameters(settings), subject);
  if (const std::string problem = validate(settings); !problem.empty())
    throw InputError(std::string(subject) + "." + problem);
  return settings;
}

py::dict as_dict(const CameraIntrinsics& c) {
  using namespace py::literals;
  return py::dict("width"_a = c.width, "height"_a = c.height, "fx"_a = c.fx, "fy"_a = c.fy, "cx"_a = c.cx,
                  "cy"_a = c.cy);
}

// The members of a dict as of Cloud.camera.
CameraIntrinsics camera_of(const py::dict& given) {
  const auto number = [&](const char* name) {
    try {
      if (given.contains(name)) return given[name].cast<double>();
    } catch (const py::cast_error&) {
    }
    throw InputError("camera", std::string("expected a number ") + name);
  };
  const double width = number("width"), height = number("height"), fx = number("fx"), fy = number("fy");
  if (!(width >= 1 && width <= 4096 && height >= 1 && height <= 4096 && fx > 0 && fy > 0))
    throw InputError("camera", "expected 1 to 4096 columns and rows, and fx and fy above 0");
  return {static_cast<int>(width), static_cast<int>(height), fx, fy, number("cx"), number("cy")};
}

template <class Number>
py::array as_image(std::vector<Number> pixels, const CameraIntrinsics& camera) {
  return owning_array(std::move(pixels), {camera.height, camera.width});
}

using Numbers2d = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::vector<double> pixels_of(const Numbers2d& image) {
  return {image.data(), image.data() + image.size()};
}

const ImageLayout& layout_of(const PythonCloud& cloud) {
  if (!cloud.shown->image || cloud.shown->size() != cloud.shown->image->camera.pixels())
    throw InputError("Cloud", "its points are not the pixels of an image: expected a frame of a camera");
  return *cloud.shown->image;
}

DepthImage depth_of(const PythonCloud& cloud) {
  const ImageLayout& layout = layout_of(cloud);
  const RigidTransform X_CW = layout.X_WC.inverse();
  DepthImage depth{layout.camera.width, layout.camera.height, {}};
  for (std::size_t i = 0; i < cloud.shown->size(); ++i)
    depth.z_m.push_back((X_CW * cloud.shown->point(i)).z());
  return depth;
}

PixelRectangle checked(const PixelRectangle& at, const CameraIntrinsics& camera) {
  if (at.left < 0 || at.top < 0 || at.width < 1 || at.height < 1 || at.width > camera.width - at.left ||
      at.height > camera.height - at.top)
    throw InputError("rectangle", "expected pixels in the image of " + size_text(camera));
  return at;
}

// Returns the pixels of the rectangle as an image of their own; of the columns it has only the positions.
std::shared_ptr<PythonCloud> window_of(const PythonCloud& cloud, int left, int top, int width, int height) {
  PointCloud window;
  window.image = layout_of(cloud);
  CameraIntrinsics& camera = window.image->camera;
  const int columns = camera.width;
  checked({left, top, width, height}, camera);
  camera.width = width, camera.height = height, camera.cx -= left, camera.cy -= top;
  for (int row = top; row < top + height; ++row)
    for (int column = left; column < left + width; ++column)
      window.append(cloud.shown->point(static_cast<std::size_t>(row) * columns + column));
  return std::make_shared<PythonCloud>(std::move(window));
}

std::shared_ptr<PythonCloud> filtered(const PythonCloud& cloud, int left, int top, int width, int height,
                                      const py::kwargs& settings) {
  const ImageLayout& layout = layout_of(cloud);
  const auto given = settings_of<DepthDeviceSettings>(settings, "depth_pipeline");
  const PixelRectangle at = checked({left, top, width, height}, layout.camera);
  const py::gil_scoped_release without_lock;
  const AloneInThread alone;
  PointCloud made;
  DepthPipeline(given, chosen_python_kernels())
      .process(depth_of(cloud), layout.camera, layout.X_WC, at, made);
  return std::make_shared<PythonCloud>(std::move(made));
}

std::vector<Vec3> vectors_of(const py::handle& points, const char* subject) {
  const PythonPoints p = points_of(points, [subject] { return std::string(subject) + ": points"; });
  std::vector<Vec3> vectors;
  for (std::size_t i = 0; i < p.x.size(); ++i) vectors.emplace_back(p.x[i], p.y[i], p.z[i]);
  return vectors;
}

py::array as_array(std::vector<double> values) {
  const auto count = static_cast<py::ssize_t>(values.size());
  return owning_array(std::move(values), {count});
}

py::array surface_distances(const PythonCloud& cloud, const py::object& points, double radius_m) {
  if (!(radius_m > 0 && std::isfinite(radius_m)))
    throw InputError("surface_distances: radius_m", "expected a finite number above 0");
  const std::vector<Vec3> places = vectors_of(points, "surface_distances");
  std::vector<double> distances;
  {
    const py::gil_scoped_release without_lock;
    for (const Vec3& p_W : places) distances.push_back(distance_to_measured(*cloud.shown, p_W, radius_m));
  }
  return as_array(std::move(distances));
}

py::array rule_weights(const PythonCloud& cloud, const py::dict& rule) {
  const Json part = json_of(rule, "rule");
  const std::string name = rule.contains("name") ? py::str(rule["name"]) : py::str();
  const auto factory = find_entry(fixtures(), name, "rule").make();
  read_parameters(part, factory->settings(), "rule", {"name"});
  if (const std::string problem = factory->validate(); !problem.empty()) throw InputError("rule." + problem);
  return as_array(factory->build()->weights(*cloud.shown));
}

py::array signed_distances(const PythonScene& scene, const py::handle& points, const Numbers2d& time_s) {
  const bool is_one = time_s.ndim() == 0;
  const bool fits =
      is_one || (time_s.ndim() == 1 && time_s.size() == static_cast<py::ssize_t>(py::len(points)));
  if (!fits ||
      !std::all_of(time_s.data(), time_s.data() + time_s.size(), [](double t) { return std::isfinite(t); }))
    throw InputError("signed_distances: time_s", "expected one finite time, or one for each point");
  std::vector<double> distances;
  for (const Vec3& p_W : vectors_of(points, "signed_distances"))
    distances.push_back((*scene).signed_distance(p_W, time_s.data()[is_one ? 0 : distances.size()]));
  return as_array(std::move(distances));
}

py::list true_objects(const PythonScene& scene, double time_s) {
  py::list list;
  for (const PosedMesh& mesh : (*scene).true_meshes(time_s))
    list.append(py::make_tuple(mesh.name, mesh.X_WO ? py::cast(mesh.X_WO->matrix()) : py::none()));
  return list;
}

// Returns the depth, the object and the normal of the surface that each pixel of a camera without errors
// sees.
py::dict true_image(const PythonScene& scene, double time_s, const py::dict& given,
                    const Eigen::MatrixXd& pose) {
  const AloneInThread alone;
  const CameraIntrinsics camera = camera_of(given);
  if (pose.rows() != 4 || pose.cols() != 4 || !pose.allFinite())
    throw InputError("true_image: camera_pose", "expected 4 x 4 finite numbers");
  RigidTransform X_WC = RigidTransform::Identity();
  X_WC.matrix() = pose;
  const RigidTransform X_CW = X_WC.inverse();
  std::vector<RasterMesh> meshes;
  for (const PosedMesh& mesh : (*scene).true_meshes(time_s)) {
    meshes.push_back({mesh.vertices_O, {}, RigidTransform::Identity(), mesh.is_closed});
    if (mesh.X_WO) meshes.back().triangles = mesh.triangles, meshes.back().X_CO = X_CW * *mesh.X_WO;
  }
  RasterImage image = depth_raster(camera, meshes);
  std::vector<double> normals(3 * camera.pixels(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < image.mesh.size(); ++i) {
    if (image.mesh[i] < 0) continue;
    const RasterMesh& mesh = meshes[static_cast<std::size_t>(image.mesh[i])];
    const auto& [a, b, c] = mesh.triangles[static_cast<std::size_t>(image.triangle[i])];
    const Vec3& from = mesh.vertices_O[a];
    const Vec3 n_C =
        mesh.X_CO.linear() * (mesh.vertices_O[b] - from).cross(mesh.vertices_O[c] - from).normalized();
    const Vec3 seen_C = n_C.dot(mesh.X_CO * from) > 0 ? Vec3(-n_C) : n_C;
    std::copy(seen_C.data(), seen_C.data() + 3, &normals[3 * i]);
  }
  py::dict made;
  made["depth"] = as_image(std::move(image.depth.z_m), camera);
  made["object"] = as_image(std::move(image.mesh), camera);
  made["normals"] = owning_array(std::move(normals), {camera.height, camera.width, 3});
  return made;
}

double truth_uncertainty_m(const PythonScene& scene) {
  const auto* recorded = dynamic_cast<const RecordedScene*>(&*scene);
  const bool has_truth = recorded != nullptr && recorded->truth() != nullptr;
  return has_truth ? recorded->truth()->uncertainty_m() : std::numeric_limits<double>::quiet_NaN();
}

struct PythonSensor {
  DepthSensorSettings settings;
  DepthSensor sensor;
  explicit PythonSensor(const DepthSensorSettings& given)
      : settings(given), sensor(given, NoiseKey{}, chosen_python_kernels()) {}

  std::vector<py::array> measured(const Numbers2d& depth, const std::optional<Numbers2d>& cosine,
                                  const std::vector<int>& frames) const {
    const CameraIntrinsics& camera = sensor.intrinsics();
    const auto is_image = [&](const Numbers2d& image) {
      return image.ndim() == 2 && image.shape(0) == camera.height && image.shape(1) == camera.width;
    };
    if (!is_image(depth) || (cosine && !is_image(*cosine)))
      throw InputError("measured", "expected images of " + size_text(camera) + ": rows x columns");
    std::vector<double> true_depth = pixels_of(depth);
    std::vector<double> cosines = cosine ? pixels_of(*cosine) : std::vector<double>();
    std::vector<std::vector<double>> depths;
    {
      const py::gil_scoped_release without_lock;
      const AloneInThread alone;
      const auto view = sensor.view({camera.width, camera.height, std::move(true_depth)}, cosines, {});
      for (const int frame : frames) depths.push_back(sensor.measured_depth(view, frame).z_m);
    }
    std::vector<py::array> images;
    for (std::vector<double>& image : depths) images.push_back(as_image(std::move(image), camera));
    return images;
  }
  py::dict triangulated() const {
    if (settings.sensor == DepthSensorKind::simple)
      throw InputError("sensor = simple", "does not triangulate");
    const Triangulation t = triangulation(settings);
    using namespace py::literals;
    return py::dict("baseline_m"_a = t.baseline_m, "focal_px"_a = t.focal_px, "noise_px"_a = t.noise_px,
                    "step_px"_a = t.step_px, "window_px"_a = t.window_px);
  }
};

// An array of three numbers in each row.
template <class Number, class Row>
py::array as_rows(const std::vector<Row>& rows) {
  std::vector<Number> numbers;
  for (const Row& row : rows) numbers.insert(numbers.end(), row.data(), row.data() + 3);
  return owning_array(std::move(numbers), {static_cast<py::ssize_t>(rows.size()), 3});
}

// Returns the vertices and the triangles of the mesh of a tool, which is made unless it is in the cache.
py::tuple tool_mesh(const py::kwargs& given) {
  const auto settings = settings_of<ToolSettings>(given, "tool");
  std::shared_ptr<const VoxelTool> tool;
  {
    const py::gil_scoped_release without_lock;
    const AloneInThread alone;
    tool = load_tool(settings);
  }
  return py::make_tuple(as_rows<double>(tool->mesh.vertices), as_rows<int>(tool->mesh.triangles));
}

}  // namespace

void bind_images(py::module_& module, CloudClass& cloud, SceneClass& scene) {
  const auto left = py::arg("left"), top = py::arg("top"), width = py::arg("width"),
             height = py::arg("height");
  cloud
      .def_property_readonly(
          "camera", [](const PythonCloud& c) { return as_dict(layout_of(c).camera); },
          "width, height, fx, fy, cx, cy, in pixels")
      .def_property_readonly(
          "camera_pose", [](const PythonCloud& c) { return Eigen::Matrix4d(layout_of(c).X_WC.matrix()); },
          "4 x 4: camera frame to world frame")
      .def_property_readonly(
          "depth", [](const PythonCloud& c) { return as_image(depth_of(c).z_m, layout_of(c).camera); },
          "m along the optical axis: rows x columns")
      .def("window", &window_of, left, top, width, height, "A rectangle of pixels as an image of its own.")
      .def(
          "filtered", &filtered, left, top, width, height,
          "A rectangle of pixels behind the depth pipeline, with settings of depth_pipeline: filtered points "
          "with normals. The CPU computes them, whatever device says.")
      .def("surface_distances", &surface_distances, py::arg("points"), py::arg("radius_m"),
           "Distances of points from the surface that the image shows: from planes through the pixels within "
           "radius_m.")
      .def("rule_weights", &rule_weights, py::arg("rule"),
           "0 to 1 for each point: how a fixture rule, a dict of the section fixtures, selects it.");
  scene
      .def("signed_distances", &signed_distances, py::arg("points"), py::arg("time_s"),
           "signed_distance() of many points, at one time or at one for each.")
      .def(
          "true_objects", &true_objects, py::arg("time_s"),
          "(name, pose) of the meshes that are the true surface; poses are 4 x 4, to the world frame, or None.")
      .def("true_image", &true_image, py::arg("time_s"), py::arg("camera"), py::arg("camera_pose"),
           "What a camera without errors sees of true_objects(): images of depth (m), object (-1: none) and "
           "normals (camera frame).")
      .def_property_readonly("truth_uncertainty_m", &truth_uncertainty_m, "of a recording; NaN: not stated");
  py::class_<PythonSensor>(module, "DepthSensor",
                           "A simulated depth sensor, with the settings of the scenario mesh-scene about it.")
      .def(py::init([](const py::kwargs& settings) {
        return PythonSensor(settings_of<DepthSensorSettings>(settings, "sensor"));
      }))
      .def_property_readonly("camera", [](const PythonSensor& s) { return as_dict(s.sensor.intrinsics()); })
      .def_property_readonly("triangulation", &PythonSensor::triangulated)
      .def(
          "measured", &PythonSensor::measured, py::arg("depth"), py::arg("cosine") = py::none(),
          py::arg("frames") = std::vector<int>{0},
          "The images of these frames, of a scene at rest: an image of true depths (m), and one of the cosines "
          "between ray and normal (None: 1).");
  module.def(
      "tool_mesh", &tool_mesh,
      "The mesh of a tool, with the settings tool_... of a renderer: vertices, in m from the centre of "
      "mass, and triangles, the numbers of their vertices.");
}

namespace {

// A renderer of the catalog, and what processes its frames.
class Stepper {
 public:
  explicit Stepper(const Experiment& experiment,
                   const std::shared_ptr<FixtureSwitches>& switches = std::make_shared<FixtureSwitches>())
      : renderer_(experiment.build_renderer(chosen_python_kernels(), switches)),
        processing_(experiment.build_processing(chosen_python_kernels(), switches)) {}

  void frame(const py::object& given, double captured_s) {
    const auto cloud = (py::isinstance<PythonCloud>(given) ? given : py::type::of<PythonCloud>()(given))
                           .cast<std::shared_ptr<PythonCloud>>();
    require_finite(captured_s, "frame: captured_s");
    const py::gil_scoped_release without_lock;
    const AloneInThread one_thread;
    const auto alone = only_user();
    Frame frame{next_++, captured_s, captured_s, nullptr};
    processing_.fill(frame, *cloud->shown, processing_.fixtures.off());
    processing_.needs.check(frame);
    renderer_->on_frame(frame);
  }
  PythonOutput step(const py::object& given, double time_s) {
    const DeviceState device =
        py::isinstance<DeviceState>(given)
            ? given.cast<DeviceState>()
            : DeviceState{.position_W = vector_of(given, [] { return "step: device"; })};
    require_finite(time_s, "step: time_s");
    if (time_s < now_s_)
      throw InputError("step: time_s = " + std::to_string(time_s),
                       "expected no time before that of the last step, " + std::to_string(now_s_));
    const py::gil_scoped_release without_lock;
    const AloneInThread one_thread;
    const auto alone = only_user();
    PythonOutput made;
    made.output = renderer_->step(device, time_s), made.has_proxy = true;
    now_s_ = time_s;
    if (made.output.tool) {
      made.torque_Nm = made.output.tool->torque_Nm;
      made.tool_orientation = made.output.tool->orientation_W;
    }
    return made;
  }

 private:
  static void require_finite(double value, const char* name) {
    if (!std::isfinite(value)) throw InputError(name, "expected a finite number");
  }
  // A renderer in Python may call itself, so this does not wait.
  std::unique_lock<std::mutex> only_user() {
    std::unique_lock lock(*mutex_, std::try_to_lock);
    if (!lock.owns_lock())
      throw InputError("renderer", "another thread uses it: expected one renderer for each thread");
    return lock;
  }

  std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();
  std::unique_ptr<Renderer> renderer_;
  FrameProcessing processing_;
  int next_ = 0;
  double now_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

void bind_stepper(py::module_& module) {
  py::class_<Stepper>(module, "Stepper", "A renderer of the catalog in steps, see stepper().")
      .def(py::init([](const std::string& subject, const std::optional<std::string>& text,
                       const std::vector<std::string>& overrides) {
             return Stepper(experiment_of(subject, text, overrides));
           }),
           py::arg("subject"), py::arg("text"), py::arg("overrides"))
      .def(
          "frame", &Stepper::frame, py::arg("cloud"), py::arg("captured_s"),
          "A new frame, a Cloud or an array (n, 3), which the depth pipeline and the fixtures process before.")
      .def("step", &Stepper::step, py::arg("device"), py::arg("time_s"),
           "One tick for a Device or a position: an Output.");
}

}  // namespace remote_touch
