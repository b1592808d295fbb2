#include "analysis/hdf5_reader.h"

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <stdexcept>

#include "analysis/hdf5_handle.h"
#include "analysis/hdf5_seal.h"
#include "core/input_error.h"

namespace remote_touch {

std::string attribute(const TextAttributes& attributes, const std::string& name) {
  for (const auto& [known, value] : attributes)
    if (known == name) return value;
  return {};
}

namespace {

std::string read_text(hid_t attribute) {
  const Handle type(H5Aget_type(attribute), H5Tclose);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0) return {};
  std::string text(H5Tget_size(type), '\0');
  check(H5Aread(attribute, type, text.data()));
  text.erase(std::find(text.begin(), text.end(), '\0'), text.end());
  return text;
}

std::string text_attribute(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return {};
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  return read_text(attribute);
}

// What of a dataset is read: all of it, or some rows.
struct Selection {
  hid_t in_memory = H5S_ALL, in_file = H5S_ALL;
  std::size_t count = 0;  // of values
};

std::vector<std::string> read_texts(hid_t data, hid_t type, const Selection& wanted) {
  if (H5Tis_variable_str(type) > 0) throw std::runtime_error("texts of variable length");
  const std::size_t length = H5Tget_size(type);
  std::string packed(length * wanted.count, '\0');
  check(H5Dread(data, type, wanted.in_memory, wanted.in_file, H5P_DEFAULT, packed.data()));
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < wanted.count; ++i) {
    texts.push_back(packed.substr(i * length, length));
    texts.back().erase(std::find(texts.back().begin(), texts.back().end(), '\0'), texts.back().end());
  }
  return texts;
}

template <class Number>
std::vector<Number> read_numbers(hid_t data, hid_t type, const Selection& wanted) {
  std::vector<Number> numbers(wanted.count);
  // Not read as its own type: that may be wider.
  check(H5Dread(data, type, wanted.in_memory, wanted.in_file, H5P_DEFAULT, numbers.data()));
  return numbers;
}

std::vector<std::string> names_of(hid_t enumeration) {
  std::vector<std::string> names;
  for (int i = 0; i < H5Tget_nmembers(enumeration); ++i) {
    char* member = H5Tget_member_name(enumeration, static_cast<unsigned>(i));
    names.emplace_back(member);
    H5free_memory(member);
  }
  return names;
}

Values read_values(hid_t data, hid_t type, const Selection& wanted) {
  switch (H5Tget_class(type)) {
    case H5T_FLOAT:
      return read_numbers<double>(data, H5T_NATIVE_DOUBLE, wanted);
    case H5T_STRING:
      return read_texts(data, type, wanted);
    case H5T_INTEGER:
      if (H5Tget_size(type) == sizeof(std::uint64_t) && H5Tget_sign(type) == H5T_SGN_NONE)
        return read_numbers<std::uint64_t>(data, H5T_NATIVE_UINT64, wanted);
      [[fallthrough]];
    default:
      return read_numbers<std::int32_t>(data, H5T_NATIVE_INT32, wanted);
  }
}

struct Rows {
  hsize_t first, count;
};

// All rows of a dataset, or some.
Column read_dataset(hid_t data, const std::string& name, const Rows* some) {
  const Handle type(H5Dget_type(data), H5Tclose), space(H5Dget_space(data), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 1) throw std::runtime_error(name + " has no dimension");
  std::vector<hsize_t> size(static_cast<std::size_t>(rank)), start(size.size(), 0);
  check(H5Sget_simple_extent_dims(space, size.data(), nullptr));
  Column column{name, text_attribute(data, "units"), text_attribute(data, "long_name"), {}, 1, {}};
  if (rank == 2 && size[1] == 0) throw std::runtime_error(name + " has rows without numbers");
  column.width = static_cast<int>(rank == 2 ? size[1] : 1);
  if (some) start[0] = some->first, size[0] = some->count;
  const auto count = std::accumulate(size.begin(), size.end(), std::size_t{1}, std::multiplies<>());
  if (H5Tget_class(type) == H5T_ENUM) column.value_names = names_of(type);
  if (!some) {
    column.values = read_values(data, type, {H5S_ALL, H5S_ALL, count});
    return column;
  }
  check(H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr));
  const Handle memory(H5Screate_simple(rank, size.data(), nullptr), H5Sclose);
  column.values = read_values(data, type, {memory, space, count});
  return column;
}

