#pragma once
/// Bodies of a scene that move on given paths, whatever they meet: mocap bodies with a path in the scene's <custom>.
///
///   <body name="cart" mocap="true" pos="1 2 0.4"> … </body>
///   <custom> <numeric name="path/cart" data="0.5  1 2  4 2  4 5"/> </custom>
///
/// The first number is a speed v in m/s, the others are corners x y in m. The body's centre goes round the closed
/// polygon with v, from the first corner at time 0 on. Its height and orientation stay.

#include <mujoco/mujoco.h>

#include <array>
#include <vector>

namespace robot_control {

class MocapPaths {
 public:
  /// Throws DriverError for a path without a mocap body, without two different corners, or with a number that is not
  /// finite.
  explicit MocapPaths(const mjModel& model);

  /// Sets the positions of the bodies at `time` in s. It does not allocate.
  void place(double time, mjData& data) const noexcept;

 private:
  struct Path {
    int mocap = 0;  ///< index into mjData::mocap_pos
    double speed = 0;
    double length = 0;  ///< m, of the whole polygon
    std::vector<std::array<double, 2>> corners;
  };
  std::vector<Path> paths_;
};

}  // namespace robot_control
