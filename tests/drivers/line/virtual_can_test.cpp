#include "drivers/line/virtual_can.h"

#include "drivers/drive/device_rig.h"

namespace robot_control::tests {

struct VirtualCanBus : ::testing::Test {
  VirtualCan bus_{1.0e6};
  std::vector<std::pair<canid_t, std::int64_t>> received_;
  std::size_t first_ = bus_.join([](const can_frame&, std::int64_t) {});
  std::size_t second_ = bus_.join([](const can_frame&, std::int64_t) {});
  std::size_t listener_ =
      bus_.join([this](const can_frame& frame, std::int64_t now_ns) { received_.emplace_back(frame.can_id, now_ns); });
};

TEST_F(VirtualCanBus, AFrameTakesTheTimeOfItsBits) {
  const can_frame frame = word_frame(0x123, 0x5555'5555'5555'5555, 8);
  bus_.send(first_, frame);
  bus_.advance(1'000'000);
  ASSERT_EQ(received_.size(), 1u);
  EXPECT_EQ(received_[0].second, 1000 * static_cast<std::int64_t>(frame_bits(frame)));
  EXPECT_EQ(bus_.busy_ns(), received_[0].second);
}

TEST(VirtualCanFd, TheDataHaveTheirOwnRate) {
  VirtualCan bus(1.0e6, 1, 5.0e6);
  std::int64_t end_ns = 0;
  const std::size_t sender = bus.join([](const can_frame&, std::int64_t) {});
  bus.join([&end_ns](const can_frame&, std::int64_t now_ns) { end_ns = now_ns; });
  can_frame frame = word_frame(0x123, 0x5555'5555'5555'5555, 8);
  frame.flags = CANFD_FDF | CANFD_BRS;
  bus.send(sender, frame);
  bus.advance(1'000'000);
  const FrameBits bits = fd_frame_bits(frame);
  EXPECT_EQ(end_ns, 1000 * std::int64_t{bits.arbitration} + 200 * std::int64_t{bits.data});
}

TEST_F(VirtualCanBus, TheLowestIdentifierWinsAndDataWinOverARequest) {
  bus_.send(first_, word_frame(0x300, 0, 8));
  bus_.advance(10'000);  // 0x300 is on the bus already.
  bus_.send(first_, word_frame(0x200 | CAN_RTR_FLAG, 0, 0));
  bus_.send(first_, word_frame(0x100, 0, 1));
  bus_.send(second_, word_frame(0x200, 0, 1));
  bus_.send(second_, word_frame(0x250, 0, 1));
  bus_.advance(10'000'000);
  std::vector<canid_t> order;
  for (const auto& [id, time_ns] : received_) order.push_back(id);
  // The queue of a party keeps its order: 0x100 waits behind the request.
  EXPECT_EQ(order, (std::vector<canid_t>{0x300, 0x200, 0x200 | CAN_RTR_FLAG, 0x100, 0x250}));
}

TEST_F(VirtualCanBus, AFrameThatNobodyAcknowledgesStaysInItsQueue) {
  bus_.connect(second_, false);
  bus_.connect(listener_, false);
  for (std::size_t i = 0; i < VirtualCan::kMaxQueue; ++i) EXPECT_TRUE(bus_.send(first_, word_frame(1, 0, 0)));
  bus_.advance(1'000'000'000);
  EXPECT_FALSE(bus_.send(first_, word_frame(1, 0, 0)));
  bus_.connect(listener_, true);
  bus_.advance(2'000'000'000);
  EXPECT_EQ(received_.size(), VirtualCan::kMaxQueue);
  EXPECT_GE(received_.front().second, 1'000'000'000);
}

template <class Pair>
void expect_planned_load(const std::vector<Pair>& pairs, double rate) {
  DeviceRig rig(rate);
  for (const Pair& pair : pairs) add(rig, pair);
  const std::vector<PlannedFrames> plan = rig.drives().plan();
  ASSERT_TRUE(rig.runs());
  const std::uint64_t before = rig.bus().frames();
  const std::int64_t busy_before = rig.bus().busy_ns();
  constexpr double kSeconds = 10;
  rig.run(kSeconds);
  const double counted = static_cast<double>(rig.bus().frames() - before) / kSeconds;
  double planned = 0;
  for (const PlannedFrames& frames : plan) planned += frames.per_cycle * rate + frames.per_second;
  EXPECT_NEAR(counted, planned, 0.01 * planned);
  const double load = static_cast<double>(rig.bus().busy_ns() - busy_before) * 1.0e-9 / kSeconds;
  EXPECT_LE(load, bus_load(plan, rate, 1.0e6));
  EXPECT_GE(load, 0.75 * bus_load(plan, rate, 1.0e6));  // The worst stuffing adds a quarter.
}

TEST(PlannedLoad, IsThatOfTheFramesOnTheBus) {
  OdrivePair cyclic = odrive_pair(1);
  cyclic.drive.estimates_period = cyclic.device.estimates_period = 0.001;
  expect_planned_load<OdrivePair>({odrive_pair(1), odrive_pair(2)}, 1000);
  expect_planned_load<OdrivePair>({cyclic}, 1000);
  Cia402Pair with_velocity = cia402_pair(1);
  with_velocity.drive.velocity_pdo = cia402::VelocityPdo::kTrue;
  expect_planned_load<Cia402Pair>({cia402_pair(1), cia402_pair(2)}, 1000);
  expect_planned_load<Cia402Pair>({with_velocity}, 500);
}

}  // namespace robot_control::tests
