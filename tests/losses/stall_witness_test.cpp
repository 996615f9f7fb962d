/// The witness of stalls detects what stops the loop's core, and nothing that the loop itself does to it.

#include "support/processes/stall_witness.h"

#include "losses_fixture.h"

namespace robot_control::tests {

constexpr std::int64_t kSpellNs = 100'000'000;

struct Witness : ::testing::Test {
  Witness() {
    while (witness_.longest_gap_ns(0) == 0) sleep_ns(1'000'000);
    began_ns_ = monotonic_ns();
  }

  StallWitness witness_{0};
  std::int64_t began_ns_ = 0;
};

TEST_F(Witness, SeesThatItWasStoppedAndForgetsItWhereALaterTimeIsAskedFor) {
  witness_.process().send(SIGSTOP);
  sleep_ns(kSpellNs);
  EXPECT_GE(witness_.longest_gap_ns(began_ns_), kSpellNs) << "while it lasts";
  witness_.process().send(SIGCONT);
  sleep_ns(kSpellNs);
  EXPECT_GE(witness_.longest_gap_ns(began_ns_), kSpellNs);
  EXPECT_LT(witness_.longest_gap_ns(monotonic_ns() - kSpellNs / 2), kSpellNs);
}

/// The stop is the loop's own: a node that computes without end is no stall of the machine.
using AStop = Losses;

TEST_F(AStop, IsNoStallByItself) {
  nodes().process(LoopNode::kController).stop_with(SIGSTOP);
  EXPECT_TRUE(robot_.await([&] { return robot_.permit().causes != 0; })) << robot_.situation();
  EXPECT_EQ(robot_.permit().causes & ~kStallCauses, 0u) << robot_.situation();
  EXPECT_FALSE(robot_.stalled()) << robot_.situation();
  nodes().process(LoopNode::kController).send(SIGCONT);
}

}  // namespace robot_control::tests
