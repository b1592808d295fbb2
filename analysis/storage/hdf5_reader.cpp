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

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/block_journal.h"
#include "analysis/storage/digest.h"
#include "analysis/storage/hdf5_file.h"
#include "core/parameters/parameter.h"

namespace remote_touch {

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

namespace {

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
