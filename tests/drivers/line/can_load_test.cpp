#include "drivers/line/can_load.h"

#include <algorithm>
#include <random>

#include "support/matchers.h"

namespace robot_control::tests {

std::string binary(std::uint32_t value, unsigned bits) {
  std::string text;
  while (bits-- > 0) text += (value >> bits & 1U) != 0 ? '1' : '0';
  return text;
}

/// The bits from the start of frame to the end of the data (ISO 11898-1, 10.4.2).
std::string head_and_data(const can_frame& frame) {
  const std::string rtr = is_remote_request(frame) ? "1" : "0";
  std::string text = "0";
  if (is_extended(frame)) {
    text += binary(frame.can_id >> 18U, 11) + "11" + binary(frame.can_id, 18) + rtr + "00";
  } else {
    text += binary(frame.can_id, 11) + rtr + "00";
  }
  text += binary(frame.len, 4);
  for (std::uint8_t i = 0; i < frame.len && rtr == "0"; ++i) text += binary(frame.data[i], 8);
  return text;
}

/// The remainder of the division by x¹⁵ + x¹⁴ + x¹⁰ + x⁸ + x⁷ + x⁴ + x³ + 1, by hand.
std::string remainder(std::string dividend) {
  const std::string divisor = "1100010110011001";
  const std::size_t length = dividend.size();
  dividend += std::string(15, '0');
  for (std::size_t at = 0; at < length; ++at) {
    if (dividend[at] == '0') continue;
    for (std::size_t i = 0; i < divisor.size(); ++i) dividend[at + i] = dividend[at + i] == divisor[i] ? '0' : '1';
  }
  return dividend.substr(length);
}

std::string stuffed(const std::string& bits) {
  std::string text;
  for (const char bit : bits) {
    text += bit;
    if (text.size() >= 5 && text.substr(text.size() - 5) == std::string(5, bit)) text += bit == '0' ? '1' : '0';
  }
  return text;
}

unsigned reference_bits(const can_frame& frame) {
  const std::string plain = head_and_data(frame);
  return static_cast<unsigned>(stuffed(plain + remainder(plain)).size()) + 13;
}

can_frame random_frame(std::mt19937_64& random) {
  can_frame frame{};
  const bool extended = random() % 2 == 0;
  frame.can_id = extended ? (random() & CAN_EFF_MASK) | CAN_EFF_FLAG : random() & CAN_SFF_MASK;
  if (random() % 8 == 0) frame.can_id |= CAN_RTR_FLAG;
  frame.len = static_cast<std::uint8_t>(random() % 9);
  // Bytes of few changes need the most stuffing.
  const std::uint8_t few[] = {0x00, 0xFF, 0x0F, 0xF0, 0x1E, 0xE1, 0x3C, 0xC3, 0x78, 0x87};
  const bool any = random() % 2 == 0;
  for (std::uint8_t& byte : frame.data)
    byte = any ? static_cast<std::uint8_t>(random()) : few[random() % std::size(few)];
  return frame;
}

TEST(CanLoad, CountsTheBitsOfAFrameAsAnEncoderByHandDoes) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 2000; ++i) {
    const can_frame frame = random_frame(random);
    ASSERT_EQ(frame_bits(frame), reference_bits(frame)) << "frame " << i << ", id " << std::hex << frame.can_id;
  }
}

TEST(CanLoad, NoFrameIsLongerThanTheBoundAndSomeComeWithinTwoBits) {
  std::mt19937_64 random(2);
  unsigned nearest = 99;
  for (int i = 0; i < 100'000; ++i) {
    const can_frame frame = random_frame(random);
    const unsigned bound = max_frame_bits(is_extended(frame), is_remote_request(frame) ? 0 : frame.len);
    ASSERT_LE(frame_bits(frame), bound) << "frame " << i << ", id " << std::hex << frame.can_id;
    nearest = std::min(nearest, bound - frame_bits(frame));
  }
  EXPECT_LE(nearest, 2u);
}

/// The bits of a frame of CAN FD up to the end of its data (ISO 11898-1:2015, 10.4.2), by hand.
std::string fd_head(const can_frame& frame) {
  const std::string id = is_extended(frame) ? binary(frame.can_id >> 18U, 11) + "11" + binary(frame.can_id, 18) + "0"
                                            : binary(frame.can_id, 11) + "00";
  return "0" + id + "10" + ((frame.flags & CANFD_BRS) != 0 ? "1" : "0");
}

std::string fd_data(const can_frame& frame) {
  const unsigned lengths[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};
  const auto code = std::ranges::find(lengths, frame.len) - std::begin(lengths);
  std::string text = "0" + binary(static_cast<std::uint32_t>(code), 4);
  for (unsigned i = 0; i < frame.len; ++i) text += binary(frame.data[i], 8);
  return text;
}

