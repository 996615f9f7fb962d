#include "log/replay/frame_fields.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdio>

namespace robot_control {
namespace {

enum class Number { kReal, kWhole };

/// A member of a frame that consists of `words` numbers, in groups of those that `parts` names; "" names nothing, and
/// # marks a whole number.
struct Member {
  const char* name;
  std::size_t words;
  std::vector<const char*> parts = {""};
  Number number = Number::kReal;
};

std::string text_of(std::uint64_t word, Number number) {
  if (number == Number::kWhole) return std::to_string(word);
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.17g", std::bit_cast<double>(word));
  return text.data();
}

std::string field_name(const Member& member, std::size_t word) {
  const std::size_t width = member.parts.size();
  std::string name = member.name;
  if (member.words > width) name += "[" + std::to_string(word / width) + "]";
  std::string part = member.parts[word % width];
  if (part.starts_with('#')) part.erase(0, 1);
  return part.empty() ? name : name + "." + part;
}

Number number_of(const Member& member, std::size_t word) {
  return member.parts[word % member.parts.size()][0] == '#' ? Number::kWhole : member.number;
}

/// `members`: all of the frame behind `skipped` words, in their order.
template <class Frame>
std::vector<FieldDifference> compare(const Frame& logged, const Frame& replayed, std::size_t skipped,
                                     const std::vector<Member>& members) {
  constexpr std::size_t kWords = sizeof(Frame) / 8;
  const auto was = std::bit_cast<std::array<std::uint64_t, kWords>>(logged);
  const auto is = std::bit_cast<std::array<std::uint64_t, kWords>>(replayed);
  std::vector<FieldDifference> found;
  std::size_t at = skipped;
  for (const Member& member : members) {
    for (std::size_t word = 0; word < member.words && at < kWords; ++word, ++at) {
      if (was[at] == is[at]) continue;
      const Number number = number_of(member, word);
      found.push_back({field_name(member, word), text_of(was[at], number), text_of(is[at], number)});
    }
  }
  return found;
}

constexpr std::size_t kHead = sizeof(FrameHead) / 8;
const std::vector<const char*> kAxes{"x", "y", "z"};
const std::vector<const char*> kPose{"position.x",    "position.y",    "position.z",   "orientation.x",
                                     "orientation.y", "orientation.z", "orientation.w"};
const std::vector<const char*> kTwist{"linear.x", "linear.y", "linear.z", "angular.x", "angular.y", "angular.z"};

Member whole(const char* name, std::size_t words = 1) {
  return {name, words, {""}, Number::kWhole};
}

}  // namespace

std::vector<FieldDifference> differences(const StateFrame& logged, const StateFrame& replayed) {
  static const std::vector<Member> kMembers{
      whole("first_cycle"),
      whole("skipped"),
      {"pose_odom", 7, kPose},
      {"twist_base", 6, kTwist},
      {"pose_covariance", 36},
      {"twist_covariance", 36},
      {"gyro_bias", 3, kAxes},
      {"accelerometer_bias", 3, kAxes},
      {"attitude", 4, {"x", "y", "z", "w"}},
      {"attitude_covariance", 9},
      {"gyro_bias_deviation", 3, kAxes},
      whole("degraded"),
      whole("flags"),
      {"distance", 1},
      {"joint_velocity", kMaxJoints},
      whole("contact_count"),
      {"contacts", 3 * kMaxContacts, {"probability", "slip", "load"}},
      {"calibration", 4, {"radius_ratio", "wheel_base_factor", "radius_ratio_deviation", "wheel_base_deviation"}},
      {"odometry", 5, {"x", "y", "yaw", "linear", "angular"}},
      {"confidence", kWheeledSensors},
      {"nis", kWheeledSensors},
      whole("rejected", kWheeledSensors),
      whole("slip"),
      {"residual_level", 1}};
  return compare(logged, replayed, kHead, kMembers);
}

std::vector<FieldDifference> differences(const CommandFrame& logged, const CommandFrame& replayed) {
  static const std::vector<Member> kMembers{
      whole("joint_count"),
      {"joints", kMaxJoints * 6, {"#mode", "position", "velocity", "stiffness", "damping", "effort"}},
      {"requested", 6, kTwist},
      {"requested", 6, {"height", "roll", "pitch", "x", "y", "yaw"}},
      whole("requested.mode"),
      {"requested.joints", kRequestJoints},
      {"twist_limited", 6, kTwist},
      whole("reasons"),
      whole("state_cycle"),
      whole("permit_cycle"),
      whole("request_cycle"),
      whole("requests_received"),
      whole("requests_refused"),
      whole("requests_stale"),
      whole("requests_crowded"),
      whole("requests_revoked"),
      whole("requests_partial"),
      whole("ignored"),
      whole("timeouts"),
      whole("first_cycle"),
      whole("zero_requests"),
      whole("zero_requested"),
      whole("silent_cycles"),
      whole("silence_needed"),
      {"velocity_measured", kMaxWheels},
      whole("legged_phase"),
      whole("legged_lifted"),
      {"legged_body", 6, {"x", "y", "height", "roll", "pitch", "yaw"}},
      whole("legged_gait"),
      {"legged_gait_phase", 1},
      {"legged_stance", 4}};
  return compare(logged, replayed, kHead, kMembers);
}

std::vector<FieldDifference> differences(const Permit& logged, const Permit& replayed) {
  static const std::vector<Member> kMembers{
      whole("action"),
      whole("ramp_until"),
      whole("expiry"),
      whole("state"),
      whole("causes"),
      whole("active"),
      whole("first_cause"),
      whole("warnings"),
      whole("since_cycle"),
      whole("missing"),
      whole("unreleased"),
      whole("withdrawals"),
      whole("driver_instance"),
      whole("resets_handled"),
      whole("reset_refusal"),
      {"speed_limit", 1},
      {"evidence", kMaxEvidence * 5, {"#cause", "#cycle", "#joint", "value", "limit"}}};
  return compare(logged, replayed, kHead, kMembers);
}

std::vector<FieldDifference> differences(const GateReport& logged, const GateReport& replayed) {
  static const std::vector<Member> kMembers{
      whole("cycle"), whole("verdict"), whole("reasons"),      whole("command_cycle"), whole("permit_cycle"),
      whole("held"),  whole("missed"),  whole("late_permits"), whole("refused"),       {"stance", 4}};
  return compare(logged, replayed, 0, kMembers);
}

}  // namespace robot_control
