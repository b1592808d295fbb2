#include <gtest/gtest.h>

#include <stdexcept>

#include "runners/presentation/export_formats.h"
#include "tests/support/test_files.h"

namespace remote_touch::npz_test {
namespace {

// The header has 10 bytes, the text padded to 128 bytes with its line feed, and the values.
std::string npy(const std::string& text, const std::string& values) {
  std::string file("\x93NUMPY\x01\x00\x76\x00", 10);
  file += text;
  file.resize(127, ' ');
  return file + "\n" + values;
}

TEST(NpyArray, WritesNumbers) {
  const Column column{"a", "m", "", std::vector<double>{1.5, -2}, 1, {}};
  EXPECT_EQ(npy_array(column), npy("{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }",
                                   std::string("\0\0\0\0\0\0\xf8\x3f\0\0\0\0\0\0\0\xc0", 16)));
}

TEST(NpyArray, WritesVectorsCountsAndHashes) {
  const Column counts{"a", "1", "", std::vector<std::int32_t>{1, 2, 3, -1, 5, 6}, 3, {}};
  EXPECT_EQ(npy_array(counts),
            npy("{'descr': '<i4', 'fortran_order': False, 'shape': (2, 3), }",
                raw(1) + raw(2) + raw(3) + std::string("\xff\xff\xff\xff", 4) + raw(5) + raw(6)));
  const Column hashes{"a", "1", "", std::vector<std::uint64_t>{0x0123456789abcdef}, 1, {}};
  EXPECT_EQ(npy_array(hashes), npy("{'descr': '<u8', 'fortran_order': False, 'shape': (1,), }",
                                   "\xef\xcd\xab\x89\x67\x45\x23\x01"));
  const Column none{"a", "m", "", std::vector<double>{}, 3, {}};
  EXPECT_EQ(npy_array(none), npy("{'descr': '<f8', 'fortran_order': False, 'shape': (0, 3), }", ""));
}

// Characters have four bytes; U+00E9, U+20AC and U+1F600 have two, three and four in UTF-8.
TEST(NpyArray, WritesTexts) {
  const Column column{"a", "1", "", std::vector<std::string>{"\u00e9\u20ac\U0001f600", "x", ""}, 1, {}};
  const auto c = [](std::uint32_t character) { return raw(character); };
  EXPECT_EQ(npy_array(column),
            npy("{'descr': '<U3', 'fortran_order': False, 'shape': (3,), }",
                c(0xe9) + c(0x20ac) + c(0x1f600) + c('x') + c(0) + c(0) + c(0) + c(0) + c(0)));
  EXPECT_EQ(npy_text("ok"), npy("{'descr': '<U2', 'fortran_order': False, 'shape': (), }", c('o') + c('k')));
  EXPECT_EQ(npy_text("a\xff\xc3"),
            npy("{'descr': '<U3', 'fortran_order': False, 'shape': (), }", c('a') + c(0xfffd) + c(0xfffd)));
}

// Forms that are too long, halves of pairs of UTF-16, and numbers above U+10FFFF, which NumPy refuses.
TEST(NpyArray, ACharacterThatIsNoneBecomesAQuestion) {
  const std::string question = raw(std::uint32_t{0xfffd});
  const auto values = [](const std::string& text) { return npy_text(text).substr(128); };
  for (const char* wrong : {"\xe0\x80\x80", "\xed\xa0\x80", "\xed\xbf\xbf"})
    EXPECT_EQ(values(wrong), question + question + question) << wrong;
  for (const char* wrong : {"\xf0\x80\x80\x80", "\xf4\x90\x80\x80"})
    EXPECT_EQ(values(wrong), question + question + question + question) << wrong;
  for (const auto& [right, number] : {std::pair("\xe0\xa0\x80", 0x800u),
                                      {"\xed\x9f\xbf", 0xd7ffu},
                                      {"\xee\x80\x80", 0xe000u},
                                      {"\xf0\x90\x80\x80", 0x10000u},
                                      {"\xf4\x8f\xbf\xbf", 0x10ffffu}})
    EXPECT_EQ(values(right), raw(std::uint32_t{number})) << right;
}

// The bytes follow the specification (APPNOTE 4.3). The CRC-32 of "123456789" is the check value of its
// catalogue.
TEST(ZipArchive, HasTheBytesOfTheSpecification) {
  std::string archive;
  ZipArchive zip([&](const std::string& bytes) { archive += bytes; });
  zip.add("a", "123456789");
  zip.add("bc", "");
  zip.finish();
  const auto u16 = [](int value) { return raw(static_cast<std::uint16_t>(value)); };
  const auto member = [&](std::uint32_t crc, std::uint32_t size, int name_length) {
    return u16(20) + u16(0) + u16(0) + u16(0) + u16(0x21) + raw(crc) + raw(size) + raw(size) +
           u16(name_length) + u16(0);
  };
  const std::string local = std::string("PK\3\4") + member(0xcbf43926, 9, 1) + "a" + "123456789" + "PK\3\4" +
                            member(0, 0, 2) + "bc";
  const std::string no_more = u16(0) + u16(0) + u16(0) + raw(std::uint32_t{0});
  const std::string central = std::string("PK\1\2") + u16(20) + member(0xcbf43926, 9, 1) + no_more +
                              raw(std::uint32_t{0}) + "a" + "PK\1\2" + u16(20) + member(0, 0, 2) + no_more +
                              raw(std::uint32_t{40}) + "bc";
  const std::string end = std::string("PK\5\6") + u16(0) + u16(0) + u16(2) + u16(2) +
                          raw(static_cast<std::uint32_t>(central.size())) +
                          raw(static_cast<std::uint32_t>(local.size())) + u16(0);
  EXPECT_EQ(archive, local + central + end);
  EXPECT_TRUE(archive.starts_with(ZipArchive::opening("a", "123456789")));
}

TEST(ZipArchive, HasNoMoreMembersThanTheFormatCounts) {
  ZipArchive zip([](const std::string&) {});
  for (int i = 0; i < 65534; ++i) zip.add("a", "");
  try {
    zip.add("a", "");
    ADD_FAILURE() << "one more is accepted";
  } catch (const std::length_error& limit) {
    EXPECT_STREQ(limit.what(), "would have more than 65534 members");
  }
}

}  // namespace
}  // namespace remote_touch::npz_test
