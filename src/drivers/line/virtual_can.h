#pragma once
/// A CAN bus in virtual time: each frame takes the time of its bits at the bit rate, and the lowest identifier wins.
/// The data of CAN FD have their own rate.
///
/// Each party sends its frames in their order. The first frames of all parties take part in the arbitration as soon as
/// the bus is free. A data frame wins over a remote request of the same identifier. All other parties that are
/// connected receive a frame at its end. A frame that no other party could acknowledge stays in its queue. Losses are
/// drawn from a seeded generator; real CAN repeats corrupted frames, so a loss stands for a full queue.

#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "drivers/line/can_frame.h"

namespace robot_control {

class VirtualCan {
 public:
  using Receiver = std::function<void(const can_frame& frame, std::int64_t now_ns)>;

  static constexpr std::size_t kMaxQueue = 128;  ///< frames of one party

  /// A `data_rate` of 0 is the bit rate.
  explicit VirtualCan(double bit_rate, std::uint64_t seed = 1, double data_rate = 0);

  /// Returns the number of the new party.
  std::size_t join(Receiver receiver);

  /// Queues a frame at the present time. False: the party's queue is full.
  bool send(std::size_t party, const can_frame& frame);

  /// Carries all frames that end at or before `until_ns`.
  void advance(std::int64_t until_ns);

  /// A party that is not connected neither sends nor receives: its cable is out, its bit rate is wrong, or its
  /// controller is in bus-off. Its queue is emptied.
  void connect(std::size_t party, bool connected);

  /// From now on each frame is lost with this probability.
  void lose(double probability) { loss_ = probability; }

  /// From now on each frame is late by a random time up to this one. The frames of a party keep their order.
  void delay(std::int64_t longest_ns) { longest_delay_ns_ = longest_ns; }

  std::int64_t now_ns() const { return now_ns_; }
  /// Time in which the bus was busy.
  std::int64_t busy_ns() const { return busy_ns_; }
  /// Number of frames that were carried.
  std::uint64_t frames() const { return frames_; }

 private:
  struct Pending {
    can_frame frame{};
    std::int64_t ready_ns = 0;
  };
  struct Party {
    Receiver receiver;
    std::vector<Pending> queue;  // has room for kMaxQueue
    bool connected = true;
  };

  std::int64_t ready_ns(const Party& sender);
  Party* next_sender(std::int64_t start_ns);
  void deliver(const Party& sender, const can_frame& frame);

  double bit_rate_;
  double data_rate_;
  std::mt19937_64 generator_;
  double loss_ = 0;
  std::int64_t longest_delay_ns_ = 0;
  std::vector<Party> parties_;
  std::int64_t now_ns_ = 0;
  std::int64_t free_ns_ = 0;  // the bus is free from then on
  std::int64_t busy_ns_ = 0;
  std::uint64_t frames_ = 0;
};

}  // namespace robot_control
