#pragma once
/// A LatencyRequest limits how deep the processors of the machine may sleep while they are idle.
///
/// A processor needs up to some hundred µs to leave a deep idle state. A 32-bit number of µs that is written
/// to /dev/cpu_dma_latency excludes the idle states with a longer exit latency; 0 permits polling alone. The smallest
/// of all requests holds for all processors. A request ends when its descriptor is closed, also by the end of the
/// process. Source: the kernel's documentation, power/pm_qos_interface.

#include <cstdint>
#include <string>

namespace robot_control {

inline constexpr const char* kLatencyDevice = "/dev/cpu_dma_latency";

class LatencyRequest {
 public:
  LatencyRequest() = default;  ///< requests nothing

  /// Opens the device and writes the request. A refusal is no exception: `refusal` returns it.
  explicit LatencyRequest(std::int32_t latency_us, const char* device = kLatencyDevice);
  LatencyRequest(const LatencyRequest&) = delete;
  LatencyRequest& operator=(const LatencyRequest&) = delete;
  ~LatencyRequest();

  /// Returns what was refused, why, and the remedy; "" if the request is in force or nothing was requested.
  const std::string& refusal() const noexcept { return refusal_; }

 private:
  int descriptor_ = -1;
  std::string refusal_;
};

}  // namespace robot_control
