#include "navigation/mapping/mapper.h"

#include <gtest/gtest.h>

#include "navigation/house.h"

namespace robot_control::navigation::tests {

using namespace testing_house;

/// A robot that drives through two rooms, with an odometry that is true.
struct MapperTest : testing::Test {
  void scan_at(const PlanarPose& truth, const UncertainPose& odometry) {
    mapper_.update(scan_of(house_, truth), {}, odometry);
  }
  void map_the_left_room() {
    for (double x = 1; x < 2.2; x += 0.1) scan_at({x, 1.2, 0}, {{x, 1.2, 0}});
    for (double y = 1.2; y < 2.2; y += 0.1) scan_at({2.2, y, 0}, {{2.2, y, 0}});
  }

  Grid house_ = two_rooms(1.0);
  Mapper mapper_;
};

/// The odometry shows a correction of 0.8 m within two seconds, in steps of up to 0.16 m, while the robot stands.
TEST_F(MapperTest, ACorrectionOfThePastPathIsNoMotion) {
  map_the_left_room();
  const PlanarPose truth{2.2, 2.1, 0};
  for (double left = 0.8; left > 0.01; left *= 0.8) {
    UncertainPose odometry{{truth.x + 0.8 - left, truth.y, 0}, 1e-4 * Eigen::Matrix3d::Identity()};
    odometry.covariance(0, 0) += left * left;
    scan_at(truth, odometry);
    EXPECT_TRUE(mapper_.fits()) << left << " m left: " << mapper_.reason();
    EXPECT_NEAR(mapper_.pose().x, truth.x - 1, 0.05) << left << " m left";  // the map begins 1 m from the corner
  }
}

}  // namespace robot_control::navigation::tests
