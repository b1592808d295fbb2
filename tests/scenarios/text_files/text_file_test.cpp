#include "scenarios/text_files/text_file.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/stat.h>

#include <csignal>
#include <future>
#include <string>
#include <thread>

#include "tests/support/test_files.h"

namespace remote_touch::text_file_test {
namespace {

namespace fs = std::filesystem;

std::string refused(const fs::path& file) {
  return refusal([&] { read_text_file(file, "expected a list"); });
}

TEST(TextFile, IsReadWhole) {
  const TestFolder folder("text_file_test");
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{65536}, kMaxTextBytes}) {
    const std::string text(size, 'x');
    EXPECT_EQ(read_text_file(folder.write("x", text), ""), text);
  }
  EXPECT_EQ(read_text_file(folder.write("x", std::string("\0\r\n\xff", 4)), ""),
            std::string("\0\r\n\xff", 4));
}

TEST(TextFile, IsRefusedIfItIsTooLongOrNoFile) {
  const TestFolder folder("text_file_test");
  EXPECT_HAS(refused(folder.write("long", std::string(kMaxTextBytes + 1, 'x'))),
             "long: is longer than 16 MiB: expected a list");
  EXPECT_HAS(refused(fs::path("/dev/zero")), "/dev/zero: is longer than 16 MiB: expected a list");
  EXPECT_HAS(refused(folder.path()), "cannot be read (Is a directory): expected a list");
  EXPECT_HAS(refused(folder / "none"), "none: cannot be read (No such file or directory): expected a list");
}

// A reader of a pipe that nobody writes to would wait for ever.
TEST(TextFile, AnInputIsNeitherPipeNorDeviceNorFolder) {
  const TestFolder folder("text_file_test");
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  fs::create_symlink("/dev/zero", folder / "zero");
  const auto refused_input = [](const fs::path& file) {
    EXPECT_EQ(refusal([&] { require_file(file); }), refusal([&] { read_input_text(file, ""); }));
    return refusal([&] { require_file(file); });
  };
  for (const char* name : {"pipe", "zero"}) {
    const std::string expected =
        (folder / name).string() + ": cannot be read (a pipe or a device): expected a file";
    EXPECT_EQ(refused_input(folder / name), expected);
    EXPECT_EQ(refusal([&] { require_file_or_folder(folder / name); }), expected);
  }
  EXPECT_EQ(refused_input(folder.path()),
            folder.path().string() + ": cannot be read (a folder): expected a file");
  require_file_or_folder(folder.path());
  fs::create_symlink(folder.write("text", "a list"), folder / "link");
  EXPECT_EQ(read_input_text(folder / "link", ""), "a list");
  require_file(folder / "none");
  EXPECT_HAS(refusal([&] { read_input_text(folder / "none", "expected a list"); }), "No such file");
}

TEST(TextFile, AMarkOfTheOrderOfBytesIsNoText) {
  EXPECT_EQ(without_byte_order_mark("\xEF\xBB\xBF# x"), "# x");
  for (const char* text : {"", "\xEF\xBB", "x\xEF\xBB\xBF"}) EXPECT_EQ(without_byte_order_mark(text), text);
}

TEST(TextFile, APipeIsReadToItsEnd) {
  const TestFolder folder("text_file_test");
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  auto text = std::async(std::launch::async, [&] { return read_text_file(folder / "pipe", ""); });
  const std::string sent(300'000, 'p');
  folder.write("pipe", sent);
  EXPECT_EQ(text.get(), sent);
}

// The signal arrives like SIGTERM, whose handler lets interrupted calls continue.
TEST(TextFile, ASignalEndsTheWaitForAPipe) {
  const TestFolder folder("text_file_test");
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  const auto before = std::signal(SIGUSR1, [](int) {});
  std::promise<pthread_t> started;
  auto answer = std::async(std::launch::async, [&] {
    started.set_value(::pthread_self());
    return refused(folder / "pipe");
  });
  const pthread_t reader = started.get_future().get();
  while (answer.wait_for(std::chrono::milliseconds(1)) != std::future_status::ready)
    ::pthread_kill(reader, SIGUSR1);
  EXPECT_HAS(answer.get(), "cannot be read (Interrupted system call)");
  std::signal(SIGUSR1, before);
}

}  // namespace
}  // namespace remote_touch::text_file_test
