#include "analysis/hdf5_file.h"

#include <hdf5.h>
#include <hdf5_hl.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "analysis/whole_file.h"
#include "core/input_error.h"

namespace remote_touch {

namespace {

// Rows in a chunk of a long column.
constexpr hsize_t kChunk = 4096;

// Closes what it holds. A negative identifier is the library's way to say that a call failed.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {
    if (id < 0) throw std::runtime_error("the HDF5 library refused a call");
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void check(herr_t result) {
  if (result < 0) throw std::runtime_error("the HDF5 library refused a call");
}

// Object time stamps off, so that equal contents are equal bytes.
Handle creation_list(hid_t kind) {
  Handle list(H5Pcreate(kind), H5Pclose);
  check(H5Pset_obj_track_times(list, false));
  return list;
}

Handle text_type(std::size_t length) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  check(H5Tset_size(type, std::max<std::size_t>(1, length)));
  check(H5Tset_cset(type, H5T_CSET_UTF8));
  check(H5Tset_strpad(type, H5T_STR_NULLPAD));
  return type;
}

Handle stored_type(const Column& column) {
  if (std::holds_alternative<std::vector<double>>(column.values))
    return Handle(H5Tcopy(H5T_IEEE_F64LE), H5Tclose);
  if (column.value_names.empty()) return Handle(H5Tcopy(H5T_STD_I32LE), H5Tclose);
  Handle type(H5Tenum_create(H5T_STD_I32LE), H5Tclose);
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(column.value_names.size()); ++i)
    check(H5Tenum_insert(type, column.value_names[static_cast<std::size_t>(i)].c_str(), &i));
  return type;
}

}  // namespace

Hdf5Writer::Hdf5Writer() : file_(-1) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are exceptions, not printed
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  check(H5Pset_fapl_core(access, 1 << 20, false));
  const Handle creation = creation_list(H5P_FILE_CREATE);
  // Brings the root an object header that takes attributes above 64 KiB: a configuration with many waypoints.
  check(H5Pset_attr_creation_order(creation, H5P_CRT_ORDER_TRACKED));
  file_ = H5Fcreate("remote-touch", H5F_ACC_TRUNC, creation, access);
  if (file_ < 0) throw std::runtime_error("the HDF5 library refused to start a file");
}

Hdf5Writer::~Hdf5Writer() {
  H5Fclose(file_);
}

