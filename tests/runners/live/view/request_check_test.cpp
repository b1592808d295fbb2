// Which requests the page server answers, and what it says to the others.
#include "runners/live/view/request_check.h"

#include <gtest/gtest.h>

#include "tests/support/test_files.h"

namespace remote_touch::request_check_test {
namespace {

TEST(RequestCheck, LoopbackNamesWithAnyPortAreAnswered) {
  for (const char* host : {"127.0.0.1:40123", "localhost:40123", "localhost:8000", "127.0.0.1:1",
                           "[::1]:65535", "localhost", "127.0.0.1"})
    EXPECT_TRUE(is_loopback_host(host)) << host;
}

TEST(RequestCheck, OtherNamesAreRefused) {
  for (const char* host :
       {"", "example.org", "example.org:8000", "localhost.example.org", "localhost:8000.example.org",
        "127.0.0.1.example.org:8000", "127.0.0.1:", "localhost:80a0", "localhost:8000;x", "localhost:123456",
        "127.0.0.2:8000", "10.0.0.1:8000", "user@localhost:8000", " localhost", "localhost:8000 "})
    EXPECT_FALSE(is_loopback_host(host)) << host;
}

// Another program on this machine may serve a page, too: its port differs.
TEST(RequestCheck, OnlyThePageOfThisServerOpensAChannel) {
  EXPECT_TRUE(is_own_origin("http://127.0.0.1:40123", "127.0.0.1:40123"));
  EXPECT_TRUE(is_own_origin("http://localhost:8000", "localhost:8000")) << "through ssh -L";
  EXPECT_FALSE(is_own_origin("http://127.0.0.1:40124", "127.0.0.1:40123"));
  EXPECT_FALSE(is_own_origin("http://localhost:40123", "127.0.0.1:40123"));
  EXPECT_FALSE(is_own_origin("http://example.org", "example.org")) << "DNS rebinding";
  EXPECT_FALSE(is_own_origin("https://127.0.0.1:40123", "127.0.0.1:40123"));
  EXPECT_FALSE(is_own_origin("null", "127.0.0.1:40123"));
  EXPECT_FALSE(is_own_origin("", "127.0.0.1:40123"));
  EXPECT_FALSE(is_own_origin("http://127.0.0.1:40123/", "127.0.0.1:40123"));
}

TEST(RequestCheck, EveryRefusalSaysWhatToDo) {
  EXPECT_HAS(refusal_text(403, "40123"), "ssh -L 8000:127.0.0.1:40123 ");
  EXPECT_HAS(refusal_text(404, "40123"), "open the whole address");
  EXPECT_HAS(refusal_text(409, "40123"), "Close one of them");
  EXPECT_HAS(refusal_text(405, "40123"), "Open the address that the terminal prints");
}

}  // namespace
}  // namespace remote_touch::request_check_test
