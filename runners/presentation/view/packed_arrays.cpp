#include "runners/presentation/view/packed_arrays.h"

#include <nlohmann/json.hpp>

namespace remote_touch {

Json json_of(const PackedArray& array) {
  return {{"at", array.at}, {"type", array.type}, {"length", array.length}};
}

}  // namespace remote_touch
