#include "ros/inputs/command_senders.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace robot_control {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class CommandSendersTest : public testing::Test {
 protected:
  CommandSendersTest() { senders_.set_window(100); }

  CommandSenders senders_;
};

TEST_F(CommandSendersTest, AreThoseReceivedWithinTheWindow) {
  EXPECT_THAT(senders_.at(0), IsEmpty());
  senders_.add("/b", 10);
  senders_.add("/a", 50);
  EXPECT_THAT(senders_.at(110), ElementsAre("/a", "/b"));
  EXPECT_THAT(senders_.at(111), ElementsAre("/a"));
  EXPECT_THAT(senders_.at(151), IsEmpty());
}

TEST_F(CommandSendersTest, OfOneNameAreOne) {
  for (std::int64_t now = 0; now < 50; ++now) senders_.add("/a", now);
  EXPECT_EQ(senders_.count(50), 1u);
}

TEST_F(CommandSendersTest, AreForgottenWhenTimeTurnsBackByMoreThanTheWindow) {
  senders_.add("/a", 1000);
  EXPECT_THAT(senders_.at(900), ElementsAre("/a")) << "two threads looked in another order";
  EXPECT_THAT(senders_.at(899), IsEmpty());
  senders_.add("/a", 900);
  EXPECT_THAT(senders_.at(950), ElementsAre("/a"));
}

TEST_F(CommandSendersTest, UnderEverNewNamesTakeBoundedMemoryAndTheNewestStays) {
  for (int i = 0; i < 1000; ++i) senders_.add("/sender_" + std::to_string(i), i / 100);
  EXPECT_EQ(senders_.count(10), 16u);
  senders_.add("/last", 11);
  EXPECT_THAT(senders_.at(11), testing::Contains("/last"));
}

}  // namespace
}  // namespace robot_control
