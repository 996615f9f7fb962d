#pragma once
/// The frames of one moteus controller of mjbots on CAN FD. The identifier is source << 8 | target, of 7 bits each, and
/// has 29 bits beyond 7FFh. Bit 15 requests a reply. The data are subframes, each about `count` registers in a row:
///
///   00h | type << 2 | count   writes the registers; their values follow
///   10h | type << 2 | count   reads them
///   20h | type << 2 | count   replies; their values follow
///   30h, 31h                  could not write or read: number of the register, number of the error
///   50h                       nothing: padding at the end, to a length of CAN FD
///
/// The number of the first register follows the first byte. Before it comes `count`, if the two bits are 0. Both are
/// varuints: seven bits a byte, the lowest first, and bit 7 of a byte means that another one follows. A Type names the
/// format of the values, little-endian. The lowest integer means NaN. Positions are in turns of the output.
///
/// Sources: mjbots/moteus, docs/protocol/can.md and registers.md; PyPI moteus 1.1.1, moteus/multiplex.py.

#include <cstdint>
#include <numbers>
#include <optional>
#include <span>

#include "drivers/drive/mit/mit_codec.h"

namespace robot_control::moteus {

inline constexpr double kTurn = 2 * std::numbers::pi;  ///< rad
inline constexpr std::uint64_t kBroadcast = 127;       ///< every controller takes frames for this number
inline constexpr canid_t kHost = 0;                    ///< number of this program
inline constexpr canid_t kRequestsReply = 0x8000;
inline constexpr unsigned kMaxCount = 64;  ///< of registers in a subframe

enum class Type : std::uint8_t { kInt8, kInt16, kInt32, kFloat };
enum class Access : std::uint8_t { kWrite = 0x00, kRead = 0x10, kReply = 0x20 };

enum class Register : std::uint32_t {
  kMode = 0x000,
  kPosition = 0x001,
  kVelocity = 0x002,
  kTorque = 0x003,
  kHome = 0x00C,  ///< 0: the position is relative to nothing, 1: to one turn of the rotor, 2: to the output
  kVoltage = 0x00D,
  kTemperature = 0x00E,
  kFault = 0x00F,
  kOrderPosition = 0x020,
  kOrderVelocity = 0x021,
  kOrderTorque = 0x022,
  kStiffnessScale = 0x023,
  kDampingScale = 0x024,
  kMaxTorque = 0x025,
  kTimeout = 0x027,
  kVelocityLimit = 0x028,  ///< of a trajectory; less than 0: none
  kAccelerationLimit = 0x029,
  kProportional = 0x030,  ///< N·m, parts of the last torque before its limit
  kIntegral = 0x031,
  kDerivative = 0x032,
  kMapVersion = 0x102,
};

/// Others are ways to the mode position (2, 3, 4), or modes that no order here requests.
enum class Mode : std::int8_t { kStopped = 0, kFault = 1, kPosition = 10, kTimeout = 11 };

struct Subframe {
  Access access = Access::kRead;
  Type type = Type::kInt8;
  std::uint32_t first = 0;  ///< register
  std::uint32_t count = 0;
  std::span<const std::uint8_t> values{};  ///< none of a kRead
};

/// Reads the subframes of a frame in their order, without errors and padding.
class SubframeReader {
 public:
  /// The frame outlives the reader.
  explicit SubframeReader(const can_frame& frame) noexcept;

  /// Returns nothing at the end, and from a subframe on that is cut or not of these kinds.
  std::optional<Subframe> next() noexcept;

  /// After the last subframe: returns whether all bytes were read.
  bool whole() const noexcept { return whole_; }

 private:
  std::uint32_t varuint() noexcept;

  std::span<const std::uint8_t> rest_;
  bool whole_ = true;
};

/// Writes subframes into a frame. Bytes beyond its room are left out.
class SubframeWriter {
 public:
  explicit SubframeWriter(canid_t id) noexcept;

  SubframeWriter& begin(Access access, Type type, Register first, unsigned count) noexcept;
  /// Rounds to the nearest number of the type.
  SubframeWriter& value(Type type, double value) noexcept;
  /// Returns the frame, padded.
  can_frame frame() const noexcept;

 private:
  void add(unsigned byte) noexcept {
    if (frame_.len < CANFD_MAX_DLEN) frame_.data[frame_.len++] = static_cast<std::uint8_t>(byte);
  }

  can_frame frame_{};
};

/// Returns the value of register `i` of a subframe that has values.
double value_of(const Subframe& subframe, unsigned i) noexcept;

/// A controller is requested to reply its state, and one thing more.
enum class Query : std::uint8_t { kState, kIdentity, kGains };

struct Reply {
  double mode = 0;         ///< Mode
  double position = 0;     ///< rad, of the output
  double velocity = 0;     ///< rad/s
  double torque = 0;       ///< N·m
  double voltage = 0;      ///< V
  double temperature = 0;  ///< °C, of the board
  double fault = 0;        ///< its code; from 96 on a limit that acts

  double home = 0;  ///< of Query::kIdentity
  double map_version = 0;
  double proportional = 0, integral = 0, derivative = 0;  ///< N·m, of Query::kGains

  bool has_identity = false, has_gains = false;
};

/// A register of a reply.
struct ReplyField {
  Register number;
  Type type;
  double Reply::*member;
  double scale;  ///< SI value of one unit
};

/// Returns nothing if no reply here has the register in this format.
const ReplyField* field_of(std::uint32_t number, Type type) noexcept;

/// Encodes a request to stop, which also clears an error and ends a timeout.
can_frame encode_stop(std::uint64_t node, Query query) noexcept;

/// Encodes an order. `ranges` hold the stiffness and the damping of the scale 1, and the greatest torque. The order
/// ends after `timeout` s. No trajectory limits its steps.
can_frame encode_order(std::uint64_t node, const MitRanges& ranges, const MitCommand& command, double timeout,
                       Query query) noexcept;

/// Returns nothing if the frame is not the whole state of this controller, for this program.
std::optional<Reply> decode_reply(const can_frame& frame, std::uint64_t node) noexcept;

/// Returns whether a controller with this number obeys the frame. Streams of the maker's tool count as well.
bool commands(const can_frame& frame, std::uint64_t node) noexcept;

}  // namespace robot_control::moteus
