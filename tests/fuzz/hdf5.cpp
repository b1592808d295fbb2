// HDF5 files: damaged ones, those of other programs, and the answers of the child process that reads them.
#include <hdf5.h>
#include <algorithm>
#include <array>
#include <stdexcept>

#include "analysis/storage/hdf5_reader.h"
#include "analysis/storage/hdf5_values.h"
#include "analysis/sweeps/sweep_file.h"
#include "tests/fuzz/shared/fuzz_target.h"
#include "tests/fuzz/shared/lasting_child.h"

namespace remote_touch::fuzz::hdf5 {
namespace {

// Damaged and foreign HDF5 files. The HDF5 library reads them in a child process with limits.

void read_bytes(std::string_view bytes) {
  use_hdf5();  // it begins here, once, and not in each child
  const auto file = scratch_file("file.h5", bytes);
  accepts(bytes, [&] {
    const Hdf5Reader reader(file, run_in_child());
    if (reader.has("/sweep/checksum")) read_sweep(reader);
    for (const std::string& dataset : reader.datasets()) reader.column(dataset);
  });
}

const Registered of_bytes("hdf5_bytes", read_bytes);

// HDF5 files of other programs: sound, but with attributes and datasets of any type and shape. The bytes
// choose them, the library makes the file, and the reader reads it in this process.

constexpr int kMaxObjects = 8;

class Choices {
 public:
  explicit Choices(std::string_view bytes) : bytes_(bytes) {}
  bool any() const { return at_ < bytes_.size(); }
  // Returns one of 0 .. count - 1, or 0 at the end.
  std::size_t of(std::size_t count) { return any() ? static_cast<unsigned char>(bytes_[at_++]) % count : 0; }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

Handle text_type_of(Choices& choose) {
  constexpr std::array<std::size_t, 6> kLengths{1, 2, 8, 200, 70000, 100'000'000};
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  check(H5Tset_size(type, choose.of(4) == 0 ? H5T_VARIABLE : kLengths[choose.of(kLengths.size())]));
  H5Tset_strpad(type, static_cast<H5T_str_t>(choose.of(3)));
  H5Tset_cset(type, static_cast<H5T_cset_t>(choose.of(2)));
  return type;
}

Handle enumeration_of(Choices& choose) {
  Handle type(H5Tenum_create(choose.of(2) == 0 ? H5T_NATIVE_INT : H5T_NATIVE_UINT64), H5Tclose);
  const int members = static_cast<int>(choose.of(5));
  for (std::int64_t i = 0; i < members; ++i)
    check(H5Tenum_insert(type, (std::string(choose.of(40), 'n') + std::to_string(i)).c_str(), &i));
  return type;
}

Handle compound_of(Choices& choose) {
  Handle type(H5Tcreate(H5T_COMPOUND, 16), H5Tclose);
  check(H5Tinsert(type, "a", 0, H5T_NATIVE_DOUBLE));
  if (choose.of(2) != 0) check(H5Tinsert(type, "b", 8, H5T_NATIVE_INT));
  return type;
}

Handle type_of(Choices& choose) {
  const std::array<hid_t, 14> numbers{
      H5T_NATIVE_DOUBLE, H5T_NATIVE_FLOAT, H5T_IEEE_F64BE,    H5T_NATIVE_LDOUBLE, H5T_NATIVE_INT8,
      H5T_STD_I16BE,     H5T_NATIVE_INT,   H5T_NATIVE_UINT32, H5T_NATIVE_INT64,   H5T_STD_U64BE,
      H5T_STD_REF_OBJ,   H5T_STD_B8LE,     H5T_UNIX_D32LE,    H5T_NATIVE_UINT16};
  const std::array<hsize_t, 2> shape{choose.of(3) + 1, choose.of(300) + 1};
  switch (choose.of(8)) {
    case 0:
      return text_type_of(choose);
    case 1:
      return enumeration_of(choose);
    case 2:
      return compound_of(choose);
    case 3:
      return Handle(H5Tarray_create2(H5T_NATIVE_DOUBLE, 2, shape.data()), H5Tclose);
    case 4:
      return Handle(H5Tvlen_create(H5T_NATIVE_INT), H5Tclose);
    default:
      return Handle(H5Tcopy(numbers[choose.of(numbers.size())]), H5Tclose);
  }
}

std::vector<hsize_t> extent_of(Choices& choose) {
  constexpr std::array<hsize_t, 12> kLengths{
      0, 1, 2, 3, 7, 100, 1 << 16, 1ull << 31, 1ull << 32, 1ull << 40, 1ull << 61, ~0ull - 1};
  std::vector<hsize_t> extent(choose.of(5));
  for (hsize_t& length : extent) length = kLengths[choose.of(choose.of(2) == 0 ? 6 : kLengths.size())];
  return extent;
}

Handle space_of(const std::vector<hsize_t>& extent, Choices& choose) {
  if (extent.empty()) return Handle(H5Screate(choose.of(2) == 0 ? H5S_SCALAR : H5S_NULL), H5Sclose);
  const std::vector<hsize_t> any(extent.size(), H5S_UNLIMITED);
  return Handle(H5Screate_simple(static_cast<int>(extent.size()), extent.data(),
                                 choose.of(2) == 0 ? nullptr : any.data()),
                H5Sclose);
}

void add_attribute(hid_t object, const std::string& name, Choices& choose) {
  const Handle type = type_of(choose);
  const std::vector<hsize_t> extent = extent_of(choose);
  const Handle space = space_of(extent, choose);
  const Handle made(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  const std::size_t size = H5Tget_size(type);
  const bool is_plain = H5Tget_class(type) != H5T_VLEN && H5Tis_variable_str(type) <= 0;
  if (count < 1 || !is_plain || size * static_cast<std::size_t>(count) > 1 << 16) return;
  check(H5Awrite(
      made, type,
      std::string(size * static_cast<std::size_t>(count), static_cast<char>(choose.of(256))).data()));
}

void add_dataset(hid_t file, const std::string& name, Choices& choose) {
  const Handle type = type_of(choose);
  const std::vector<hsize_t> extent = extent_of(choose);
  const Handle space = space_of(extent, choose), creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  double chunk_size = 1;  // numbers
  if (!extent.empty() && choose.of(2) != 0) {
    std::vector<hsize_t> chunk;
    for (std::size_t i = 0; i < extent.size(); ++i) {
      chunk.push_back(choose.of(2) == 0 ? 16 : hsize_t{1} << choose.of(32));
      chunk_size *= static_cast<double>(chunk.back());
    }
    check(H5Pset_chunk(creation, static_cast<int>(chunk.size()), chunk.data()));
    if (choose.of(2) != 0) check(H5Pset_deflate(creation, 9));
  } else if (choose.of(2) != 0) {
    check(H5Pset_layout(creation, H5D_COMPACT));
  }
  const Handle data(H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT),
                    H5Dclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  const bool is_number = H5Tget_class(type) == H5T_FLOAT || H5Tget_class(type) == H5T_INTEGER;
  if (count > 0 && count < 1000 && chunk_size < 1e5 && is_number) {  // the library writes whole chunks
    const std::vector<double> values(static_cast<std::size_t>(count), choose.of(256) * 1e7);
    H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  }
  if (choose.of(2) != 0) add_attribute(data, choose.of(2) == 0 ? "units" : "long_name", choose);
  if (choose.of(4) == 3) add_attribute(data, "_Encoding", choose);
  if (choose.of(4) == 3) add_attribute(data, "NAME", choose);
}

// The library refuses impossible objects. The objects before them make a file.
void make(const std::filesystem::path& file, Choices& choose) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);
  const Handle made(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose);
  for (int i = 0; i < kMaxObjects && choose.any(); ++i) try {
      if (choose.of(3) == 0)
        add_attribute(made, "attribute" + std::to_string(i), choose);
      else
        add_dataset(made, "data" + std::to_string(i), choose);
    } catch (const std::runtime_error&) {
    }
}

template <class Read>
void answers(std::string_view bytes, Read&& read) {
  try {
    read();
  } catch (const std::runtime_error& refusal) {
    require_one_line(refusal.what(), bytes);
  }
}

void read_all(const Hdf5Source& source, std::string_view bytes) {
  answers(bytes, [&] { source.attributes(); });
  for (const std::string& name : source.datasets())
    answers(bytes, [&] {
      const Column column = source.column(name);
      const std::size_t rows = column.length();
      require(column.width > 0, "a row has numbers");
      if (rows == 0) return;
      const Column last = source.rows(name, rows - 1, 1);
      require(last.values.index() == column.values.index(), "a row is of the kind of its column");
    });
}

void read_shapes(std::string_view bytes) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const auto file = scratch_file("shapes.h5", "");
  Choices choose(bytes);
  make(file, choose);
  read_all(*open_hdf5(file), bytes);
}

const Registered of_shapes("hdf5_shapes", read_shapes);

// Reads the answer of a child process about an HDF5 file. The child has read bytes of unknown origin, and may
// send anything.

// A refusal is the text that the reader of the file would report.
template <class Unpack>
void read_as(const std::string& bytes, Unpack unpack) {
  try {
    require(packed(unpack(bytes)) == bytes, "an answer is packed as it was");
  } catch (const std::runtime_error& refusal) {
    require_one_line(refusal.what(), bytes);
  }
}

void read_answer(std::string_view bytes) {
  const std::string answer(bytes);
  read_as(answer, unpacked_summary);
  read_as(answer, unpacked_column);
}

const Registered of_answer("child_answer", read_answer);

}  // namespace
}  // namespace remote_touch::fuzz::hdf5
