#include "tools/plumb/start_flags.h"

#include <gtest/gtest.h>

namespace plumb::tools {
namespace {

TEST(Mount, TellsWhatIsUpInTheLidarsFrame) {
  const struct {
    const char* mount;
    Eigen::Vector3d up;
  } cases[] = {{"", {0, 0, 1}},
               {"0,0", {0, 0, 1}},
               {"180,0", {0, 0, -1}},
               {"90,0", {0, 1, 0}},
               {"-90,0", {0, -1, 0}},
               {"0,90", {-1, 0, 0}},
               {"90,90", {-1, 0, 0}},
               {"180,180", {0, 0, 1}},
               {"0,30", {-0.5, 0, std::sqrt(0.75)}},
               {"90,30", {-0.5, std::sqrt(0.75), 0}}};
  for (const auto& c : cases) {
    const auto up = ParseMount(c.mount);
    ASSERT_TRUE(up) << c.mount;
    EXPECT_LT((*up - c.up).norm(), 1e-12) << c.mount << ": " << up->transpose();
  }
}

TEST(Mount, NamesWhatIsNoMount) {
  for (const char* mount : {"180", "1,2,3", "x,0", "0,", "nan,0", "0,inf"}) {
    const auto up = ParseMount(mount);
    ASSERT_FALSE(up) << mount;
    EXPECT_EQ(up.error().code, ErrorCode::kBadOption);
    EXPECT_NE(up.error().message.find(mount), std::string::npos);
  }
}

}  // namespace
}  // namespace plumb::tools
