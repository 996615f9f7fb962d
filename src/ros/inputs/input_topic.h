#pragma once
/// An InputTopic subscribes to a topic for the loop, without delay (TCP_NODELAY), with a bounded queue and checked
/// message lengths.
///
/// A flood of messages delays only the ordinary threads of ROS. The queue drops its oldest message, and received values
/// go into an inbox that keeps only the latest one (bus/latest_value.h).

#include <ros/ros.h>

#include <atomic>
#include <functional>
#include <string>
#include <utility>

#include "ros/inputs/publisher.h"
#include "ros/messages/bounded_message.h"
#include "ros/network/publisher_uri.h"
#include "rt/clock.h"

namespace robot_control {

template <class BoundedMessage>
class InputTopic {
 public:
  using Message = decltype(BoundedMessage::message);

  /// `queue` is the queue's length: 1 if only the latest message counts, more if none may be lost.
  InputTopic(std::string name, std::uint32_t queue) : name_(std::move(name)), queue_(queue) {}
  InputTopic(const InputTopic&) = delete;
  InputTopic& operator=(const InputTopic&) = delete;

  /// `malformed` is called instead of `receive` for data that are no message of this type; a warning follows at most
  /// every 10 s.
  void connect(
      ros::NodeHandle& handle, const std::function<void(const Message&)>& receive,
      const std::function<void()>& malformed = [] {}) {
    connect_with_sender(
        handle, [receive](const Message& message, const Publisher&) { receive(message); },
        [malformed](const std::string&) { malformed(); });
  }

  /// Subscribes as `connect` does; `receive` also gets the publisher of the message.
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
  Publisher publisher_of(const ros::MessageEvent<const BoundedMessage>& event) const {
    return {event.getPublisherName(), event.getConnectionHeaderPtr(), publisher_uri(event.getConnectionHeader()),
            name_};
  }

  void warn() {
    constexpr std::int64_t kSilence = 10'000'000'000;  // ns
    const std::int64_t now_ns = monotonic_ns();
    if (reported_ns_ != 0 && now_ns - reported_ns_ < kSilence) return;
    reported_ns_ = now_ns;
    ROS_WARN("%s: a message of the wrong length was refused; check its publisher: rostopic info %s", name_.c_str(),
             subscriber_.getTopic().c_str());
  }

  std::string name_;
  std::uint32_t queue_;
  ros::Subscriber subscriber_;
  std::atomic<std::int64_t> reported_ns_{0};
};

}  // namespace robot_control
