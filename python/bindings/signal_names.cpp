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

/// The text for any robot: roles stand for the programs that play them.
std::string of_any_robot(std::string_view text) {
  return with_names(text, kWheeledKind,
                    [](Role role) { return "the " + std::string(kRoles[static_cast<std::size_t>(role)].role); });
}

py::list bits(std::span<const BitName> table) {
  py::list rows;
  for (const BitName& row : table) {
    rows.append(py::make_tuple(std::string(row.name), of_any_robot(row.sentence), of_any_robot(row.remedy),
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
  py::dict all;
  py::list roles;
  for (const RoleNames& row : kRoles) roles.append(py::make_tuple(std::string(row.role), std::string(row.program)));
  all["Role"] = roles;
  py::list kinds;
  for (const KindNames& row : kKinds) kinds.append(py::make_tuple(std::string(row.kind), std::string(row.controller)));
  all["RobotKind"] = kinds;
  all["StopCause"] = bits(kStopCauseNames);
  all["CommandReason"] = bits(kCommandReasonNames);
  all["RequestPart"] = bits(kRequestPartNames);
  all["GateReason"] = bits(kGateReasonNames);
  all["StateFlag"] = bits(kStateFlagNames);
  all["SlipReason"] = bits(kSlipReasonNames);
  all["DegradedReason"] = bits(kDegradedReasonNames);
  all["DriverFault"] = bits(kDriverFaultNames);
  all["SupervisorState"] = states<SupervisorState>(6);
  all["PermitAction"] = states<PermitAction>(3);
  all["GateVerdict"] = states<GateVerdict>(5);
  all["DriverState"] = states<DriverState>(5);
  all["JointMode"] = states<JointMode>(kJointModes);
  all["LegPhase"] = states<LegPhase>(7);
  all["Gait"] = gait_words(all_gaits({}));
  all["SensorIndex"] = words(kStateSensorNames);
  all["FaultComponent"] = words(kFaultComponentNames);
  all["FaultKind"] = words(kFaultKindNames);
  return all;
}

}  // namespace robot_control
