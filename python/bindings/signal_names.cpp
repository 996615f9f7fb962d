#include "bindings/signal_names.h"

#include <pybind11/stl.h>

#include <span>
#include <string>
#include <string_view>

#include "control/legged/walk/gait.h"
#include "control/legged/walk/own_gaits.h"
#include "signals/names.h"
#include "signals/robot_kinds.h"

namespace py = pybind11;

namespace robot_control {
namespace {

py::list bits(std::span<const BitName> table) {
  py::list rows;
  for (const BitName& row : table) {
    rows.append(py::make_tuple(std::string(row.name), std::string(row.sentence), std::string(row.remedy),
                               std::string(row.unit)));
  }
  return rows;
}

py::list words(std::span<const std::string_view> names) {
  py::list all;
  for (const std::string_view name : names) all.append(std::string(name));
  return all;
}

template <typename State>
py::list states(int count) {
  py::list names;
  for (int i = 0; i < count; ++i) names.append(std::string(name_of(static_cast<State>(i))));
  return names;
}

}  // namespace

py::dict signal_names() {
  using namespace py::literals;
  py::list roles, kinds;
  for (const RoleNames& row : kRoles) roles.append(py::make_tuple(std::string(row.role), std::string(row.program)));
  for (const KindNames& row : kKinds) kinds.append(py::make_tuple(std::string(row.kind), std::string(row.controller)));
  return py::dict("Role"_a = roles, "RobotKind"_a = kinds, "StopCause"_a = bits(kStopCauseNames),
                  "ResetRefusal"_a = bits(kResetRefusalNames), "MissingNode"_a = bits(kMissingNodeNames),
                  "CommandReason"_a = bits(kCommandReasonNames), "RequestPart"_a = bits(kRequestPartNames),
                  "GateReason"_a = bits(kGateReasonNames), "StateFlag"_a = bits(kStateFlagNames),
                  "SlipReason"_a = bits(kSlipReasonNames), "DegradedReason"_a = bits(kDegradedReasonNames),
                  "DriverFault"_a = bits(kDriverFaultNames), "DigitalInput"_a = bits(kDigitalInputNames),
                  "SupervisorState"_a = states<SupervisorState>(6), "PermitAction"_a = states<PermitAction>(3),
                  "GateVerdict"_a = states<GateVerdict>(5), "DriverState"_a = states<DriverState>(5),
                  "JointMode"_a = states<JointMode>(kJointModes), "LegPhase"_a = states<LegPhase>(7),
                  "Gait"_a = gait_words(all_gaits({})), "SensorIndex"_a = words(kStateSensorNames),
                  "FaultComponent"_a = words(kFaultComponentNames), "FaultKind"_a = words(kFaultKindNames));
}

}  // namespace robot_control
