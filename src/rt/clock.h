#pragma once
/// Outside the bridge, clocks are read only by these functions.

#include <cstdint>

namespace robot_control {

/// Returns CLOCK_MONOTONIC in ns.
std::int64_t monotonic_ns() noexcept;

/// Return the time of day since 1970 UTC, for records that people read, never for a law.
std::int64_t utc_seconds() noexcept;
std::int64_t utc_ns() noexcept;

/// Sleeps until the absolute CLOCK_MONOTONIC time; returns at once if that has passed.
void sleep_until(std::int64_t deadline_ns) noexcept;

}  // namespace robot_control
