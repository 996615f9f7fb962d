#include "drivers/line/can_bus.h"

#include <linux/can/error.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <deque>

#include "rt/clock.h"
#include "support/matchers.h"

namespace {

/// Results of the next calls of sendmmsg: a negative entry is an error, another one the number of messages accepted.
std::deque<int> planned_sends;

}  // namespace

/// Stands before the C library's: an interface whose queue is full cannot be had without CAN.
extern "C" int sendmmsg(int descriptor, mmsghdr* messages, unsigned count, int flags) {
  if (!planned_sends.empty()) {
    const int plan = planned_sends.front();
    planned_sends.pop_front();
    if (plan < 0) {
      errno = -plan;
      return -1;
    }
    count = std::min(count, static_cast<unsigned>(plan));
  }
  return static_cast<int>(syscall(SYS_sendmmsg, descriptor, messages, count, flags));
}

namespace {

/// The kernel's own count of frames that found no room, which a local socket never reports; 0: not reported.
std::uint32_t reported_drops = 0;

}  // namespace

extern "C" int recvmmsg(int descriptor, mmsghdr* messages, unsigned count, int flags, timespec* timeout) {
  const auto received = static_cast<int>(syscall(SYS_recvmmsg, descriptor, messages, count, flags, timeout));
  for (int i = 0; i < received && reported_drops != 0; ++i) {
    msghdr& head = messages[i].msg_hdr;
    head.msg_controllen = CMSG_LEN(sizeof reported_drops);
    *CMSG_FIRSTHDR(&head) = {.cmsg_len = head.msg_controllen, .cmsg_level = SOL_SOCKET, .cmsg_type = SO_RXQ_OVFL};
    std::memcpy(CMSG_DATA(CMSG_FIRSTHDR(&head)), &reported_drops, sizeof reported_drops);
  }
  return received;
}

namespace robot_control::tests {

can_frame numbered(unsigned number) {
  return word_frame(0x100 + number % 0x100, number, 8);
}

std::vector<can_frame> numbered_up_to(unsigned count) {
  std::vector<can_frame> frames;
  for (unsigned i = 0; i < count; ++i) frames.push_back(numbered(i));
  return frames;
}

CanTime at(std::int64_t time_ns) {
  return {.time_ns = time_ns, .utc_ns = utc_ns()};
}

/// A healthy bus on one end of a socket pair; the test holds the other end.
struct CanBusTest : ::testing::Test {
  void SetUp() override {
    int ends[2];
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends), 0);
    bus_ = std::make_unique<CanBus>(CanSocket(ends[0]));
    far_ = ends[1];
  }
  void TearDown() override {
    planned_sends.clear();
    reported_drops = 0;
    if (far_ >= 0) close(far_);
  }

  void send_from_far(const void* data, std::size_t bytes) {
    ASSERT_EQ(::send(far_, data, bytes, 0), static_cast<ssize_t>(bytes));
  }
  void send_from_far(const can_frame& frame) { send_from_far(&frame, transfer_size(frame)); }
  void report(canid_t error, std::uint8_t controller = 0) {
    can_frame frame = word_frame(CAN_ERR_FLAG | error, 0, CAN_ERR_DLC);
    frame.data[1] = controller;
    send_from_far(frame);
    EXPECT_TRUE(bus_->receive(at(1)).frames.empty());
  }

  std::vector<unsigned> arrived_at_far() {
    std::vector<unsigned> numbers;
    can_frame frame{};
    while (::recv(far_, &frame, kFrameBytes, 0) == kFrameBytes)
      numbers.push_back(static_cast<unsigned>(data_word(frame)));
    return numbers;
  }

  std::unique_ptr<CanBus> bus_;
  int far_ = -1;
};

TEST_F(CanBusTest, SendsABatchInItsOrderOneFrameAMessage) {
  const auto frames = numbered_up_to(40);
  EXPECT_EQ(bus_->send(frames), 40u);
  const auto arrived = arrived_at_far();
  ASSERT_EQ(arrived.size(), 40u);
  EXPECT_TRUE(std::ranges::is_sorted(arrived));
  EXPECT_EQ(bus_->counts().sent, 40u);
}

