#include "analysis/storage/hdf5_values.h"

#include <fcntl.h>
#include <hdf5_hl.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <limits>
#include <mutex>
#include <new>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "analysis/storage/hdf5_file.h"
#include "core/parameters/parameter.h"

namespace remote_touch {
namespace {

// It has a fixed buffer for one line, because there may be no memory for a string.
struct Refusal {
  bool lacks_memory = false;
  char of_system[128] = "";
};

// The library puts the text of the system into a sentence: "..., errno = 28, error message = 'No space left
// on device', ...".
void take_text_of_system(const char* sentence, Refusal& refusal) {
  constexpr const char* kBefore = "error message = '";
  const char* begin = std::strstr(sentence, kBefore);
  if (!begin) return;
  begin += std::strlen(kBefore);
  const char* const end = std::strchr(begin, '\'');
  const std::size_t size = end ? static_cast<std::size_t>(end - begin) : 0;
  if (size > 0 && size < sizeof refusal.of_system) {
    std::memcpy(refusal.of_system, begin, size);
    refusal.of_system[size] = '\0';
  }
}

herr_t take_error(unsigned, const H5E_error2_t* error, void* refusal) {
  auto& found = *static_cast<Refusal*>(refusal);
  if (error->maj_num == H5E_RESOURCE && (error->min_num == H5E_NOSPACE || error->min_num == H5E_CANTALLOC))
    found.lacks_memory = true;
  if (error->desc) take_text_of_system(error->desc, found);
  return 0;
}

// Silences the library's error messages. The library prints those of its first call; only redirecting stderr
// prevents that.
void begin() {
  const Hdf5Work work;
  // The library's work at the end of the program is not needed if every file is closed. If a call found no
  // memory, that work may hang or crash.
  H5dont_atexit();
  const int shown = ::dup(STDERR_FILENO), nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (shown >= 0) Hdf5Work::set_messages(shown);
  if (shown >= 0 && nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
  const bool is_silent = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0;
  if (shown >= 0 && nowhere >= 0) ::dup2(shown, STDERR_FILENO);
  Hdf5Work::set_messages(STDERR_FILENO);
  if (shown >= 0) ::close(shown);
  if (nowhere >= 0) ::close(nowhere);
  if (!is_silent) throw std::bad_alloc();
}

// Largest ratio of deflate. A dataset that claims more bytes than this for each stored byte is not read,
// unless it is small: values that were never written occupy no space in the file.
constexpr hsize_t kMaxInflation = 1032, kMaxUnwritten = 1 << 20;

std::optional<hsize_t> product(const std::vector<hsize_t>& extent, hsize_t factor) {
  hsize_t all = factor;
  for (const hsize_t along : extent)
    if (__builtin_mul_overflow(all, along, &all)) return {};
  return all;
}

hsize_t file_size(hid_t object) {
  const Handle file(H5Iget_file_id(object), H5Fclose);
  hsize_t size = 0;
  check(H5Fget_filesize(file, &size));
  return size;
}

// Returns the text in a field of fixed length.
std::string text_in(const char* place, std::size_t length, H5T_str_t padding) {
  std::string text(place, std::find(place, place + length, '\0'));
  if (padding == H5T_STR_SPACEPAD) text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

std::vector<std::string> texts_in(const std::string& packed, std::size_t length, H5T_str_t padding) {
  std::vector<std::string> texts;
  for (std::size_t at = 0; at < packed.size(); at += length)
    texts.push_back(text_in(packed.data() + at, length, padding));
  return texts;
}

bool has_fixed_texts(hid_t type) {
  return H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 && H5Tget_size(type) > 0;
}

// Part of a dataset that is read: all of it, or some rows.
struct Selection {
  hid_t in_memory = H5S_ALL, in_file = H5S_ALL;
  std::size_t count = 0;        // number of values
  std::size_t text_length = 1;  // number of values that make one text
};

std::vector<std::string> read_texts(hid_t data, hid_t type, const Selection& wanted) {
  std::string packed(H5Tget_size(type) * wanted.count, '\0');
  check(H5Dread(data, type, wanted.in_memory, wanted.in_file, H5P_DEFAULT, packed.data()));
  return texts_in(packed, H5Tget_size(type) * wanted.text_length, H5Tget_strpad(type));
}

template <class Number>
std::vector<Number> read_numbers(hid_t data, hid_t type, const Selection& wanted) {
  std::vector<Number> numbers(wanted.count);
  // It is not read as the type of the dataset, which may be wider than Number.
  check(H5Dread(data, type, wanted.in_memory, wanted.in_file, H5P_DEFAULT, numbers.data()));
  return numbers;
}

std::string member_name(hid_t enumeration, unsigned member) {
  char* text = H5Tget_member_name(enumeration, member);
  if (!text) throw_refusal();
  std::string name = text;
  H5free_memory(text);
  return name;
}

std::int64_t member_value(hid_t enumeration, unsigned member) {
  std::int64_t value = 0;
  std::vector<char> bytes(std::max(H5Tget_size(enumeration), sizeof value));
  check(H5Tget_member_value(enumeration, member, bytes.data()));
  const Handle integers(H5Tget_super(enumeration), H5Tclose);
  check(H5Tconvert(integers, H5T_NATIVE_INT64, 1, bytes.data(), nullptr, H5P_DEFAULT));
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

// Returns the names in the order of their values. Throws std::runtime_error unless these are 0, 1, 2, ...
std::vector<std::string> names_of(hid_t enumeration, const std::string& dataset) {
  const int members = H5Tget_nmembers(enumeration);
  check(members);
  std::vector<std::string> names(static_cast<std::size_t>(members));
  for (unsigned i = 0; i < names.size(); ++i) {
    const std::int64_t value = member_value(enumeration, i);
    if (value < 0 || value >= members)
      throw std::runtime_error(dataset + " names the value " + std::to_string(value) +
                               ", and not only 0, 1, 2, ...");
    names[static_cast<std::size_t>(value)] = member_name(enumeration, i);
  }
  return names;
}

// Unsigned integers of 64 bits are read as hashes. Signed ones are read as doubles, which are exact up to
// 2^53. So are unsigned ones of 32 bits, because the HDF5 library would clip values above 2^31 - 1.
Values read_integers(hid_t data, hid_t type, const Selection& wanted) {
  const std::size_t size = H5Tget_size(type);
  const bool has_sign = H5Tget_sign(type) != H5T_SGN_NONE;
  if (size < sizeof(std::int32_t) || (size == sizeof(std::int32_t) && has_sign))
    return read_numbers<std::int32_t>(data, H5T_NATIVE_INT32, wanted);
  if (size > sizeof(std::int32_t) && !has_sign)
    return read_numbers<std::uint64_t>(data, H5T_NATIVE_UINT64, wanted);
  return read_numbers<double>(data, H5T_NATIVE_DOUBLE, wanted);
}

Values read_values(hid_t data, hid_t type, const Selection& wanted) {
  switch (H5Tget_class(type)) {
    case H5T_FLOAT:
      return read_numbers<double>(data, H5T_NATIVE_DOUBLE, wanted);
    case H5T_STRING:
      return read_texts(data, type, wanted);
    case H5T_INTEGER:
      return read_integers(data, type, wanted);
    default:
      return read_numbers<std::int32_t>(data, H5T_NATIVE_INT32, wanted);
  }
}

void require_known_kind(hid_t type, const std::string& name) {
  const H5T_class_t kind = H5Tget_class(type);
  if (kind != H5T_FLOAT && kind != H5T_INTEGER && kind != H5T_ENUM && !has_fixed_texts(type))
    throw std::runtime_error(name + " is neither numbers nor texts of one length");
}

// Throws std::runtime_error unless the values are in this file, in one piece or in chunks: neither in other
// files, nor put together from other datasets.
void require_own_values(hid_t creation, const std::string& name) {
  const H5D_layout_t layout = H5Pget_layout(creation);
  if ((layout != H5D_COMPACT && layout != H5D_CONTIGUOUS && layout != H5D_CHUNKED) ||
      H5Pget_external_count(creation) != 0)
    throw std::runtime_error(name + " has its values in another file");
}

std::vector<hsize_t> chunk_of(hid_t creation, std::size_t rank) {
  std::vector<hsize_t> chunk(rank, 1);
  if (H5Pget_layout(creation) == H5D_CHUNKED)
    check(H5Pget_chunk(creation, static_cast<int>(rank), chunk.data()));
  return chunk;
}

void require_room_for(hid_t data, hid_t type, const std::vector<hsize_t>& extent, const std::string& name) {
  const Handle creation(H5Dget_create_plist(data), H5Pclose);
  require_own_values(creation, name);
  const hsize_t stored = std::min(H5Dget_storage_size(data), file_size(data));
  const hsize_t allowed = std::max(kMaxUnwritten, kMaxInflation * stored);
  for (const auto& claimed : {extent, chunk_of(creation, extent.size())})
    if (product(claimed, H5Tget_size(type)).value_or(std::numeric_limits<hsize_t>::max()) > allowed)
      throw std::runtime_error(name + " claims more values than the file can hold");
}

// Returns the extent of a dataset. Throws std::runtime_error if this program cannot read it.
std::vector<hsize_t> checked_extent(hid_t data, hid_t type, hid_t space, const std::string& name) {
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 1) throw std::runtime_error(name + " has no dimension");
  std::vector<hsize_t> extent(static_cast<std::size_t>(rank));
  check(H5Sget_simple_extent_dims(space, extent.data(), nullptr));
  require_known_kind(type, name);
  if (rank == 2 && extent[1] == 0) throw std::runtime_error(name + " has rows without numbers");
  if (rank == 2 && extent[1] > std::numeric_limits<int>::max())
    throw std::runtime_error(name + " has rows of " + std::to_string(extent[1]) + " values");
  require_room_for(data, type, extent, name);
  return extent;
}

// True if texts are stored as this program writes them, by character. Other programs, and earlier versions of
// this one, store each text as one value.
bool has_texts_by_character(hid_t data, hid_t type, const std::vector<hsize_t>& extent) {
  return extent.size() > 1 && extent.back() > 0 && has_fixed_texts(type) && H5Tget_size(type) == 1 &&
         !text_attribute(data, kEncoding).empty();
}

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

void throw_refusal() {
  const bool no_memory = errno == ENOMEM;
  Refusal refusal;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, take_error, &refusal);
  if (refusal.of_system[0] != '\0') throw std::runtime_error(refusal.of_system);
  if (refusal.lacks_memory || no_memory) throw std::bad_alloc();
  throw std::runtime_error("the HDF5 library failed: out of memory, or a damaged file");  // it says no more
}

void use_hdf5() {
  static std::once_flag once;
  std::call_once(once, begin);
  // A library that was built for threads prints the errors of each thread until that thread silences it, too.
  thread_local bool is_silent = false;
  if (is_silent) return;
  is_silent = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0;
  if (!is_silent) throw std::bad_alloc();
}

std::string read_text(hid_t attribute) {
  const Handle type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  if (!has_fixed_texts(type) || count < 1) return {};
  const auto size = product({static_cast<hsize_t>(count)}, H5Tget_size(type));
  if (!size || *size > file_size(attribute)) throw std::runtime_error("an attribute is longer than the file");
  std::string packed(*size, '\0');
  check(H5Aread(attribute, type, packed.data()));
  return joined(texts_in(packed, H5Tget_size(type), H5Tget_strpad(type)), ", ");
}

std::string text_attribute(hid_t object, const char* name) {
  const htri_t is_there = H5Aexists(object, name);
  if (is_there < 0) throw_refusal();
  if (is_there == 0) return {};
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  return read_text(attribute);
}

Column read_dataset(hid_t data, const std::string& name, const RowRange* rows) {
  const Handle type(H5Dget_type(data), H5Tclose), space(H5Dget_space(data), H5Sclose);
  std::vector<hsize_t> size = checked_extent(data, type, space, name);
  std::vector<hsize_t> start(size.size(), 0);
  Column column{name, text_attribute(data, "units"), text_attribute(data, "long_name"), {}};
  const bool by_character = has_texts_by_character(data, type, size);
  column.width = static_cast<int>(size.size() == 2 && !by_character ? size[1] : 1);
  if (rows) start[0] = rows->first, size[0] = rows->count;
  Selection wanted;
  wanted.count = product(size, 1).value();
  if (by_character) wanted.text_length = size.back();
  if (H5Tget_class(type) == H5T_ENUM) column.value_names = names_of(type, name);
  if (!rows) {
    column.values = read_values(data, type, wanted);
    return column;
  }
  check(H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr));
  const Handle memory = space_of(size);
  wanted.in_memory = memory, wanted.in_file = space;
  column.values = read_values(data, type, wanted);
  return column;
}

void add_dimension(hid_t file, const std::string& path, hsize_t size) {
  if (is_there(file, path)) return;
  const std::string text = formatted("%s%10llu", kNoVariable, static_cast<unsigned long long>(size));
  const Handle dimension = made_scale(file, path, H5T_IEEE_F32BE, size);  // never written: needs no space
  check(H5DSset_scale(dimension, text.c_str()));
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
