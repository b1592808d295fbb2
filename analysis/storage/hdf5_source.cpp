#include "analysis/storage/hdf5_source.h"

#include <algorithm>
#include <cerrno>
#include <new>
#include <stdexcept>

#include "analysis/storage/hdf5_dimensions.h"
#include "analysis/storage/hdf5_handle.h"
#include "analysis/storage/hdf5_values.h"

namespace remote_touch {

namespace {

// An exception must not pass through the library, so an error code is returned.
herr_t note_dataset(hid_t, const char* name, const H5O_info_t* info, void* names) noexcept try {
  if (info->type == H5O_TYPE_DATASET)
    static_cast<std::vector<std::string>*>(names)->push_back(std::string("/") + name);
  return 0;
} catch (const std::bad_alloc&) {
  errno = ENOMEM;
  return -1;
}

std::string last_part(const std::string& path) {
  return path.substr(path.rfind('/') + 1);
}

std::string name_of_attribute(hid_t attribute) {
  const ssize_t length = H5Aget_name(attribute, 0, nullptr);
  if (length < 0) throw_refusal();
  std::string name(static_cast<std::size_t>(length), '\0');
  if (H5Aget_name(attribute, name.size() + 1, name.data()) < 0) throw_refusal();
  return name;
}

// Returns the list of properties with which the library reads a copy of the bytes instead of a file.
Handle access_to(std::string_view bytes) {
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  check(H5Pset_fapl_core(access, 1 << 20, false));
  check(H5Pset_file_image(access, const_cast<char*>(bytes.data()), bytes.size()));
  return access;
}

class LibrarySource final : public Hdf5Source {
 public:
  explicit LibrarySource(const std::string& file)
      : file_(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose) {}
  explicit LibrarySource(std::string_view bytes)
      : file_(H5Fopen("bytes", H5F_ACC_RDONLY, access_to(bytes)), H5Fclose) {}

  TextAttributes attributes() const override {
    use_hdf5();
    TextAttributes found;
    H5O_info_t root;
    check(H5Oget_info2(file_, &root, H5O_INFO_NUM_ATTRS));
    for (hsize_t i = 0; i < root.num_attrs; ++i) {
      const Handle attribute(
          H5Aopen_by_idx(file_, "/", H5_INDEX_NAME, H5_ITER_INC, i, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
      found.emplace_back(name_of_attribute(attribute), read_text(attribute));
    }
    return found;
  }
  std::vector<std::string> datasets() const override {
    use_hdf5();
    std::vector<std::string> names;
    check(H5Ovisit2(file_, H5_INDEX_NAME, H5_ITER_INC, note_dataset, &names, H5O_INFO_BASIC));
    std::erase_if(names, [this](const std::string& name) { return only_names_a_dimension(file_, name); });
    return names;
  }
  Column column(const std::string& dataset) const override {
    return read_dataset(opened(dataset), last_part(dataset), nullptr);
  }
  Column rows(const std::string& dataset, std::size_t first, std::size_t count) const override {
    const RowRange range{first, count};
    return read_dataset(opened(dataset), last_part(dataset), &range);
  }
  std::int64_t offset(const std::string& dataset) const override {
    const haddr_t offset = H5Dget_offset(opened(dataset));
    if (offset == HADDR_UNDEF) throw std::runtime_error(dataset + " is not stored in one piece");
    return static_cast<std::int64_t>(offset);
  }

 private:
  Handle opened(const std::string& dataset) const {
    use_hdf5();
    const hid_t found = H5Dopen2(file_, dataset.c_str(), H5P_DEFAULT);
    if (found >= 0) return Handle(found, H5Dclose);
    try {
      throw_refusal();
    } catch (const std::runtime_error&) {
      if (!is_missing(dataset)) throw;
    }
    throw std::runtime_error(dataset + " is missing");
  }
  // True if the dataset or one of its groups is certainly missing.
  bool is_missing(const std::string& dataset) const {
    for (std::size_t end = 0; end < dataset.size();) {
      end = std::min(dataset.find('/', end + 1), dataset.size());
      const htri_t found = H5Lexists(file_, dataset.substr(0, end).c_str(), H5P_DEFAULT);
      if (found <= 0) return found == 0;
    }
    return false;
  }

  const Hdf5Work work_;
  Handle file_;
};

}  // namespace

std::unique_ptr<Hdf5Source> open_hdf5(const std::filesystem::path& file) {
  use_hdf5();
  return std::make_unique<LibrarySource>(file.string());
}

std::unique_ptr<Hdf5Source> open_hdf5_image(std::string_view bytes) {
  use_hdf5();
  return std::make_unique<LibrarySource>(bytes);
}

}  // namespace remote_touch
