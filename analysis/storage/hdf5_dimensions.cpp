#include "analysis/storage/hdf5_dimensions.h"

#include <hdf5_hl.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <numeric>
#include <stdexcept>

#include "analysis/storage/hdf5_values.h"

namespace remote_touch {

namespace {

// Text by which netCDF recognises a dataset that is no variable. The size follows, formatted as in netCDF.
constexpr const char* kNoVariable = "This is a netCDF dimension but not a netCDF variable.";
constexpr const char* kLabels = "names of components";

bool is_there(hid_t file, const std::string& path) {
  const htri_t found = H5Lexists(file, path.c_str(), H5P_DEFAULT);
  if (found < 0) throw_refusal();
  return found > 0;
}

Handle made_scale(hid_t file, const std::string& path, hid_t type, hsize_t size) {
  return Handle(H5Dcreate2(file, path.c_str(), type, space_of({size}), H5P_DEFAULT,
                           creation_list(H5P_DATASET_CREATE), H5P_DEFAULT),
                H5Dclose);
}

Handle enumeration_of(const std::vector<std::string>& value_names) {
  Handle type(H5Tenum_create(H5T_STD_I32LE), H5Tclose);
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(value_names.size()); ++i)
    check(H5Tenum_insert(type, value_names[static_cast<std::size_t>(i)].c_str(), &i));
  return type;
}

}  // namespace

void add_dimension(hid_t file, const std::string& path, hsize_t size) {
  if (is_there(file, path)) return;
  std::array<char, 80> text{};
  std::snprintf(text.data(), text.size(), "%s%10llu", kNoVariable, static_cast<unsigned long long>(size));
  const Handle dimension = made_scale(file, path, H5T_IEEE_F32BE, size);  // never written: needs no space
  check(H5DSset_scale(dimension, text.data()));
}

std::string component_labels(hid_t file, const std::string& group, int width) {
  const std::string labels = width == 3 ? "xyz" : "wxyz", path = group + "/" + labels;
  if (is_there(file, path)) return path;
  const Handle type = character_type();
  {
    const Handle dimension = made_scale(file, path, type, labels.size());
    check(H5Dwrite(dimension, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, labels.data()));
    check(H5DSset_scale(dimension, kLabels));
  }
  write_text(file, path, kEncoding, "utf-8");
  return path;
}

void attach_dimension(hid_t file, const std::string& dataset, const std::string& dimension, unsigned place) {
  const Handle values(H5Dopen2(file, dataset.c_str(), H5P_DEFAULT), H5Dclose);
  const Handle along(H5Dopen2(file, dimension.c_str(), H5P_DEFAULT), H5Dclose);
  check(H5DSattach_scale(values, along, place));
}

bool only_names_a_dimension(hid_t file, const std::string& dataset) try {
  const Handle opened(H5Dopen2(file, dataset.c_str(), H5P_DEFAULT), H5Dclose);
  const std::string name = text_attribute(opened, "NAME");  // of a dimension scale
  return name == kLabels || name.starts_with(kNoVariable);
} catch (const std::runtime_error&) {
  return false;  // a read of the dataset reports what is wrong
}

Handle character_type() {
  Handle type = text_type(1);
  check(H5Tset_cset(type, H5T_CSET_ASCII));
  return type;
}

Handle named_enumeration(hid_t file, const std::string& column, const std::vector<std::string>& value_names) {
  Handle type = enumeration_of(value_names);
  for (int number = 1;; ++number) {
    const std::string path = "/" + column + "_values" + (number > 1 ? std::to_string(number) : "");
    if (!is_there(file, path)) {
      const Handle creation = creation_list(H5P_DATATYPE_CREATE);
      check(H5Tcommit2(file, path.c_str(), type, H5P_DEFAULT, creation, H5P_DEFAULT));
      return type;
    }
    Handle known(H5Topen2(file, path.c_str(), H5P_DEFAULT), H5Tclose);
    if (H5Tequal(known, type) > 0) return known;
  }
}

void write_flags(hid_t file, const std::string& dataset, const std::vector<std::string>& value_names) {
  std::vector<std::int32_t> values(value_names.size());
  std::iota(values.begin(), values.end(), 0);
  write_attribute(file, dataset, "flag_values", H5T_STD_I32LE, space_of({values.size()}), H5T_NATIVE_INT32,
                  values.data());
  std::vector<std::string> words = value_names;
  for (std::string& name : words) std::replace(name.begin(), name.end(), ' ', '_');  // a blank ends a name
  write_text(file, dataset, "flag_meanings", joined(words, " "));
}

}  // namespace remote_touch
