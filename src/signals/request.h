#pragma once
/// A Request is what a machine shall do: the twist of its base, a posture and a mode. A machine executes the parts that
/// it can execute; the controller names the others (CommandFrame::ignored).

#include <cmath>
#include <cstdint>

#include "signals/geometry.h"

namespace robot_control {

/// The posture of the base relative to the nominal one, which is all zero.
struct Posture {
  double height = 0;  ///< m
  double roll = 0;    ///< rad
  double pitch = 0;   ///< rad
};

struct Request {
  Twist twist{};  ///< base axes
  Posture posture{};
  std::uint64_t mode = 0;  ///< number of a way of moving, of the kind of machine; 0: its default
};

/// The parts of a request; bits of CommandFrame::ignored.
enum RequestPart : std::uint64_t {
  kPartLinearX = 1u << 0,
  kPartLinearY = 1u << 1,
  kPartLinearZ = 1u << 2,
  kPartAngularX = 1u << 3,
  kPartAngularY = 1u << 4,
  kPartAngularZ = 1u << 5,
  kPartHeight = 1u << 6,
  kPartRoll = 1u << 7,
  kPartPitch = 1u << 8,
  kPartMode = 1u << 9,
};

/// Returns the RequestPart bits of the parts that are not zero.
inline std::uint64_t parts_of(const Request& request) noexcept {
  const auto& [linear, angular] = request.twist;
  const double values[] = {linear[0],
                           linear[1],
                           linear[2],
                           angular[0],
                           angular[1],
                           angular[2],
                           request.posture.height,
                           request.posture.roll,
                           request.posture.pitch};
  std::uint64_t parts = request.mode != 0 ? std::uint64_t{kPartMode} : 0;
  std::uint64_t part = kPartLinearX;
  for (const double value : values) {
    if (value != 0) parts |= part;
    part <<= 1;
  }
  return parts;
}

inline bool finite(const Request& request) noexcept {
  return finite(request.twist) && std::isfinite(request.posture.height) && std::isfinite(request.posture.roll) &&
         std::isfinite(request.posture.pitch);
}

}  // namespace robot_control
