#pragma once
/// Each error of the plant has its own stream of random numbers, so that setting one error to zero does not change the
/// others.

#include <cstdint>
#include <random>

namespace robot_control {

/// The numbers of the streams; 0 … 5 are bias, noise and walk of gyro and accelerometer (sensor_errors.cpp).
enum ErrorStream : std::uint64_t {
  kVibrationStream = 6,
  kSlowErrorStream = 7,
  kImuLateStream = 8,
  kEncodersLateStream = 9,
  kLeftSlipStream = 10,
  kRightSlipStream = 11,
  kLaserStream = 16,  ///< and all numbers behind it: one stream per scan
  kJointOffsetStream = 1ULL << 62,
};

/// A NormalStream returns independent standard normal numbers by G. Marsaglia's polar method (SIAM Review 6, 1964, p.
/// 260). It takes a quarter of the time of libstdc++'s distribution and gives the same bits with any standard library.
class NormalStream {
 public:
  void seed(std::uint64_t seed, std::uint64_t stream);
  double next() noexcept;

  /// Returns an independent number x with −1 ≤ x < 1, all equally probable.
  double uniform() noexcept { return static_cast<double>(static_cast<std::int64_t>(engine_()) >> 11) * 0x1p-52; }

 private:
  std::mt19937_64 engine_;
  double spare_ = 0;  ///< the method computes two numbers at a time
  bool has_spare_ = false;
};

}  // namespace robot_control
