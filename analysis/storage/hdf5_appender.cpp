#include "analysis/storage/hdf5_appender.h"

#include <zlib.h>

#include <new>
#include <utility>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/digest.h"
#include "analysis/storage/hdf5_values.h"
#include "core/parameters/parameter.h"

namespace remote_touch {

namespace {

// Compression level: camera data is compressed as fast as possible.
constexpr unsigned kDeflate = 1;

hid_t stored(Hdf5Appender::Number number) {
  const hid_t types[] = {H5T_IEEE_F64LE, H5T_IEEE_F32LE, H5T_STD_I32LE,
                         H5T_STD_U64LE,  H5T_STD_U32LE,  H5T_STD_U16LE};
  return types[static_cast<int>(number)];
}

}  // namespace

// The library does not always report the reason of a failure. The message asks for room, because mostly the
// disk is full.
template <class Call>
void Hdf5Appender::guarded(const Call& call) {
  try {
    use_hdf5();
    call();
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw InputError(target_.string(), "cannot be written (out of memory): expected more memory");
  } catch (const std::exception& error) {
    throw InputError(target_.string(), std::string("cannot be written (") + error.what() +
                                           "): expected a writable folder with free space");
  }
}

Hdf5Appender::Hdf5Appender(const std::filesystem::path& target)
    : target_(target), temporary_(temporary_of(target)) {
  require_writable(target);
  require_no_device(target);
  remove_leftovers(target);
  try {
    guarded([&] { begin(); });
  } catch (...) {  // the destructor does not run for a constructor that throws
    remove_temporary();
    throw;
  }
}

void Hdf5Appender::begin() {
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  check(H5Pset_userblock(creation, kSealBlockSize));
  check(H5Pset_attr_creation_order(creation, H5P_CRT_ORDER_TRACKED));  // needed for attributes above 64 KiB
  file_ = H5Fcreate(temporary_.c_str(), H5F_ACC_TRUNC, creation, H5P_DEFAULT);
  check(file_ < 0 ? -1 : 0);
}

void Hdf5Appender::remove_temporary() {
  std::error_code gone;
  std::filesystem::remove(temporary_, gone);
}

// Returns false if something could not be written.
bool Hdf5Appender::close() {
  bool good = true;
  for (const auto& [path, data] : open_) good &= H5Dclose(data.id) >= 0;
  open_.clear();
  if (file_ >= 0) good &= H5Fclose(std::exchange(file_, -1)) >= 0;
  return good;
}

Hdf5Appender::~Hdf5Appender() {
  if (finished_) return;
  close();
  remove_temporary();
}

void Hdf5Appender::group(const std::string& path) {
  guarded([&] {
    const Handle made(H5Gcreate2(file_, path.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  });
}

void Hdf5Appender::dataset(const Dataset& made) {
  guarded([&] {
    std::vector<hsize_t> now{0}, max{H5S_UNLIMITED}, chunk{made.rows_a_chunk};
    for (const auto extent : made.row) now.push_back(extent), max.push_back(extent), chunk.push_back(extent);
    const Handle space(H5Screate_simple(static_cast<int>(now.size()), now.data(), max.data()), H5Sclose);
    const Handle creation = creation_list(H5P_DATASET_CREATE);
    check(H5Pset_chunk(creation, static_cast<int>(chunk.size()), chunk.data()));
    check(H5Pset_shuffle(creation));
    check(H5Pset_deflate(creation, kDeflate));
    const hid_t id =
        H5Dcreate2(file_, made.path.c_str(), stored(made.number), space, H5P_DEFAULT, creation, H5P_DEFAULT);
    check(id < 0 ? -1 : 0);
    open_[made.path] = {id, made};
    write_text(file_, made.path, "units", made.units);
    write_text(file_, made.path, "long_name", made.long_name);
  });
}

void Hdf5Appender::append(const std::string& path, const void* rows, std::size_t count) {
  if (count == 0) return;
  guarded([&] {
    Open& data = open_.at(path);
    std::vector<hsize_t> start{data.rows}, size{count}, end{data.rows + count};
    for (const auto extent : data.made.row) start.push_back(0), size.push_back(extent), end.push_back(extent);
    check(H5Dset_extent(data.id, end.data()));
    const Handle space(H5Dget_space(data.id), H5Sclose);
    check(H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr));
    const Handle memory = space_of(size);
    const Handle type(H5Tget_native_type(stored(data.made.number), H5T_DIR_ASCEND), H5Tclose);
    check(H5Dwrite(data.id, type, memory, space, H5P_DEFAULT, rows));
    data.rows += count;
  });
}

// row: the bytes of a chunk as they are in the file. The library does not compress them again.
void Hdf5Appender::append_deflated(const std::string& path, const std::string& row) {
  guarded([&] {
    Open& data = open_.at(path);
    std::vector<hsize_t> start{data.rows}, end{data.rows + 1};
    for (const auto extent : data.made.row) start.push_back(0), end.push_back(extent);
    check(H5Dset_extent(data.id, end.data()));
    constexpr std::uint32_t kEveryFilter = 0;  // none was skipped
    check(H5Dwrite_chunk(data.id, H5P_DEFAULT, kEveryFilter, start.data(), row.size(), row.data()));
    ++data.rows;
  });
}

void Hdf5Appender::attributes(const std::string& object, const TextAttributes& list) {
  guarded([&] {
    for (const auto& [name, value] : list) write_text(file_, object, name, value);
  });
}

void Hdf5Appender::finish() {
  guarded([&] {
    check(H5Fflush(file_, H5F_SCOPE_GLOBAL));
    if (!close()) throw_refusal();
  });
  guarded([&] { write_seal(temporary_); });
  move_into_place(temporary_, target_);
  finished_ = true;
}

std::string deflated_row(const void* values, std::size_t count, std::size_t value_size) {
  const char* const bytes = static_cast<const char*>(values);
  const std::size_t size = count * value_size;
  std::string shuffled(size, '\0');
  for (std::size_t byte = 0; byte < value_size; ++byte)
    for (std::size_t i = 0; i < count; ++i) shuffled[byte * count + i] = bytes[i * value_size + byte];
  uLongf used = ::compressBound(static_cast<uLong>(size));
  std::string row(used, '\0');
  const int result = ::compress2(reinterpret_cast<Bytef*>(row.data()), &used,
                                 reinterpret_cast<const Bytef*>(shuffled.data()), static_cast<uLong>(size),
                                 static_cast<int>(kDeflate));
  if (result != Z_OK) throw std::bad_alloc();  // buffer and level are valid
  row.resize(used);
  return row;
}

bool is_deflated_row(const std::string& row, std::size_t size) {
  constexpr std::size_t kMaxRatio = 1032;  // largest ratio of deflate
  if (row.size() < size / kMaxRatio) return false;
  std::string shuffled(size, '\0');
  uLongf used = static_cast<uLongf>(size);
  uLong read = static_cast<uLong>(row.size());
  const int result = ::uncompress2(reinterpret_cast<Bytef*>(shuffled.data()), &used,
                                   reinterpret_cast<const Bytef*>(row.data()), &read);
  if (result == Z_MEM_ERROR) throw std::bad_alloc();
  return result == Z_OK && used == size && read == row.size();
}

}  // namespace remote_touch
