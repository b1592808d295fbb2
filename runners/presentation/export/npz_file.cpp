#include "runners/presentation/export/npz_file.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/parameters/input_error.h"
#include "runners/presentation/export/npy_array.h"
#include "runners/presentation/export/result_tables.h"
#include "runners/presentation/export/zip_archive.h"
#include "scenarios/text_files/text_file.h"

namespace remote_touch {

namespace {

constexpr const char* kFormat = "format.npy";

std::string member_of(const std::vector<Table>& tables, const Table& table, const Column& column) {
  return (tables.size() > 1 ? table.name + "/" : "") + column.name;
}

std::string about(const ExportJob& job, const std::vector<Table>& tables) {
  Json attributes = Json::object(), members = Json::object();
  for (const auto& [name, value] : exported_attributes(job.result, tables)) attributes[name] = value;
  for (const Table& table : tables)
    for (const Column& column : table.columns)
      members[member_of(tables, table, column)] = {
          {"unit", column.units}, {"meaning", column.long_name}, {"names", column.value_names}};
  const Json all{{"attributes", std::move(attributes)}, {"members", std::move(members)}};
  return all.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

void write_npz(const ExportJob& job) try {
  const std::vector<Table> tables = result_tables(job.result);
  const std::string format = npy_text("remote-touch export 1");
  job.begin(job.output, ZipArchive::opening(kFormat, format));
  ZipArchive archive([&](const std::string& bytes) { job.files.append(bytes); });
  archive.add(kFormat, format);
  archive.add("about.npy", npy_text(about(job, tables)));
  for (const Table& table : tables)
    for (const Column& column : table.columns) {
      job.go_on();
      archive.add(member_of(tables, table, column) + ".npy", npy_array(column));
    }
  archive.finish();
} catch (const std::length_error& limit) {
  throw InputError(job.output.string(), std::string(limit.what()) + ": expected .csv for so large a result");
}

}  // namespace remote_touch
