#include "drivers/unitree_go/go2.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "signals/formatted_text.h"

namespace robot_control {

using unitree::go::kReportBytes;
using unitree::go::MotionService;
using unitree::go::RobotsSeen;

Go2::Go2(const Line& line)
    : max_silence_ns_(std::llround(1.0e9 * line.max_silence)), other_writers_(line.other_writers) {}

std::span<const std::uint8_t> Go2::opened(std::span<const std::uint8_t> datagram, std::int64_t now_ns) noexcept {
  report_ns_ = now_ns;
  if (!read_report(datagram, report_)) return datagram.size() == kStateBytes ? datagram.first(1) : datagram;
  has_report_ = true;
  return datagram.subspan(kReportBytes);
}

unitree::Flaw Go2::decode(std::span<const std::uint8_t> bytes, State& state) noexcept {
  if (bytes.size() == kReportBytes + kStateBytes) return unitree::Flaw::kHead;  // it begins with no report
  return unitree::go::decode(bytes, state);
}

LegObstacle Go2::obstacle(std::int64_t now_ns) const noexcept {
  if (!has_report_ || now_ns - report_ns_ > max_silence_ns_) return {.cause = DriveCause::kBridge};
  if (report_.other_commands != 0)
    return {.cause = DriveCause::kForeignCommander, .subject = "LowCmd", .is_fault = true};
  if (report_.writers > other_writers_)
    return {.cause = DriveCause::kForeignCommander,
            .subject = "LowCmd: it has not sent yet, number of writers",
            .found = static_cast<double>(report_.writers),
            .expected = static_cast<double>(other_writers_),
            .is_fault = true};
  if (report_.robots == RobotsSeen::kAwaited) return {.cause = DriveCause::kIdentity};
  if (report_.robots == RobotsSeen::kMore)
    return {.cause = DriveCause::kOtherDevice, .subject = "a second writer of rt/lowstate"};
  switch (report_.service) {
    case MotionService::kAsked:
      return {.cause = DriveCause::kMotionService, .subject = "to answer"};
    case MotionService::kActive:
      return {.cause = DriveCause::kMotionService, .subject = "to be released"};
    case MotionService::kNoAnswer:
      return {.cause = DriveCause::kNoAnswer, .subject = "the mode of its motion service", .is_fault = true};
    case MotionService::kFree:
    case MotionService::kNone:
      break;
  }
  return {};
}

namespace {

/// Returns what a silent process does, by its state in /proc/<pid>/stat (proc(5)).
const char* silence_of(std::uint32_t process) {
  std::ifstream file(formatted("/proc/%u/stat", process));
  std::string line;
  std::getline(file, line);
  const std::size_t name_end = line.rfind(')');
  if (name_end == std::string::npos || name_end + 2 >= line.size()) return "has ended";
  return line[name_end + 2] == 'Z' ? "has ended" : "hangs";
}

}  // namespace

std::string Go2::detail(DriveCause cause, const Notice& notice) {
  if (cause == DriveCause::kMotionService && notice.mode[0] != '\0') return formatted("(mode %s)", notice.mode.data());
  if (cause != DriveCause::kBridge) return "";
  if (notice.process == 0) return "(not started)";
  return formatted("(process %u %s)", notice.process, silence_of(notice.process));
}

const char* Go2::remedy(DriveCause cause) {
  switch (cause) {
    case DriveCause::kFirstFrame:
      return "; check the key interface of the drive file";
    case DriveCause::kBridge:
      return "; without the program unitree_bridge: scripts/setup --unitree, then build";
    case DriveCause::kNoAnswer:
      return "; set has_service: false for a robot without it, as most simulators";
    case DriveCause::kForeignCommander:
      return "; set other_writers for programs that never send";
    case DriveCause::kOtherDevice:
      return "; connect only one robot: all robots on a network obey rt/lowcmd";
    default:
      return "";
  }
}

bool Go2::Device::write_head(std::span<std::uint8_t> head) const noexcept {
  write_report(report, head);
  return !ended;
}

bool Go2::Device::inject(std::string_view component, std::string_view kind) {
  constexpr std::array<std::string_view, 8> kKnownKinds{"ok",        "off",           "asked",          "active",
                                                        "no_answer", "second_writer", "other_commands", "other_states"};
  if (component != "bridge" || std::ranges::find(kKnownKinds, kind) == kKnownKinds.end()) return false;
  report.service = kind == "asked"       ? MotionService::kAsked
                   : kind == "active"    ? MotionService::kActive
                   : kind == "no_answer" ? MotionService::kNoAnswer
                                         : MotionService::kFree;
  report.mode = {};
  if (kind == "active") std::ranges::copy(std::string_view("mcf"), report.mode.begin());
  report.writers = kind == "second_writer" ? 1 : 0;
  report.other_commands = kind == "other_commands" ? 1 : 0;
  report.robots = kind == "other_states" ? RobotsSeen::kMore : RobotsSeen::kOne;
  ended = kind == "off";
  forwards = !ended && report.service == MotionService::kFree;
  return true;
}

}  // namespace robot_control
