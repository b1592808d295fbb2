#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <stdexcept>

#include "analysis/hdf5_file.h"
#include "analysis/hdf5_handle.h"
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

std::vector<std::string> read_texts(hid_t data, hid_t type, std::size_t count) {
  if (H5Tis_variable_str(type) > 0) throw std::runtime_error("texts of variable length");
  const std::size_t length = H5Tget_size(type);
  std::string packed(length * count, '\0');
  check(H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, packed.data()));
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < count; ++i) {
    texts.push_back(packed.substr(i * length, length));
    texts.back().erase(std::find(texts.back().begin(), texts.back().end(), '\0'), texts.back().end());
  }
  return texts;
}

template <class Number>
std::vector<Number> read_numbers(hid_t data, hid_t type, std::size_t count) {
  std::vector<Number> numbers(count);
  // Not read as its own type: that may be wider.
  check(H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()));
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

Column read_dataset(hid_t data, const std::string& name) {
  const Handle type(H5Dget_type(data), H5Tclose), space(H5Dget_space(data), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 1) throw std::runtime_error(name + " has no dimension");
  std::vector<hsize_t> size(static_cast<std::size_t>(rank));
  check(H5Sget_simple_extent_dims(space, size.data(), nullptr));
  Column column{name, text_attribute(data, "units"), text_attribute(data, "long_name"), {}, 1, {}};
  if (rank == 2 && size[1] == 0) throw std::runtime_error(name + " has rows without numbers");
  column.width = static_cast<int>(rank == 2 ? size[1] : 1);
  const auto count = std::accumulate(size.begin(), size.end(), std::size_t{1}, std::multiplies<>());
  switch (H5Tget_class(type)) {
    case H5T_FLOAT:
      column.values = read_numbers<double>(data, H5T_NATIVE_DOUBLE, count);
      break;
    case H5T_STRING:
      column.values = read_texts(data, type, count);
      break;
    case H5T_ENUM:
      column.value_names = names_of(type);
      [[fallthrough]];
    default:
      column.values = read_numbers<std::int32_t>(data, H5T_NATIVE_INT32, count);
  }
  return column;
}

herr_t note_dataset(hid_t, const char* name, const H5O_info_t* info, void* names) {
  if (info->type == H5O_TYPE_DATASET) static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

}  // namespace

namespace {

// Throws InputError unless the file exists and is HDF5; then what read throws, as damage.
template <class Read>
auto read_from(const std::filesystem::path& file, Read&& read) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  std::error_code unreachable;
  if (!std::filesystem::exists(file, unreachable))
    throw InputError(file.string(), "no such file; allowed an HDF5 result");
  if (std::filesystem::is_directory(file, unreachable) || H5Fis_hdf5(file.c_str()) <= 0)
    throw InputError(file.string(), "not a readable HDF5 file; allowed a result of this program");
  try {
    return read(Handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose));
  } catch (const std::exception& error) {  // also a length that a damaged header claims
    throw InputError(file.string(),
                     std::string("damaged (") + error.what() + "); allowed a result of this program");
  }
}

}  // namespace

Hdf5Content read_hdf5(const std::filesystem::path& file) {
  return read_from(file, [](const Handle& opened) {
    Hdf5Content content;
    H5O_info_t root;
    check(H5Oget_info2(opened, &root, H5O_INFO_NUM_ATTRS));
    for (hsize_t i = 0; i < root.num_attrs; ++i) {
      const Handle attribute(
          H5Aopen_by_idx(opened, "/", H5_INDEX_NAME, H5_ITER_INC, i, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
      std::array<char, 256> name{};
      H5Aget_name(attribute, name.size(), name.data());
      content.attributes.emplace_back(name.data(), read_text(attribute));
    }
    std::vector<std::string> names;
    check(H5Ovisit2(opened, H5_INDEX_NAME, H5_ITER_INC, note_dataset, &names, H5O_INFO_BASIC));
    for (const std::string& name : names) {
      const Handle data(H5Dopen2(opened, name.c_str(), H5P_DEFAULT), H5Dclose);
      content.datasets.emplace_back("/" + name, read_dataset(data, name.substr(name.rfind('/') + 1)));
    }
    return content;
  });
}

std::int64_t offset_of(const std::filesystem::path& file, const std::string& dataset) {
  return read_from(file, [&](const Handle& opened) {
    const Handle data(H5Dopen2(opened, dataset.c_str(), H5P_DEFAULT), H5Dclose);
    const haddr_t offset = H5Dget_offset(data);
    if (offset == HADDR_UNDEF) throw std::runtime_error(dataset + " is not stored in one piece");
    return static_cast<std::int64_t>(offset);
  });
}

}  // namespace remote_touch
