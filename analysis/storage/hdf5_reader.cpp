#include "analysis/storage/hdf5_reader.h"

#include <fcntl.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <fstream>
#include <new>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/block_journal.h"
#include "analysis/storage/digest.h"
#include "analysis/storage/hdf5_file.h"
#include "analysis/storage/hdf5_values.h"
#include "analysis/storage/other_processes.h"
#include "core/parameters/parameter.h"

namespace remote_touch {
namespace {

// An exception must not pass through the library, so an error code is returned.
herr_t note_dataset(hid_t, const char* name, const H5O_info_t* info, void* names) noexcept try {
  if (info->type == H5O_TYPE_DATASET)
    static_cast<std::vector<std::string>*>(names)->push_back(std::string("/") + name);
  return 0;
} catch (const std::bad_alloc&) {
  errno = ENOMEM;
  return -1;
}

std::string last_part(const std::string& path) {
  return path.substr(path.rfind('/') + 1);
}

std::string name_of_attribute(hid_t attribute) {
  const ssize_t length = H5Aget_name(attribute, 0, nullptr);
  if (length < 0) throw_refusal();
  std::string name(static_cast<std::size_t>(length), '\0');
  if (H5Aget_name(attribute, name.size() + 1, name.data()) < 0) throw_refusal();
  return name;
}

class LibrarySource final : public Hdf5Source {
 public:
  explicit LibrarySource(const std::string& file)
      : file_(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose) {}

