/// Tests every combination of permit and command: the joints move if and only if all four answers are yes.

#include <array>

#include "gate/gate_fixture.h"

namespace robot_control::tests {

constexpr std::array kLookups{Lookup::kMissing, Lookup::kFrame, Lookup::kToken, Lookup::kCorrupt};
constexpr std::array<std::int64_t, 8> kAges{-1, 0, 1, 2, 3, 4, 5, 6};  // in cycles; 0: this very one, -1: the future
constexpr std::array<std::uint64_t, 2> kRuns{kRun, kRun + 1};
constexpr std::array<std::int64_t, 3> kExpiries{-1, 0, 1000};  // in cycles from now on: over, still valid, unlimited

enum class Order { kBrake, kRamp, kRampOver, kDrive, kUnknown };
constexpr std::array kOrders{Order::kBrake, Order::kRamp, Order::kRampOver, Order::kDrive, Order::kUnknown};

enum class Content { kGood, kNotFinite, kUnknownMode, kOneJointMore };
constexpr std::array kContents{Content::kGood, Content::kNotFinite, Content::kUnknownMode, Content::kOneJointMore};

constexpr std::uint64_t kTick = 100;

struct PermitCase {
  Lookup found;
  std::int64_t age;
  std::uint64_t run;
  std::int64_t expiry;
  Order order;
};

struct CommandCase {
  Lookup found;
  std::int64_t age;
  std::uint64_t run;
  Content content;
};

std::vector<PermitCase> permits() {
  std::vector<PermitCase> all;
  for (const Lookup found : kLookups)
    for (const std::int64_t age : kAges)
      for (const std::uint64_t run : kRuns)
        for (const std::int64_t expiry : kExpiries)
          for (const Order order : kOrders) all.push_back({found, age, run, expiry, order});
  return all;
}

std::vector<CommandCase> commands() {
  std::vector<CommandCase> all;
  for (const Lookup found : kLookups)
    for (const std::int64_t age : kAges)
      for (const std::uint64_t run : kRuns)
        for (const Content content : kContents) all.push_back({found, age, run, content});
  return all;
}

// The four questions of the gate's specification.
bool alive(const PermitCase& permit) {
  return permit.found == Lookup::kFrame && permit.run == kRun && permit.age >= 1 && permit.age <= 4 &&
         permit.expiry >= 0;
}
bool allows(const PermitCase& permit) {
  return permit.order == Order::kRamp || permit.order == Order::kDrive;
}
bool fresh(const CommandCase& command) {
  return command.found == Lookup::kFrame && command.run == kRun && command.age >= 1 && command.age <= 4;
}
bool sound(const CommandCase& command) {
  return command.content == Content::kGood;
}

struct GateEnumeration : GateFixture {
  static std::uint64_t from_now(std::int64_t cycles) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(kTick) + cycles);
  }
  void put(const PermitCase& wanted) {
    input_.permit_found = wanted.found;
    permit_.head.run = wanted.run;
    permit_.head.cycle = from_now(-wanted.age);
    permit_.expiry = from_now(wanted.expiry);
    permit_.ramp_until = from_now(wanted.order == Order::kRampOver ? -1 : 5);
    permit_.action = wanted.order == Order::kDrive     ? PermitAction::kDrive
                     : wanted.order == Order::kBrake   ? PermitAction::kBrake
                     : wanted.order == Order::kUnknown ? static_cast<PermitAction>(7)
                                                       : PermitAction::kRamp;
  }
  void put(const CommandCase& wanted) {
    input_.command_found = wanted.found;
    command_ = healthy_;
    command_.head.run = wanted.run;
    command_.head.cycle = from_now(-wanted.age);
    if (wanted.content == Content::kNotFinite) command_.joints[1].stiffness = kNaN;
    if (wanted.content == Content::kUnknownMode) command_.joints[1].mode = static_cast<JointMode>(kJointModes);
    if (wanted.content == Content::kOneJointMore) command_.joint_count = 3;
  }

  const CommandFrame healthy_ = command_;
};

TEST_F(GateEnumeration, MovesIfAndOnlyIfAllFourQuestionsAreAnsweredYes) {
  const std::vector<CommandCase> all_commands = commands();
  std::uint64_t moved = 0;
  for (const PermitCase& permit : permits()) {
    put(permit);
    for (const CommandCase& command : all_commands) {
      put(command);
      gate_.enter_run();
      step();
      const bool yes = alive(permit) && allows(permit) && fresh(command) && sound(command);
      const auto which = [&] {
        return "permit " + std::to_string(static_cast<int>(permit.found)) + " of age " + std::to_string(permit.age) +
               ", run " + std::to_string(permit.run) + ", expiry " + std::to_string(permit.expiry) + ", order " +
               std::to_string(static_cast<int>(permit.order)) + "; command " +
               std::to_string(static_cast<int>(command.found)) + " of age " + std::to_string(command.age) + ", run " +
               std::to_string(command.run) + ", content " + std::to_string(static_cast<int>(command.content));
      };
      ASSERT_EQ(!braked(), yes) << which();
      ASSERT_EQ(reasons() == 0, yes && command.age == 1) << which();
      moved += yes;
    }
  }
  EXPECT_EQ(moved, 4u * 2 * 2 * 4);  // ages × expiries × orders of permits × ages of commands
}

}  // namespace robot_control::tests
