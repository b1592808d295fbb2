#include "analysis/report/report.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <type_traits>
#include <utility>

#include "core/parameters/parameter.h"

namespace remote_touch {

namespace {

using Json = nlohmann::ordered_json;

bool is_number(const ReportValue& value) {
  return std::holds_alternative<std::int64_t>(value) || std::holds_alternative<std::uint64_t>(value) ||
         std::holds_alternative<double>(value);
}

std::string plain_text(const ReportValue& value) {
  if (const auto* const text = std::get_if<std::string>(&value)) return *text;
  if (const auto* const number = std::get_if<std::int64_t>(&value)) return std::to_string(*number);
  if (const auto* const number = std::get_if<std::uint64_t>(&value)) return std::to_string(*number);
  const auto* const number = std::get_if<double>(&value);
  return number ? formatted("%.6g", *number) : "";
}

Json to_json(const ReportValue& value) {
  return std::visit(
      [](const auto& of) -> Json {
        using Value = std::decay_t<decltype(of)>;
        if constexpr (std::is_same_v<Value, std::monostate>) {
          return nullptr;
        } else if constexpr (std::is_same_v<Value, std::vector<ReportValue>>) {
          Json list = Json::array();
          for (const ReportValue& each : of) list.push_back(to_json(each));
          return list;
        } else {
          return of;
        }
      },
      static_cast<const ReportValue::variant&>(value));
}

Json to_json(const ReportRow& row) {
  Json object = Json::object();
  for (const ReportRow::Cell& cell : row.cells)
    if (!cell.key.empty()) object[cell.key] = to_json(cell.value);
  return object;
}

// Bytes of names that are not UTF-8 are replaced.
std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

// Returns the number of characters of a text; the bytes that continue a character of UTF-8 take no place.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

// One column of a table as people see it.
struct TextColumn {
  std::string heading;
  std::vector<std::string> texts;
  bool is_right = false;
};

// Returns the columns of the rows that are shown. All rows have the same cells.
std::vector<TextColumn> shown_columns(const std::vector<ReportRow>& rows) {
  std::vector<TextColumn> columns;
  for (const ReportRow& row : rows) {
    if (!row.is_shown) continue;
    std::size_t place = 0;
    for (const ReportRow::Cell& cell : row.cells) {
      if (cell.heading.empty()) continue;
      if (place == columns.size()) columns.push_back({cell.heading, {}});
      columns[place].texts.push_back(printable(cell.text));
      columns[place++].is_right |= is_number(cell.value);
    }
  }
  return columns;
}

// Puts the heading, in as many lines as the tallest one has, above the texts.
void add_heading(TextColumn& column, std::size_t height) {
  std::istringstream lines(column.heading);
  std::vector<std::string> heading(height);
  for (std::string& line : heading) std::getline(lines, line);
  column.texts.insert(column.texts.begin(), heading.begin(), heading.end());
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    // XML has no control characters, and bytes outside ASCII may not be UTF-8: both become '?'.
    const bool is_plain = static_cast<unsigned char>(c) >= 0x20 && static_cast<unsigned char>(c) <= 0x7e;
    safe += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : is_plain ? std::string(1, c) : "?";
  }
  return safe;
}

std::string case_xml(const ReportSuite& suite, const ReportCase& one) {
  constexpr const char* kElements[] = {"", "failure", "error", "skipped"};
  std::string xml =
      "    <testcase classname=\"" + escaped(suite.name) + "\" name=\"" + escaped(one.name) + "\"";
  if (one.state == ReportCase::State::passed) return xml + "/>\n";
  return xml + "><" + kElements[static_cast<int>(one.state)] + " message=\"" + escaped(one.text) +
         "\"/></testcase>\n";
}

std::string count(const ReportSuite& suite, ReportCase::State state) {
  return std::to_string(std::count_if(suite.cases.begin(), suite.cases.end(),
                                      [&](const ReportCase& one) { return one.state == state; }));
}

}  // namespace

ReportRow& ReportRow::add(std::string key, std::string heading, ReportValue value) {
  std::string text = plain_text(value);
  return add(std::move(key), std::move(heading), std::move(value), std::move(text));
}

