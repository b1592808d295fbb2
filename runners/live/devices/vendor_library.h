// A vendor's library whose functions initialise pointers: the type of the pointer is that of the function.
//   VendorLibrary library{...};
//   int (*close)(char id) = library["dhdClose"];
#pragma once

#include "runners/libraries/shared_library.h"
#include "runners/live/devices/availability.h"

namespace remote_touch {

class VendorLibrary : public SharedLibrary {
 public:
  using SharedLibrary::SharedLibrary;

  struct Function {
    const SharedLibrary& library;
    const char* name;
    bool is_required;

    template <class Type>
    operator Type*() const {
      Type* function = nullptr;
      is_required ? library.find(name, function) : library.find_optional(name, function);
      return function;
    }
  };

  // The conversion throws InputError if there is no such function.
  Function operator[](const char* name) const { return {*this, name, true}; }
  // A function that some versions lack: the pointer is null if there is none.
  Function optional(const char* name) const { return {*this, name, false}; }
};

// The availability of devices whose library does not report them before one is opened.
template <class Functions>
Availability availability_of_library() {
  return availability_of([] {
    return Availability{
        .detail = Functions().library.file() + ": a device is detected only when one is opened",
        .was_searched = false};
  });
}

}  // namespace remote_touch
