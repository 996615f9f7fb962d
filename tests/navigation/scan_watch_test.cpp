#include "navigation/scan_watch.h"

#include "support/matchers.h"

namespace robot_control::navigation::tests {

/// A laser of 360 rays; each test breaks one thing.
struct ScanWatchTest : testing::Test {
  static Scan healthy(float range = 2) { return {-M_PI, 2 * M_PI / 360, 0.05, 8.0, std::vector<float>(360, range)}; }
  std::string refusal(const std::function<void(Scan&)>& broken) {
    Scan scan = healthy();
    broken(scan);
    return watch_.receive(scan, "laser", 10, 10, 0);
  }
  ScanWatch watch_;
};

TEST_F(ScanWatchTest, AHealthyScanCounts) {
  EXPECT_THAT(watch_.problem(10), HasSubstr("no scan received"));
  EXPECT_EQ(watch_.receive(healthy(), "laser", 10, 10, 0), "");
  EXPECT_EQ(watch_.problem(10.1), "");
}

TEST_F(ScanWatchTest, EachMessageThatIsNoScanIsRefused) {
  const auto nan = std::nan("");
  EXPECT_THAT(refusal([](Scan& scan) { scan.ranges.clear(); }), HasSubstr("has 0 rays: allowed are 2 to 20000"));
  EXPECT_THAT(refusal([](Scan& scan) { scan.ranges.resize(1); }), HasSubstr("has 1 rays"));
  EXPECT_THAT(refusal([](Scan& scan) { scan.ranges.resize(100'000); }), HasSubstr("has 100000 rays"));
  EXPECT_THAT(refusal([](Scan& scan) { scan.angle_increment = 0; }), HasSubstr("the increment not zero"));
  EXPECT_THAT(refusal([&](Scan& scan) { scan.angle_min = nan; }), HasSubstr("both must be finite"));
  EXPECT_THAT(refusal([](Scan& scan) { scan.angle_increment = 0.1; }), HasSubstr("covers 35.9 rad"));
  EXPECT_THAT(refusal([](Scan& scan) { scan.range_max = 0; }), HasSubstr("range_max 0 m"));
  EXPECT_THAT(refusal([](Scan& scan) { scan.range_max = HUGE_VAL; }), HasSubstr("range_max inf m: it must be finite"));
  EXPECT_THAT(refusal([](Scan& scan) { scan.angle_max = M_PI / 2; }), HasSubstr("angle_max 1.571 rad"));
  EXPECT_THAT(refusal([](Scan& scan) { scan.range_min = -1; }), HasSubstr("range_min -1 m"));
  EXPECT_THAT(watch_.problem(10), HasSubstr("range_min -1 m"));
}

TEST_F(ScanWatchTest, AnAngleMaxAtTheLastRayOrOneStepBehindItIsTaken) {
  EXPECT_EQ(refusal([](Scan& scan) { scan.angle_max = M_PI; }), "");
  EXPECT_EQ(refusal([](Scan& scan) { scan.angle_max = M_PI - 2 * M_PI / 360; }), "");
}

TEST_F(ScanWatchTest, ALaserOnItsHeadIsTaken) {
  EXPECT_EQ(refusal([](Scan& scan) { scan.angle_min = M_PI, scan.angle_increment *= -1; }), "");
}

TEST_F(ScanWatchTest, SilenceAndWrongStampsAreNamed) {
  watch_.receive(healthy(), "laser", 10, 10, 0);
  EXPECT_THAT(watch_.problem(10.6), HasSubstr("no scan for 0.6 s"));
  watch_.receive(healthy(1), "laser", 10.1, 11, 0);
  EXPECT_THAT(watch_.problem(11), HasSubstr("stamps of scan are 0.9 s old"));
  watch_.receive(healthy(), "laser", 20, 11.1, 0);
  EXPECT_THAT(watch_.problem(11.1), HasSubstr("8.9 s ahead"));
}

TEST_F(ScanWatchTest, ASecondPublisherAndTimeThatGoesBackAreRefused) {
  watch_.receive(healthy(), "front", 10, 10, 0);
  EXPECT_THAT(watch_.receive(healthy(), "rear", 10.05, 10.05, 0), HasSubstr("two publishers, front and rear"));
  EXPECT_THAT(watch_.receive(healthy(), "front", 9, 10.1, 0), HasSubstr("go back by 1.000 s"));
  EXPECT_EQ(watch_.problem(10.1), "");
  EXPECT_EQ(watch_.receive(healthy(), "rear", 12, 12, 0), "");
}

TEST_F(ScanWatchTest, TakesTheLaserAgainAfterOneWrongStampOrAClockThatWasSetBack) {
  EXPECT_EQ(watch_.receive(healthy(), "laser", 3610, 10, 0), "");
  EXPECT_THAT(watch_.receive(healthy(), "laser", 10.1, 10.1, 0), HasSubstr("go back by 3599.900 s"));
  EXPECT_EQ(watch_.receive(healthy(), "laser", 11.1, 11.1, 0), "");
  EXPECT_EQ(watch_.receive(healthy(), "laser", 5, 5, 0), "");
  EXPECT_EQ(watch_.problem(5), "");
}

TEST_F(ScanWatchTest, AFrozenScanIsNamedOnceTheRobotMoved) {
  watch_.receive(healthy(), "laser", 10, 10, 0);
  watch_.receive(healthy(), "laser", 10.1, 10.1, 0.04);
  EXPECT_EQ(watch_.problem(10.1), "");
  watch_.receive(healthy(), "laser", 10.2, 10.2, 0.08);
  EXPECT_THAT(watch_.problem(10.2), HasSubstr("frozen"));
  watch_.receive(healthy(2.01F), "laser", 10.3, 10.3, 0.12);
  EXPECT_EQ(watch_.problem(10.3), "");
}

TEST_F(ScanWatchTest, AnOpenFieldIsNotFrozenAndACoveredLaserIsBlind) {
  const float infinity = std::numeric_limits<float>::infinity();
  watch_.receive(healthy(infinity), "laser", 10, 10, 0);
  watch_.receive(healthy(infinity), "laser", 10.1, 10.1, 0.5);
  EXPECT_EQ(watch_.problem(10.1), "");
  watch_.receive(healthy(0), "laser", 10.2, 10.2, 0.5);
  EXPECT_THAT(watch_.problem(10.2), HasSubstr("no measured range"));
}

TEST_F(ScanWatchTest, ADriverThatReportsRangeMaxOrZeroForNoEchoIsNamedAndCounts) {
  Scan scan = healthy();
  watch_.receive(scan, "laser", 10, 10, 0);
  EXPECT_EQ(watch_.remark(), "");
  std::fill_n(scan.ranges.begin(), 90, 8.0F);
  EXPECT_EQ(watch_.receive(scan, "laser", 10.1, 10.1, 0), "");
  EXPECT_THAT(watch_.remark(), HasSubstr("exactly range_max (8 m) in 25 % of its rays"));
  std::fill_n(scan.ranges.begin(), 90, 0.0F);
  watch_.receive(scan, "laser", 10.2, 10.2, 0);
  EXPECT_EQ(watch_.remark(), "");
  scan.range_min = 0;
  watch_.receive(scan, "laser", 10.3, 10.3, 0);
  EXPECT_THAT(watch_.remark(), HasSubstr("0 m in 25 % of its rays"));
  EXPECT_EQ(watch_.problem(10.3), "");
  watch_.receive(healthy(8.0F), "laser", 10.4, 10.4, 0);
  EXPECT_EQ(watch_.problem(10.4), "") << "an open field";
}

}  // namespace robot_control::navigation::tests
