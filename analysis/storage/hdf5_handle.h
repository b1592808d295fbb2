// Handles of the HDF5 library, for the files that call it.
#pragma once

#include <hdf5.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace remote_touch {

// Throws the error of the call that the library refused: std::runtime_error with the error text of the
// system, if the library reports one; else std::bad_alloc, if it found no memory; else std::runtime_error.
[[noreturn]] void throw_refusal();

// Stops the library from printing errors, because they become exceptions. Every thread must call it before it
// uses the library.
void use_hdf5();

// Closes the object that it holds. A negative identifier means that a call of the library failed.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {
    if (id < 0) throw_refusal();
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }
  // Closes the object now. Throws if the library cannot, for example because it cannot write the last values.
  void finish() {
    const herr_t result = close_(std::exchange(id_, -1));
    if (result < 0) throw_refusal();
  }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

inline void check(herr_t result) {
  if (result < 0) throw_refusal();
}

// Property list for a new object. Time stamps are off, so that equal contents are equal bytes.
inline Handle creation_list(hid_t kind) {
  Handle list(H5Pcreate(kind), H5Pclose);
  check(H5Pset_obj_track_times(list, false));
  return list;
}

inline Handle space_of(const std::vector<hsize_t>& extent) {
  return Handle(H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose);
}

inline Handle text_type(std::size_t length) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  check(H5Tset_size(type, std::max<std::size_t>(1, length)));
  check(H5Tset_cset(type, H5T_CSET_UTF8));
  check(H5Tset_strpad(type, H5T_STR_NULLPAD));
  return type;
}

// Writes an attribute of an existing group or dataset.
inline void write_attribute(hid_t file, const std::string& object, const std::string& name, hid_t stored,
                            hid_t space, hid_t in_memory, const void* values) {
  const Handle made(H5Acreate_by_name(file, object.c_str(), name.c_str(), stored, space, H5P_DEFAULT,
                                      H5P_DEFAULT, H5P_DEFAULT),
                    H5Aclose);
  check(H5Awrite(made, in_memory, values));
}

inline void write_text(hid_t file, const std::string& object, const std::string& name,
                       const std::string& value) {
  const Handle type = text_type(value.size());
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  write_attribute(file, object, name, type, space, type, value.empty() ? "\0" : value.data());
}

}  // namespace remote_touch
