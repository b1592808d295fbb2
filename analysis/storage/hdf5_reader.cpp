#include "analysis/storage/hdf5_reader.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <new>
#include <stdexcept>

#include "analysis/storage/file_digest.h"
#include "analysis/storage/hdf5_handle.h"
#include "analysis/storage/hdf5_values.h"
#include "analysis/storage/schema.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

std::string attribute(const TextAttributes& attributes, const std::string& name) {
  for (const auto& [known, value] : attributes)
    if (known == name) return value;
  return {};
}

namespace {

// The library cannot be left by an exception.
herr_t note_dataset(hid_t, const char* name, const H5O_info_t* info, void* names) noexcept try {
  if (info->type == H5O_TYPE_DATASET)
    static_cast<std::vector<std::string>*>(names)->push_back(std::string("/") + name);
  return 0;
} catch (const std::bad_alloc&) {
  errno = ENOMEM;
  return -1;
}

TextAttributes root_attributes(hid_t file) {
  TextAttributes found;
  H5O_info_t root;
  check(H5Oget_info2(file, &root, H5O_INFO_NUM_ATTRS));
  for (hsize_t i = 0; i < root.num_attrs; ++i) {
    const Handle attribute(H5Aopen_by_idx(file, "/", H5_INDEX_NAME, H5_ITER_INC, i, H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
    std::array<char, 256> name{};
    check(H5Aget_name(attribute, name.size(), name.data()) < 0 ? -1 : 0);
    found.emplace_back(name.data(), read_text(attribute));
  }
  return found;
}

[[noreturn]] void refuse_for_memory(const std::string& file) {
  throw InputError(file, "cannot be read (out of memory): expected a smaller file or more memory");
}

// Of a call that failed: what is wrong, unless there is no memory.
[[noreturn]] void refuse_call(const std::string& wrong) {
  try {
    throw_refusal();
  } catch (const std::runtime_error&) {
    throw std::runtime_error(wrong);
  }
}

void require_hdf5(const std::filesystem::path& file) try {
  const htri_t found = H5Fis_hdf5(file.c_str());
  if (found < 0) throw_refusal();
  if (found == 0) throw std::runtime_error("");
} catch (const std::bad_alloc&) {
  refuse_for_memory(file.string());
} catch (const std::runtime_error&) {
  throw InputError(file.string(), "not a readable HDF5 file: expected a result of this program");
}

// Throws InputError unless the file exists, is HDF5 and as it was written. True when it is sealed.
bool require_readable(const std::filesystem::path& file) {
  std::error_code unreachable;
  if (!std::filesystem::exists(file, unreachable))
    throw InputError(file.string(), "no such file: expected an HDF5 result");
  if (std::filesystem::is_directory(file, unreachable))
    throw InputError(file.string(), "a folder: expected an HDF5 result");
  if (std::filesystem::file_size(file, unreachable) == 0)
    throw InputError(file.string(), "empty: expected an HDF5 result");
  const FileDigest found = file_digest_of(file);
  if (found == FileDigest::broken)
    throw InputError(file.string(),
                     "damaged or modified (its SHA-256 does not match): expected a result of this program");
  require_hdf5(file);
  return found == FileDigest::valid;
}

Handle open_dataset(const std::shared_ptr<void>& file, const std::string& dataset) {
  const hid_t found = H5Dopen2(*static_cast<Handle*>(file.get()), dataset.c_str(), H5P_DEFAULT);
  if (found < 0) refuse_call(dataset + " is missing");
  return Handle(found, H5Dclose);
}

std::string last_part(const std::string& path) {
  return path.substr(path.rfind('/') + 1);
}

}  // namespace

// Whatever the library throws is damage.
template <class Read>
auto Hdf5Reader::guarded(Read&& read) const {
  try {
    return read();
  } catch (const std::bad_alloc&) {
    refuse_for_memory(file_);
  } catch (const std::exception& error) {
    damaged(error.what());
  }
}

void Hdf5Reader::damaged(const std::string& how) const {
  throw InputError(file_, "damaged (" + how + "): expected a result of this program");
}

void Hdf5Reader::require_kind(const std::string& kind, const std::string& made_by) const {
  const std::string found = attribute(attributes_, "schema");
  if (found == schema_name(kind)) return;
  throw InputError(file_, (found.empty() ? "names no schema" : "is of schema " + found) + ": expected " +
                              schema_name(kind) + ", " + made_by);
}

// Columns and keys have other names in other versions: nothing of such a file can be used.
void Hdf5Reader::require_version() const {
  const std::string schema = attribute(attributes_, "schema");
  const std::string current = std::string(1, '/') + std::to_string(kSchemaVersion);
  if (!schema.starts_with(kSchemaPrefix) || schema.ends_with(current)) return;
  const std::string readable = schema.substr(0, schema.rfind('/')) + current;
  if (schema.ends_with("/1"))
    throw InputError(file_, "written by version 0.1 (schema " + schema + "); this version reads " + readable +
                                ": run it again");
  throw InputError(file_, "is of schema " + schema + ": expected " + readable);
}

void Hdf5Reader::require_file_digest() const {
  if (!sealed_)
    damaged("its SHA-256 header is missing: modified by another program, or written by an old version");
}

Hdf5Reader::Hdf5Reader(const std::filesystem::path& file) : file_(file.string()) {
  use_hdf5();
  sealed_ = require_readable(file);
  guarded([&] {
    handle_ = std::make_shared<Handle>(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    attributes_ = root_attributes(*static_cast<Handle*>(handle_.get()));
  });
  require_version();
  // Of this program's files only one of a sweep at work is not sealed: its runs have checksums of their own.
  if (attribute(attributes_, "schema").starts_with(kSchemaPrefix) && !has("/sweep/checksum"))
    require_file_digest();
}

std::vector<std::string> Hdf5Reader::datasets() const {
  return guarded([&] {
    std::vector<std::string> names;
    check(H5Ovisit2(*static_cast<Handle*>(handle_.get()), H5_INDEX_NAME, H5_ITER_INC, note_dataset, &names,
                    H5O_INFO_BASIC));
    return names;
  });
}

bool Hdf5Reader::has(const std::string& dataset) const {
  const std::vector<std::string> all = datasets();
  return std::find(all.begin(), all.end(), dataset) != all.end();
}

Column Hdf5Reader::column(const std::string& dataset) const {
  return guarded([&] { return read_dataset(open_dataset(handle_, dataset), last_part(dataset), nullptr); });
}

Column Hdf5Reader::rows(const std::string& dataset, std::size_t first, std::size_t count) const {
  const RowRange some{first, count};
  return guarded([&] { return read_dataset(open_dataset(handle_, dataset), last_part(dataset), &some); });
}

std::int64_t Hdf5Reader::offset(const std::string& dataset) const {
  return guarded([&] {
    const haddr_t offset = H5Dget_offset(open_dataset(handle_, dataset));
    if (offset == HADDR_UNDEF) throw std::runtime_error(dataset + " is not stored in one piece");
    return static_cast<std::int64_t>(offset);
  });
}

Hdf5Content read_hdf5(const std::filesystem::path& file) {
  const Hdf5Reader reader(file);
  Hdf5Content content{reader.attributes(), {}};
  for (const std::string& path : reader.datasets()) content.datasets.emplace_back(path, reader.column(path));
  return content;
}

std::int64_t offset_of(const std::filesystem::path& file, const std::string& dataset) {
  return Hdf5Reader(file).offset(dataset);
}

}  // namespace remote_touch
