/// Properties that all frames on the bus share.

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstring>

#include "signals/command_frame.h"
#include "signals/permit.h"
#include "signals/sensor_frame.h"
#include "signals/state_frame.h"
#include "signals/trace.h"
#include "signals/truth_frame.h"

namespace robot_control::tests {

/// A constant expression cannot read padding, so this compiles only without any.
template <class Plain>
constexpr bool kWithoutPadding = [] {
  constexpr auto words = std::bit_cast<std::array<std::uint64_t, sizeof(Plain) / 8>>(Plain{});
  return words.size() * 8 == sizeof(Plain);
}();
static_assert(kWithoutPadding<DriverTrace> && kWithoutPadding<EstimatorTrace> && kWithoutPadding<ControllerTrace> &&
              kWithoutPadding<MonitorTrace>);

template <class Frame>
struct FrameTest : testing::Test {
  FrameTest() {
    frame_.head.run = 7;
    frame_.head.cycle = 1234;
    seal(frame_);
  }

  Frame frame_{};
};

using Frames = testing::Types<SensorFrame, StateFrame, CommandFrame, Permit, TruthFrame>;
TYPED_TEST_SUITE(FrameTest, Frames);

TYPED_TEST(FrameTest, HasNoPadding) {
  static_assert(kWithoutPadding<TypeParam>);
  SUCCEED();
}

TYPED_TEST(FrameTest, IsIntactOnceSealed) {
  EXPECT_TRUE(intact(this->frame_));
}

TYPED_TEST(FrameTest, IsNotIntactBeforeItIsSealed) {
  EXPECT_FALSE(intact(TypeParam{}));
}

TYPED_TEST(FrameTest, SealingTwiceChangesNothing) {
  const std::uint64_t once = this->frame_.head.checksum;
  seal(this->frame_);
  EXPECT_EQ(this->frame_.head.checksum, once);
}

// Every step of the hash is a bijection of its input word, so a change of one word can never cancel.
TYPED_TEST(FrameTest, NoticesEveryFlippedBit) {
  constexpr std::size_t kBits = sizeof(TypeParam) * 8;
  for (std::size_t bit = 0; bit < kBits; ++bit) {
    TypeParam flipped = this->frame_;
    auto* bytes = reinterpret_cast<unsigned char*>(&flipped);
    bytes[bit / 8] = static_cast<unsigned char>(bytes[bit / 8] ^ (1u << (bit % 8)));
    ASSERT_FALSE(intact(flipped)) << "bit " << bit;
  }
}

TYPED_TEST(FrameTest, NoticesTwoWordsThatChangedPlaces) {
  TypeParam swapped = this->frame_;
  std::swap(swapped.head.run, swapped.head.cycle);
  EXPECT_FALSE(intact(swapped));
}

TYPED_TEST(FrameTest, IsNotIntactOfZeroes) {
  TypeParam zero = this->frame_;
  std::memset(static_cast<void*>(&zero), 0, sizeof zero);
  EXPECT_FALSE(intact(zero));
}

TEST(SensorFrame, SealsANaNLikeAnyNumber) {
  SensorFrame frame;
  frame.imu.angular_velocity[2] = std::numeric_limits<double>::quiet_NaN();
  seal(frame);
  EXPECT_TRUE(intact(frame));
}

TEST(CommandFrame, BrakesByDefault) {
  const CommandFrame frame;
  for (const JointCommand& joint : frame.joints) EXPECT_EQ(joint.mode, JointMode::kBrake);
}

TEST(Permit, BrakesByDefault) {
  EXPECT_EQ(Permit{}.action, PermitAction::kBrake);
}

}  // namespace robot_control::tests
