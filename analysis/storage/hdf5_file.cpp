#include "analysis/storage/hdf5_file.h"

#include <hdf5_hl.h>
#include <zlib.h>

#include <algorithm>
#include <new>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/digest.h"
#include "analysis/storage/hdf5_values.h"
#include "core/parameters/parameter.h"

namespace remote_touch {

namespace {

// Columns of more than kMaxContiguous rows are compressed, in chunks of kChunk rows. Those of several
// dimensions have chunks of at most kMaxChunk values.
constexpr hsize_t kMaxContiguous = 256, kChunk = 4096, kMaxChunk = 32768;

// Returns the length of the longest text, at least 1: a dimension of size 0 would hold no texts.
std::size_t max_length(const std::vector<std::string>& texts) {
  std::size_t length = 1;
  for (const std::string& text : texts) length = std::max(length, text.size());
  return length;
}

[[noreturn]] void refuse_target(const std::filesystem::path& target, const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error)) throw std::bad_alloc();
  throw InputError(target.string(), std::string("cannot be written (") + error.what() +
                                        "): expected a writable folder with free space for the file");
}

Handle stored_type(hid_t file, const Column& column) {
  if (std::holds_alternative<std::vector<std::string>>(column.values)) return character_type();
  const bool are_integers = std::holds_alternative<std::vector<std::int32_t>>(column.values);
  if (are_integers && !column.value_names.empty())
    return named_enumeration(file, column.name, column.value_names);
  const bool are_hashes = std::holds_alternative<std::vector<std::uint64_t>>(column.values);
  return Handle(H5Tcopy(are_integers ? H5T_STD_I32LE
                        : are_hashes ? H5T_STD_U64LE
                                     : H5T_IEEE_F64LE),
                H5Tclose);
}

// Returns a name that no column has.
std::string name_of_rows(const std::vector<Column>& columns) {
  std::string name = "row";
  const auto is_taken = [&](const Column& column) { return column.name == name; };
  while (std::any_of(columns.begin(), columns.end(), is_taken)) name += '_';
  return name;
}

// Compression level: camera data is compressed as fast as possible.
constexpr unsigned kDeflate = 1;

hid_t stored(Hdf5Appender::Number number) {
  const hid_t types[] = {H5T_IEEE_F64LE, H5T_IEEE_F32LE, H5T_STD_I32LE,
                         H5T_STD_U64LE,  H5T_STD_U32LE,  H5T_STD_U16LE};
  return types[static_cast<int>(number)];
}

void prepare(const std::filesystem::path& target) {
  require_writable(target);
  require_no_device(target);
  remove_leftovers(target);
}

void remove_quietly(const std::filesystem::path& file) {
  std::error_code gone;
  std::filesystem::remove(file, gone);
}

// Extent of a chunk: whole trailing dimensions, as many as fit.
std::vector<hsize_t> chunk_of(std::vector<hsize_t> extent) {
  if (extent.size() == 1) return {std::min(kChunk, extent.front())};
  for (hsize_t& along : extent) {
    const auto product = std::accumulate(extent.begin(), extent.end(), hsize_t{1}, std::multiplies<>());
    if (product > kMaxChunk) along = std::max<hsize_t>(1, kMaxChunk * along / product);
  }
  return extent;
}

// The places of values in memory and in the dataset.
struct Spaces {
  hid_t memory = H5S_ALL, file = H5S_ALL;
};

// length: bytes of a text.
void write_values(hid_t dataset, hid_t type, const Values& values, std::size_t length,
                  const Spaces& selected = {}) {
  // The machine is little-endian (asserted in digest.cpp), so the stored types are the native ones.
  const auto write = [&](const auto& v) {
    check(H5Dwrite(dataset, type, selected.memory, selected.file, H5P_DEFAULT, v.data()));
  };
  if (const auto* texts = std::get_if<std::vector<std::string>>(&values)) {
    std::string packed(length * texts->size(), '\0');
    for (std::size_t i = 0; i < texts->size(); ++i) (*texts)[i].copy(packed.data() + i * length, length);
    write(packed);
  } else {
    std::visit(write, values);
  }
}

std::size_t size_of(const std::vector<hsize_t>& extent) {
  return static_cast<std::size_t>(
      std::accumulate(extent.begin(), extent.end(), hsize_t{1}, std::multiplies<>()));
}

// The chunks of an array in the order of their values. Each is a range of values, because only one dimension
// is divided: those before it have one index in a chunk, and those after it are whole, see chunk_of().
class ChunkWalk {
 public:
  ChunkWalk(std::vector<hsize_t> extent, const std::vector<hsize_t>& chunk)
      : extent_(std::move(extent)), start_(extent_.size(), 0) {
    while (divided_ + 1 < chunk.size() && chunk[divided_] == 1) ++divided_;
    step_ = chunk[divided_];
  }
  bool ended() const { return extent_.front() <= start_.front(); }
  const std::vector<hsize_t>& start() const { return start_; }
  std::vector<hsize_t> count() const {
    std::vector<hsize_t> count = extent_;
    std::fill_n(count.begin(), divided_, 1);
    count[divided_] = std::min(step_, extent_[divided_] - start_[divided_]);
    return count;
  }
  void next() {
    start_[divided_] += step_;
    for (std::size_t i = divided_; i > 0 && start_[i] >= extent_[i]; --i) start_[i] = 0, ++start_[i - 1];
  }

