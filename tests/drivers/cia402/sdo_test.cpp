#include "drivers/cia402/sdo.h"

#include <gtest/gtest.h>

namespace robot_control::canopen::tests {

using enum SdoCommand;
using enum SdoSide;

struct Example {
  const char* name;
  SdoSide side;
  SdoMessage message;
  std::vector<std::uint8_t> bytes;
};

void PrintTo(const Example& example, std::ostream* stream) {
  *stream << example.name;
}

constexpr ObjectAddress kObject{0x1A02, 3};

/// The bytes follow from the bits of CiA 301, 7.2.4.3.3 – 7.2.4.3.17.
const Example kExamples[] = {
    {"DownloadOfOneByte",
     kRequest,
     {.command = kDownload, .object = kObject, .expedited = true, .length = 1, .data = {0xAB}},
     {0x2F, 0x02, 0x1A, 0x03, 0xAB, 0, 0, 0}},
    {"DownloadOfTwoBytes",
     kRequest,
     {.command = kDownload, .object = kObject, .expedited = true, .length = 2, .data = {1, 2}},
     {0x2B, 0x02, 0x1A, 0x03, 1, 2, 0, 0}},
    {"DownloadOfThreeBytes",
     kRequest,
     {.command = kDownload, .object = kObject, .expedited = true, .length = 3, .data = {1, 2, 3}},
     {0x27, 0x02, 0x1A, 0x03, 1, 2, 3, 0}},
    {"DownloadOfFourBytes",
     kRequest,
     {.command = kDownload, .object = kObject, .expedited = true, .length = 4, .data = {1, 2, 3, 4}},
     {0x23, 0x02, 0x1A, 0x03, 1, 2, 3, 4}},
    {"DownloadInSegments",
     kRequest,
     {.command = kDownload, .object = kObject, .size = 10},
     {0x21, 0x02, 0x1A, 0x03, 10, 0, 0, 0}},
    {"DownloadAcknowledged",
     kResponse,
     {.command = kDownload, .object = kObject},
     {0x60, 0x02, 0x1A, 0x03, 0, 0, 0, 0}},
    {"FirstDownloadSegment",
     kRequest,
     {.command = kDownloadSegment, .length = 7, .data = {1, 2, 3, 4, 5, 6, 7}},
     {0x00, 1, 2, 3, 4, 5, 6, 7}},
    {"LastDownloadSegment",
     kRequest,
     {.command = kDownloadSegment, .toggle = true, .last = true, .length = 3, .data = {8, 9, 10}},
     {0x19, 8, 9, 10, 0, 0, 0, 0}},
    {"SegmentAcknowledged", kResponse, {.command = kDownloadSegment, .toggle = true}, {0x30, 0, 0, 0, 0, 0, 0, 0}},
    {"Upload", kRequest, {.command = kUpload, .object = kObject}, {0x40, 0x02, 0x1A, 0x03, 0, 0, 0, 0}},
    {"UploadOfOneByte",
     kResponse,
     {.command = kUpload, .object = kObject, .expedited = true, .length = 1, .data = {7}},
     {0x4F, 0x02, 0x1A, 0x03, 7, 0, 0, 0}},
    {"UploadOfFourBytes",
     kResponse,
     {.command = kUpload, .object = kObject, .expedited = true, .length = 4, .data = {1, 2, 3, 4}},
     {0x43, 0x02, 0x1A, 0x03, 1, 2, 3, 4}},
    {"UploadInSegments",
     kResponse,
     {.command = kUpload, .object = kObject, .size = 0x12345678},
     {0x41, 0x02, 0x1A, 0x03, 0x78, 0x56, 0x34, 0x12}},
    {"SegmentAskedFor", kRequest, {.command = kUploadSegment, .toggle = true}, {0x70, 0, 0, 0, 0, 0, 0, 0}},
    {"UploadSegment",
     kResponse,
     {.command = kUploadSegment, .last = true, .length = 7, .data = {1, 2, 3, 4, 5, 6, 7}},
     {0x01, 1, 2, 3, 4, 5, 6, 7}},
    {"AbortByTheClient",
     kRequest,
     {.command = kAbort, .object = kObject, .abort_code = 0x05040000},
     {0x80, 0x02, 0x1A, 0x03, 0x00, 0x00, 0x04, 0x05}},
    {"AbortByTheServer",
     kResponse,
     {.command = kAbort, .object = kObject, .abort_code = 0x06020000},
     {0x80, 0x02, 0x1A, 0x03, 0x00, 0x00, 0x02, 0x06}},
};

class SdoExample : public ::testing::TestWithParam<Example> {};

TEST_P(SdoExample, HasTheBytesOfTheStandardBothWays) {
  const can_frame frame = encode_sdo(GetParam().side, 9, GetParam().message);
  EXPECT_EQ(frame.can_id, GetParam().side == kRequest ? 0x609u : 0x589u);
  EXPECT_EQ(std::vector(frame.data, frame.data + frame.len), GetParam().bytes);
  EXPECT_EQ(decode_sdo(GetParam().side, 9, frame), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(Cia301, SdoExample, ::testing::ValuesIn(kExamples),
                         [](const auto& each) { return std::string(each.param.name); });

TEST(Sdo, AnExpeditedValueWithoutASizeHasFourBytes) {
  const auto message = decode_sdo(kResponse, 9, word_frame(0x589, 0x04030201'03'1A02'4E, 8));
  ASSERT_TRUE(message);
  EXPECT_EQ(message->length, 4);
  EXPECT_EQ(expedited_value(*message), 0x04030201u);
}

TEST(Sdo, BytesWithoutDataAreNoPartOfTheValue) {
  const auto message = decode_sdo(kResponse, 9, word_frame(0x589, 0xFFFFFF07'03'1A02'4F, 8));
  ASSERT_TRUE(message);
  EXPECT_EQ(expedited_value(*message), 7u);
}

TEST(Sdo, AWriteOfANumberIsLittleEndian) {
  const SdoMessage message = expedited_download({0x6060, 0}, 0x0A, 1);
  EXPECT_EQ(data_word(encode_sdo(kRequest, 1, message)), 0x0A'00'6060'2Fu);
  EXPECT_EQ(expedited_value(message), 10u);
}

TEST(Sdo, OtherFramesAreNotOfThisTransfer) {
  const can_frame good = encode_sdo(kResponse, 9, {.command = kDownload});
  EXPECT_TRUE(decode_sdo(kResponse, 9, good));
  EXPECT_FALSE(decode_sdo(kResponse, 8, good));
  EXPECT_FALSE(decode_sdo(kRequest, 9, good));
  can_frame other = good;
  other.len = 7;
  EXPECT_FALSE(decode_sdo(kResponse, 9, other));
  other = good;
  other.data[0] = 0xA0;  // block upload
  EXPECT_FALSE(decode_sdo(kResponse, 9, other));
  other = good;
  other.can_id |= CAN_EFF_FLAG;
  EXPECT_FALSE(decode_sdo(kResponse, 9, other));
}

TEST(Sdo, AbortsHaveWords) {
  EXPECT_STREQ(abort_words(0x06020000), "object does not exist in the object dictionary");
  EXPECT_STREQ(abort_words(0x06010002), "attempt to write a read-only object");
  EXPECT_STREQ(abort_words(0x08000022),
               "data cannot be transferred or stored because of the present state of the device");
  EXPECT_STREQ(abort_words(0x12345678), "unknown abort code");
}

}  // namespace robot_control::canopen::tests
