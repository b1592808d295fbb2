#include "analysis/trace/renamed_columns.h"

#include <string_view>

namespace remote_touch {

namespace {

struct RenamedColumn {
  std::string_view old_name, new_name;  // the end of the name if it begins with _
};
constexpr RenamedColumn kRenamedColumns[] = {
    {"_all_lost", "_all_lost"},  // not the column _lost
    {"_least", "_bound_low"},
    {"_lost", "_first_lost"},
    {"_most", "_bound_high"},
    {"_stray_torque", "_torque_error"},
    {"apart", "difference_in_standard_errors"},
    {"right", "found"},
    {"second", "second_implementation"},
    {"shown", "significant"},
};

bool is_old_name(const RenamedColumn& renamed, std::string_view column) {
  return renamed.old_name.starts_with('_') ? column.ends_with(renamed.old_name) : column == renamed.old_name;
}

}  // namespace

std::string present_column(const std::string& name) {
  const std::size_t begin = name.rfind('/') + 1;  // 0 if there is no table
  const std::string_view column = std::string_view(name).substr(begin);
  for (const RenamedColumn& renamed : kRenamedColumns)
    if (is_old_name(renamed, column))
      return name.substr(0, name.size() - renamed.old_name.size()) + std::string(renamed.new_name);
  return name;
}

}  // namespace remote_touch
