#pragma once
/// The inputs of a law are collected from row to row (signals/law_calls.h).

#include <cstdint>

#include "signals/law_calls.h"

namespace robot_control {

/// Number of a process that gave itself none: alone on its channels.
inline constexpr std::uint64_t kOnlyProcess = 1;

/// The first row of a law.
template <class Calls>
Calls first_row() noexcept {
  Calls calls;
  calls.law.process = kOnlyProcess;
  return calls;
}

/// `noted` goes into `row`, unless no frame has a checksum (FrameWriter::seals); then it is empty, for the next row.
template <class Calls>
void close_row(bool seals, Calls& noted, std::uint64_t sensors, std::uint64_t output, Calls& row) noexcept {
  const LawRow closed = noted.law;
  if (seals) {
    row = noted;
    row.law.sensors = sensors;
    row.law.output = output;
  }
  noted = {};
  noted.law.process = closed.process;
  noted.law.number = closed.number + 1;
}

}  // namespace robot_control
