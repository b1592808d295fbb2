#include "analysis/storage/hdf5_handle.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <mutex>
#include <new>
#include <stdexcept>

#include "analysis/storage/hdf5_file.h"

namespace remote_touch {

namespace {

// It has a fixed buffer for one line, because there may be no memory for a string.
struct Refusal {
  bool lacks_memory = false;
  char of_system[128] = "";
};

// The library puts the text of the system into a sentence: "..., errno = 28, error message = 'No space left
// on device', ...".
void take_text_of_system(const char* sentence, Refusal& refusal) {
  constexpr const char* kBefore = "error message = '";
  const char* begin = std::strstr(sentence, kBefore);
  if (!begin) return;
  begin += std::strlen(kBefore);
  const char* const end = std::strchr(begin, '\'');
  const std::size_t size = end ? static_cast<std::size_t>(end - begin) : 0;
  if (size > 0 && size < sizeof refusal.of_system) {
    std::memcpy(refusal.of_system, begin, size);
    refusal.of_system[size] = '\0';
  }
}

herr_t take_error(unsigned, const H5E_error2_t* error, void* refusal) {
  auto& found = *static_cast<Refusal*>(refusal);
  if (error->maj_num == H5E_RESOURCE && (error->min_num == H5E_NOSPACE || error->min_num == H5E_CANTALLOC))
    found.lacks_memory = true;
  if (error->desc) take_text_of_system(error->desc, found);
  return 0;
}

// Silences the library's error messages. The library prints those of its first call; only redirecting stderr
// prevents that.
void begin() {
  const Hdf5Work work;
  // The library's work at the end of the program is not needed if every file is closed. If a call found no
  // memory, that work may hang or crash.
  H5dont_atexit();
  const int shown = ::dup(STDERR_FILENO), nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (shown >= 0) Hdf5Work::set_messages(shown);
  if (shown >= 0 && nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
  const bool is_silent = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0;
  if (shown >= 0 && nowhere >= 0) ::dup2(shown, STDERR_FILENO);
  Hdf5Work::set_messages(STDERR_FILENO);
  if (shown >= 0) ::close(shown);
  if (nowhere >= 0) ::close(nowhere);
  if (!is_silent) throw std::bad_alloc();
}

}  // namespace

void throw_refusal() {
  const bool no_memory = errno == ENOMEM;
  Refusal refusal;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, take_error, &refusal);
  if (refusal.of_system[0] != '\0') throw std::runtime_error(refusal.of_system);
  if (refusal.lacks_memory || no_memory) throw std::bad_alloc();
  throw std::runtime_error("the HDF5 library failed: out of memory, or a damaged file");  // it says no more
}

void use_hdf5() {
  static std::once_flag once;
  std::call_once(once, begin);
  // A library that was built for threads prints the errors of each thread until that thread silences it, too.
  thread_local bool is_silent = false;
  if (is_silent) return;
  is_silent = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0;
  if (!is_silent) throw std::bad_alloc();
}

}  // namespace remote_touch
