// Reports of what a command found: one tree of lines, values, tables and sections. Three writers print it:
// text for people, JSON for programs, and JUnit's XML for build servers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace remote_touch {

// A value for programs. No value (monostate) and numbers that are not finite are null in JSON.
struct ReportValue : std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, std::string,
                                  std::vector<ReportValue>> {
  using variant::variant;
  ReportValue(int number) : variant(std::int64_t{number}) {}
  template <class Number>
  ReportValue(const std::optional<Number>& value) {
    if (value) *this = ReportValue(*value);
  }
};

// Returns the elements as one value.
template <class List>
ReportValue list_of(const List& elements) {
  return std::vector<ReportValue>(elements.begin(), elements.end());
}

// One test case and its result.
struct ReportCase {
  enum class State { passed, failed, error, skipped };
  std::string name;
  State state = State::passed;
  std::string text = {};  // why it did not pass
};

// A row of a table.
struct ReportRow {
  struct Cell {
    std::string key;      // its name in JSON; empty: only people see the cell
    std::string heading;  // its column in the text, up to two lines; empty: only programs see the cell
    ReportValue value;
    std::string text;
  };
  std::vector<Cell> cells = {};
  bool is_shown = true;                   // false: only programs see the row
  std::optional<ReportCase> result = {};  // a row may be a test case

  // Adds a cell for people and programs. The text of a number without one has six digits.
  ReportRow& add(std::string key, std::string heading, ReportValue value);
  ReportRow& add(std::string key, std::string heading, ReportValue value, std::string text);
  // Adds a cell for people; a value that is a number puts its text at the right of the column.
  ReportRow& show(std::string heading, std::string text, ReportValue value = {});
  // Adds a cell for programs.
  ReportRow& tell(std::string key, ReportValue value);
};

// A table: in JSON a list of objects, which is left out if it is empty.
struct ReportTable {
  std::string key = {};  // its name in JSON; empty: only people see the table
  std::string indent = "  ";
  bool has_headings = true;
  std::vector<ReportRow> rows = {};

  // Columns are as wide as their widest text, two blanks apart. Numbers stand at the right, texts at the
  // left. Control characters are escaped, see printable(). Empty if no row is shown.
  std::string text() const;
};

class Report {
 public:
  void line(const std::string& text);             // people read it; a line break is added
  void tell(std::string key, ReportValue value);  // programs read it; replaces the value of this key
  void add(ReportCase one);                       // build servers read it
  void add(ReportTable table);                    // all three read it
  // Adds an object of this name for programs; people read its lines and tables here.
  void add(std::string key, Report section);

  std::string text() const;
  std::string json() const;  // an object; ends with a line break
  std::vector<ReportCase> cases() const;

 private:
  friend struct ReportJson;
  struct Part {
    std::string key = {}, line = {};
    std::optional<ReportValue> value = {};
    std::optional<ReportTable> table = {};
    std::vector<Report> section = {};  // none or one
    std::optional<ReportCase> result = {};
  };
  std::vector<Part> parts_;
};

// Returns the reports as one list.
std::string json_of(const std::vector<Report>& reports);

struct ReportSuite {
  std::string name;
  std::vector<ReportCase> cases = {};
};
std::string junit(const std::vector<ReportSuite>& suites);

}  // namespace remote_touch
