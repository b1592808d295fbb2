#include "runners/presentation/view/page_file.h"

#include <openssl/evp.h>
#include <zlib.h>

#include "core/parameters/input_error.h"
#include "runners/presentation/view/viewer_files.h"

namespace remote_touch {

namespace {

std::string gzip(const std::string& bytes) {
  constexpr int kGzip = 16, kLevel = 6, kMemory = 8;
  z_stream stream{};
  if (deflateInit2(&stream, kLevel, Z_DEFLATED, MAX_WBITS + kGzip, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  std::string packed(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  const int code = deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  if (code != Z_STREAM_END) throw std::bad_alloc();
  return packed;
}

std::string base64(const std::string& bytes) {
  std::string text((bytes.size() + 2) / 3 * 4 + 1, '\0');
  const int length =
      EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                      reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()));
  text.resize(static_cast<std::size_t>(length));
  return text;
}

std::string escaped(const std::string& text) {
  std::string html;
  for (const char c : text) {
    if (c == '&')
      html += "&amp;";
    else if (c == '<')
      html += "&lt;";
    else
      html += c;
  }
  return html;
}

// Replaces each '<', because "</script>" in a string of JSON would end the element.
std::string in_script(const std::string& json) {
  std::string text;
  for (const char c : json) text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return text;
}

}  // namespace

std::string compressed(const std::string& bytes) {
  return base64(gzip(bytes));
}

std::string page_file(const std::string& title, const std::string& json, const std::string& bytes) {
  if (viewer_script().empty())
    throw InputError("this program",
                     "was built without the viewer: expected a build by scripts/build, with Node");
  std::string html =
      "<!DOCTYPE html>\n<!-- remote-touch view -->\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width\">\n<title>" +
      escaped(title) + "</title>\n<style>\n";
  html.append(viewer_style())
      .append("</style></head>\n<body>\n<script type=\"application/json\" id=\"view\">");
  html.append(in_script(json)).append("</script>\n<script type=\"text/plain\" id=\"numbers\">");
  html.append(compressed(bytes)).append("</script>\n<script type=\"module\">\n");
  html.append(viewer_script()).append("</script>\n</body></html>\n");
  return html;
}

}  // namespace remote_touch
