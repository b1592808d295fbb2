// The content of result files as tables for other programs.
#include "runners/presentation/export_formats.h"
#include "tests/fuzz/shared/content_text.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::export_tables {
namespace {

void read(std::string_view bytes) {
  const Content content = content_of(bytes);
  accepts(bytes, [&] {
    for (const Table& table : result_tables(reader_of(content))) {
      const std::string header = csv_header(table);
      const std::string lines = csv_rows(table, 0, table.columns.front().length());
      require(header.ends_with('\n') && (lines.empty() || lines.ends_with('\n')), "lines end");
      for (const Column& column : table.columns)
        require(npy_array(column).size() % 2 == 0, "an array of numbers or of characters of four bytes");
    }
  });
}

const Registered registered("export", read);

}  // namespace
}  // namespace remote_touch::fuzz::export_tables
