// Reads a page of the viewer as a browser would.
#pragma once

#include <gtest/gtest.h>
#include <openssl/evp.h>
#include <zlib.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scenarios/files/input_files.h"

namespace remote_touch {

inline std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin);
  if (from == std::string::npos) return {};
  const std::size_t start = from + begin.size();
  return text.substr(start, text.find(end, start) - start);
}

inline std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

inline std::string decompressed(const std::string& base64, std::size_t max_bytes) {
  std::string packed(base64.size(), '\0'), bytes(max_bytes, '\0');
  const int length =
      EVP_DecodeBlock(reinterpret_cast<unsigned char*>(packed.data()),
                      reinterpret_cast<const unsigned char*>(base64.data()), static_cast<int>(base64.size()));
  z_stream stream{};
  EXPECT_EQ(inflateInit2(&stream, MAX_WBITS + 16), Z_OK);
  stream.next_in = reinterpret_cast<Bytef*>(packed.data()), stream.avail_in = static_cast<uInt>(length);
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data()), stream.avail_out = static_cast<uInt>(max_bytes);
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  bytes.resize(stream.total_out);
  inflateEnd(&stream);
  return bytes;
}

// The data of a page, decoded as a browser does.
struct ReadPage {
  explicit ReadPage(const std::string& html)
      : json(Json::parse(between(html, "id=\"view\">", "</script>"))),
        bytes(decompressed(between(html, "id=\"numbers\">", "</script>"), 50'000'000)) {}

  template <class T>
  std::vector<T> numbers(const Json& packed) const {
    std::vector<T> values(packed["length"].get<std::size_t>());
    bytes.copy(reinterpret_cast<char*>(values.data()), values.size() * sizeof(T),
               packed["at"].get<std::size_t>());
    return values;
  }
  const Json& column(const std::string& name, std::size_t run = 0) const {
    for (const Json& one : json["runs"][run]["columns"])
      if (one["name"] == name) return one["numbers"];
    throw std::out_of_range(name);
  }

  Json json;
  std::string bytes;
};

}  // namespace remote_touch
