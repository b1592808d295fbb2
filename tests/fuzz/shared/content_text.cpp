#include "tests/fuzz/shared/content_text.h"

#include <charconv>
#include <sstream>
#include <stdexcept>

namespace remote_touch::fuzz {

namespace {

template <class Number>
std::vector<Number> numbers_in(std::istream& words) {
  std::vector<Number> numbers;
  for (std::string word; words >> word;) {
    Number number{};
    std::from_chars(word.data(), word.data() + word.size(), number);
    numbers.push_back(number);
  }
  return numbers;
}

std::vector<std::string> parts_of(const std::string& list) {
  std::vector<std::string> parts;
  std::istringstream text(list);
  for (std::string part; std::getline(text, part, ',');) parts.push_back(part);
  return parts;
}

Values values_in(const std::string& type, std::istream& words) {
  if (type == "f64") return numbers_in<double>(words);
  if (type == "u64") return numbers_in<std::uint64_t>(words);
  if (type != "text") return numbers_in<std::int32_t>(words);
  std::vector<std::string> texts;
  for (std::string word; words >> word;) texts.push_back(word == "-" ? "" : word);
  return texts;
}

void add_dataset(const std::string& line, Content& content) {
  std::istringstream words(line);
  std::string path, type;
  Column column;
  if (!(words >> path >> type >> column.width)) return;
  const std::size_t colon = type.find(':');
  if (colon != std::string::npos) column.value_names = parts_of(type.substr(colon + 1));
  column.values = values_in(type.substr(0, colon), words);
  const std::size_t count = std::visit([](const auto& values) { return values.size(); }, column.values);
  if (column.width < 1 || count % static_cast<std::size_t>(column.width) != 0) return;
  column.name = path.substr(path.rfind('/') + 1);
  content.datasets[path] = column;
}

class ContentSource final : public Hdf5Source {
 public:
  explicit ContentSource(Content content) : content_(std::move(content)) {}
  TextAttributes attributes() const override { return content_.attributes; }
  std::vector<std::string> datasets() const override {
    std::vector<std::string> names;
    for (const auto& [name, column] : content_.datasets) names.push_back(name);
    return names;
  }
  Column column(const std::string& dataset) const override { return found(dataset); }
  Column rows(const std::string& dataset, std::size_t first, std::size_t count) const override {
    Column column = found(dataset);
    if (first > column.length() || count > column.length() - first)
      throw std::runtime_error(dataset + " has no such rows");
    const auto width = static_cast<std::size_t>(column.width);
    std::visit(
        [&](auto& values) {
          const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first * width);
          values = {begin, begin + static_cast<std::ptrdiff_t>(count * width)};
        },
        column.values);
    return column;
  }
  std::int64_t offset(const std::string& dataset) const override {
    throw std::runtime_error(found(dataset).name + " is not stored in one piece");
  }

 private:
  const Column& found(const std::string& dataset) const {
    const auto place = content_.datasets.find(dataset);
    if (place == content_.datasets.end()) throw std::runtime_error(dataset + " is missing");
    return place->second;
  }
  Content content_;
};

}  // namespace

Content content_of(std::string_view text) {
  Content content;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) {
    const std::size_t blank = line.find(' ');
    if (line.starts_with('/'))
      add_dataset(line, content);
    else if (blank != std::string::npos)
      content.attributes.emplace_back(line.substr(0, blank), line.substr(blank + 1));
  }
  return content;
}

Hdf5Reader reader_of(Content content) {
  return {"fuzz.h5", std::make_shared<ContentSource>(std::move(content))};
}

std::pair<std::string_view, std::string_view> two_parts(std::string_view text) {
  constexpr std::string_view kBetween = "\n---\n";
  const std::size_t end = text.find(kBetween);
  if (end == std::string_view::npos) return {text, text};
  return {text.substr(0, end), text.substr(end + kBetween.size())};
}

}  // namespace remote_touch::fuzz