TEST_F(CanBusTest, ReceivesInBatchesUntilNothingIsLeft) {
  for (unsigned i = 0; i < 100; ++i) send_from_far(numbered(i));
  unsigned next = 0, calls = 0;
  for (bool more = true; more; ++calls) {
    const ReceivedFrames batch = bus_->receive(at(1));
    for (const ReceivedFrame& each : batch.frames) EXPECT_EQ(data_word(each.frame), next++);
    more = batch.more;
  }
  EXPECT_EQ(next, 100u);
  EXPECT_EQ(calls, 4u);
  EXPECT_EQ(bus_->counts().received, 100u);
}

TEST(CanLine, ADatagramHoldsTheFramesOfACycle) {
  int ends[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends), 0);
  CanBus near(CanSocket::line_end(ends[0])), far(CanSocket::line_end(ends[1]));
  const auto frames = numbered_up_to(kMaxFramesPerDatagram + 4);
  EXPECT_EQ(near.send(frames), frames.size());
  std::array<char, kFrameBytes> start{};
  EXPECT_EQ(::recv(ends[1], start.data(), start.size(), MSG_PEEK | MSG_TRUNC),
            static_cast<ssize_t>(kMaxFramesPerDatagram * kFrameBytes));
  const ReceivedFrames received = far.receive(at(7));
  ASSERT_EQ(received.frames.size(), frames.size());
  for (unsigned i = 0; i < frames.size(); ++i) EXPECT_EQ(data_word(received.frames[i].frame), i);
  EXPECT_EQ(received.frames[0].stamp_ns, 7);
}

/// A frame of CAN FD whose last byte is its number.
can_frame fd_frame(unsigned length, std::uint8_t number) {
  can_frame frame = word_frame(0x8001 | CAN_EFF_FLAG, 0, 0);
  frame.flags = CANFD_FDF | CANFD_BRS;
  frame.len = static_cast<std::uint8_t>(length);
  frame.data[length - 1] = number;
  return frame;
}

TEST(CanLine, FramesOfBothKindsShareADatagramInTheirOrder) {
  int ends[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends), 0);
  CanBus near(CanSocket::line_end(ends[0])), far(CanSocket::line_end(ends[1]));
  const can_frame frames[] = {numbered(1), fd_frame(64, 2), fd_frame(12, 3), numbered(4)};
  EXPECT_EQ(near.send(frames), 4u);
  std::array<char, 1> start{};
  EXPECT_EQ(::recv(ends[1], start.data(), start.size(), MSG_PEEK | MSG_TRUNC),
            static_cast<ssize_t>(2 * kFrameBytes + 2 * kFdFrameBytes));
  const ReceivedFrames received = far.receive(at(7));
  ASSERT_EQ(received.frames.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const can_frame& frame = received.frames[i].frame;
    EXPECT_EQ(frame.can_id, frames[i].can_id);
    EXPECT_EQ(frame.len, frames[i].len);
    EXPECT_EQ(frame.flags, frames[i].flags);
    EXPECT_TRUE(std::ranges::equal(frame.data, frames[i].data));
  }
}

TEST_F(CanBusTest, AFrameOfCanFdIsSentAsALongOneAndReceivedWithoutItsMark) {
  const can_frame long_frame = fd_frame(48, 9);
  EXPECT_EQ(bus_->send({&long_frame, 1}), 1u);
  can_frame frame{};
  ASSERT_EQ(::recv(far_, &frame, sizeof frame, 0), static_cast<ssize_t>(kFdFrameBytes));
  frame.flags = CANFD_BRS;  // as of a kernel before Linux 5.14
  send_from_far(&frame, kFdFrameBytes);
  const ReceivedFrames received = bus_->receive(at(1));
  ASSERT_EQ(received.frames.size(), 1u);
  EXPECT_EQ(received.frames[0].frame.flags, long_frame.flags);
  EXPECT_EQ(received.frames[0].frame.data[47], 9);
}

TEST_F(CanBusTest, AFrameOfCanFdThatIsTooLongOrCutIsMalformed) {
  can_frame frame = fd_frame(64, 1);
  frame.len = 65;
  send_from_far(frame);
  send_from_far(&frame, 2 * kFrameBytes);
  EXPECT_TRUE(bus_->receive(at(1)).frames.empty());
  EXPECT_EQ(bus_->counts().malformed, 2u);
}

