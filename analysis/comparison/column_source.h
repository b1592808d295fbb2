// Columns to compare: in a file, read one at a time as needed, or in memory.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_reader.h"

namespace remote_touch {

class ColumnSource {
 public:
  virtual ~ColumnSource() = default;
  virtual std::vector<std::string> column_names() const = 0;  // order: as stored and hashed
  virtual Column column(const std::string& name) const = 0;
  // Rows first .. first + count - 1; pre: they exist.
  virtual Column rows(const std::string& name, std::size_t first, std::size_t count) const = 0;

  bool has(const std::string& name) const;
};

// Columns below a group of a file.
class StoredColumns : public ColumnSource {
 public:
  std::vector<std::string> column_names() const override { return column_names_; }
  Column column(const std::string& name) const override { return hdf5_.column(group_ + name); }
  Column rows(const std::string& name, std::size_t first, std::size_t count) const override {
    return hdf5_.rows(group_ + name, first, count);
  }
  const TextAttributes& attributes() const { return hdf5_.attributes(); }

 protected:
  StoredColumns(Hdf5Reader hdf5, std::string group) : hdf5_(std::move(hdf5)), group_(std::move(group)) {}
  Hdf5Reader hdf5_;
  std::string group_;  // with a slash at its end
  std::vector<std::string> column_names_;
};

// Throws InputError for a file that is not a trace, has another version of the layout, or was changed since
// it was written.
class StoredTrace final : public StoredColumns {
 public:
  explicit StoredTrace(Hdf5Reader hdf5);
  explicit StoredTrace(const std::filesystem::path& file) : StoredTrace(Hdf5Reader(file)) {}
  std::vector<std::uint64_t> running_hash() const;  // kRunningHash
};

// The tables of a figure; columns are named table/column. Those of a figure of schema /2 have their present
// names.
class StoredFigure final : public StoredColumns {
 public:
  explicit StoredFigure(Hdf5Reader hdf5);
  Column column(const std::string& name) const override;
  Column rows(const std::string& name, std::size_t first, std::size_t count) const override;

 private:
  std::string stored_name(const std::string& name) const;
  std::vector<std::string> stored_names_;  // as in the file, in the order of column_names()
};

class ColumnsInMemory final : public ColumnSource {
 public:
  explicit ColumnsInMemory(std::vector<Column> columns) : all_(std::move(columns)) {}
  std::vector<std::string> column_names() const override { return names_of(all_); }
  Column column(const std::string& name) const override { return find(name); }
  Column rows(const std::string& name, std::size_t first, std::size_t count) const override;

 private:
  const Column& find(const std::string& name) const;
  std::vector<Column> all_;
};

}  // namespace remote_touch
