#include "runners/presentation/export_formats.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/parameters/parameter.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {
namespace {

// Returns the header. Its length, including the 10 bytes of the opening, is a multiple of 64, so that the
// values are aligned.
std::string npy_header(const std::string& type, const std::string& shape) {
  constexpr std::size_t kOpening = 10, kAlignment = 64;
  std::string text = "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
  const std::size_t whole = (kOpening + text.size() + 1 + kAlignment - 1) / kAlignment * kAlignment;
  text.resize(whole - kOpening - 1, ' ');
  text += '\n';
  std::string header("\x93NUMPY\x01\x00", 8);
  put(header, static_cast<std::uint16_t>(text.size()));
  return header + text;
}

// Decodes UTF-8. Each byte that is not part of a valid character becomes U+FFFD: forms that are too long,
// halves of pairs of UTF-16 and numbers above U+10FFFF are no characters.
std::u32string characters(const std::string& text) {
  constexpr char32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};  // by the number of bytes
  std::u32string all;
  for (std::size_t at = 0; at < text.size();) {
    const auto first = static_cast<unsigned char>(text[at]);
    const int ones = std::countl_one(first);
    const auto length = static_cast<std::size_t>(std::max(ones, 1));
    char32_t character = first & (ones == 0 ? 0x7fu : 0x7fu >> ones);
    bool is_good = ones != 1 && length <= 4 && at + length <= text.size();
    for (std::size_t k = 1; is_good && k < length; ++k) {
      const auto next = static_cast<unsigned char>(text[at + k]);
      is_good = (next & 0xc0) == 0x80;
      character = character << 6 | (next & 0x3fu);
    }
    is_good = is_good && character >= kLeast[length] && character <= 0x10ffff &&
              (character < 0xd800 || character >= 0xe000);
    all += is_good ? character : U'\xfffd';
    at += is_good ? length : 1;
  }
  return all;
}

std::string array_of_texts(const std::vector<std::string>& texts, const std::string& shape) {
  std::vector<std::u32string> all;
  std::size_t length = 1;
  for (const std::string& text : texts) length = std::max(length, all.emplace_back(characters(text)).size());
  std::string array = npy_header("<U" + std::to_string(length), shape);
  for (std::u32string& text : all) {
    text.resize(length);
    array.append(reinterpret_cast<const char*>(text.data()), 4 * length);
  }
  return array;
}

constexpr std::uint32_t kLocalHeader = 0x04034b50, kCentralHeader = 0x02014b50, kEnd = 0x06054b50;
constexpr std::uint16_t kVersion = 20, kFirstOf1980 = 0x21, kNone = 0;

std::uint32_t crc_of(const std::string& bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

// Appends the fields that the header of a member and its entry at the end of the archive have in common: from
// the version that is needed to the length of the extra field, which is none. Flags, method and time are 0.
void put_member(std::string& bytes, std::uint32_t crc, std::uint32_t size, const std::string& name) {
  put(bytes, kVersion, kNone, kNone, kNone, kFirstOf1980, crc, size, size);
  put(bytes, static_cast<std::uint16_t>(name.size()), kNone);
}

std::string local_header(const std::string& name, std::uint32_t crc, std::uint32_t size) {
  std::string header;
  put(header, kLocalHeader);
  put_member(header, crc, size, name);
  return header + name;
}

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

std::string npy_array(const Column& column) {
  const std::string count = std::to_string(column.length());
  const std::string shape =
      column.width == 1 ? "(" + count + ",)" : "(" + count + ", " + std::to_string(column.width) + ")";
  const auto array_of = [&]<class Value>(const std::vector<Value>& values) {
    if constexpr (std::is_same_v<Value, std::string>) {
      return array_of_texts(values, shape);
    } else {
      const char* const type = std::is_same_v<Value, double>         ? "<f8"
                               : std::is_same_v<Value, std::int32_t> ? "<i4"
                                                                     : "<u8";
      return npy_header(type, shape)
          .append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
    }
  };
  return std::visit(array_of, column.values);
}

std::string npy_text(const std::string& text) {
  return array_of_texts({text}, "()");
}

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
  constexpr std::uint32_t kNoRights = 0;
  std::string directory;
  for (const Member& member : members_) {
    put(directory, kCentralHeader, kVersion);
    put_member(directory, member.crc, member.size, member.name);
    put(directory, kNone, kNone, kNone, kNoRights, member.at);  // first: comment, disk, kind of file
    directory += member.name;
  }
  const auto size = static_cast<std::uint32_t>(directory.size());
  const auto count = static_cast<std::uint16_t>(members_.size());
  put(directory, kEnd, kNone, kNone, count, count, size, static_cast<std::uint32_t>(size_));
  put(directory, kNone);  // no comment
  write_(directory);
}

void write_npz(const ExportJob& job) try {
  const std::vector<Table> tables = result_tables(job);
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
