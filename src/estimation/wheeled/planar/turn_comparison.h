#pragma once
/// Divides a drive into blocks of at least kBlock, over which the planar core compares the turn of the wheels with that
/// of the gyro. A block begins and ends where both sides have been read. While wheels slip, blocks show contradictions
/// but teach nothing. After a fault of a drive none begins before the next rest: one wheel coasts, others brake.

#include "estimation/wheeled/planar/planar_core.h"

namespace robot_control {

class TurnComparison {
 public:
  /// Adds the time and travel of a step, and the flags of `step`.
  void add(const PlanarCore::Block& step) noexcept {
    block_.time += step.time;
    block_.left += step.left;
    block_.right += step.right;
    block_.stuck = block_.stuck || step.stuck;
    block_.slid = block_.slid || step.slid;
  }
  /// Returns true if a block may begin where both sides have been read. The block before ends.
  bool at_border() const noexcept { return !suspended_ && (!open_ || block_.time >= Tuning::kBlock); }
  bool open() const noexcept { return open_; }
  const PlanarCore::Block& block() const noexcept { return block_; }
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
  PlanarCore::Block block_;
  bool open_ = false;
  bool suspended_ = false;
};

}  // namespace robot_control
