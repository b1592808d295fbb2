// A mistake of each kind that a sanitizer must find: `mistake address` reads behind the end of a vector,
// `mistake thread` changes one number in two threads.
#include <cstddef>
#include <string_view>
#include <thread>
#include <vector>

int main(int count, char** arguments) {
  if (count == 2 && std::string_view(arguments[1]) == "address") {
    const std::vector<int> values(static_cast<std::size_t>(count));
    return *(values.data() + count);
  }
  int shared = 0;
  std::thread other([&] { ++shared; });
  ++shared;
  other.join();
  return shared - 2;
}
