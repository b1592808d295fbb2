#include "runners/evaluation/verification/dimension.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <sstream>

#include "core/parameters/input_error.h"

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

}  // namespace remote_touch