void Hdf5Writer::group(const std::string& path) {
  const Handle creation = creation_list(H5P_GROUP_CREATE);
  const Handle made(H5Gcreate2(file_, path.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose);
}

void Hdf5Writer::attribute(const std::string& object, const std::string& name, const std::string& value) {
  const Handle type = text_type(value.size());
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle made(H5Acreate_by_name(file_, object.c_str(), name.c_str(), type, space, H5P_DEFAULT,
                                      H5P_DEFAULT, H5P_DEFAULT),
                    H5Aclose);
  check(H5Awrite(made, type, value.empty() ? "\0" : value.data()));
}

void Hdf5Writer::attribute(const std::string& object, const std::string& name,
                           const std::vector<double>& values) {
  const hsize_t length = values.size();
  const Handle space(H5Screate_simple(1, &length, nullptr), H5Sclose);
  const Handle made(H5Acreate_by_name(file_, object.c_str(), name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT,
                                      H5P_DEFAULT, H5P_DEFAULT),
                    H5Aclose);
  check(H5Awrite(made, H5T_NATIVE_DOUBLE, values.data()));
}

void Hdf5Writer::attribute(const std::string& object, const std::string& name, std::int32_t value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle made(H5Acreate_by_name(file_, object.c_str(), name.c_str(), H5T_STD_I32LE, space, H5P_DEFAULT,
                                      H5P_DEFAULT, H5P_DEFAULT),
                    H5Aclose);
  check(H5Awrite(made, H5T_NATIVE_INT32, &value));
}

void Hdf5Writer::attributes(const std::string& object, const TextAttributes& list) {
  for (const auto& [name, value] : list) attribute(object, name, value);
}

void Hdf5Writer::dataset(const std::string& path, const Column& column) {
  const std::array<hsize_t, 2> size{column.length(), static_cast<hsize_t>(column.width)};
  const int rank = column.width == 1 ? 1 : 2;
  const Handle space(H5Screate_simple(rank, size.data(), nullptr), H5Sclose);
  const Handle creation = creation_list(H5P_DATASET_CREATE);
  if (size[0] > kChunk) {
    const std::array<hsize_t, 2> chunk{kChunk, size[1]};
    check(H5Pset_chunk(creation, rank, chunk.data()));
    check(H5Pset_shuffle(creation));
    check(H5Pset_deflate(creation, 1));
    check(H5Pset_fletcher32(creation));
  }
  const Handle type = stored_type(column);
  const Handle made(H5Dcreate2(file_, path.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT),
                    H5Dclose);
  // The machine is little-endian (asserted in digest.cpp), so the stored types are the native ones.
  std::visit([&](const auto& v) { check(H5Dwrite(made, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, v.data())); },
             column.values);
  attribute(path, "units", column.units);
  attribute(path, "long_name", column.long_name);
}

void Hdf5Writer::columns(const std::string& group, const std::vector<Column>& columns,
                         const std::string& scale) {
  for (const Column& column : columns) dataset(group + "/" + column.name, column);
  if (scale.empty()) return;
  const Handle rows(H5Dopen2(file_, (group + "/" + scale).c_str(), H5P_DEFAULT), H5Dclose);
  check(H5DSset_scale(rows, scale.c_str()));
  for (const Column& column : columns) {
    if (column.name == scale) continue;
    const Handle values(H5Dopen2(file_, (group + "/" + column.name).c_str(), H5P_DEFAULT), H5Dclose);
    check(H5DSattach_scale(values, rows, 0));
  }
}

void Hdf5Writer::save(const std::filesystem::path& target) {
  check(H5Fflush(file_, H5F_SCOPE_GLOBAL));
  const ssize_t size = H5Fget_file_image(file_, nullptr, 0);
  if (size < 0) throw std::runtime_error("the HDF5 library gave no file image");
  std::vector<char> image(static_cast<std::size_t>(size));
  if (H5Fget_file_image(file_, image.data(), image.size()) != size)
    throw std::runtime_error("the HDF5 library gave no file image");
  write_whole_file(target, image.data(), image.size());
}

// --- reading ---

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

Column read_dataset(hid_t data, const std::string& name) {
  const Handle type(H5Dget_type(data), H5Tclose), space(H5Dget_space(data), H5Sclose);
  std::array<hsize_t, 2> size{1, 1};
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 1 || rank > 2) throw std::runtime_error(name + " has neither one nor two dimensions");
  check(H5Sget_simple_extent_dims(space, size.data(), nullptr));
  Column column{name, text_attribute(data, "units"), text_attribute(data, "long_name"), {}, 1, {}};
  if (rank == 2 && size[1] == 0) throw std::runtime_error(name + " has rows without numbers");
  column.width = static_cast<int>(rank == 2 ? size[1] : 1);
  const std::size_t count = size[0] * static_cast<std::size_t>(column.width);
  if (H5Tget_class(type) == H5T_FLOAT) {
    std::vector<double> values(count);
    check(H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
    column.values = std::move(values);
    return column;
  }
  std::vector<std::int32_t> values(count);
  const bool named = H5Tget_class(type) == H5T_ENUM;
  // Not read as its own type: that may be wider than 32 bits.
  check(H5Dread(data, H5T_NATIVE_INT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
  column.values = std::move(values);
  for (int i = 0; named && i < H5Tget_nmembers(type); ++i) {
    char* member = H5Tget_member_name(type, static_cast<unsigned>(i));
    column.value_names.emplace_back(member);
    H5free_memory(member);
  }
  return column;
}

herr_t note_dataset(hid_t, const char* name, const H5O_info_t* info, void* names) {
  if (info->type == H5O_TYPE_DATASET) static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

}  // namespace

Hdf5Content read_hdf5(const std::filesystem::path& file) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  std::error_code unreachable;
  if (!std::filesystem::exists(file, unreachable))
    throw InputError(file.string(), "no such file; allowed an HDF5 result");
  if (std::filesystem::is_directory(file, unreachable) || H5Fis_hdf5(file.c_str()) <= 0)
    throw InputError(file.string(), "not a readable HDF5 file; allowed a result of this program");
  try {
    const Handle opened(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
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
  } catch (const std::exception& error) {  // also a length that a damaged header claims
    throw InputError(file.string(),
                     std::string("damaged (") + error.what() + "); allowed a result of this program");
  }
}

}  // namespace remote_touch
