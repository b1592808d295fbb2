// Tables as text, for spreadsheets, R and pandas.
#pragma once

#include <string>
#include <vector>

#include "analysis/trace/column.h"
#include "runners/presentation/export/export_job.h"

namespace remote_touch {

// Writes x.csv, or x_NAME.csv for each of several tables, with one line of names. Also writes x_columns.csv
// with a line for each of these names: table, column, unit, meaning. Lines end with a line feed.
void write_csv(const ExportJob& job);
// The same with these tables instead of those of the result.
void write_csv(const std::vector<Table>& tables, const ExportJob& job);

// Returns the line of names. The names of a vector are name_x, name_y, name_z.
std::string csv_header(const Table& table);
// Returns the rows first .. end - 1. Numbers are the shortest text that is read back as the same bits, or
// nan, inf, -inf. Enumerations have the names of their values. Texts are in quotes if they need them (RFC
// 4180).
std::string csv_rows(const Table& table, std::size_t first, std::size_t end);

}  // namespace remote_touch
