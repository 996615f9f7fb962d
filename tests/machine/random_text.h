#pragma once
/// Random numbers for descriptions that are written at random.

#include <random>
#include <string>

namespace robot_control {

using Random = std::mt19937_64;

inline double between(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

inline std::size_t below(Random& random, std::size_t end) {
  return end == 0 ? 0 : std::uniform_int_distribution<std::size_t>(0, end - 1)(random);
}

inline bool toss(Random& random) {
  return below(random, 2) == 1;
}

/// A decimal number, to 1 nm.
inline std::string metres(double value) {
  std::string text = std::to_string(std::llround(value * 1e9));
  const bool negative = text[0] == '-';
  if (negative) text.erase(0, 1);
  if (text.size() < 10) text.insert(0, 10 - text.size(), '0');
  return (negative ? "-" : "") + text.insert(text.size() - 9, ".");
}

inline std::string xyz(double x, double y, double z) {
  return metres(x) + " " + metres(y) + " " + metres(z);
}

}  // namespace robot_control
