#include "runners/presentation/result_pages.h"

#include <openssl/evp.h>
#include <zlib.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/parameters/parameter.h"
#include "runners/presentation/export_formats.h"

// The assembler reads the files; as texts in C++ they would take a minute to compile.
// clang-format off
asm(".section .rodata\n"
    "viewer_script_begin:\n.incbin \"" VIEWER_SCRIPT "\"\nviewer_script_end:\n"
    "viewer_style_begin:\n.incbin \"" VIEWER_STYLE "\"\nviewer_style_end:\n"
    ".globl viewer_script_begin, viewer_script_end, viewer_style_begin, viewer_style_end\n"
    ".previous\n");
// clang-format on
// NOLINTNEXTLINE(readability-identifier-naming): symbols of the assembler
extern "C" const char viewer_script_begin[], viewer_script_end[], viewer_style_begin[], viewer_style_end[];

namespace remote_touch {

std::string_view viewer_script() {
  return {viewer_script_begin, viewer_script_end};
}
std::string_view viewer_style() {
  return {viewer_style_begin, viewer_style_end};
}

namespace {

// Compresses in pieces, because zlib counts the bytes of a call in 32 bits.
std::string gzip(const std::string& bytes) {
  constexpr std::size_t kPiece = 1 << 20;
  constexpr int kGzip = 16, kLevel = 6, kMemory = 8;
  z_stream stream{};
  if (deflateInit2(&stream, kLevel, Z_DEFLATED, MAX_WBITS + kGzip, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  std::string packed(deflateBound(&stream, bytes.size()), '\0');
  std::size_t read = 0, written = 0;
  int code = Z_OK;
  while (code == Z_OK) {
    const std::size_t in = std::min(bytes.size() - read, kPiece),
                      out = std::min(packed.size() - written, kPiece);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + read));
    stream.avail_in = static_cast<uInt>(in);
    stream.next_out = reinterpret_cast<Bytef*>(packed.data() + written);
    stream.avail_out = static_cast<uInt>(out);
    code = deflate(&stream, read + in == bytes.size() ? Z_FINISH : Z_NO_FLUSH);
    read += in - stream.avail_in, written += out - stream.avail_out;
  }
  packed.resize(written);
  deflateEnd(&stream);
  if (code != Z_STREAM_END) throw std::bad_alloc();
  return packed;
}

// Encodes in pieces, because OpenSSL counts the bytes of a call in 31 bits. Three bytes give four characters,
// so only the last piece is padded. Each call writes a zero behind its characters.
std::string base64(const std::string& bytes) {
  constexpr std::size_t kPiece = 3 << 20;
  std::string text((bytes.size() + 2) / 3 * 4 + 1, '\0');
  std::size_t written = 0;
  for (std::size_t at = 0; at < bytes.size(); at += kPiece)
    written +=
        static_cast<std::size_t>(EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data() + written),
                                                 reinterpret_cast<const unsigned char*>(bytes.data() + at),
                                                 static_cast<int>(std::min(bytes.size() - at, kPiece))));
  text.resize(written);
  return text;
}

// Replaces each '<', because "</script>" in a string of JSON would end the element.
std::string in_script(const std::string& json) {
  std::string text;
  for (const char c : json) text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return text;
}

constexpr const char* kPageSchema = "remote-touch-view/1";
constexpr std::size_t kMaxPointsOfFrame = 30000;
constexpr int kTrials = 8;

// Returns a first estimate of the number of points of a frame that fits. A point has six bytes of position
// and three of colour, and compression leaves about two thirds of them.
std::size_t points_of_frame(const std::vector<std::unique_ptr<ShownRun>>& runs, std::size_t max_bytes) {
  std::size_t frames = 0;
  for (const auto& run : runs) frames += run->frame_count();
  return std::min(kMaxPointsOfFrame, max_bytes / (8 * frames) + 1);
}

// Returns the number of points of a frame that may fit, after `points` made a page too large. Points that
// touch are in every page, so the size shrinks less than in proportion.
std::size_t fewer_points(std::size_t points, std::size_t bytes, std::size_t max_bytes) {
  const std::size_t fixed = std::min(max_bytes, viewer_script().size());
  const double part = static_cast<double>(max_bytes - fixed) / static_cast<double>(bytes - fixed);
  return static_cast<std::size_t>(0.8 * part * static_cast<double>(points));
}

std::string joined(const std::vector<std::unique_ptr<ShownRun>>& runs) {
  std::string text;
  for (const auto& run : runs) {
    if (runs.size() > 1) text += run->source().name + ": ";
    text += run->shown() + "\n";
    if (!run->note().empty()) text += "  " + run->note() + "\n";
  }
  return text;
}

}  // namespace

std::string gzip_base64(const std::string& bytes) {
  return base64(gzip(bytes));
}

std::string page_file(const std::string& title, const std::string& json, const std::string& bytes,
                      bool is_stored) {
  std::string html =
      "<!DOCTYPE html>\n<!-- remote-touch view -->\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width\">\n";
  if (is_stored)
    html +=
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src "
        "'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; base-uri 'none'; form-action "
        "'none'\">\n";
  html += "<title>" + xml_escaped(title, false) + "</title>\n<style>\n";
  html.append(viewer_style())
      .append("</style></head>\n<body>\n<script type=\"application/json\" id=\"view\">");
  html.append(in_script(json)).append("</script>\n<script type=\"text/plain\" id=\"numbers\">");
  html.append(gzip_base64(bytes)).append("</script>\n<script type=\"module\">\n");
  html.append(viewer_script()).append("</script>\n</body></html>\n");
  return html;
}

ViewPage view_page(const std::string& title, const std::vector<std::unique_ptr<ShownRun>>& runs,
                   const Json& page, const PackedArrays& numbers, const ViewOptions& options) {
  std::size_t points = points_of_frame(runs, options.max_bytes), size = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    PackedArrays all = numbers;
    Json whole{{"schema", kPageSchema}, {"runs", Json::array()}};
    whole.update(page);
    for (const auto& run : runs) whole["runs"].push_back(run->json(all, points));
    std::string html = page_file(title, whole.dump(), all.bytes());
    size = html.size();
    if (size <= options.max_bytes) return {std::move(html), joined(runs)};
    // If the first estimate was wrong, most of the page is not points, so far fewer of them fit.
    points = std::min(fewer_points(points, size, options.max_bytes), trial > 0 ? points / 3 : points);
  }
  throw InputError(runs.front()->source().name, "has a page of " + std::to_string(size) +
                                                    " bytes even with few points: expected --max-mb " +
                                                    std::to_string(size / 1'000'000 + 1) + " or more");
}

}  // namespace remote_touch