 private:
  std::vector<hsize_t> extent_, start_;
  std::size_t divided_ = 0;
  hsize_t step_ = 1;
};

Handle creation_of(const std::vector<hsize_t>& extent, std::size_t rows, Hdf5Writer::Storage storage) {
  Handle creation = creation_list(H5P_DATASET_CREATE);
  if (storage == Hdf5Writer::Storage::in_place) {
    check(H5Pset_alloc_time(creation, H5D_ALLOC_TIME_EARLY));
  } else if (rows > kMaxContiguous) {
    check(H5Pset_chunk(creation, static_cast<int>(extent.size()), chunk_of(extent).data()));
    check(H5Pset_shuffle(creation));
    check(H5Pset_deflate(creation, 1));
    check(H5Pset_fletcher32(creation));
  }
  return creation;
}

}  // namespace

Hdf5Writer::Hdf5Writer(Finished finished) : sealed_(finished == Finished::yes) {
  create();
}

Hdf5Writer::Hdf5Writer(const std::filesystem::path& target)
    : sealed_(true), on_disk_(temporary_of(target).string() + ".unsealed") {
  prepare(target);
  try {
    create();
  } catch (const std::exception& error) {  // the destructor does not run for a constructor that throws
    remove_quietly(on_disk_);
    refuse_target(target, error);
  }
}

void Hdf5Writer::create() {
  use_hdf5();
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  if (on_disk_.empty()) check(H5Pset_fapl_core(access, 1 << 20, false));
  const Handle creation = creation_list(H5P_FILE_CREATE);
  // Gives the root an object header that can hold attributes above 64 KiB: a configuration with many
  // waypoints.
  check(H5Pset_attr_creation_order(creation, H5P_CRT_ORDER_TRACKED));
  file_ = H5Fcreate(on_disk_.empty() ? "remote-touch" : on_disk_.c_str(), H5F_ACC_TRUNC, creation, access);
  if (file_ < 0) throw_refusal();
}

Hdf5Writer::~Hdf5Writer() {
  if (file_ >= 0) H5Fclose(file_);
  if (!on_disk_.empty()) remove_quietly(on_disk_);
}