TEST(CanLoad, CountsTheBitsOfAFrameOfCanFdAsAnEncoderByHandDoes) {
  std::mt19937_64 random(3);
  unsigned nearest = 999;
  for (int i = 0; i < 20'000; ++i) {
    can_frame frame = random_frame(random);
    frame.can_id &= ~CAN_RTR_FLAG;
    frame.flags = CANFD_FDF | (random() % 8 == 0 ? 0 : CANFD_BRS);
    frame.len = static_cast<std::uint8_t>(fd_length(static_cast<unsigned>(random() % 65)));
    const auto head = static_cast<unsigned>(stuffed(fd_head(frame)).size());
    const auto all = static_cast<unsigned>(stuffed(fd_head(frame) + fd_data(frame)).size());
    const unsigned checksum = frame.len > 16 ? 4 + 21 + 7 : 4 + 17 + 6;
    const FrameBits bits = fd_frame_bits(frame);
    const FrameBits bound = max_fd_bits(is_extended(frame), frame.len);
    if ((frame.flags & CANFD_BRS) == 0) {
      ASSERT_EQ(bits.arbitration, all + checksum + 13) << i;
      continue;
    }
    ASSERT_EQ(bits.arbitration, head + 13) << i;
    ASSERT_EQ(bits.data, all - head + checksum) << i;
    ASSERT_LE(bits.arbitration, bound.arbitration) << i;
    ASSERT_LE(bits.data, bound.data) << i;
    nearest = std::min(nearest, bound.data - bits.data);
  }
  EXPECT_LE(nearest, 3u);
}

TEST(CanLoad, ThreeOrdersAndAnswersOfCanFdLoadABusWithThreeQuarters) {
  // An order: 35 + 8 + 13 bits at 1 Mbit/s, 389 + 97 + 32 at 5 Mbit/s. An answer: 17 + 4 + 13, and 197 + 49 + 32.
  const PlannedFrames plan[] = {{.fd = true, .extended = true, .data_bytes = 48, .per_cycle = 3},
                                {.fd = true, .data_bytes = 24, .per_cycle = 3}};
  EXPECT_DOUBLE_EQ(bus_load(plan, 1000, 1e6, 5e6), 3 * (56 + 518.0 / 5 + 34 + 278.0 / 5) * 1e-3);
  EXPECT_DOUBLE_EQ(bus_load(plan, 1000, 1e6), 3 * (56 + 518 + 34 + 278) * 1e-3);
}

TEST(CanLoad, TheBoundsAreThoseOfTheStandard) {
  EXPECT_EQ(max_frame_bits(false, 0), 55u);
  EXPECT_EQ(max_frame_bits(false, 4), 95u);
  EXPECT_EQ(max_frame_bits(false, 8), 135u);
  EXPECT_EQ(max_frame_bits(true, 0), 80u);
  EXPECT_EQ(max_frame_bits(true, 4), 120u);
  EXPECT_EQ(max_frame_bits(true, 8), 160u);
}

/// Torque to each drive and estimates from it in each cycle, heartbeats at 10 Hz.
std::vector<PlannedFrames> odrive_plan(unsigned drives) {
  return {{.data_bytes = 4, .per_cycle = 1.0 * drives},
          {.data_bytes = 8, .per_cycle = 1.0 * drives},
          {.data_bytes = 8, .per_second = 10.0 * drives}};
}

TEST(CanLoad, IsTheShareOfTheBitRate) {
  EXPECT_DOUBLE_EQ(bus_load(odrive_plan(2), 1000, 1e6), 2 * (95 + 135 + 1.35) * 1e-3);
}

TEST(CanLoad, APlanBelowSeventyPercentIsTaken) {
  EXPECT_EQ(bus_load_problem(odrive_plan(2), 1000, 1e6, 100), std::nullopt);
}

TEST(CanLoad, TheRefusalNamesTheRateThatFits) {
  const auto problem = bus_load_problem(odrive_plan(4), 1000, 1e6, 100);
  ASSERT_TRUE(problem);
  EXPECT_THAT(*problem, HasSubstr("93 % of 1000 kbit/s at a robot.rate of 1000 Hz, more than 70 %"));
  EXPECT_THAT(*problem, HasSubstr("set robot.rate to at most 755"));
  EXPECT_LE(bus_load(odrive_plan(4), 755, 1e6), kMaxBusLoad);
  EXPECT_GT(bus_load(odrive_plan(4), 756, 1e6), kMaxBusLoad);
}

TEST(CanLoad, NamesTheBitRateWhereNoRateFits) {
  const auto problem = bus_load_problem(odrive_plan(8), 1000, 125e3, 100);
  ASSERT_TRUE(problem);
  EXPECT_THAT(*problem, HasSubstr("no robot.rate fits; set a bit rate of at least 279 kbit/s"));
  EXPECT_LE(bus_load(odrive_plan(8), 100, 279e3), kMaxBusLoad);
}

TEST(CanLoad, ARateThatIsRefusedLeavesARateThatFitsForAllPlans) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> frames(0, 6);
  for (int i = 0; i < 1000; ++i) {
    const std::vector<PlannedFrames> plan = {
        {.extended = random() % 2 == 0, .data_bytes = static_cast<unsigned>(random() % 9), .per_cycle = frames(random)},
        {.per_second = 100 * frames(random)}};
    const auto problem = bus_load_problem(plan, 2000, 500e3, 1);
    const std::string mark = "at most ";
    const std::size_t at = problem ? problem->find(mark) : std::string::npos;
    if (at == std::string::npos) continue;
    const double rate = std::stod(problem->substr(at + mark.size()));
    ASSERT_LE(bus_load(plan, rate, 500e3), kMaxBusLoad + 1e-12) << "plan " << i;
    ASSERT_GT(bus_load(plan, rate + 1, 500e3), kMaxBusLoad) << "plan " << i;
  }
}

}  // namespace robot_control::tests
