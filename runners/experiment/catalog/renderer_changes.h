// Settings of a renderer that change during a run: the section `changes` of an experiment.
#pragma once

#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

// A change takes effect in the first tick at or after its time, before that tick's frame. Changes of the same
// time take effect together. Two changes of one parameter in one tick are refused.
struct RendererChange {
  double time_s = 0;
  std::string parameter;  // "renderer.stiffness_N_per_m"; one that is marked live
  double value = 0;       // 0 or 1 for a switch
};

Parameters parameters(RendererChange& change);
inline std::string validate(const RendererChange&) {
  return {};
}

// The name that a parameter of a renderer has in changes.
inline std::string name_in_changes(const Parameter& parameter) {
  return "renderer." + parameter.name;
}
// Returns the parameter that has this name in changes; null if there is none.
const Parameter* find_in_changes(const Parameters& live, const std::string& name);

// pre: a number or a switch, as all live parameters are. Allocates nothing.
void set_number(const Parameter& parameter, double value);
double number_of(const Parameter& parameter);

// Makes the changes of an experiment while it runs.
class RendererChanges {
 public:
  // pre: the changes are sorted by time and name live parameters of the renderer, which outlives this.
  RendererChanges(const std::vector<RendererChange>& changes, Renderer& renderer);
  // Makes the changes that are due at time_s.
  void make_until(double time_s);

 private:
  struct Change {
    double time_s;
    Parameter parameter;
    double value;
  };
  Renderer& renderer_;
  std::vector<Change> changes_;
  std::size_t next_ = 0;
};

}  // namespace remote_touch