TEST(CanLine, WhatAFullLineRefusesIsCounted) {
  int ends[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends), 0);
  CanBus near(CanSocket::line_end(ends[0]));
  std::size_t sent = 0, offered = 0;
  while (near.counts().refused == 0 && offered < 1'000'000) {
    offered += 4;
    sent += near.send(numbered_up_to(4));
  }
  EXPECT_EQ(near.counts().refused, 4u);
  EXPECT_EQ(sent + 4, offered);
  EXPECT_EQ(near.counts().errors, 0u);
  close(ends[1]);
}

TEST_F(CanBusTest, DoesNotWaitWhereNothingArrived) {
  const ReceivedFrames batch = bus_->receive(at(1));
  EXPECT_TRUE(batch.frames.empty());
  EXPECT_FALSE(batch.more);
  EXPECT_EQ(bus_->counts().errors, 0u);
}

TEST_F(CanBusTest, WhatAFullQueueRefusesIsCountedAndNotSentLater) {
  planned_sends = {2, -ENOBUFS};
  EXPECT_EQ(bus_->send(numbered_up_to(40)), 2u);
  EXPECT_EQ(bus_->counts().sent, 2u);
  EXPECT_EQ(bus_->counts().refused, 38u);
  EXPECT_EQ(bus_->counts().errors, 0u);
  EXPECT_EQ(bus_->send(std::vector{numbered(77)}), 1u);
  EXPECT_THAT(arrived_at_far(), ElementsAre(0, 1, 77));
}

TEST_F(CanBusTest, AnInterruptedCallIsRepeated) {
  planned_sends = {-EINTR, 1, -EINTR};
  EXPECT_EQ(bus_->send(numbered_up_to(3)), 3u);
  EXPECT_THAT(arrived_at_far(), ElementsAre(0, 1, 2));
}

TEST_F(CanBusTest, AnInterfaceThatIsDownIsAnError) {
  planned_sends = {-ENETDOWN};
  EXPECT_EQ(bus_->send(numbered_up_to(3)), 0u);
  EXPECT_EQ(bus_->counts().errors, 1u);
  EXPECT_EQ(bus_->counts().refused, 3u);
}

TEST_F(CanBusTest, AnEndThatWasClosedIsAnError) {
  close(far_);
  far_ = -1;
  EXPECT_EQ(bus_->send(numbered_up_to(1)), 0u);
  EXPECT_EQ(bus_->counts().errors, 1u);
}

TEST_F(CanBusTest, ErrorFramesMoveTheStateAndAreNotReturned) {
  EXPECT_EQ(bus_->state(), CanState::kActive);
  report(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING);
  EXPECT_EQ(bus_->state(), CanState::kWarning);
  report(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_PASSIVE);
  EXPECT_EQ(bus_->state(), CanState::kPassive);
  report(CAN_ERR_CRTL, CAN_ERR_CRTL_ACTIVE);
  EXPECT_EQ(bus_->state(), CanState::kActive);
  report(CAN_ERR_ACK);
  EXPECT_EQ(bus_->state(), CanState::kActive);
  EXPECT_EQ(bus_->counts().error_frames, 4u);
  EXPECT_EQ(bus_->last_error_frame().can_id, CAN_ERR_FLAG | CAN_ERR_ACK);
  EXPECT_EQ(bus_->counts().received, 0u);
}

TEST_F(CanBusTest, BusOffIsCountedOnceUntilTheControllerIsRestarted) {
  report(CAN_ERR_BUSOFF);
  report(CAN_ERR_BUSOFF);
  EXPECT_EQ(bus_->state(), CanState::kBusOff);
  EXPECT_EQ(bus_->counts().bus_off, 1u);
  report(CAN_ERR_RESTARTED);
  EXPECT_EQ(bus_->state(), CanState::kActive);
  report(CAN_ERR_BUSOFF);
  EXPECT_EQ(bus_->counts().bus_off, 2u);
}

TEST_F(CanBusTest, AReceivedFrameEndsBusOff) {
  report(CAN_ERR_BUSOFF);
  send_from_far(numbered(1));
  EXPECT_EQ(bus_->receive(at(1)).frames.size(), 1u);
  EXPECT_EQ(bus_->state(), CanState::kActive);
}

TEST_F(CanBusTest, AnOverflowOfTheControllerIsALoss) {
  report(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW);
  EXPECT_EQ(bus_->counts().lost, 1u);
}

