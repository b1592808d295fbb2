// A library of a vendor, loaded when a device needs it. The program is built and started without any such
// library. Its functions initialise pointers, whose types are those of the functions:
//   SharedLibrary library{...};
//   int (*close)(char id) = library["dhdClose"];
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

  // Converts to a pointer of the type that the caller gives.
  struct Function {
    void* address;
    template <class Type>
    operator Type*() const {
      return reinterpret_cast<Type*>(address);
    }
  };
  // Throws InputError if there is no such function.
  Function operator[](const char* name) const;
  // A function that some versions lack: the pointer is null if there is none.
  Function optional(const char* name) const;

 private:
  void* handle_ = nullptr;
  std::string file_;
  const char* variable_;
};

}  // namespace remote_touch
