// A vendor's library, loaded when a device needs it: none of them is needed to build or to start.
#pragma once

#include <string>
#include <vector>

namespace remote_touch {

class SharedLibrary {
 public:
  struct Place {
    std::vector<std::string> names;  // tried in turn, where the loader looks
    const char* variable;            // names the file instead, where it is set
    const char* package;             // what would bring the library
  };

  // Throws InputError where there is none. It stays loaded until the program ends: vendors' libraries leave
  // threads behind.
  explicit SharedLibrary(const Place& place);

  // As it was found.
  const std::string& file() const { return file_; }

  // The function of this name, whose type the caller knows; throws InputError where there is none.
  template <class Function>
  void find(const char* name, Function*& function) const {
    function = reinterpret_cast<Function*>(address(name));
  }
  // Null where there is none: what only newer versions have.
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