TEST_F(CanBusTest, WhatTheKernelDroppedBeforeAFrameIsLost) {
  for (const std::uint32_t drops : {3U, 3U, 5U}) {
    reported_drops = drops;
    send_from_far(numbered(1));
    EXPECT_EQ(bus_->receive(at(1)).frames.size(), 1u);
    EXPECT_EQ(bus_->counts().lost, drops);
  }
}

TEST_F(CanBusTest, WhatIsNoWholeFrameIsCountedAndDropped) {
  const ::can_frame frames[kMaxFramesPerDatagram + 1] = {};
  send_from_far(frames, kFrameBytes - 1);
  send_from_far(frames, 0);
  send_from_far(frames, sizeof frames);
  can_frame long_frame = numbered(1);
  long_frame.len = CAN_MAX_DLEN + 1;
  send_from_far(long_frame);
  send_from_far(numbered(2));
  const ReceivedFrames batch = bus_->receive(at(1));
  ASSERT_EQ(batch.frames.size(), 1u);
  EXPECT_EQ(data_word(batch.frames[0].frame), 2u);
  EXPECT_EQ(bus_->counts().malformed, 4u);
}

TEST_F(CanBusTest, AStampIsTheTimeOfReceptionNotOfTheCall) {
  const std::int64_t before = utc_ns();
  send_from_far(numbered(1));
  const std::int64_t after = utc_ns();
  constexpr std::int64_t kCall = 5'000'000'000, kLater = 40'000'000;
  const ReceivedFrames batch = bus_->receive({.time_ns = kCall, .utc_ns = after + kLater});
  ASSERT_EQ(batch.frames.size(), 1u);
  EXPECT_LE(batch.frames[0].stamp_ns, kCall - kLater);
  EXPECT_GE(batch.frames[0].stamp_ns, kCall - kLater - (after - before));
}

TEST_F(CanBusTest, AStampStaysBetweenTwoCallsWhenTheTimeOfDayJumps) {
  constexpr std::int64_t kHour = 3'600'000'000'000, kFirst = 5'000'000'000, kSecond = 5'001'000'000;
  bus_->receive({.time_ns = kFirst, .utc_ns = utc_ns()});
  send_from_far(numbered(1));
  const auto early = bus_->receive({.time_ns = kSecond, .utc_ns = utc_ns() + kHour});
  ASSERT_EQ(early.frames.size(), 1u);
  EXPECT_EQ(early.frames[0].stamp_ns, kFirst);
  send_from_far(numbered(2));
  const auto late = bus_->receive({.time_ns = kSecond + 1, .utc_ns = utc_ns() - kHour});
  ASSERT_EQ(late.frames.size(), 1u);
  EXPECT_EQ(late.frames[0].stamp_ns, kSecond + 1);
}

std::vector<canid_t> passing(const std::vector<can_filter>& filters, const std::vector<canid_t>& ids) {
  int ends[2];
  EXPECT_EQ(socketpair(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends), 0);
  CanBus bus(CanSocket(ends[0], filters));
  for (const canid_t id : ids) {
    const can_frame frame = word_frame(id, 0, 0);
    EXPECT_EQ(::send(ends[1], &frame, kFrameBytes, 0), static_cast<ssize_t>(kFrameBytes));
  }
  std::vector<canid_t> passed;
  for (const ReceivedFrame& each : bus.receive(at(1)).frames) passed.push_back(each.frame.can_id);
  close(ends[1]);
  return passed;
}

TEST(CanFilters, FramesThatPassNoneAreDropped) {
  const std::vector<can_filter> filters = {{.can_id = 0x120, .can_mask = 0x7F0}, {.can_id = 0x581, .can_mask = 0x7FF}};
  EXPECT_THAT(passing(filters, {0x11F, 0x120, 0x12F, 0x130, 0x581, 0x582}), ElementsAre(0x120, 0x12F, 0x581));
}

TEST(CanFilters, AnInvertedOnePassesTheOthers) {
  const std::vector<can_filter> filters = {{.can_id = 0x120 | CAN_INV_FILTER, .can_mask = 0x7F0}};
  EXPECT_THAT(passing(filters, {0x11F, 0x120, 0x12F, 0x130}), ElementsAre(0x11F, 0x130));
}

}  // namespace robot_control::tests
