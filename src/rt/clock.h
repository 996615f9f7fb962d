#pragma once
/// The only reading of a clock outside the bridge.

#include <cstdint>

namespace robot_control {

/// CLOCK_MONOTONIC, ns.
std::int64_t monotonic_ns() noexcept;

/// The time of day, since 1970 UTC: for records that people read, never for a law.
std::int64_t utc_seconds() noexcept;
std::int64_t utc_ns() noexcept;

/// Sleeps until the absolute CLOCK_MONOTONIC time; at once if that has passed.
void sleep_until(std::int64_t deadline_ns) noexcept;

}  // namespace robot_control
