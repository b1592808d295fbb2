// A vendor's library that is replaced by its test double.
#pragma once

#include <dlfcn.h>

#include <cstdlib>
#include <stdexcept>
#include <string>

#include "tests/doubles/simulated_clock.h"
#include "tests/support/loaded_libraries.h"
#include "tests/support/test_files.h"

namespace remote_touch {

// The environment variable of the library names the double, newly reset, as long as this object lives. The
// double uses a simulated clock, or the steady one.
template <class Double>
class InstalledDouble {
 public:
  template <class Vendor>
  explicit InstalledDouble(const Vendor& vendor, SimulatedClock* clock = nullptr)
      : variable_(vendor.variable) {
    void* library = dlopen(vendor.double_file, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) throw std::runtime_error(dlerror());
    double_ = reinterpret_cast<Double* (*)()>(dlsym(library, Double::kExport))();
    double_->reset();
    double_->follow(clock);
    setenv(variable_, vendor.double_file, 1);
  }
  ~InstalledDouble() {
    double_->reset();
    double_->follow(nullptr);
    unsetenv(variable_);
  }
  InstalledDouble(const InstalledDouble&) = delete;
  InstalledDouble& operator=(const InstalledDouble&) = delete;

  Double* operator->() const { return double_; }
  Double& operator*() const { return *double_; }

 private:
  const char* variable_;
  Double* double_;
};

// Checks that an adapter names the missing library and the variable. open(): opens the device or the camera.
template <class Vendor, class Open>
void expect_absent_library_is_named(const Vendor& vendor, Open open) {
  unsetenv(vendor.variable);
  std::string message = refusal(open);
  if (!has_loaded(vendor.library)) {  // it may be installed here
    EXPECT_HAS(message, std::string(vendor.library) + ": cannot be loaded (" + vendor.library + ", ");
    EXPECT_HAS(message, vendor.variable);
    EXPECT_EQ(vendor.availability().detail, message);
    EXPECT_FALSE(vendor.availability().found);
  }
  setenv(vendor.variable, "/no/such/library.so", 1);
  message = refusal(open);
  EXPECT_HAS(message,
             "/no/such/library.so: cannot be loaded (/no/such/library.so: cannot open shared object file");
  EXPECT_HAS(message, std::string(vendor.variable) + " must name the library of ");
}

}  // namespace remote_touch
