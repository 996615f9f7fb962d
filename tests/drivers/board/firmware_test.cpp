/// The firmware in C as the host compiles it: frames, messages, watchdog, refusals and the velocity loop.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <span>

#include "drivers/board/mutated_stream.h"
#include "firmware/board.h"

namespace robot_control::tests {

using Bytes = std::vector<std::uint8_t>;

Bytes frame_of(std::span<const std::uint8_t> body) {
  Bytes frame(BOARD_MAX_FRAME);
  frame.resize(board_encode(body.data(), static_cast<std::uint8_t>(body.size()), frame.data()));
  return frame;
}

Bytes frame_of(const board_order& order) {
  Bytes body(BOARD_MAX_BODY);
  body.resize(board_write_order(&order, body.data()));
  return frame_of(body);
}

/// The same order to both wheels.
board_order order_of(std::uint16_t cycle, int mode, std::int32_t value, std::uint8_t wheels = 2) {
  board_order order{};
  order.cycle = cycle;
  order.wheels = wheels;
  for (board_wheel_order& wheel : order.wheel) wheel = {.mode = static_cast<std::uint8_t>(mode), .value = value};
  return order;
}

TEST(BoardFrame, HasTheChecksumAndTheBytesOfTheSpecification) {
  const Bytes check{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(board_crc32(check.data(), 9), 0xCBF43926u);  // the check value of CRC-32
  EXPECT_EQ(frame_of(Bytes{0}), (Bytes{1, 5, 0x8D, 0xEF, 0x02, 0xD2, 0}));
}

TEST(BoardFrame, AnyBodyComesBackAndLongerOnesAreRefused) {
  std::mt19937 random(7);
  board_decoder decoder{};
  for (std::size_t size = 1; size <= BOARD_MAX_BODY; ++size) {
    Bytes body(size);
    for (std::uint8_t& byte : body) byte = static_cast<std::uint8_t>(random() % 4 == 0 ? 0 : random());
    const Bytes frame = frame_of(body);
    ASSERT_LE(frame.size(), std::size_t{BOARD_MAX_FRAME});
    ASSERT_EQ(std::ranges::count(frame, 0), 1) << "the end of the frame alone";
    std::uint8_t got = 0;
    for (const std::uint8_t byte : frame) got = board_decode(&decoder, byte);
    ASSERT_EQ(got, size);
    ASSERT_TRUE(std::equal(body.begin(), body.end(), decoder.body));
  }
  EXPECT_TRUE(frame_of(Bytes(BOARD_MAX_BODY + 1)).empty());
  EXPECT_TRUE(frame_of(Bytes{}).empty());
  EXPECT_EQ(decoder.bad, 0);
}

/// A board with two wheels and no machine.
struct BoardTest : testing::Test {
  BoardTest() { configure({}); }

  void configure(board_config config) {
    config.context = this;
    config.wheels = 2;
    config.functions = {
        .time_us = [](void* test) { return self(test).now_us_; },
        .counts = [](void* test, std::uint32_t* counts) { std::copy_n(self(test).counts_.begin(), 2, counts); },
        .drive =
            [](void* test, std::uint8_t wheel, board_mode mode, std::int32_t value) {
              self(test).driven_[wheel] = {.mode = static_cast<std::uint8_t>(mode), .value = value};
            },
        .sensors = [](void*, std::uint8_t, board_sensors* sensors) { sensors->valid = BOARD_HAS_IMU; },
        .write =
            [](void* test, const std::uint8_t* bytes, std::uint8_t size) {
              self(test).receive({bytes, size});
            }};
    board_begin(&board_, &config);
  }

  static BoardTest& self(void* test) { return *static_cast<BoardTest*>(test); }

  void receive(std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) {
      const std::uint8_t size = board_decode(&decoder_, byte);
      if (size != 0) reports_ += board_read_report(decoder_.body, size, &report_);
    }
  }

  void give(const Bytes& bytes) { board_step(&board_, bytes.data(), static_cast<std::uint8_t>(bytes.size())); }
  void order(int mode, std::int32_t value, std::uint16_t cycle = 1, std::uint8_t wheels = 2) {
    give(frame_of(order_of(cycle, mode, value, wheels)));
  }

  void expect_no_motion(int streams) {
    MutatedStreams mutated;
    for (int i = 0; i < streams; ++i) {
      give(mutated.next(frame_of(order_of(static_cast<std::uint16_t>(i), BOARD_EFFORT, 1000))));
      ASSERT_EQ(driven_[0].mode, BOARD_BRAKE) << i;
      ASSERT_EQ(driven_[1].mode, BOARD_BRAKE) << i;
    }
    order(BOARD_EFFORT, 7);
    EXPECT_EQ(driven_[0].value, 7) << "a whole order is obeyed after all that";
  }

  board board_{};
  board_decoder decoder_{};
  board_report report_{};
  int reports_ = 0;
  std::uint32_t now_us_ = 0xFFFFFF00U;  // its clock wraps
  std::array<std::uint32_t, 2> counts_{};
  std::array<board_wheel_order, 2> driven_{};
};

TEST_F(BoardTest, AnswersAnOrderWithItsCycleAndDrives) {
  counts_ = {5, 0xFFFFFFFF};
  order(BOARD_EFFORT, -1234567, 77);
  EXPECT_EQ(reports_, 1);
  EXPECT_EQ(report_.cycle, 77);
  EXPECT_EQ(report_.time_us, now_us_);
  EXPECT_EQ(report_.counts[1], 0xFFFFFFFFu);
  EXPECT_EQ(report_.flags, BOARD_WATCHDOG) << "it braked before its first order";
  EXPECT_EQ(driven_[1].mode, BOARD_EFFORT);
  EXPECT_EQ(driven_[1].value, -1234567);
}

TEST_F(BoardTest, EachReportSaysThatItBrakedByItselfUntilTheHostBrakes) {
  order(BOARD_BRAKE, 0);
  order(BOARD_EFFORT, 1, 2);
  ASSERT_EQ(report_.flags, 0);
  now_us_ += 50'000;
  give({});
  order(BOARD_EFFORT, 1, 3, 1);  // of another number of wheels
  EXPECT_EQ(report_.flags, BOARD_WATCHDOG | BOARD_REFUSED);
  for (std::uint16_t cycle = 4; cycle < 10; ++cycle) {
    order(BOARD_EFFORT, 1, cycle);
    EXPECT_EQ(report_.flags, BOARD_WATCHDOG);
    EXPECT_EQ(driven_[0].mode, BOARD_EFFORT);
  }
  order(BOARD_BRAKE, 0, 10);
  EXPECT_EQ(report_.flags, BOARD_WATCHDOG) << "this report may be lost: the host brakes on";
  order(BOARD_EFFORT, 1, 11);
  EXPECT_EQ(report_.flags, 0);
}

TEST_F(BoardTest, BrakesFiftyMillisecondsAfterTheLastOrderAndUntilTheNextOne) {
  give({});
  EXPECT_EQ(driven_[0].mode, BOARD_BRAKE) << "before the first order";
  order(BOARD_EFFORT, 1);
  now_us_ += 49'999;
  give({});
  EXPECT_EQ(driven_[0].mode, BOARD_EFFORT);
  now_us_ += 1;
  give({});
  EXPECT_EQ(driven_[0].mode, BOARD_BRAKE);
  now_us_ -= 1;  // as if the clock had wrapped
  give({});
  EXPECT_EQ(driven_[0].mode, BOARD_BRAKE);
  order(BOARD_EFFORT, 1, 2);
  EXPECT_EQ(driven_[0].mode, BOARD_EFFORT);
}

TEST_F(BoardTest, RefusesWhatItDoesNotKnowAndBrakes) {
  const board_order other = order_of(2, BOARD_BRAKE, 0);
  Bytes body(BOARD_MAX_BODY);
  body.resize(board_write_order(&other, body.data()));
  body[0] = BOARD_PROTOCOL + 1;
  for (int kind = 0; kind < 3; ++kind) {
    order(BOARD_EFFORT, 1);
    ASSERT_EQ(driven_[0].mode, BOARD_EFFORT);
    if (kind == 0) give(frame_of(body));
    if (kind == 1) order(BOARD_EFFORT, 1, 3, 1);
    if (kind == 2) order(BOARD_VELOCITY + 1, 1, 3);
    EXPECT_EQ(driven_[0].mode, BOARD_BRAKE) << kind;
    EXPECT_EQ(report_.flags & BOARD_REFUSED, BOARD_REFUSED) << kind;
  }
}

TEST_F(BoardTest, CountsLostOrdersAndBadFrames) {
  order(BOARD_BRAKE, 0, 0xFFFE);
  order(BOARD_BRAKE, 0, 2);  // FFFF, 0 and 1 are missing
  EXPECT_EQ(report_.lost, 3);
  Bytes damaged = frame_of(order_of(3, BOARD_BRAKE, 0));
  damaged[3] ^= 0x40;
  give(damaged);
  order(BOARD_BRAKE, 0, 4);
  EXPECT_EQ(report_.bad, 1);
}

TEST_F(BoardTest, ItsVelocityLoopReachesTheSpeedWithinItsLimitAndWithoutWindUp) {
  // A motor of 20 000 counts/s at full voltage with a time constant of 50 ms.
  board_config config{};
  config.velocity_loop = 1;
  config.loop_period_us = 1000;
  config.kp = 20;
  config.ki = 1;
  config.max_pwm = 10000;
  configure(config);
  const auto run = [&](std::int32_t speed, int milliseconds) {
    double largest = 0;
    static double velocity = 0;
    static double position = 0;
    for (int i = 0; i < milliseconds; ++i) {
      order(BOARD_VELOCITY, 256 * speed, static_cast<std::uint16_t>(i));
      EXPECT_EQ(driven_[0].mode, BOARD_PWM);
      EXPECT_LE(std::abs(driven_[0].value), 10000);
      velocity += (2.0 * driven_[0].value - velocity) * 0.001 / 0.05;
      position += velocity * 0.001;
      counts_[0] = static_cast<std::uint32_t>(static_cast<std::int64_t>(position));
      now_us_ += 1000;
      largest = std::max(largest, std::abs(velocity));
    }
    return std::pair(velocity, largest);
  };
  const auto [velocity, largest] = run(10000, 1000);
  EXPECT_NEAR(velocity, 10000, 300);
  EXPECT_LT(largest, 12000);
  run(100000, 2000);  // beyond what the motor can
  EXPECT_NEAR(run(0, 500).first, 0, 300) << "the integral did not wind up";
}

TEST_F(BoardTest, NoStreamOfBytesMovesAWheelUnlessItsOrderIsWhole) {
  expect_no_motion(20'000);
}

TEST_F(BoardTest, NightlyNoneOfAMillionStreamsMovesAWheel) {
  expect_no_motion(1'000'000);
}

}  // namespace robot_control::tests