void Hdf5Writer::group(const std::string& path) {
  const Handle creation = creation_list(H5P_GROUP_CREATE);
  const Handle made(H5Gcreate2(file_, path.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose);
}

void Hdf5Writer::attribute(const std::string& object, const std::string& name, const std::string& value) {
  write_text(file_, object, name, value);
}

void Hdf5Writer::attribute(const std::string& object, const std::string& name,
                           const std::vector<double>& values) {
  write_attribute(file_, object, name, H5T_IEEE_F64LE, space_of({values.size()}), H5T_NATIVE_DOUBLE,
                  values.data());
}

void Hdf5Writer::attribute(const std::string& object, const std::string& name, std::int32_t value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  write_attribute(file_, object, name, H5T_STD_I32LE, space, H5T_NATIVE_INT32, &value);
}

void Hdf5Writer::attributes(const std::string& object, const TextAttributes& list) {
  for (const auto& [name, value] : list) attribute(object, name, value);
}

// Texts have one more dimension, that of their characters, because the netCDF library crashes on texts of
// fixed length, and Octave refuses a file with texts of variable length.
void Hdf5Writer::dataset(const std::string& path, const Column& column, Extent extent, Storage storage) {
  const auto* const texts = std::get_if<std::vector<std::string>>(&column.values);
  const std::size_t length = texts ? max_length(*texts) : 1;
  if (texts) extent.push_back(length);
  {
    const Handle type = stored_type(file_, column), space = space_of(extent);
    const Handle creation = creation_of(extent, column.length(), storage);
    Handle made(H5Dcreate2(file_, path.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose);
    write_values(made, type, column.values, length);
    made.finish();  // writes what the library still holds
  }
  describe(path, column, extent);
}

void Hdf5Writer::block_dataset(const std::string& path, const Column& column, Extent extent,
                               std::size_t longest_text, const Block& values) {
  const bool are_texts = std::holds_alternative<std::vector<std::string>>(column.values);
  const std::size_t rows = size_of(extent), length = are_texts ? longest_text : 1;
  if (are_texts) extent.push_back(length);
  {
    const Handle type = stored_type(file_, column), space = space_of(extent);
    const Handle creation = creation_of(extent, rows, Storage::compact);
    Handle made(H5Dcreate2(file_, path.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose);
    std::size_t first = 0;
    for (ChunkWalk walk(extent, rows > kMaxContiguous ? chunk_of(extent) : extent); !walk.ended();
         walk.next()) {
      const std::vector<hsize_t> size = walk.count();
      const std::size_t count = size_of(size) / length;
      const Handle memory = space_of(size);
      check(H5Sselect_hyperslab(space, H5S_SELECT_SET, walk.start().data(), nullptr, size.data(), nullptr));
      write_values(made, type, values(first, count), length, {memory, space});
      first += count;
    }
    made.finish();  // writes what the library still holds
  }
  describe(path, column, extent);
}

// Writes the attributes of a dataset, and the dimension of the characters of its texts.
void Hdf5Writer::describe(const std::string& path, const Column& column, const Extent& extent) {
  attribute(path, "units", column.units);
  attribute(path, "long_name", column.long_name);
  if (!column.value_names.empty()) write_flags(file_, path, column.value_names);
  if (!std::holds_alternative<std::vector<std::string>>(column.values)) return;
  attribute(path, kEncoding, "utf-8");
  add_dimension(file_, path + "_length", extent.back());
  attach_dimension(file_, path, path + "_length", static_cast<unsigned>(extent.size()) - 1);
}

void Hdf5Writer::scale(const std::string& path) {
  const Handle values(H5Dopen2(file_, path.c_str(), H5P_DEFAULT), H5Dclose);
  check(H5DSset_scale(values, path.substr(path.rfind('/') + 1).c_str()));
}

void Hdf5Writer::columns(const std::string& group, const std::vector<Column>& columns,
                         const std::string& rows) {
  for (const Column& column : columns) {
    std::vector<hsize_t> extent{column.length()};
    if (column.width > 1) extent.push_back(static_cast<hsize_t>(column.width));
    dataset(group + "/" + column.name, column, extent, Storage::compact);
  }
  const std::string along = group + "/" + (rows.empty() ? name_of_rows(columns) : rows);
  if (!rows.empty()) scale(along);
  for (const Column& column : columns) {
    const std::string path = group + "/" + column.name;
    if (rows.empty()) add_dimension(file_, along, column.length());
    if (path != along) attach_dimension(file_, path, along, 0);
    if (column.width > 1) attach_dimension(file_, path, components(group, column.width, !rows.empty()), 1);
  }
}

std::string Hdf5Writer::components(const std::string& group, int width, bool are_vectors) {
  if (are_vectors && (width == 3 || width == 4)) return component_labels(file_, group, width);
  const std::string path = group + "/components_" + std::to_string(width);
  add_dimension(file_, path, static_cast<hsize_t>(width));
  return path;
}

Hdf5Writer::Extent Hdf5Writer::extent_over(const std::string& group,
                                           const std::vector<std::string>& axes) const {
  Extent extent;
  for (const std::string& axis : axes) {
    const Handle along(H5Dopen2(file_, (group + "/" + axis).c_str(), H5P_DEFAULT), H5Dclose);
    const Handle space(H5Dget_space(along), H5Sclose);
    extent.push_back(static_cast<hsize_t>(H5Sget_simple_extent_npoints(space)));
  }
  return extent;
}

void Hdf5Writer::array(const std::string& group, const Column& column, const std::vector<std::string>& axes,
                       Storage storage) {
  const std::string path = group + "/" + column.name;
  dataset(path, column, extent_over(group, axes), storage);
  for (unsigned i = 0; i < axes.size(); ++i) attach_dimension(file_, path, group + "/" + axes[i], i);
}

void Hdf5Writer::array_in_blocks(const std::string& group, const Column& column,
                                 const std::vector<std::string>& axes, const Block& values,
                                 std::size_t longest_text) {
  const std::string path = group + "/" + column.name;
  block_dataset(path, column, extent_over(group, axes), longest_text, values);
  for (unsigned i = 0; i < axes.size(); ++i) attach_dimension(file_, path, group + "/" + axes[i], i);
}

std::size_t Hdf5Writer::size() {
  check(H5Fflush(file_, H5F_SCOPE_GLOBAL));
  const ssize_t size = H5Fget_file_image(file_, nullptr, 0);
  if (size < 0) throw_refusal();
  return static_cast<std::size_t>(size);
}

// Writes the seal and the content to a second file, and moves that into place. The content is copied before
// the file is closed, because the library then shortens it: the bytes would not be those of a file built in
// memory.
void Hdf5Writer::save_from_disk(const std::filesystem::path& target) {
  const std::filesystem::path sealed = temporary_of(target);
  try {
    check(H5Fflush(file_, H5F_SCOPE_GLOBAL));
    write_sealed_copy(on_disk_, sealed);
  } catch (const std::exception& error) {
    remove_quietly(sealed);
    refuse_target(target, error);
  }
  move_into_place(sealed, target);
}

void Hdf5Writer::save(const std::filesystem::path& target) {
  if (!on_disk_.empty()) return save_from_disk(target);
  std::vector<char> image(size());
  if (H5Fget_file_image(file_, image.data(), image.size()) != static_cast<ssize_t>(image.size()))
    throw_refusal();
  if (sealed_) image = with_seal(image);
  write_file_atomically(target, image.data(), image.size());
}

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
  prepare(target);
  try {
    guarded([&] { begin(); });
  } catch (...) {  // the destructor does not run for a constructor that throws
    remove_quietly(temporary_);
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
  remove_quietly(temporary_);
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
