#include "runners/experiment/provenance/maker.h"

#include <gtest/gtest.h>

#include "runners/experiment/provenance/provenance.h"
#include "tests/support/test_files.h"

namespace remote_touch::maker_test {
namespace {

class Maker : public testing::Test {
 protected:
  ~Maker() override { identify_program({}); }
};

int unknown() {
  throw InputError("renderer.name = \"centroid\"", "expected proxy");
}

TEST_F(Maker, IsNotNamedForAResultOfThisProgram) {
  EXPECT_EQ(other_maker({}), "");
  EXPECT_EQ(refusal([] { read_configuration({}, "a.h5", unknown); }),
            "renderer.name = \"centroid\": expected proxy");
}

TEST_F(Maker, IsNamedBeforeTheEntryThatIsUnknownHere) {
  const TextAttributes result = {{"program", "press-lab"}};
  EXPECT_EQ(refusal([&] { read_configuration(result, "a.h5", unknown); }),
            "a.h5: was made by press-lab, which has entries of its own: expected that program (here: "
            "renderer.name = \"centroid\": expected proxy)");
  EXPECT_EQ(read_configuration(result, "a.h5", [] { return 3; }), 3);
  identify_program({"press-lab", "12ab"});
  EXPECT_EQ(other_maker(result), "");
}

TEST_F(Maker, NamesThePlugins) {
  const TextAttributes result = {{"plugins", "./a.so: sha256 01"}};
  EXPECT_EQ(refusal([&] { read_configuration(result, "a.h5", unknown); }),
            "a.h5: was made with plug-ins: expected --plugin for each of ./a.so: sha256 01 (here: "
            "renderer.name = \"centroid\": expected proxy)");
  identify_program({"remote-touch", "", {{"./b.so", "02"}}});
  EXPECT_HAS(other_maker(result), "was made with plug-ins: ");
  identify_program({"remote-touch", "", {{"./b.so", "02"}, {"./renamed.so", "01"}}});
  EXPECT_EQ(other_maker(result), "");
  EXPECT_HAS(other_maker({{"plugins", "./a.so: sha256 01\n./c.so: sha256 03"}}), "was made with plug-ins: ");
}

}  // namespace
}  // namespace remote_touch::maker_test