  TextAttributes attributes() const override {
    use_hdf5();
    TextAttributes found;
    H5O_info_t root;
    check(H5Oget_info2(file_, &root, H5O_INFO_NUM_ATTRS));
    for (hsize_t i = 0; i < root.num_attrs; ++i) {
      const Handle attribute(
          H5Aopen_by_idx(file_, "/", H5_INDEX_NAME, H5_ITER_INC, i, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
      found.emplace_back(name_of_attribute(attribute), read_text(attribute));
    }
    return found;
  }
  std::vector<std::string> datasets() const override {
    use_hdf5();
    std::vector<std::string> names;
    check(H5Ovisit2(file_, H5_INDEX_NAME, H5_ITER_INC, note_dataset, &names, H5O_INFO_BASIC));
    std::erase_if(names, [this](const std::string& name) { return only_names_a_dimension(file_, name); });
    return names;
  }
  Column column(const std::string& dataset) const override {
    return read_dataset(opened(dataset), last_part(dataset), nullptr);
  }
  Column rows(const std::string& dataset, std::size_t first, std::size_t count) const override {
    const RowRange range{first, count};
    return read_dataset(opened(dataset), last_part(dataset), &range);
  }
  std::int64_t offset(const std::string& dataset) const override {
    const haddr_t offset = H5Dget_offset(opened(dataset));
    if (offset == HADDR_UNDEF) throw std::runtime_error(dataset + " is not stored in one piece");
    return static_cast<std::int64_t>(offset);
  }

 private:
  Handle opened(const std::string& dataset) const {
    use_hdf5();
    const hid_t found = H5Dopen2(file_, dataset.c_str(), H5P_DEFAULT);
    if (found >= 0) return Handle(found, H5Dclose);
    try {
      throw_refusal();
    } catch (const std::runtime_error&) {
      if (!is_missing(dataset)) throw;
    }
    throw std::runtime_error(dataset + " is missing");
  }
  // True if the dataset or one of its groups is certainly missing.
  bool is_missing(const std::string& dataset) const {
    for (std::size_t end = 0; end < dataset.size();) {
      end = std::min(dataset.find('/', end + 1), dataset.size());
      const htri_t found = H5Lexists(file_, dataset.substr(0, end).c_str(), H5P_DEFAULT);
      if (found <= 0) return found == 0;
    }
    return false;
  }

  const Hdf5Work work_;
  Handle file_;
};

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

// True if the signature is at an offset where the HDF5 part of a file may begin: 0, 512, 1024, 2048, ...
bool has_hdf5_signature(const std::filesystem::path& file, std::uintmax_t size) {
  constexpr std::string_view kSignature = "\x89HDF\r\n\x1a\n";
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream && errno == ENOMEM) throw std::bad_alloc();
  stream.exceptions(std::ios::badbit);  // lack of memory is not a missing signature
  for (std::uintmax_t at = 0; at + kSignature.size() <= size; at = at == 0 ? 512 : 2 * at) {
    std::string found(kSignature.size(), '\0');
    stream.seekg(static_cast<std::streamoff>(at));
    if (!stream.read(found.data(), static_cast<std::streamsize>(found.size()))) return false;
    if (found == kSignature) return true;
  }
  return false;
}

[[noreturn]] void refuse_for_memory(const std::string& file) {
  throw InputError(file, "cannot be read (out of memory): expected a smaller file or more memory");
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what,
                         const char* expected = "an HDF5 result") {
  throw InputError(file.string(), what + ": expected " + expected);
}

// Throws InputError unless the file exists and is a regular file, which can be opened without blocking.
void require_regular(const std::filesystem::path& file) {
  require_no_journal(file);
  std::error_code unreachable;
  if (!std::filesystem::exists(file, unreachable)) refuse(file, "no such file");
  if (std::filesystem::is_directory(file, unreachable)) refuse(file, "a folder");
  if (!std::filesystem::is_regular_file(file, unreachable)) refuse(file, "a pipe or a device");
}

// Throws InputError if the file is not HDF5 or its seal is broken. Returns true if it is sealed, false
// without a seal.
bool require_readable(const std::filesystem::path& file) {
  std::error_code unreachable;
  const std::uintmax_t size = std::filesystem::file_size(file, unreachable);
  if (size == 0) refuse(file, "empty");
  const SealState found = seal_state_of(file);
  if (found == SealState::broken)
    refuse(file, "damaged or modified (its SHA-256 does not match)", "a result of this program");
  if (!has_hdf5_signature(file, size)) refuse(file, "not a readable HDF5 file", "a result of this program");
  return found == SealState::valid;
}

}  // namespace

std::unique_ptr<Hdf5Source> open_hdf5(const std::filesystem::path& file) {
  use_hdf5();
  return std::make_unique<LibrarySource>(file.string());
}

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

std::string attribute(const TextAttributes& attributes, const std::string& name) {
  for (const auto& [known, value] : attributes)
    if (known == name) return value;
  return {};
}

TextAttributes provenance_of(const TextAttributes& attributes) {
  static const std::set<std::string> added = {"schema",  "digest", "plan_digest", "default",
                                              "columns", "axes",   "measures",    "note_kinds"};
  TextAttributes kept;
  for (const auto& one : attributes)
    if (!added.contains(one.first)) kept.push_back(one);
  return kept;
}

ReplacedFile::ReplacedFile(const std::string& file)
    : InputError(file,
                 "was replaced by another program while it was read: expected a file that no program "
                 "writes") {}

// Holds a file open, so that no other file gets its inode number.
class Hdf5Reader::HeldFile {
 public:
  explicit HeldFile(const std::string& file)
      : descriptor_(::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {}
  ~HeldFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  HeldFile(const HeldFile&) = delete;
  HeldFile& operator=(const HeldFile&) = delete;

  // True if that is still the name of the held file, or if the file could not be opened (another check
  // refuses it).
  bool has_name(const std::string& file) const { return descriptor_ < 0 || is_name_of(file, descriptor_); }

 private:
  int descriptor_;
};

bool Hdf5Reader::is_replaced() const {
  return held_file_ && !held_file_->has_name(file_);
}

// Any exception of the library, except for lack of memory, is reported as damage of the file.
template <class Read>
auto Hdf5Reader::guarded(Read&& read) const {
  try {
    auto answer = read();
    if (is_replaced()) throw ReplacedFile(file_);
    return answer;
  } catch (const ReplacedFile&) {
    throw;
  } catch (const std::bad_alloc&) {
    refuse_for_memory(file_);
  } catch (const std::exception& error) {
    if (is_replaced()) throw ReplacedFile(file_);
    damaged(error.what());
  }
}

void Hdf5Reader::damaged(const std::string& how) const {
  throw InputError(file_, "damaged (" + how + "): expected a result of this program");
}

void Hdf5Reader::require_kind(const std::string& kind, const std::string& made_by) const {
  const std::string found = attribute(attributes_, "schema");
  if (found == schema_name(kind)) return;
  throw InputError(file_, (found.empty() ? "has no attribute schema" : "is of schema " + found) +
                              ": expected " + schema_name(kind) + ", " + made_by);
}

// Other versions have other names of columns and keys.
void Hdf5Reader::require_version() const {
  const std::string schema = attribute(attributes_, "schema");
  const std::string present = schema.substr(0, schema.rfind('/') + 1) + std::to_string(kSchemaVersion);
  if (!schema.starts_with(kSchemaPrefix) || schema == present) return;
  throw InputError(file_, "is of schema " + schema + ": expected " + present + "; make the result again");
}

Hdf5Reader::Hdf5Reader(std::string file, std::shared_ptr<const Hdf5Source> content)
    : file_(std::move(file)), content_(std::move(content)) {
  attributes_ = guarded([&] { return content_->attributes(); });
  require_version();
}

// Opens the file. Returns true if it is sealed: the library then reads it in this process, and keeps it open.
bool Hdf5Reader::open(const RunInChild& run) {
  const bool is_sealed = require_readable(file_);
  attributes_ = guarded([&] {
    content_ = is_sealed ? open_hdf5(file_) : open_hdf5_in_child(file_, run);
    return content_->attributes();
  });
  require_version();
  // The only unsealed file of this program is that of a running sweep, whose runs have checksums of their
  // own.
  if (!is_sealed && attribute(attributes_, "schema").starts_with(kSchemaPrefix) && !has("/sweep/checksum"))
    damaged("its SHA-256 header is missing: modified by another program, or written by an old version");
  return is_sealed;
}

Hdf5Reader::Hdf5Reader(const std::filesystem::path& file, const RunInChild& run) : file_(file.string()) {
  require_regular(file);
  held_file_ = std::make_shared<HeldFile>(file_);
  try {
    if (open(run)) held_file_.reset();
  } catch (const InputError&) {
    if (is_replaced()) throw ReplacedFile(file_);
    throw;
  }
}

std::vector<std::string> Hdf5Reader::datasets() const {
  return guarded([&] { return content_->datasets(); });
}

bool Hdf5Reader::has(const std::string& dataset) const {
  const std::vector<std::string> all = datasets();
  return std::find(all.begin(), all.end(), dataset) != all.end();
}

Column Hdf5Reader::column(const std::string& dataset) const {
  return guarded([&] { return content_->column(dataset); });
}

Column Hdf5Reader::rows(const std::string& dataset, std::size_t first, std::size_t count) const {
  return guarded([&] { return content_->rows(dataset, first, count); });
}

std::int64_t Hdf5Reader::offset(const std::string& dataset) const {
  return guarded([&] { return content_->offset(dataset); });
}

Hdf5Content read_hdf5(const std::filesystem::path& file) {
  const Hdf5Reader reader(file);
  Hdf5Content content{reader.attributes(), {}};
  for (const std::string& path : reader.datasets()) content.datasets.emplace_back(path, reader.column(path));
  return content;
}

}  // namespace remote_touch
