#include "runners/evaluation/contract/allocation_counter.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<std::size_t> count{0};
}

// The operators have a file of their own: a compiler that sees both these operators and their callers takes
// malloc and free for a mismatched pair.
void* operator new(std::size_t size) {
  ++count;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
// std::stable_sort and others allocate with this operator. A sanitizer's own version would not match the
// delete below.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++count;
  return std::malloc(size);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace remote_touch {
std::size_t allocation_count() {
  return count;
}
}  // namespace remote_touch
