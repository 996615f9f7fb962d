#pragma once
/// Divides a drive into blocks of at least kBlock, over which the planar core compares the turn of the wheels with that
/// of the gyro. A block begins and ends where both sides have been read.
/// While wheels slip, blocks show contradictions but teach nothing (planar_core.h).
/// After a fault of a drive no block begins before the next rest. One wheel brakes while the other coasts, so wheels
/// and gyro differ by slip.

#include <optional>

#include "estimation/tuning.h"

namespace robot_control {

class TurnComparison {
 public:
  struct Input {
    double dt = 0;               ///< s
    double left = 0, right = 0;  ///< m, travel in this step
    bool border = false;         ///< Both sides were read, and the gyro turns the robot.
    bool slide = false;          ///< Wheels slip.
    double gyro_unchanged = 0;   ///< s, ImuReading::gyro_unchanged
  };
  struct Block {
    double time = 0, left = 0, right = 0;  ///< s, m
    bool slid = false;                     ///< Wheels slipped.
    bool stuck = false;                    ///< The gyro repeated one sample for longer than kMaxHoldTime.
  };
  struct Output {
    bool begins = false;         ///< A block begins.
    std::optional<Block> ended;  ///< the block before
  };

  Output step(const Input& input) noexcept {
    block_.time += input.dt;
    block_.left += input.left;
    block_.right += input.right;
    block_.stuck = block_.stuck || input.gyro_unchanged > Tuning::kMaxHoldTime;
    block_.slid = block_.slid || input.slide;
    if (!input.border || suspended_ || (open_ && block_.time < Tuning::kBlock)) return {};
    const Output output{.begins = true, .ended = open_ ? std::optional(block_) : std::nullopt};
    begin();
    return output;
  }
  void begin() noexcept {  ///< begins a block
    block_ = {};
    open_ = true;
  }
  void interrupt() noexcept { open_ = false; }  ///< The open block is not compared.
  void suspend() noexcept {                     ///< No block begins before `resume`.
    open_ = false;
    suspended_ = true;
  }
  void resume() noexcept { suspended_ = false; }

 private:
  Block block_;
  bool open_ = false;
  bool suspended_ = false;
};

}  // namespace robot_control
