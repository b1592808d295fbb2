// A library of a vendor, loaded when a device needs it. The program is built and started without any such
// library.
#pragma once

#include <string>
#include <vector>

namespace remote_touch {

class SharedLibrary {
 public:
  struct Lookup {
    std::vector<std::string> names;  // tried in turn, in the loader's search path
    const char* variable;            // environment variable that, if set, names the file instead
    const char* package;             // package that contains the library, for the message
  };

  // Throws InputError if it is not found. It stays loaded until the program ends, because vendors' libraries
  // leave threads behind.
  explicit SharedLibrary(const Lookup& lookup);

  // The file that was loaded.
  const std::string& file() const { return file_; }

  // Finds the function of this name, of the type that the caller gives. Throws InputError if there is none.
  template <class Function>
  void find(const char* name, Function*& function) const {
    function = reinterpret_cast<Function*>(address(name));
  }
  // The same for a function that only newer versions have: it is null if there is none.
  template <class Function>
  void find_optional(const char* name, Function*& function) const {
    function = reinterpret_cast<Function*>(address_if_there(name));
  }

 private:
  void* address(const char* name) const;
  void* address_if_there(const char* name) const;

  void* handle_ = nullptr;
  std::string file_;
  const char* variable_;
};

}  // namespace remote_touch
