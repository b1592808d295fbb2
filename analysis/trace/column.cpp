#include "analysis/trace/column.h"

#include <sstream>
#include <stdexcept>

namespace remote_touch {

std::vector<std::string> names_of(const std::vector<Column>& columns) {
  std::vector<std::string> names;
  for (const Column& column : columns) names.push_back(column.name);
  return names;
}

std::string joined(const std::vector<std::string>& names, const char* separator) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : separator) + name;
  return all;
}

std::vector<std::string> split_names(const std::string& joined) {
  std::vector<std::string> list;
  std::istringstream text(joined);
  text.exceptions(std::ios::badbit);  // throws if memory runs out, instead of ending the list early
  for (std::string name; std::getline(text, name, ',');) list.push_back(name);
  return list;
}

const std::vector<double>& numbers(const Table& table, const std::string& column) {
  for (const Column& candidate : table.columns)
    if (candidate.name == column) return std::get<std::vector<double>>(candidate.values);
  throw std::out_of_range(table.name + " has no column " + column);
}

}  // namespace remote_touch
