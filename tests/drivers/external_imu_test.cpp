#include "drivers/external_imu.h"

#include <gtest/gtest.h>

#include "drivers/board/board_machine.h"

namespace robot_control::tests {

struct ExternalImuTest : testing::Test {
  SensorFrame read() {
    SensorFrame frame;
    machine_.read(frame);
    machine_.write(std::vector<JointCommand>(2));
    return frame;
  }
  void send(double rate, std::uint64_t valid = kValidGyro | kValidAccelerometer) {
    inbox_->store({.imu = {.angular_velocity = {0, 0, rate}, .linear_acceleration = {0, 0, 9.81}},
                   .valid = valid,
                   .time_ns = now_ns_});
  }

  std::int64_t now_ns_ = 1'000'000'000;
  std::shared_ptr<ImuInbox> inbox_ = std::make_shared<ImuInbox>();
  ExternalImu machine_{std::make_unique<BoardMachine>(), inbox_, [this] { return now_ns_; }};
};

TEST_F(ExternalImuTest, TheMachineIsStartingUntilTheFirstSample) {
  machine_.start();
  EXPECT_EQ(read().driver_state, DriverState::kStarting);
  EXPECT_NE(machine_.warning().find("imu/input"), std::string::npos);
  send(0.5);
  const SensorFrame frame = read();
  EXPECT_EQ(frame.driver_state, DriverState::kRunning);
  EXPECT_EQ(frame.valid & (kValidGyro | kValidAccelerometer), kValidGyro | kValidAccelerometer);
  EXPECT_EQ(frame.imu.angular_velocity[2], 0.5);
  EXPECT_EQ(machine_.warning(), "");
}

TEST_F(ExternalImuTest, ASampleCountsForItsLife) {
  machine_.start();
  send(0.5);
  now_ns_ += ExternalImu::kImuLife;
  EXPECT_NE(read().valid & kValidGyro, 0u);
  now_ns_ += 1;
  const SensorFrame frame = read();
  EXPECT_EQ(frame.valid, 0u);
  EXPECT_EQ(frame.driver_state, DriverState::kRunning);
}

TEST_F(ExternalImuTest, WhatIsNotFiniteOrNotMeasuredIsNotValid) {
  machine_.start();
  send(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(read().valid, kValidAccelerometer);
  send(0.5, kValidGyro);
  EXPECT_EQ(read().valid, kValidGyro);
}

}  // namespace robot_control::tests