ReportRow& ReportRow::add(std::string key, std::string heading, ReportValue value, std::string text) {
  cells.push_back({std::move(key), std::move(heading), std::move(value), std::move(text)});
  return *this;
}

ReportRow& ReportRow::show(std::string heading, std::string text, ReportValue value) {
  return add("", std::move(heading), std::move(value), std::move(text));
}

ReportRow& ReportRow::tell(std::string key, ReportValue value) {
  return add(std::move(key), "", std::move(value), "");
}

std::string ReportTable::text() const {
  std::vector<TextColumn> columns = shown_columns(rows);
  if (columns.empty()) return {};
  std::size_t height = 1;
  for (const TextColumn& column : columns)
    height = std::max<std::size_t>(height, 1 + std::ranges::count(column.heading, '\n'));
  std::vector<std::string> lines;
  for (TextColumn& column : columns) {
    if (has_headings) add_heading(column, height);
    std::size_t width = 0;
    for (const std::string& text : column.texts) width = std::max(width, width_of(text));
    lines.resize(column.texts.size(), indent);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const std::string blanks(width - width_of(column.texts[i]), ' ');
      lines[i] += (column.is_right ? blanks + column.texts[i] : column.texts[i] + blanks) + "  ";
    }
  }
  std::string all;
  for (const std::string& line : lines) all += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  return all;
}

void Report::line(const std::string& text) {
  if (!text.empty()) parts_.push_back({.line = text + "\n"});
}

void Report::tell(std::string key, ReportValue value) {
  for (Part& part : parts_)
    if (part.value && part.key == key) {
      part.value = std::move(value);
      return;
    }
  parts_.push_back({.key = std::move(key), .value = std::move(value)});
}

void Report::add(ReportCase one) {
  parts_.push_back({.result = std::move(one)});
}

void Report::add(ReportTable table) {
  std::string key = table.key;
  parts_.push_back({.key = std::move(key), .table = std::move(table)});
}

void Report::add(std::string key, Report section) {
  parts_.push_back({.key = std::move(key), .section = {std::move(section)}});
}

std::string Report::text() const {
  std::string all;
  for (const Part& part : parts_) {
    all += part.line;
    if (part.table) all += part.table->text();
    for (const Report& section : part.section) all += section.text();
  }
  return all;
}

std::vector<ReportCase> Report::cases() const {
  std::vector<ReportCase> all;
  const auto add = [&](const std::optional<ReportCase>& one) {
    if (one) all.push_back(*one);
  };
  for (const Part& part : parts_) {
    add(part.result);
    if (part.table)
      for (const ReportRow& row : part.table->rows) add(row.result);
    for (const Report& section : part.section)
      for (const ReportCase& one : section.cases()) add(one);
  }
  return all;
}

struct ReportJson {
  static Json of(const Report& report) {
    Json object = Json::object();
    for (const Report::Part& part : report.parts_) {
      if (part.value) object[part.key] = to_json(*part.value);
      if (part.table && !part.key.empty())
        for (const ReportRow& row : part.table->rows) object[part.key].push_back(to_json(row));
      for (const Report& section : part.section) object[part.key] = of(section);
    }
    return object;
  }
};

std::string Report::json() const {
  return text_of(ReportJson::of(*this));
}

std::string json_of(const std::vector<Report>& reports) {
  Json list = Json::array();
  for (const Report& report : reports) list.push_back(ReportJson::of(report));
  return text_of(list);
}

std::string junit(const std::vector<ReportSuite>& suites) {
  using Result = ReportCase::State;
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
  for (const ReportSuite& suite : suites) {
    xml += "  <testsuite name=\"" + escaped(suite.name) + "\" tests=\"" + std::to_string(suite.cases.size()) +
           "\" failures=\"" + count(suite, Result::failed) + "\" errors=\"" + count(suite, Result::error) +
           "\" skipped=\"" + count(suite, Result::skipped) + "\">\n";
    for (const ReportCase& one : suite.cases) xml += case_xml(suite, one);
    xml += "  </testsuite>\n";
  }
  return xml + "</testsuites>\n";
}

}  // namespace remote_touch
