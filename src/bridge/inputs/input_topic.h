#pragma once
/// A topic into the loop: sent without delay, its queue bounded, its messages of the right length.
///
/// A flood of messages delays only the ordinary threads of ROS: the queue drops its oldest message, and a received
/// value goes into an inbox that keeps the latest one only (rt/latest_value.h).

#include <ros/ros.h>

#include <atomic>
#include <functional>
#include <string>
#include <utility>

#include "bridge/inputs/publisher.h"
#include "bridge/messages/bounded_message.h"
#include "bridge/network/publisher_uri.h"
#include "rt/clock.h"

namespace robot_control {

template <class BoundedMessage>
class InputTopic {
 public:
  using Message = decltype(BoundedMessage::message);

  /// Queue lengths: 1 where only the latest message counts, more where none must be lost.
  InputTopic(std::string name, std::uint32_t queue) : name_(std::move(name)), queue_(queue) {}
  InputTopic(const InputTopic&) = delete;
  InputTopic& operator=(const InputTopic&) = delete;

  /// `malformed`: called instead of `receive` for data that is no message of this type, with a warning every 10 s at
  /// most.
  void connect(
      ros::NodeHandle& handle, const std::function<void(const Message&)>& receive,
      const std::function<void()>& malformed = [] {}) {
    connect_with_sender(
        handle, [receive](const Message& message, const Publisher&) { receive(message); },
        [malformed](const std::string&) { malformed(); });
  }

  /// The same with the connection over which it came and the node at its other end.
  void connect_with_sender(
      ros::NodeHandle& handle, const std::function<void(const Message&, const Publisher&)>& receive,
      const std::function<void(const std::string&)>& malformed = [](const std::string&) {}) {
    using Event = ros::MessageEvent<const BoundedMessage>;
    const boost::function<void(const Event&)> callback = [this, receive, malformed](const Event& event) {
      const BoundedMessage& received = *event.getConstMessage();
      if (received.accepted) return receive(received.message, publisher_of(event));
      malformed(event.getPublisherName());
      warn();
    };
    subscriber_ = handle.subscribe<BoundedMessage, const Event&>(name_, queue_, callback, nullptr,
                                                                 ros::TransportHints().tcpNoDelay());
  }

 private:
  static Publisher publisher_of(const ros::MessageEvent<const BoundedMessage>& event) {
    return {event.getPublisherName(), event.getConnectionHeaderPtr(), publisher_uri(event.getConnectionHeader())};
  }

  void warn() {
    constexpr std::int64_t kSilence = 10'000'000'000;  // ns
    const std::int64_t now_ns = monotonic_ns();
    if (reported_ns_ != 0 && now_ns - reported_ns_ < kSilence) return;
    reported_ns_ = now_ns;
    ROS_WARN("%s: a message of the wrong length was refused; find its publisher: rostopic info %s", name_.c_str(),
             subscriber_.getTopic().c_str());
  }

  std::string name_;
  std::uint32_t queue_;
  ros::Subscriber subscriber_;
  std::atomic<std::int64_t> reported_ns_{0};
};

}  // namespace robot_control
