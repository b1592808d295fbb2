#include "analysis/storage/hdf5_child_source.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "analysis/storage/packed_values.h"

namespace remote_touch {

namespace {

[[noreturn]] void no_answer() {
  throw std::runtime_error("its reader sent an incomplete answer");
}

// Unpacks values of the wanted kind, which is an index of the variant Values.
template <std::size_t kind = 0>
void unpack_values(Unpacker& unpack, std::size_t wanted, Values& values) {
  if constexpr (kind < std::variant_size_v<Values>) {
    if (wanted != kind) return unpack_values<kind + 1>(unpack, wanted, values);
    unpack.list(values.emplace<kind>());
  } else {
    no_answer();
  }
}

std::int64_t offset_or_none(const Hdf5Source& source, const std::string& dataset) {
  try {
    return source.offset(dataset);
  } catch (const std::runtime_error&) {
    return -1;
  }
}

Hdf5Summary summary_of(const Hdf5Source& source) {
  Hdf5Summary summary{source.attributes(), source.datasets(), {}};
  for (const std::string& dataset : summary.datasets)
    summary.offsets.push_back(offset_or_none(source, dataset));
  return summary;
}

enum class About : std::uint8_t { summary, column, rows };

// Question to a child about a file.
struct Question {
  About about = About::summary;
  std::string dataset = {};
  std::size_t first = 0, count = 0;  // rows
};

std::string packed_question(const std::string& file, const Question& question) {
  MemoryPacker pack;
  pack.text(file), pack.value(question.about), pack.text(question.dataset);
  pack.value(question.first), pack.value(question.count);
  return pack.take();
}

// Runs in the child: returns the packed answer to a packed question.
std::string answer(const std::string& bytes) {
  Unpacker unpack(bytes);
  std::string file;
  Question question;
  unpack.text(file), unpack.value(question.about), unpack.text(question.dataset);
  unpack.value(question.first), unpack.value(question.count);
  const auto hdf5 = open_hdf5(file);
  switch (question.about) {
    case About::summary:
      return packed(summary_of(*hdf5));
    case About::column:
      return packed(hdf5->column(question.dataset));
    case About::rows:
      break;
  }
  return packed(hdf5->rows(question.dataset, question.first, question.count));
}

class ChildSource final : public Hdf5Source {
 public:
  ChildSource(const std::filesystem::path& file, RunInChild run)
      : file_(file.string()),
        run_(std::move(run)),
        // The values are in memory twice, as read and packed, and some files are slightly compressed.
        limits_(limits_to_read(file, 4)),
        summary_(unpacked_summary(ask({}))) {}

  TextAttributes attributes() const override { return summary_.attributes; }
  std::vector<std::string> datasets() const override { return summary_.datasets; }
  Column column(const std::string& dataset) const override {
    return unpacked_column(ask({About::column, dataset}));
  }
  Column rows(const std::string& dataset, std::size_t first, std::size_t count) const override {
    return unpacked_column(ask({About::rows, dataset, first, count}));
  }
  std::int64_t offset(const std::string& dataset) const override {
    const auto found = std::find(summary_.datasets.begin(), summary_.datasets.end(), dataset);
    if (found == summary_.datasets.end()) throw std::runtime_error(dataset + " is missing");
    const std::int64_t offset = summary_.offsets[static_cast<std::size_t>(found - summary_.datasets.begin())];
    if (offset < 0) throw std::runtime_error(dataset + " is not stored in one piece");
    return offset;
  }

 private:
  std::string ask(const Question& question) const {
    return run_(limits_, answer, packed_question(file_, question));
  }

  std::string file_;
  RunInChild run_;
  ChildLimits limits_;
  Hdf5Summary summary_;
};

}  // namespace

std::string packed(const Hdf5Summary& summary) {
  MemoryPacker pack;
  pack.value(summary.attributes.size());
  for (const auto& [name, value] : summary.attributes) pack.text(name), pack.text(value);
  pack.list(summary.datasets), pack.list(summary.offsets);
  return pack.take();
}

Hdf5Summary unpacked_summary(const std::string& bytes) {
  Unpacker unpack(bytes);
  Hdf5Summary summary;
  std::size_t count = 0;
  unpack.value(count);
  for (std::size_t i = 0; i < count && unpack.good(); ++i) {
    auto& [name, value] = summary.attributes.emplace_back();
    unpack.text(name), unpack.text(value);
  }
  unpack.list(summary.datasets), unpack.list(summary.offsets);
  if (!unpack.done() || summary.offsets.size() != summary.datasets.size()) no_answer();
  return summary;
}

std::string packed(const Column& column) {
  MemoryPacker pack;
  pack.text(column.name), pack.text(column.units), pack.text(column.long_name);
  pack.value(column.width), pack.list(column.value_names);
  pack.value(column.values.index());
  std::visit([&](const auto& values) { pack.list(values); }, column.values);
  return pack.take();
}

Column unpacked_column(const std::string& bytes) {
  Unpacker unpack(bytes);
  Column column;
  std::size_t kind = 0;
  unpack.text(column.name), unpack.text(column.units), unpack.text(column.long_name);
  unpack.value(column.width), unpack.list(column.value_names);
  unpack.value(kind);
  unpack_values(unpack, kind, column.values);
  const auto count = std::visit([](const auto& values) { return values.size(); }, column.values);
  if (!unpack.done() || column.width < 1 || count % static_cast<std::size_t>(column.width) != 0) no_answer();
  return column;
}

std::unique_ptr<Hdf5Source> open_hdf5_in_child(const std::filesystem::path& file, const RunInChild& run) {
  return std::make_unique<ChildSource>(file, run);
}

}  // namespace remote_touch
