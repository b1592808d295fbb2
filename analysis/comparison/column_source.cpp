#include "analysis/comparison/column_source.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "analysis/figures/result_file.h"
#include "analysis/storage/schema.h"
#include "analysis/trace/hash64.h"
#include "analysis/trace/renamed_columns.h"

namespace remote_touch {

bool ColumnSource::has(const std::string& name) const {
  const std::vector<std::string> names = column_names();
  return std::find(names.begin(), names.end(), name) != names.end();
}

StoredTrace::StoredTrace(Hdf5Reader hdf5) : StoredColumns(std::move(hdf5), "/trace/") {
  hdf5_.require_kind("trace", "a trace of remote-touch run or replay");
  column_names_ = split_names(attribute(hdf5_.attributes(), "columns"));
}

std::vector<std::uint64_t> StoredTrace::running_hash() const {
  return hdf5_.values<std::uint64_t>(group_ + kRunningHash);
}

StoredFigure::StoredFigure(Hdf5Reader hdf5) : StoredColumns(std::move(hdf5), "/tables/") {
  hdf5_.require_kind("figure", "a figure of remote-touch figure");
  for (const std::string& path : hdf5_.datasets())
    if (path.starts_with(group_)) stored_names_.push_back(path.substr(group_.size()));
  const bool is_earlier = is_earlier_schema(attribute(hdf5_.attributes(), "schema"));
  for (const std::string& name : stored_names_)
    column_names_.push_back(is_earlier ? present_column(name) : name);
}

// Returns the name as it is if the file has no such column; reading it then fails.
std::string StoredFigure::stored_name(const std::string& name) const {
  const auto found = std::find(column_names_.begin(), column_names_.end(), name);
  return found == column_names_.end()
             ? name
             : stored_names_[static_cast<std::size_t>(found - column_names_.begin())];
}

Column StoredFigure::column(const std::string& name) const {
  Column whole = StoredColumns::column(stored_name(name));
  whole.name = name.substr(name.rfind('/') + 1);
  return whole;
}

Column StoredFigure::rows(const std::string& name, std::size_t first, std::size_t count) const {
  Column some = StoredColumns::rows(stored_name(name), first, count);
  some.name = name.substr(name.rfind('/') + 1);
  return some;
}

const Column& ColumnsInMemory::find(const std::string& name) const {
  for (const Column& column : all_)
    if (column.name == name) return column;
  throw std::out_of_range("no column " + name);
}

Column ColumnsInMemory::rows(const std::string& name, std::size_t first, std::size_t count) const {
  Column some = find(name);
  const auto width = static_cast<std::ptrdiff_t>(some.width);
  std::visit(
      [&](auto& values) {
        const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first) * width;
        values = std::decay_t<decltype(values)>(begin, begin + static_cast<std::ptrdiff_t>(count) * width);
      },
      some.values);
  return some;
}

}  // namespace remote_touch
