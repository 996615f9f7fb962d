#include <algorithm>

#include "log/fields/trace_field_groups.h"
#include "log/fields/trace_field_kinds.h"

namespace robot_control {

using namespace trace_words;

namespace {

/// The first evidence is that of the first active cause, or else of the first warning; NaN: there is none.
template <class Get>
TraceColumn first_evidence(std::string_view name, Get) {
  return column<M>(name, "of the first cause, else of the first warning; unit by signals/stop_causes.def",
                   [](const M& monitor, std::size_t) {
                     const CauseEvidence& first = monitor.permit.evidence[0];
                     return where(first.cause != 0, Get{}(first));
                   });
}

}  // namespace

void add_permit(TraceFields& to) {
  const auto number = [&](const char* name, const char* comment, auto get) { field<M, u64>(to, name, comment, get); };
  const auto shown = [&](const char* name, const char* comment, auto get) {
    field<M, u64>(to, name, comment, get).shown();
  };
  number("permit_expiry", "last cycle in which it is alive", MEMBER(permit.expiry));
  field<M, u8>(to, "permit_action", "PermitAction", MEMBER(permit.action)).shown();
  field<M, u8>(to, "supervisor_state", "SupervisorState", MEMBER(permit.state)).shown();
  number("permit_ramp_until", "last cycle of a ramp", MEMBER(permit.ramp_until));
  shown("permit_causes", "StopCause bits, latched", MEMBER(permit.causes));
  shown("permit_active", "StopCause bits, true in this cycle", MEMBER(permit.active));
  number("permit_first_cause", "StopCause bit", MEMBER(permit.first_cause));
  shown("permit_warnings", "StopCause bits, not latched", MEMBER(permit.warnings));
  number("permit_since_cycle", "in which the state was entered", MEMBER(permit.since_cycle));
  shown("permit_missing", "MissingNode bits", MEMBER(permit.missing));
  number("permit_withdrawals", "starts and latched causes so far", MEMBER(permit.withdrawals));
  number("permit_unreleased", "1: no zero velocity was requested since a start", MEMBER(permit.unreleased));
  number("permit_driver_instance", "of the driver it was issued for", MEMBER(permit.driver_instance));
  number("resets_handled", "counter of the last reset request answered", MEMBER(permit.resets_handled));
  shown("reset_refusal", "ResetRefusal bits, of that request", MEMBER(permit.reset_refusal));
  field<M, f64>(to, "speed_limit", "m/s, of the base, and so of every wheel's rim; 1e9: none",
                MEMBER(permit.speed_limit))
      .shown_as(column<M>(
          "speed_limit", "m/s, of the base, and so of every wheel's rim; NaN: none",
          [](const M& m, std::size_t) { return where(m.permit.speed_limit < kNoSpeedLimit, m.permit.speed_limit); }));
  static constexpr auto kSize = [](const M* monitor, std::size_t) {
    if (monitor == nullptr) return std::size_t{0};
    const auto& evidence = monitor->permit.evidence;
    return static_cast<std::size_t>(
        std::find_if(evidence.begin(), evidence.end(), [](const CauseEvidence& e) { return e.cause == 0; }) -
        evidence.begin());
  };
  list<M, u64, kMaxEvidence>(to, "evidence_cause", "StopCause bit of each measurement that stopped or warned", kSize,
                             ELEMENT(permit.evidence[i].cause))
      .shown({"evidence_cause"});
  list<M, u64, kMaxEvidence>(to, "evidence_cycle", "", kSize, ELEMENT(permit.evidence[i].cycle));
  list<M, u64, kMaxEvidence>(to, "evidence_joint", "index; 32: none", kSize, ELEMENT(permit.evidence[i].joint));
  list<M, f64, kMaxEvidence>(to, "evidence_value", "unit by signals/stop_causes.def", kSize,
                             ELEMENT(permit.evidence[i].value))
      .shown_as(first_evidence("evidence_value", [](const CauseEvidence& e) { return e.value; }));
  list<M, f64, kMaxEvidence>(to, "evidence_limit", "", kSize, ELEMENT(permit.evidence[i].limit))
      .shown_as(first_evidence("evidence_limit", [](const CauseEvidence& e) { return e.limit; }));
}

}  // namespace robot_control
