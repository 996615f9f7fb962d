#include "drivers/line/bus_watch.h"

#include <linux/can/error.h>
#include <sys/socket.h>
#include <unistd.h>

#include "support/matchers.h"

namespace robot_control::tests {

/// A healthy bus: a frame was received just now. The test holds the other end of the socket.
struct BusWatchTest : ::testing::Test {
  static constexpr std::int64_t kSecond = 1'000'000'000;  // ns

  BusWatchTest() {
    carry(data_frame(0x123, {}));
    after(0);
  }
  ~BusWatchTest() override { close(ends_.other); }

  struct Ends {
    int own = -1, other = -1;
    Ends() {
      int ends[2];
      if (socketpair(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0, ends) != 0) ADD_FAILURE() << "no socket";
      own = ends[0];
      other = ends[1];
    }
  };

  void carry(const can_frame& frame) const {
    ASSERT_EQ(::send(ends_.other, &frame, kFrameBytes, 0), static_cast<ssize_t>(kFrameBytes));
  }
  void report(canid_t classes, std::uint64_t data) const {
    carry(word_frame(CAN_ERR_FLAG | classes, data, CAN_ERR_DLC));
  }
  /// Runs one cycle, this many ns after the last one.
  const BusStatus& after(std::int64_t ns) {
    now_ns_ += ns;
    bus_.receive({.time_ns = now_ns_, .utc_ns = now_ns_});
    watch_.step(bus_, now_ns_);
    return watch_.status();
  }
  std::string text() const { return words(watch_.status()); }

  Ends ends_;
  CanBus bus_{CanSocket(ends_.own)};
  BusWatch watch_;
  std::int64_t now_ns_ = kSecond;
};

TEST_F(BusWatchTest, ABusThatCarriesFramesIsUp) {
  EXPECT_EQ(after(kSecond).state, LinkState::kUp);
  EXPECT_EQ(text(), "");
}

TEST_F(BusWatchTest, IsDownAfterTheTimeWithoutAnyFrame) {
  EXPECT_EQ(after(BusWatch::kRecentNs - 1).state, LinkState::kUp);
  EXPECT_EQ(after(1).state, LinkState::kDown);
  EXPECT_EQ(text(),
            "the bus: no frame was received in the last 1.5 s; check the cable, its terminators, the power of the "
            "drives and the bit rate");
  carry(data_frame(0x123, {}));
  EXPECT_EQ(after(1).state, LinkState::kUp);
}

TEST_F(BusWatchTest, ABusThatNeverCarriedAFrameStartsAndIsThenDown) {
  BusWatch watch;
  const Ends ends;
  const CanBus bus{CanSocket(ends.own)};
  watch.step(bus, 0);
  EXPECT_EQ(watch.status().state, LinkState::kStarting);
  EXPECT_EQ(words(watch.status()), "");
  watch.step(bus, BusWatch::kRecentNs);
  EXPECT_EQ(watch.status().state, LinkState::kDown);
  close(ends.other);
}

TEST_F(BusWatchTest, SaysThatTheControllerIsBusOff) {
  report(CAN_ERR_BUSOFF, 0);
  EXPECT_EQ(after(1).state, LinkState::kDown);
  EXPECT_THAT(text(), HasSubstr("bus-off: the CAN controller is off until it is restarted"));
  EXPECT_THAT(text(), HasSubstr("restart-ms"));
  report(CAN_ERR_RESTARTED, 0);
  after(1);
  carry(data_frame(0x123, {}));
  EXPECT_EQ(after(BusWatch::kRecentNs).state, LinkState::kUp);
  EXPECT_EQ(text(), "");
}

TEST_F(BusWatchTest, SaysThatTheBitRateIsAnotherOne) {
  report(CAN_ERR_PROT, std::uint64_t{CAN_ERR_PROT_STUFF} << 16U);
  EXPECT_EQ(after(1).state, LinkState::kDegraded);
  EXPECT_THAT(text(), HasSubstr("bit stuffing error: check that all nodes have the same bit rate"));
}

// An error-passive controller does not report the same state again.
TEST_F(BusWatchTest, AnErrorPassiveControllerStaysDegraded) {
  report(CAN_ERR_CRTL, std::uint64_t{CAN_ERR_CRTL_TX_PASSIVE} << 8U);
  after(1);
  for (int i = 0; i < 5; ++i) {
    carry(data_frame(0x123, {}));
    EXPECT_EQ(after(kSecond).state, LinkState::kDegraded);
    EXPECT_THAT(text(), HasSubstr("error passive by transmit errors"));
  }
  report(CAN_ERR_CRTL, std::uint64_t{CAN_ERR_CRTL_ACTIVE} << 8U);
  carry(data_frame(0x123, {}));
  after(1);
  carry(data_frame(0x123, {}));
  EXPECT_EQ(after(BusWatch::kRecentNs).state, LinkState::kUp);
}

TEST_F(BusWatchTest, SaysThatTheSendQueueIsFull) {
  const can_frame frame = data_frame(0x100, {});
  while (bus_.send({&frame, 1}) == 1) continue;
  EXPECT_EQ(after(1).state, LinkState::kDegraded);
  EXPECT_THAT(text(), HasSubstr("the send queue is full"));
}

can_frame error(canid_t classes, std::uint64_t data) {
  return word_frame(CAN_ERR_FLAG | classes, data, CAN_ERR_DLC);
}

TEST(CanErrors, AFrameReportsAllItsClasses) {
  EXPECT_EQ(can_error_words(error(CAN_ERR_ACK | CAN_ERR_BUSERROR, 0)),
            "no acknowledgement: no other node is active at this bit rate, bus error");
  EXPECT_EQ(can_error_words(error(CAN_ERR_CRTL | CAN_ERR_PROT, std::uint64_t{CAN_ERR_PROT_STUFF} << 16U |
                                                                   std::uint64_t{CAN_ERR_CRTL_TX_PASSIVE} << 8U)),
            "error passive by transmit errors, bit stuffing error: check that all nodes have the same bit rate");
}

TEST(CanErrors, DetailsCountInTheirClassAlone) {
  EXPECT_EQ(can_error_words(error(CAN_ERR_BUSOFF, ~std::uint64_t{0})),
            "bus-off: the CAN controller is off until it is restarted");
  EXPECT_EQ(can_error_words(error(CAN_ERR_CRTL, 0)), "the controller reports errors without a reason");
  EXPECT_EQ(can_error_words({}), "");
}

}  // namespace robot_control::tests
