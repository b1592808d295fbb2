#include "runners/interfaces/python/arrays.h"

#include <pybind11/stl.h>

#include <cmath>

#include "core/parameters/parameter.h"
#include "core/points/point_cloud.h"

namespace remote_touch {

namespace py = pybind11;

namespace {

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::string shape_text(const py::array& array) {
  std::string text = "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i) text += (i > 0 ? ", " : "") + std::to_string(array.shape(i));
  return text + ")";
}

// Converts numbers of any integer or floating type. Refuses truth values, texts, objects and complex numbers.
Doubles doubles_of(const py::handle& value, const Subject& subject, const char* expected) {
  const py::array any = py::array::ensure(value);
  if (!any) {
    PyErr_Clear();
    throw InputError(subject(), std::string("no array: expected ") + expected);
  }
  const char kind = any.dtype().kind();
  if (kind != 'f' && kind != 'i' && kind != 'u')
    throw InputError(subject(),
                     "an array of " + std::string(py::str(any.dtype())) + ": expected " + expected);
  // A masked number of a NumPy masked array is not known. Its array has some number there, too.
  if (!any.is(value) && py::isinstance<py::array>(value) && py::hasattr(value, "filled"))
    return Doubles(value.attr("astype")("float64").attr("filled")(std::nan("")));
  return Doubles(any);
}

Doubles checked_array(const py::handle& value, std::vector<py::ssize_t> shape, const Subject& subject,
                      const char* expected) {
  Doubles numbers = doubles_of(value, subject, expected);
  bool fits = numbers.ndim() == static_cast<py::ssize_t>(shape.size());
  for (std::size_t i = 0; fits && i < shape.size(); ++i)
    fits = shape[i] < 0 || numbers.shape(static_cast<py::ssize_t>(i)) == shape[i];
  if (!fits)
    throw InputError(subject(), "an array of shape " + shape_text(numbers) + ": expected " + expected);
  return numbers;
}

template <class Number>
bool take_numbers(const py::handle& array, Column& column) {
  if (!py::isinstance<py::array_t<Number>>(array)) return false;
  const auto numbers = py::array_t<Number, py::array::c_style>(py::reinterpret_borrow<py::object>(array));
  column.values = std::vector<Number>(numbers.data(), numbers.data() + numbers.size());
  column.width = numbers.ndim() == 2 ? static_cast<int>(numbers.shape(1)) : 1;
  return true;
}

}  // namespace

py::tuple to_python(Column column, std::vector<py::ssize_t> shape) {
  if (shape.empty()) {
    shape.push_back(static_cast<py::ssize_t>(column.length()));
    if (column.width > 1) shape.push_back(column.width);
  }
  py::object values = std::visit(
      [&]<class Values>(Values& own) -> py::object {
        if constexpr (std::is_same_v<Values, std::vector<std::string>>)
          return py::cast(own);
        else
          return owning_array(std::move(own), shape);
      },
      column.values);
  return py::make_tuple(column.name, column.units, column.long_name, std::move(values), column.value_names);
}

py::list to_python(std::vector<Column> columns) {
  py::list list;
  for (Column& column : columns) list.append(to_python(std::move(column)));
  return list;
}

py::list to_python(const TextAttributes& attributes) {
  py::list list;
  for (const auto& [name, value] : attributes) list.append(py::make_tuple(name, value));
  return list;
}

Column column_of(const py::handle& tuple) {
  const auto parts = py::reinterpret_borrow<py::tuple>(tuple);
  Column column;
  column.name = parts[0].cast<std::string>(), column.units = parts[1].cast<std::string>();
  column.long_name = parts[2].cast<std::string>();
  const py::object values = parts[3];
  if (py::isinstance<py::list>(values))
    column.values = values.cast<std::vector<std::string>>();
  else if (!take_numbers<double>(values, column) && !take_numbers<std::int32_t>(values, column) &&
           !take_numbers<std::uint64_t>(values, column))
    throw InputError("column " + column.name, "expected float64, int32 or uint64 numbers");
  column.value_names = parts[4].cast<std::vector<std::string>>();
  return column;
}

Vec3 vector_of(const py::handle& value, const Subject& subject, Allowed allowed) {
  const Doubles numbers = checked_array(value, {3}, subject, "three numbers");
  const double* p = numbers.data();
  const Vec3 vector(p[0], p[1], p[2]);
  if (allowed == Allowed::finite && !vector.allFinite())
    throw InputError(subject(), "a number is not finite: expected three finite numbers");
  return vector;
}

Eigen::Quaterniond quaternion_of(const py::handle& value, const Subject& subject) {
  const Doubles numbers = checked_array(value, {4}, subject, "a quaternion w, x, y, z");
  const double* p = numbers.data();
  const Eigen::Quaterniond q(p[0], p[1], p[2], p[3]);
  const double off = std::abs(q.norm() - 1);
  if (!(off <= 1e-6))
    throw InputError(subject(), "its length is not 1: expected a unit quaternion w, x, y, z");
  return off > 1e-12 ? q.normalized() : q;  // a quaternion that was made here keeps its bits
}

py::array_t<double> array_of(const Vec3& vector) {
  py::array_t<double> array(3);
  double* p = array.mutable_data();
  for (int i = 0; i < 3; ++i) p[i] = vector[i];
  return array;
}

py::array_t<double> array_of(const Eigen::Quaterniond& q) {
  py::array_t<double> array(4);
  double* p = array.mutable_data();
  p[0] = q.w(), p[1] = q.x(), p[2] = q.y(), p[3] = q.z();
  return array;
}

PythonPoints points_of(const py::handle& array, const Subject& subject) {
  const char* const expected = "an array of shape (n, 3) of finite numbers, NaN for a missing point";
  const Doubles numbers = checked_array(array, {-1, 3}, subject, expected);
  const auto n = static_cast<std::size_t>(numbers.shape(0));
  PythonPoints columns{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
  const double* row = numbers.data();
  for (std::size_t i = 0; i < n; ++i, row += 3) {
    const int missing = std::isnan(row[0]) + std::isnan(row[1]) + std::isnan(row[2]);
    if (missing != 3 && !(std::isfinite(row[0]) && std::isfinite(row[1]) && std::isfinite(row[2])))
      throw InputError(subject() + ": row " + std::to_string(i),
                       "a number is not finite: expected three finite numbers, or three NaN");
    columns.x[i] = row[0], columns.y[i] = row[1], columns.z[i] = row[2];
  }
  return columns;
}

std::vector<double> lengths_of(const py::handle& array, std::size_t n, bool may_be_missing,
                               const Subject& subject) {
  const std::string expected = std::to_string(n) + " numbers of 0 or more, one for each point";
  const Doubles numbers = checked_array(array, {static_cast<py::ssize_t>(n)}, subject, expected.c_str());
  std::vector<double> values(numbers.data(), numbers.data() + n);
  for (const double value : values)
    if (!(value >= 0 && std::isfinite(value)) && !(may_be_missing && std::isnan(value)))
      throw InputError(subject(), "expected " + expected);
  return values;
}

std::vector<std::uint32_t> colours_of(const py::handle& array, std::size_t n, const Subject& subject) {
  const std::string expected = std::to_string(n) + " integers 0xRRGGBB, one for each point";
  const Doubles numbers = checked_array(array, {static_cast<py::ssize_t>(n)}, subject, expected.c_str());
  std::vector<std::uint32_t> values;
  for (std::size_t i = 0; i < n; ++i) {
    const double value = numbers.data()[i];
    if (!(value >= 0 && value <= 0xffffff && value == std::floor(value)) && value != kNoColour)
      throw InputError(subject(), "expected " + expected);
    values.push_back(static_cast<std::uint32_t>(value));
  }
  return values;
}

}  // namespace remote_touch
