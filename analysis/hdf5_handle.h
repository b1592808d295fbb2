// Handles of the HDF5 library, for the files that call it.
#pragma once

#include <hdf5.h>

#include <stdexcept>
#include <utility>

namespace remote_touch {

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

inline void check(herr_t result) {
  if (result < 0) throw std::runtime_error("the HDF5 library refused a call");
}

}  // namespace remote_touch
