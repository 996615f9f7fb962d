#include "ros/inputs/e_stop_levels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace robot_control::tests {

using testing::ElementsAre;

constexpr bool kTrue = true;
constexpr bool kFalse = false;

struct EStopLevelsTest : testing::Test {
  EStopLevels levels_;
};

TEST_F(EStopLevelsTest, OfOnePublisherFollowItsLastMessage) {
  EXPECT_FALSE(levels_.stopped());
  levels_.receive("/panel", kTrue);
  EXPECT_TRUE(levels_.stopped());
  levels_.receive("/panel", kFalse);
  EXPECT_FALSE(levels_.stopped());
}

TEST_F(EStopLevelsTest, AreTrueUntilNoPublishersLastMessageIsTrue) {
  levels_.receive("/gate", kFalse);
  levels_.receive("/panel", kTrue);
  levels_.receive("/gate", kTrue);
  levels_.receive("/gate", kFalse);
  EXPECT_TRUE(levels_.stopped()) << "/panel says true";
  levels_.receive("/panel", kFalse);
  EXPECT_FALSE(levels_.stopped());
}

TEST_F(EStopLevelsTest, StayWhenTheirPublisherHasLeft) {
  levels_.receive("/gate", kFalse);
  levels_.receive("/panel", kTrue);
  levels_.receive("/gate", kFalse);
  levels_.settle({"/gate"});
  EXPECT_THAT(levels_.publishers(), ElementsAre("/panel")) << "/gate sent false before, too";
}

TEST_F(EStopLevelsTest, OfOneThatHasLeftEndAtTheResetAfterTheFirstFalseOfAnother) {
  levels_.receive("/panel", kTrue);
  levels_.receive("/rostopic_1", kFalse);
  EXPECT_TRUE(levels_.stopped());
  levels_.settle({"/panel", "/rostopic_1"});
  EXPECT_TRUE(levels_.stopped()) << "/panel is still there";
  levels_.settle({"/rostopic_1"});
  EXPECT_FALSE(levels_.stopped());
}

TEST_F(EStopLevelsTest, AreNotEndedByAFalseFromBeforeTheirLastTrue) {
  levels_.receive("/panel", kTrue);
  levels_.receive("/rostopic_1", kFalse);
  levels_.receive("/panel", kTrue);
  levels_.settle({});
  EXPECT_TRUE(levels_.stopped());
}

TEST_F(EStopLevelsTest, AreNotEndedByAPublisherThatWasThereAtAnEarlierReset) {
  levels_.receive("/panel", kTrue);
  levels_.settle({"/teleop"});
  levels_.receive("/teleop", kFalse);
  levels_.settle({"/teleop"});
  EXPECT_THAT(levels_.publishers(), ElementsAre("/panel"));
}

TEST_F(EStopLevelsTest, FromBeforeARestartStayUntilEveryPublisherThatIsThereHasSentFalse) {
  levels_.hold();
  EXPECT_TRUE(levels_.stopped());
  levels_.receive("/gate", kFalse);
  EXPECT_TRUE(levels_.stopped()) << "it ends with a reset request alone";
  levels_.settle({"/gate", "/panel"});
  EXPECT_TRUE(levels_.stopped()) << "/panel may have said true before";
  EXPECT_THAT(levels_.publishers(), ElementsAre(testing::StartsWith("/panel (has published nothing")));
  levels_.receive("/panel", kTrue);
  levels_.settle({"/gate", "/panel"});
  EXPECT_THAT(levels_.publishers(), ElementsAre("/panel"));
  levels_.receive("/panel", kFalse);
  levels_.settle({"/gate", "/panel"});
  EXPECT_FALSE(levels_.stopped());
}

TEST_F(EStopLevelsTest, FromBeforeARestartAreNotEndedBySilence) {
  levels_.hold();
  levels_.settle({});
  EXPECT_TRUE(levels_.stopped()) << "the publisher has left, its button may still be pressed";
  EXPECT_THAT(levels_.publishers(), ElementsAre(testing::HasSubstr("unknown publisher")));
  levels_.receive("/rostopic_1", kFalse);
  levels_.settle({});
  EXPECT_FALSE(levels_.stopped());
}

TEST_F(EStopLevelsTest, FromBeforeARestartAreNotEndedByAButtonThatIsPressedAndReleased) {
  levels_.hold();
  levels_.receive("/panel", kTrue);
  levels_.receive("/panel", kFalse);
  levels_.settle({"/panel"});
  EXPECT_TRUE(levels_.stopped()) << "/gate said true before, and has left";
  EXPECT_THAT(levels_.publishers(), ElementsAre(testing::HasSubstr("unknown publisher")));
  levels_.receive("/rostopic_1", kFalse);
  levels_.settle({"/panel"});
  EXPECT_FALSE(levels_.stopped());
}

TEST_F(EStopLevelsTest, UnderEverNewNamesTakeBoundedMemoryAndNoneIsLost) {
  for (int i = 0; i < 5000; ++i) levels_.receive("/panel_" + std::to_string(i), kTrue);
  EXPECT_LE(levels_.publishers().size(), 1001u);
  for (int i = 0; i < 4999; ++i) levels_.receive("/panel_" + std::to_string(i), kFalse);
  EXPECT_TRUE(levels_.stopped()) << "/panel_4999 says true";
}

}  // namespace robot_control::tests
