// Options of the address sanitizer that hold also when a program only lists its tests. Leaks are left to
// tests_under_sanitizers: where no process may be traced, looking for them ends the program with an error.
extern "C" const char* __asan_default_options();   // NOLINT: the sanitizer calls it by this name
extern "C" const char* __asan_default_options() {  // NOLINT
  return "detect_leaks=0:allocator_may_return_null=1";
}
