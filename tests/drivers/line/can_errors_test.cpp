#include <gtest/gtest.h>
#include <linux/can/error.h>

#include "drivers/line/bus_watch.h"

namespace robot_control::tests {

can_frame error(canid_t classes, std::uint64_t data) {
  return word_frame(CAN_ERR_FLAG | classes, data, CAN_ERR_DLC);
}

TEST(CanErrors, AFrameReportsAllItsClasses) {
  EXPECT_EQ(can_error_words(error(CAN_ERR_ACK | CAN_ERR_BUSERROR, 0)),
            "no acknowledgement: no other node is awake at this bit rate, bus error");
  EXPECT_EQ(can_error_words(error(CAN_ERR_CRTL | CAN_ERR_PROT, std::uint64_t{CAN_ERR_PROT_STUFF} << 16U |
                                                                   std::uint64_t{CAN_ERR_CRTL_TX_PASSIVE} << 8U)),
            "error passive by transmit errors, bit stuffing error: is the bit rate that of the other nodes?");
}

TEST(CanErrors, DetailsCountInTheirClassAlone) {
  EXPECT_EQ(can_error_words(error(CAN_ERR_BUSOFF, ~std::uint64_t{0})),
            "bus-off: the controller takes no part until it is restarted");
  EXPECT_EQ(can_error_words(error(CAN_ERR_CRTL, 0)), "the controller reports errors without a reason");
  EXPECT_EQ(can_error_words({}), "");
}

}  // namespace robot_control::tests
