// Libraries of vendors that are loaded when a device needs them, and threads for their calls. The program is
// built and started without any such library.
#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace remote_touch {

// The functions of a library initialise pointers, whose types are those of the functions:
//   SharedLibrary library{...};
//   int (*close)(char id) = library["dhdClose"];
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

// Threads for calls of others' libraries, which may hang, or crash if a thread that has called them has
// ended.

// Runs one task after another, in a thread of its own.
class LastingThread {
 public:
  LastingThread();
  // Does not wait for work that has missed its deadline.
  ~LastingThread();
  LastingThread(const LastingThread&) = delete;
  LastingThread& operator=(const LastingThread&) = delete;

  // Returns true when the work is done, and throws what the work throws. Returns false at the limit, if there
  // is one. Late work continues in its thread, so it must own all that it uses, and run() must not be called
  // again. Only one thread may call it at a time.
  bool run(std::function<void()> work, std::optional<std::chrono::milliseconds> limit = {});

 private:
  struct Shared {
    std::mutex mutex;
    std::condition_variable changed;
    std::function<void()> work;
    std::exception_ptr thrown;
    bool is_over = false;
  };
  static void serve(const std::shared_ptr<Shared>& shared);

  const std::shared_ptr<Shared> shared_;
};

// Returns a thread for one user alone, which ends with the process. When that user has released it, the next
// user gets it, so there are only as many threads as were ever in use at the same time. Throws
// std::system_error if no thread can be started.
std::shared_ptr<LastingThread> lasting_thread();

}  // namespace remote_touch
