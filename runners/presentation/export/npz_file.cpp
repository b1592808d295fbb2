#include "runners/presentation/export/npz_file.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/parameters/input_error.h"
#include "runners/presentation/export/exported_run.h"
#include "runners/presentation/export/result_tables.h"
#include "scenarios/text_files/text_file.h"

namespace remote_touch {
namespace {

static_assert(std::endian::native == std::endian::little);

// Returns the header. Its length, including the 10 bytes of the opening, is a multiple of 64, so that the
// values are aligned.
std::string npy_header(const std::string& type, const std::string& shape) {
  constexpr std::size_t kOpening = 10, kAlignment = 64;
  std::string text = "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
  const std::size_t whole = (kOpening + text.size() + 1 + kAlignment - 1) / kAlignment * kAlignment;
  text.resize(whole - kOpening - 1, ' ');
  text += '\n';
  std::string header("\x93NUMPY\x01\x00", 8);
  header += static_cast<char>(text.size() & 0xff);
  header += static_cast<char>(text.size() >> 8);
  return header + text;
}

// Returns the number of bytes of a UTF-8 character that begins with this byte; 0 if none does.
std::size_t length_of_character(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first < 0xe0) return 2;
  if (first >= 0xe0 && first < 0xf0) return 3;
  return first >= 0xf0 && first < 0xf5 ? 4 : 0;
}

// true: a character of this value has this many bytes in UTF-8. Halves of pairs of UTF-16 and numbers above
// U+10FFFF are no characters.
bool is_character(char32_t character, std::size_t length) {
  if (character >= 0xd800 && character < 0xe000) return false;
  const char32_t least = length == 4 ? 0x10000 : length == 3 ? 0x800 : length == 2 ? 0x80 : 0;
  return character >= least && character <= 0x10ffff;
}

// Decodes UTF-8. Each byte that is not part of a valid character becomes U+FFFD.
std::u32string characters(const std::string& text) {
  std::u32string all;
  for (std::size_t at = 0; at < text.size();) {
    const auto first = static_cast<unsigned char>(text[at]);
    const std::size_t length = length_of_character(first);
    char32_t character = length <= 1 ? first : first & (0x7fu >> length);
    bool is_good = length > 0 && at + length <= text.size();
    for (std::size_t k = 1; is_good && k < length; ++k) {
      const auto next = static_cast<unsigned char>(text[at + k]);
      is_good = (next & 0xc0) == 0x80;
      character = character << 6 | (next & 0x3fu);
    }
    is_good = is_good && is_character(character, length);
    all += is_good ? character : U'\xfffd';
    at += is_good ? length : 1;
  }
  return all;
}

std::string fixed_length(const std::vector<std::u32string>& texts, std::size_t length) {
  std::string bytes;
  bytes.reserve(4 * length * texts.size());
  for (std::u32string text : texts) {
    text.resize(length);
    bytes.append(reinterpret_cast<const char*>(text.data()), 4 * text.size());
  }
  return bytes;
}

std::string array_of_texts(const std::vector<std::string>& texts, const std::string& shape) {
  std::vector<std::u32string> all;
  std::size_t length = 1;
  for (const std::string& text : texts) length = std::max(length, all.emplace_back(characters(text)).size());
  return npy_header("<U" + std::to_string(length), shape) + fixed_length(all, length);
}

}  // namespace

std::string npy_array(const Column& column) {
  const std::string count = std::to_string(column.length());
  const std::string shape =
      column.width == 1 ? "(" + count + ",)" : "(" + count + ", " + std::to_string(column.width) + ")";
  if (const auto* texts = std::get_if<std::vector<std::string>>(&column.values))
    return array_of_texts(*texts, shape);
  const auto is_of = [&](auto one) {
    return std::holds_alternative<std::vector<decltype(one)>>(column.values);
  };
  const char* const type = is_of(0.0) ? "<f8" : is_of(std::int32_t{}) ? "<i4" : "<u8";
  std::string array = npy_header(type, shape);
  std::visit(
      [&](const auto& values) {
        array.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof values.front());
      },
      column.values);
  return array;
}

std::string npy_text(const std::string& text) {
  return array_of_texts({text}, "()");
}

