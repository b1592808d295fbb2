// The arrays in which a tally is stored. For tally_file.cpp only.
#pragma once

#include <string>
#include <vector>

#include "analysis/sweeps/sweep_tally.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

// The names of all columns are paths below /tally.
struct TallyArrays {
  struct Array {
    Column column;
    std::vector<std::string> axes;  // names of scales, the last runs fastest
  };
  struct Group {
    std::string name;
    std::vector<Column> columns;  // columns of equal length; their names are within the group
  };
  std::vector<Column> scales;
  std::vector<Array> arrays;
  std::vector<Group> groups;
};

// Names that no axis and no measure may have in a file of tallies.
bool is_taken_in_tallies(const std::string& name);

TallyArrays arrays_of(const SweepTally& tally);

}  // namespace remote_touch
