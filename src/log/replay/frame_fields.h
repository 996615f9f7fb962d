#pragma once
/// Compares two frames by the names of their members.

#include <string>
#include <vector>

#include "signals/command_frame.h"
#include "signals/gate_report.h"
#include "signals/permit.h"
#include "signals/state_frame.h"

namespace robot_control {

/// A member that differs.
struct FieldDifference {
  std::string field;  ///< "pose_covariance[7]"
  std::string logged;
  std::string replayed;
};

std::vector<FieldDifference> differences(const StateFrame& logged, const StateFrame& replayed);
std::vector<FieldDifference> differences(const CommandFrame& logged, const CommandFrame& replayed);
std::vector<FieldDifference> differences(const Permit& logged, const Permit& replayed);
std::vector<FieldDifference> differences(const GateReport& logged, const GateReport& replayed);

}  // namespace robot_control