namespace {

constexpr std::uint32_t kLocalHeader = 0x04034b50, kCentralHeader = 0x02014b50, kEnd = 0x06054b50;
constexpr std::uint16_t kVersion = 20, kFirstOf1980 = 0x21;

std::uint32_t crc_of(const std::string& bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

// Appends the fields that the header of a member and its entry at the end of the archive have in common: from
// the version that is needed to the length of the extra field.
void put_member(std::string& bytes, std::uint32_t crc, std::uint32_t size, const std::string& name) {
  put(bytes, kVersion);
  for (const int flags_method_time : {0, 0, 0}) put(bytes, static_cast<std::uint16_t>(flags_method_time));
  put(bytes, kFirstOf1980);
  put(bytes, crc);
  put(bytes, size);
  put(bytes, size);
  put(bytes, static_cast<std::uint16_t>(name.size()));
  put(bytes, std::uint16_t{0});  // no extra field
}

std::string local_header(const std::string& name, std::uint32_t crc, std::uint32_t size) {
  std::string header;
  put(header, kLocalHeader);
  put_member(header, crc, size, name);
  return header + name;
}

}  // namespace

std::string ZipArchive::opening(const std::string& name, const std::string& content) {
  return local_header(name, crc_of(content), static_cast<std::uint32_t>(content.size())) + content;
}

void ZipArchive::add(const std::string& name, const std::string& content) {
  constexpr std::uint64_t kMax = std::numeric_limits<std::uint32_t>::max();
  constexpr std::size_t kMaxMembers = 65534, kHeader = 30;
  if (members_.size() >= kMaxMembers) throw std::length_error("would have more than 65534 members");
  if (size_ + kHeader + name.size() + content.size() > kMax)
    throw std::length_error("would be larger than 4 GiB");
  const Member member{name, crc_of(content), static_cast<std::uint32_t>(content.size()),
                      static_cast<std::uint32_t>(size_)};
  const std::string header = local_header(name, member.crc, member.size);
  write_(header);
  write_(content);
  size_ += header.size() + content.size();
  members_.push_back(member);
}

void ZipArchive::finish() {
  std::string directory;
  for (const Member& member : members_) {
    put(directory, kCentralHeader);
    put(directory, kVersion);
    put_member(directory, member.crc, member.size, member.name);
    for (int none = 0; none < 3; ++none) put(directory, std::uint16_t{0});  // comment, disk, kind of file
    put(directory, std::uint32_t{0});                                       // rights
    put(directory, member.at);
    directory += member.name;
  }
  const auto directory_size = static_cast<std::uint32_t>(directory.size());
  const auto count = static_cast<std::uint16_t>(members_.size());
  put(directory, kEnd);
  for (const std::uint16_t number : {std::uint16_t{0}, std::uint16_t{0}, count, count})
    put(directory, number);
  put(directory, directory_size);
  put(directory, static_cast<std::uint32_t>(size_));
  put(directory, std::uint16_t{0});  // no comment
  write_(directory);
}

namespace {

constexpr const char* kFormat = "format.npy";

std::string member_of(const std::vector<Table>& tables, const Table& table, const Column& column) {
  return (tables.size() > 1 ? table.name + "/" : "") + column.name;
}

std::string about(const ExportJob& job, const std::vector<Table>& tables) {
  Json attributes = Json::object(), members = Json::object();
  for (const auto& [name, value] : exported_attributes(job.result, tables)) attributes[name] = value;
  for (const Table& table : tables)
    for (const Column& column : table.columns)
      members[member_of(tables, table, column)] = {
          {"unit", column.units}, {"meaning", column.long_name}, {"names", column.value_names}};
  const Json all{{"attributes", std::move(attributes)}, {"members", std::move(members)}};
  return all.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

void write_npz(const ExportJob& job) try {
  const std::vector<Table> tables = result_tables(job.result);
  const std::string format = npy_text("remote-touch export 1");
  job.begin(job.output, ZipArchive::opening(kFormat, format));
  ZipArchive archive([&](const std::string& bytes) { job.files.append(bytes); });
  archive.add(kFormat, format);
  archive.add("about.npy", npy_text(about(job, tables)));
  for (const Table& table : tables)
    for (const Column& column : table.columns) {
      job.go_on();
      archive.add(member_of(tables, table, column) + ".npy", npy_array(column));
    }
  archive.finish();
} catch (const std::length_error& limit) {
  throw InputError(job.output.string(), std::string(limit.what()) + ": expected .csv for so large a result");
}

}  // namespace remote_touch
