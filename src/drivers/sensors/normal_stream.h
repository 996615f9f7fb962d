#pragma once
/// The random numbers of the plant's errors: one stream for each error, so that one that is set to zero changes none of
/// the others.

#include <cstdint>
#include <random>

namespace robot_control {

/// Numbers of the streams; 0 … 5 are bias, noise and walk of gyro and accelerometer (sensor_errors.cpp).
enum ErrorStream : std::uint64_t {
  kVibrationStream = 6,
  kSlowErrorStream = 7,
  kImuLateStream = 8,
  kEncodersLateStream = 9,
  kLeftSlipStream = 10,
  kRightSlipStream = 11,
};

/// Independent standard normal numbers: G. Marsaglia's polar method (SIAM Review 6, 1964, p. 260), a quarter of the
/// time that libstdc++'s distribution takes, and the same bits with any standard library.
class NormalStream {
 public:
  void seed(std::uint64_t seed, std::uint64_t stream);
  double next() noexcept;

 private:
  double uniform() noexcept;

  std::mt19937_64 engine_;
  double spare_ = 0;  ///< the method gives two at a time
  bool has_spare_ = false;
};

}  // namespace robot_control
