// A measure of the table, by its name.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "analysis/trace/measures.h"

namespace remote_touch {

inline const Measure& measure_named(const std::string& name) {
  for (const Measure& each : built_in_measures())
    if (each.name == name) return each;
  ADD_FAILURE() << "no measure " << name;
  return built_in_measures().front();
}

}  // namespace remote_touch
