// Options of the address sanitizer that hold also when a program only lists its tests. The check for leaks is
// left to tests_under_sanitizers, because it ends the program with an error if no process may be traced.
extern "C" const char* __asan_default_options();   // NOLINT: the sanitizer calls it by this name
extern "C" const char* __asan_default_options() {  // NOLINT
  return "detect_leaks=0:allocator_may_return_null=1";
}
