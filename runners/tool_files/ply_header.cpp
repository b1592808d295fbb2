#include "runners/tool_files/ply_header.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <optional>
#include <sstream>
#include <vector>

namespace remote_touch {

namespace {

constexpr std::size_t kMaxHeader = 1 << 20;

struct Element {
  std::uint64_t count = 0;
  std::uint64_t bytes = 0;  // of one, as few as it can have
};

struct Header {
  std::vector<Element> elements;
  bool is_ascii = true, ends = false;
  std::optional<std::string> bad_count;
};

// As few bytes as a property can have in a binary file; a list may have no members. What is no type counts
// as a byte.
std::uint64_t bytes_of(const std::string& type) {
  for (const char* two : {"short", "ushort", "int16", "uint16"})
    if (type == two) return 2;
  for (const char* four : {"int", "uint", "int32", "uint32", "float", "float32"})
    if (type == four) return 4;
  return type == "double" || type == "float64" ? 8 : 1;
}

void take(const std::string& line, Header& header) {
  std::istringstream words(line);
  words.exceptions(std::ios::badbit);  // without memory it throws, where it would pass for the end
  std::string word, type;
  words >> word;
  if (word == "format") {
    words >> type;
    header.is_ascii = type == "ascii";
  } else if (word == "element") {
    std::string name, count;
    words >> name >> count;
    Element& added = header.elements.emplace_back();
    const char* end = count.data() + count.size();
    const auto [at, error] = std::from_chars(count.data(), end, added.count);
    if (error != std::errc() || at != end) header.bad_count = count;
  } else if (word == "property" && !header.elements.empty()) {
    words >> type;
    if (type == "list") words >> type;
    header.elements.back().bytes += header.is_ascii ? 2 : bytes_of(type);  // a digit and what parts it
  }
}

// Its lines end in \n, \r\n or \r.
Header header_in(const std::string& bytes, std::size_t& size) {
  Header header;
  for (size = 0; size < bytes.size() && !header.ends;) {
    const std::size_t end = bytes.find_first_of("\r\n", size);
    if (end == std::string::npos) break;
    const std::string line = bytes.substr(size, end - size);
    size = end + (bytes.compare(end, 2, "\r\n") == 0 ? 2 : 1);
    header.ends = line == "end_header";
    take(line, header);
  }
  return header;
}

}  // namespace

std::string ply_problem(const std::filesystem::path& file) {
  const std::uint64_t whole = std::filesystem::file_size(file);
  std::string bytes(std::min<std::uint64_t>(whole, kMaxHeader), '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  std::size_t size = 0;
  const Header header = header_in(bytes, size);
  if (!header.ends) return "its header has no end";
  if (header.bad_count) return "its header counts " + *header.bad_count;
  const std::uint64_t rest = whole - size;
  std::uint64_t claimed = 0, elements = 0;
  for (const Element& element : header.elements) {
    std::uint64_t all = 0;
    if (__builtin_mul_overflow(element.count, std::max<std::uint64_t>(1, element.bytes), &all) ||
        __builtin_add_overflow(claimed, all, &claimed) ||
        __builtin_add_overflow(elements, element.count, &elements))
      return "its header claims more than any file holds";
  }
  // The last number of all needs nothing behind it.
  if (claimed > rest + (header.is_ascii ? 1 : 0))
    return "its header claims " + std::to_string(elements) + " elements, more than its " +
           std::to_string(rest) + " bytes hold";
  return {};
}

std::string with_first_byte_kept(std::string ply) {
  std::size_t size = 0;
  const Header header = header_in(ply, size);
  const bool is_taken = header.ends && !header.is_ascii && size < ply.size() && ply[size] == '\n' &&
                        ply.compare(size - 2, 2, "\r\n") != 0;
  if (is_taken) ply.insert(size, 1, '\n');
  return ply;
}

}  // namespace remote_touch
