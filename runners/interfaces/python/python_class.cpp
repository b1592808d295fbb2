#include "runners/interfaces/python/python_class.h"

#include <pybind11/numpy.h>

#include <algorithm>
#include <limits>

#include "runners/interfaces/python/arrays.h"

namespace remote_touch {

namespace py = pybind11;

namespace {

std::variant<double, int, bool, std::string, Vec3> value_of(const py::object& value, bool is_integer,
                                                            const Subject& subject) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>();
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (is_integer && py::isinstance<py::int_>(value)) return value.cast<int>();
  if (py::isinstance<py::int_>(value) || py::isinstance<py::float_>(value)) return value.cast<double>();
  return vector_of(value, subject);
}

void check(const PythonSetting& setting, const std::string& subject) {
  const auto is_out = [&](double x) { return !(setting.low <= x && x <= setting.high); };
  bool wrong = false;
  if (const auto* number = std::get_if<double>(&setting.value)) wrong = is_out(*number);
  if (const auto* number = std::get_if<int>(&setting.value)) wrong = is_out(*number);
  if (const auto* vector = std::get_if<Vec3>(&setting.value))
    wrong = is_out(vector->x()) || is_out(vector->y()) || is_out(vector->z());
  if (wrong) throw InputError(subject, "its value is not in its range: expected low <= value <= high");
}

PythonSetting setting_of(const py::handle& given, const std::string& of_class) {
  PythonSetting setting;
  setting.name = given.attr("name").cast<std::string>();
  const std::string subject = of_class + ": setting " + setting.name;
  if (setting.name.empty() || setting.name == "name") throw InputError(subject, "expected another name");
  setting.help = given.attr("help").cast<std::string>();
  setting.low = given.attr("low").cast<double>(), setting.high = given.attr("high").cast<double>();
  setting.is_live = given.attr("live").cast<bool>();
  setting.value = value_of(given.attr("value"), given.attr("integer").cast<bool>(), [&] { return subject; });
  if (setting.is_live && !std::holds_alternative<double>(setting.value) &&
      !std::holds_alternative<bool>(setting.value))
    throw InputError(subject, "is live: expected a number or a switch");
  check(setting, subject);
  return setting;
}

}  // namespace

std::string problem_text(const py::error_already_set& raised) {
  std::string text = py::str(raised.type().attr("__name__"));
  const std::string said = py::str(raised.value());
  if (!said.empty()) text += ": " + said;
  py::object place = raised.trace() ? py::object(raised.trace()) : py::none();
  if (place.is_none()) return text;
  for (py::object next = place.attr("tb_next"); !next.is_none(); next = next.attr("tb_next")) place = next;
  const std::string file = py::str(place.attr("tb_frame").attr("f_code").attr("co_filename"));
  const std::string line = py::str(place.attr("tb_lineno"));
  return text + " (" + file.substr(file.rfind('/') + 1) + ", line " + line + ")";
}

double real_of(const py::handle& value) {
  const double number = PyFloat_AsDouble(value.ptr());
  if (number == -1 && PyErr_Occurred() != nullptr) throw py::error_already_set();
  return number;
}

int integer_of(const py::handle& value) {
  const long number = PyLong_AsLong(value.ptr());
  if (number == -1 && PyErr_Occurred() != nullptr) throw py::error_already_set();
  return static_cast<int>(
      std::clamp<long>(number, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
}

PythonSettings::PythonSettings(const std::string& subject, const py::list& settings) {
  for (const py::handle& setting : settings) all_.push_back(setting_of(setting, subject));
}

Parameters PythonSettings::parameters() {
  Parameters list;
  for (PythonSetting& s : all_)
    std::visit(
        [&](auto& value) {
          list.push_back({s.name, &value, s.low, s.high, s.help, s.is_live});
        },
        s.value);
  return list;
}

void PythonSettings::give_to(const py::object& object) const {
  for (const PythonSetting& setting : all_) {
    const py::object value = std::visit(
        []<class Value>(const Value& own) -> py::object {
          if constexpr (std::is_same_v<Value, Vec3>)
            return array_of(own);
          else
            return py::cast(own);
        },
        setting.value);
    object.attr(setting.name.c_str()) = value;
  }
}

PythonClass::PythonClass(std::string kind, std::string name, const py::object& type)
    : kind_(std::move(kind)), name_(std::move(name)), type_(*new py::object(type)) {
  type_name_ = py::str(type.attr("__name__"));
}

std::string PythonClass::subject(const char* method) const {
  return kind_ + " " + name_ + ": " + type_name_ + "." + method;
}

py::object PythonClass::object(const PythonSettings& settings, Init init, const py::dict& given) const {
  py::object object = type_.attr("__new__")(type_);
  settings.give_to(object);
  for (const auto& [name, value] : given) py::setattr(object, name, value);
  if (init == Init::called) object.attr("__init__")();
  return object;
}

}  // namespace remote_touch
