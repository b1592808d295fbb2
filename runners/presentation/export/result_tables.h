// The tables of a stored result, as they are exported.
#pragma once

#include <string>
#include <vector>

#include "analysis/storage/hdf5_reader.h"
#include "analysis/trace/column.h"
#include "runners/presentation/export/export_formats.h"

namespace remote_touch {

// "trace", "sweep" or "figure"; the table of a scorecard is a figure. Throws InputError for anything else.
std::string exported_kind(const Hdf5Reader& result);

// A trace has one table, a row for each tick, with step_duration if it was measured.
// A sweep has one table, a row for each run: its value on each axis, replicate if there are several, state,
// the measures, round with refinement, notes if there are any, and error.
// A figure has its own tables.
// The columns of each table have the same length. Throws InputError for a file that is damaged.
std::vector<Table> result_tables(const Hdf5Reader& result);

// Returns the root attributes of the result, with the names of axes in its tables.
TextAttributes exported_attributes(const Hdf5Reader& result, const std::vector<Table>& tables);

// Returns the names of the numbers in a row: force_x, force_y, force_z. The endings of a quaternion are w, x,
// y, z, and those of another width 0, 1, ... A column of width 1 has its own name.
std::vector<std::string> component_names(const Column& column);

// Writes tables as text, for spreadsheets, R and pandas: x.csv, or x_NAME.csv for each of several tables,
// with one line of names. Also writes x_columns.csv with a line for each of these names: table, column, unit,
// meaning. Lines end with a line feed.
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
