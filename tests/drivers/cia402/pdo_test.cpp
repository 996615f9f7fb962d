#include "drivers/cia402/pdo.h"

#include "drivers/cia402/drive_objects.h"
#include "support/matchers.h"

namespace robot_control::canopen::tests {

constexpr std::uint8_t kNode = 5;
const cia402::AxisPdos kPdos;

TEST(Pdo, TheSetUpOfTheCommandIsThatOfTheStandard) {
  const PdoSetup setup = pdo_setup(kPdos.command, kNode, kEverySync, 0);
  EXPECT_THAT(setup.all(),
              ElementsAre(SdoWrite{{0x1400, 1}, 0x80000205, 4}, SdoWrite{{0x1600, 0}, 0, 1},
                          SdoWrite{{0x1600, 1}, 0x60400010, 4}, SdoWrite{{0x1600, 2}, 0x60710010, 4},
                          SdoWrite{{0x1600, 0}, 2, 1}, SdoWrite{{0x1400, 2}, 1, 1}, SdoWrite{{0x1400, 1}, 0x205, 4}));
}

TEST(Pdo, TheBitThatForbidsRemoteRequestsIsKept) {
  const PdoSetup setup = pdo_setup(kPdos.velocity, kNode, kOnEvent, 0xC0000285);
  EXPECT_THAT(setup.all(), ElementsAre(SdoWrite{{0x1801, 1}, 0xC0000285, 4}, SdoWrite{{0x1A01, 0}, 0, 1},
                                       SdoWrite{{0x1A01, 1}, 0x606C0020, 4}, SdoWrite{{0x1A01, 0}, 1, 1},
                                       SdoWrite{{0x1801, 2}, 255, 1}, SdoWrite{{0x1801, 1}, 0x40000285, 4}));
}

TEST(Pdo, NumbersHaveTheIdentifiersOfTheStandard) {
  Pdo pdo{.kind = PdoKind::kReceive, .number = 4, .mapping = {}};
  EXPECT_EQ(pdo.cob_id(kNode), 0x505u);
  EXPECT_EQ(pdo.parameters(), 0x1403);
  EXPECT_EQ(pdo.mapping_index(), 0x1603);
  pdo.kind = PdoKind::kTransmit;
  EXPECT_EQ(pdo.cob_id(kNode), 0x485u);
  EXPECT_EQ(pdo.parameters(), 0x1803);
  EXPECT_EQ(pdo.mapping_index(), 0x1A03);
}

TEST(Pdo, ACommandIsControlwordAndTorque) {
  const std::int64_t values[] = {0x0F, -200};
  const can_frame frame = encode_pdo(kPdos.command, kNode, values);
  EXPECT_EQ(frame.can_id, 0x205u);
  EXPECT_EQ(frame.len, 4);
  EXPECT_EQ(data_word(frame), 0xFF38'000Fu);
}

TEST(Pdo, AStateIsStatuswordPositionAndTorque) {
  std::int64_t values[3] = {};
  EXPECT_TRUE(decode_pdo(kPdos.state, kNode, word_frame(0x185, 0xFF38'FFFFFFFE'9237, 8), values));
  EXPECT_THAT(values, ElementsAre(0x9237, -2, -200));
}

TEST(Pdo, OtherFramesChangeNothing) {
  std::int64_t values[3] = {7, 8, 9};
  EXPECT_FALSE(decode_pdo(kPdos.state, kNode, word_frame(0x186, 0, 8), values));
  EXPECT_FALSE(decode_pdo(kPdos.state, kNode, word_frame(0x185, 0, 7), values));
  EXPECT_FALSE(decode_pdo(kPdos.state, kNode, word_frame(0x185 | CAN_RTR_FLAG, 0, 8), values));
  EXPECT_THAT(values, ElementsAre(7, 8, 9));
}

}  // namespace robot_control::canopen::tests
