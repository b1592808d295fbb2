#include "tests/support/result_files.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <variant>
#include <vector>

#include "analysis/trace/trace.h"

namespace remote_touch {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr double kAwkward[] = {
    0.0,       -0.0,       0.1,  1.0 / 3,           -1e308, 5e-324, 2.2250738585072014e-308,
    kInfinity, -kInfinity, kNan, 1.0000000000000002};

}  // namespace

const TextAttributes kProvenance = {{"config", R"({"title": "gr\u00fcn", "seed": 1})"},
                                    {"command", "remote-touch run x --set seed=1"},
                                    {"isa", "x86-64"},
                                    {"empty", ""},
                                    {"umlaut", "grün"}};

Trace awkward_trace(int ticks) {
  Trace trace;
  std::size_t next = 0;
  const auto number = [&] { return kAwkward[next++ % std::size(kAwkward)]; };
  const auto vector = [&] { return Vec3(number(), number(), number()); };
  for (int i = 0; i < ticks; ++i) {
    RenderOutput out;
    out.proxy_W = vector(), out.force_N = vector(), out.normal_W = vector();
    out.state = static_cast<ContactState>(i % 3), out.status = static_cast<RenderStatus>(i % 5);
    out.steps = i, out.converged = i % 2 == 0;
    out.contact_count = std::numeric_limits<int>::max() - i, out.frame_index = i / 33 - 1;
    out.surface_velocity_m_per_s = number(), out.nearest_distance_m = number();
    out.slave_W = vector();
    trace.append(0.001 * i, {vector()}, out, {number(), number(), 0});
  }
  return trace;
}

bool same_bits(const Column& a, const Column& b) {
  if (a.values.index() != b.values.index() || a.width != b.width) return false;
  if (const auto* x = std::get_if<std::vector<double>>(&a.values)) {
    const auto& y = std::get<std::vector<double>>(b.values);
    return std::equal(x->begin(), x->end(), y.begin(), y.end(), [](double p, double q) {
      return std::bit_cast<std::uint64_t>(p) == std::bit_cast<std::uint64_t>(q);
    });
  }
  return a.values == b.values;
}

const Column* find(const Hdf5Content& content, const std::string& path) {
  for (const auto& [name, column] : content.datasets)
    if (name == path) return &column;
  return nullptr;
}

std::string attribute(const Hdf5Content& content, const std::string& wanted) {
  for (const auto& [name, value] : content.attributes)
    if (name == wanted) return value;
  return "no attribute " + wanted;
}

}  // namespace remote_touch
