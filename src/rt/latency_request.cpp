#include "rt/latency_request.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace robot_control {
namespace {

std::string remedy_of(int error) {
  if (error == EACCES || error == EPERM) return "scripts/privileges install, or in a container the device itself";
  return "leave robot.cpu_dma_latency out, or use a kernel with CONFIG_CPU_IDLE and its device";
}

}  // namespace

LatencyRequest::LatencyRequest(std::int32_t latency_us, const char* device)
    : descriptor_(open(device, O_WRONLY | O_CLOEXEC)) {
  if (descriptor_ >= 0 && write(descriptor_, &latency_us, sizeof latency_us) == sizeof latency_us) return;
  const int error = errno;
  refusal_ = "cpu_dma_latency " + std::to_string(latency_us) + " us is not granted (" + device + ": " +
             std::strerror(error) + "; remedy: " + remedy_of(error) + ")";
}

LatencyRequest::~LatencyRequest() {
  if (descriptor_ >= 0) close(descriptor_);
}

}  // namespace robot_control