herr_t note_dataset(hid_t, const char* name, const H5O_info_t* info, void* names) {
  if (info->type == H5O_TYPE_DATASET)
    static_cast<std::vector<std::string>*>(names)->push_back(std::string("/") + name);
  return 0;
}

TextAttributes root_attributes(hid_t file) {
  TextAttributes found;
  H5O_info_t root;
  check(H5Oget_info2(file, &root, H5O_INFO_NUM_ATTRS));
  for (hsize_t i = 0; i < root.num_attrs; ++i) {
    const Handle attribute(H5Aopen_by_idx(file, "/", H5_INDEX_NAME, H5_ITER_INC, i, H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
    std::array<char, 256> name{};
    H5Aget_name(attribute, name.size(), name.data());
    found.emplace_back(name.data(), read_text(attribute));
  }
  return found;
}

// Throws InputError unless the file exists, is HDF5 and as it was written. True when it is sealed.
bool require_readable(const std::filesystem::path& file) {
  std::error_code unreachable;
  if (!std::filesystem::exists(file, unreachable))
    throw InputError(file.string(), "no such file; allowed an HDF5 result");
  if (std::filesystem::is_directory(file, unreachable))
    throw InputError(file.string(), "a folder; allowed an HDF5 result");
  if (std::filesystem::file_size(file, unreachable) == 0)
    throw InputError(file.string(), "empty; allowed an HDF5 result");
  const Seal found = seal_of(file);
  if (found == Seal::broken)
    throw InputError(
        file.string(),
        "damaged (not as it was written: its SHA-256 is another); allowed a result of this program");
  if (H5Fis_hdf5(file.c_str()) <= 0)
    throw InputError(file.string(), "not a readable HDF5 file; allowed a result of this program");
  return found == Seal::intact;
}

Handle open_dataset(const std::shared_ptr<void>& file, const std::string& dataset) {
  return Handle(H5Dopen2(*static_cast<Handle*>(file.get()), dataset.c_str(), H5P_DEFAULT), H5Dclose);
}

std::string last_part(const std::string& path) {
  return path.substr(path.rfind('/') + 1);
}

}  // namespace

// Whatever the library or the standard library throws is damage, also a length that a damaged header claims.
template <class Read>
auto Hdf5Reader::guarded(Read&& read) const {
  try {
    return read();
  } catch (const std::exception& error) {
    damaged(error.what());
  }
}

void Hdf5Reader::damaged(const std::string& how) const {
  throw InputError(file_, "damaged (" + how + "); allowed a result of this program");
}

void Hdf5Reader::require_schema(const std::string& schema, const std::string& allowed) const {
  const std::string found = attribute(attributes_, "schema");
  if (found == schema) return;
  throw InputError(file_, (found.empty() ? "names no schema" : "is of schema " + found) + "; allowed " +
                              schema + ", " + allowed);
}

void Hdf5Reader::require_seal() const {
  if (!sealed_) damaged("its seal is missing: it was changed, or written before there were seals");
}

Hdf5Reader::Hdf5Reader(const std::filesystem::path& file) : file_(file.string()) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are exceptions, not printed
  sealed_ = require_readable(file);
  guarded([&] {
    handle_ = std::make_shared<Handle>(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    attributes_ = root_attributes(*static_cast<Handle*>(handle_.get()));
  });
  // Of this program's files only one of a sweep at work is not sealed: its runs have checksums of their own.
  if (attribute(attributes_, "schema").starts_with("remote-touch-") && !has("/sweep/checksum"))
    require_seal();
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
  const Rows some{first, count};
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
