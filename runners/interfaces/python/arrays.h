// Numbers between NumPy and C++: columns to arrays without a copy, arrays to points with checks.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <functional>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "analysis/trace/columns.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"

namespace remote_touch {

// An array that owns the vector: no number is copied.
template <class Number>
pybind11::array owning_array(std::vector<Number> values, std::vector<pybind11::ssize_t> shape) {
  auto* kept = new std::vector<Number>(std::move(values));
  const pybind11::capsule owner(kept, [](void* vector) { delete static_cast<std::vector<Number>*>(vector); });
  return pybind11::array_t<Number>(std::move(shape), kept->data(), owner);
}

// Returns the tuple (name, units, long_name, values, value_names). `values` is an array of this shape; if the
// shape is empty, its shape is (rows) or (rows, width). A column of texts has a list of texts instead.
pybind11::tuple to_python(Column column, std::vector<pybind11::ssize_t> shape = {});
pybind11::list to_python(std::vector<Column> columns);
pybind11::list to_python(const TextAttributes& attributes);  // list of (name, value)

// Converts such a tuple back, for comparisons; copies the numbers. Throws InputError, which names the column.
Column column_of(const pybind11::handle& tuple);

// Returns the subject of an error; called only if there is one: "renderer mine: Mine.step: force_N".
using Subject = std::function<std::string()>;

// Returns three finite numbers; with Allowed::any they may also be infinite or NaN. Throws InputError.
enum class Allowed { finite, any };
Vec3 vector_of(const pybind11::handle& value, const Subject& subject, Allowed allowed = Allowed::finite);
// Returns the quaternion w, x, y, z, normalised. Throws InputError unless its length is 1 within 1e-6.
Eigen::Quaterniond quaternion_of(const pybind11::handle& value, const Subject& subject);
pybind11::array_t<double> array_of(const Vec3& vector);
pybind11::array_t<double> array_of(const Eigen::Quaterniond& quaternion);

// The columns of an array of n rows of three finite numbers. A row of three NaN is a missing point.
// points_of() throws InputError for any other array.
struct PythonPoints {
  std::vector<double> x, y, z;
};
PythonPoints points_of(const pybind11::handle& array, const Subject& subject);
// Returns n finite numbers of 0 or more; if may_be_missing, NaN is allowed too. Throws InputError.
std::vector<double> lengths_of(const pybind11::handle& array, std::size_t n, bool may_be_missing,
                               const Subject& subject);
std::vector<std::uint32_t> colours_of(const pybind11::handle& array, std::size_t n, const Subject& subject);

}  // namespace remote_touch
