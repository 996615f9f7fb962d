#include "drivers/drive/drive_status.h"

#include "signals/formatted_text.h"

namespace robot_control {
namespace {

struct CauseWords {
  const char* words;
  const char* remedy;
};

// In the order of DriveCause.
constexpr CauseWords kCauseWords[] = {
    {"", ""},
    {"waits for the first frame of the drive", "check its power, the cable, the node number and the bit rate"},
    {"waits for version and identity", ""},
    {"waits for object", ""},
    {"waits for the first position", "set the drive to send its positions, or request them in the drive file"},
    {"waits for", "set it with the tool of the maker"},
    {"waits to be enabled", ""},
    {"waits for torque", ""},
    {"is silent: no", "check its power and the cable"},
    {"reports an error:", "remove the cause, then reset"},
    {"released the motor without an error:", "check its supply and its own limits, then reset"},
    {"was switched on again", "check its supply, then reset"},
    {"reports a jump of its", "check whether the drive has another zero or was switched on again; reset at standstill"},
    {"sent NaN or infinity", "check the encoder, then reset"},
    {"is too hot:", "wait until it is cool, then reset"},
    {"has a low supply:", "charge the battery, then reset"},
    {"is commanded by another program, with frame", "stop that program, then reset"},
    {"differs from the drive file:", "correct the drive or the file, then reset"},
    {"lacks", "replace the drive, or set it in the drive file"},
    {"refused to set", "set it with the tool of the maker, or remove it from the drive file"},
    {"did not answer a request for", "check the cable, then reset"},
    {"stays without torque:", "check its supply, its calibration and its enable input, then reset"},
    {"shares its node number with a second drive", "set another number for one of them"},
    {"has another axis in fault", ""},
    {"has an unknown reaction on silence",
     "set its watchdog and on_silence, or accept_unknown_watchdog: true, in the drive file"},
    {"braked by itself, because it received no order in time", "check the line, then reset"},
    {"does not turn although it is driven: no counts of",
     "check the connector of its encoder, then for a blockage; then reset"},
    {"sends messages with a wrong check sum", "check the cable and the network, then reset"},
    {"repeats its last", "restart the drive, then reset"},
    {"sends a state of another robot, by", "remove the other one, then reset"},
    {"has lost its bridge", "start unitree_bridge or read its output, then reset"},
    {"waits for the motion service of its maker",
     "release it with the app of the maker, or set release_service: true in the drive file"},
};
static_assert(std::size(kCauseWords) == static_cast<std::size_t>(DriveCause::kMotionService) + 1);

constexpr const char* kStateWords[] = {"starting", "ready", "running", "fault"};

}  // namespace

std::string status_words(const std::string& name, const DriveStatus& status, const std::string& code) {
  const CauseWords& cause = kCauseWords[static_cast<std::size_t>(status.cause)];
  std::string text = name + ": " + kStateWords[static_cast<std::size_t>(status.state)];
  if (status.cause == DriveCause::kNone) return text;
  text += std::string("; the drive ") + cause.words;
  if (*status.subject != '\0') text += std::string(" ") + status.subject;
  if (!code.empty()) text += " " + code;
  if (status.found != status.expected) {
    text += formatted(", %.4g instead of %.4g", status.found, status.expected);
  }
  return *cause.remedy == '\0' ? text : text + "; " + cause.remedy;
}

DriverFault fault_of(DriveCause cause) noexcept {
  switch (cause) {
    case DriveCause::kSilent:
    case DriveCause::kNoAnswer:
    case DriveCause::kCheckSum:
    case DriveCause::kStale:
    case DriveCause::kBridge:
      return kFaultLink;
    case DriveCause::kNotFinite:
      return kFaultNotFinite;
    default:
      return kFaultDrive;
  }
}

void DriveStateMachine::set(DrivePhase state, DriveCause cause, const char* subject, std::uint64_t code, double found,
                            double expected) noexcept {
  if (status_.state == DrivePhase::kFault) return;
  status_ = {.state = state, .cause = cause, .subject = subject, .code = code, .found = found, .expected = expected};
}

void DriveStateMachine::fail(DriveCause cause, const char* subject, std::uint64_t code, double found,
                             double expected) noexcept {
  const bool brakes =
      cause == DriveCause::kHot || cause == DriveCause::kUnderVoltage || cause == DriveCause::kForeignCommander;
  if (status_.state == DrivePhase::kFault && (brakes || !may_brake_)) return;
  had_torque_ = status_.state >= DrivePhase::kRunning;
  may_brake_ = brakes && status_.state == DrivePhase::kRunning;
  status_ = {.state = DrivePhase::kFault,
             .cause = cause,
             .subject = subject,
             .code = code,
             .found = found,
             .expected = expected};
}

}  // namespace robot_control
