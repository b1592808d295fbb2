// Tables as text, for spreadsheets, R and pandas.
#pragma once

#include <string>

#include "analysis/trace/column.h"
#include "runners/presentation/export/export_job.h"

namespace remote_touch {

// x.csv, or x_NAME.csv for each of several tables, with one line of names; and x_columns.csv, a line for each
// of those names: table, column, unit, meaning. Lines end with a line feed.
void write_csv(const ExportJob& job);

// Vectors as name_x, name_y, name_z.
std::string csv_header(const Table& table);
// Rows first .. end - 1. Numbers as the shortest text that reads back as the same bits; nan, inf, -inf;
// enumerations by the names of their values; texts in quotes where they need it (RFC 4180).
std::string csv_rows(const Table& table, std::size_t first, std::size_t end);

}  // namespace remote_touch
