#include <bit>

#include "log/fields/trace_field_groups.h"
#include "log/fields/trace_field_kinds.h"
#include "signals/law_snapshot.h"

namespace robot_control {

using namespace trace_words;

namespace {

template <class Part>
void add_law(TraceFields& to, const std::string& node) {
  const auto number = [&](const char* name, const char* comment, auto get) {
    field<Part, u64>(to, node + "_" + name, comment, get);
  };
  number("output", "checksum of what it computed", MEMBER(calls.law.output));
  number("sensors", "checksum of the sensors it used", MEMBER(calls.law.sensors));
  number("row", "rows of its process before this one", MEMBER(calls.law.number));
  number("process", "random number of its process", MEMBER(calls.law.process));
  number("new_run", "1: it entered a run since the row before", MEMBER(calls.law.new_run));
}

template <class Part, class Get>
void add_used(TraceFields& to, const std::string& name, Get) {
  field<Part, u64>(
      to, name + "_checksum", "of the frame that was found", [](auto& part) -> auto& { return Get{}(part).checksum; });
  field<Part, u64>(
      to, name + "_cycle", "in which it was found", [](auto& part) -> auto& { return Get{}(part).cycle; });
  field<Part, u8>(
      to, name + "_found", "Lookup", [](auto& part) -> auto& { return Get{}(part).found; });
}

template <class Get>
void add_velocity(TraceFields& to, const std::string& name, Get) {
  const auto number = [&](const char* what, const char* comment, auto get) {
    field<C, u64>(to, name + "_" + what, comment, get);
  };
  field<C, f64>(to, name + "_linear", "m/s", OF(content.twist.linear));
  field<C, f64>(to, name + "_angular", "rad/s", OF(content.twist.angular));
  add_request(to, name, OF(content));
  number("count", "usable commands so far", OF(count));
  field<C, std::int64_t>(to, name + "_age_ns", "ns, when it arrived, by its stamp", OF(age_ns));
  number("stale", "refused for their stamp", OF(stale));
  number("crowded", "refused because another node sends", OF(crowded));
  number("revoked", "refused because their sender owes a zero velocity", OF(revoked));
  number("not_finite", "refused as NaN or infinite beside a command in force", OF(not_finite));
  number("many_senders", "1: several nodes send, one requests motion", OF(many_senders));
  number("contested",
         "1: another sender requested motion; 2: a zero velocity of no sender; 3, 4: in place of NaN or infinity",
         OF(contested));
}

template <class Get>
void add_operator(TraceFields& to, const std::string& name, Get) {
  const auto number = [&](const char* what, const char* comment, auto get) {
    field<M, u64>(to, name + "_" + what, comment, get);
  };
  number("e_stop_level", "1: last value on e_stop is true", OF(e_stop_level));
  number("e_stop_messages", "on that topic", OF(e_stop_messages));
  number("e_stop_triggers", "true on that topic", OF(e_stop_triggers));
  number("e_stop_services", "calls of e_stop_trigger", OF(e_stop_services));
  number("resets", "calls of e_stop_reset", OF(resets));
  number("heartbeats", "messages", OF(heartbeats));
  number("clearances", "messages", OF(clearances));
  field<M, f64>(to, name + "_clearance", "m, last value", OF(clearance));
}

template <class Frame>
using Words = std::array<u64, kFrameWords<Frame>>;

/// The whole published frame is recorded if an injected fault changed it, and near a snapshot (signals/law_snapshot.h).
/// Otherwise the list is empty.
template <class Part, class Frame, class Get>
TraceField& whole_frame(TraceFields& to, std::string_view name, Get) {
  TraceField& result =
      add_field(to, name, "uint64",
                "the published frame, word by word, where a fault changed it, and near a snapshot; else empty", "[]");
  result.write = [](const TraceSource& source, std::string& message) {
    const Part* part = part_of<Part>(source.row);
    const bool published = part != nullptr && Get{}(*part).head.kind == FrameKind::kFrame;
    const bool whole =
        published && (near_snapshot(source.row.cycle) || Get{}(*part).head.checksum != part->calls.law.output);
    write_number(message, static_cast<std::uint32_t>(whole ? kFrameWords<Frame> : 0));
    if (!whole) return;
    for (const u64 word : std::bit_cast<Words<Frame>>(Get{}(*part))) write_number(message, word);
  };
  result.read = [](ByteSource& from, TraceRow& row) {
    const auto size = from.number<std::uint32_t>();
    if (size == 0) return true;
    if (size != kFrameWords<Frame>) return false;
    Words<Frame> words;
    for (u64& word : words) word = from.number<u64>();
    Get{}(part_of<Part>(row)) = std::bit_cast<Frame>(words);
    return true;
  };
  return result;
}

}  // namespace

void add_calls(TraceFields& to) {
  field<D, u64>(to, "sensors_checksum", "of the frame", MEMBER(sensors.head.checksum));
  field<E, u64>(to, "state_checksum", "of the frame", MEMBER(state.head.checksum));
  field<C, u64>(to, "command_checksum", "of the frame", MEMBER(command.head.checksum));
  field<M, u64>(to, "permit_checksum", "of the frame", MEMBER(permit.head.checksum));
  add_law<D>(to, "gate");
  add_law<E>(to, "estimator");
  add_law<C>(to, "controller");
  add_law<M>(to, "monitor");
  add_used<D>(to, "gate_used_command", MEMBER(calls.command));
  add_used<D>(to, "gate_used_permit", MEMBER(calls.permit));
  add_used<C>(to, "controller_used_permit", MEMBER(calls.permit));
  add_used<M>(to, "monitor_used_command", MEMBER(calls.command));
  add_used<M>(to, "monitor_used_state", MEMBER(calls.state));
  field<C, u64>(to, "controller_used_state_checksum", "of the state of this cycle", MEMBER(calls.state));
  field<E, u64>(to, "estimator_first_cycle", "", MEMBER(calls.first_cycle));
  field<E, u64>(to, "pose_set", "1: the pose was set before this step", MEMBER(calls.pose_set));
  field<E, f64>(to, "pose", "m, m, rad: to which", MEMBER(calls.pose));
  field<C, u64>(to, "controller_with_zero", "1: a run that it entered began with a zero request",
                MEMBER(calls.with_zero));
  field<C, u64>(to, "controller_tuned", "1: tuned before this step", MEMBER(calls.tuned));
  add_velocity(to, "request", MEMBER(calls.request));
  add_velocity(to, "inbox", MEMBER(calls.inbox));
  field<M, u8>(to, "monitor_silence", "SensorSilence, where it used no sensors", MEMBER(calls.silence));
  field<M, u64>(to, "monitor_corrupt", "", MEMBER(calls.corrupt));
  add_operator(to, "operator", MEMBER(calls.operator_input));
  whole_frame<E, StateFrame>(to, "whole_state", MEMBER(state));
  whole_frame<C, CommandFrame>(to, "whole_command", MEMBER(command));
  whole_frame<M, Permit>(to, "whole_permit", MEMBER(permit));
}

}  // namespace robot_control
