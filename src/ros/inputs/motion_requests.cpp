#include "ros/inputs/motion_requests.h"

#include <cstdlib>
#include <set>

namespace robot_control {
namespace {

bool same(const boost::weak_ptr<const void>& known, const boost::shared_ptr<const void>& connection) {
  return !known.owner_before(connection) && !connection.owner_before(known);
}

bool any_same_process(const std::vector<Publisher>& senders, const Publisher& sender) {
  return std::ranges::any_of(senders, [&](const Publisher& one) { return same_process(one, sender); });
}

}  // namespace

MotionRequests::Record& MotionRequests::record_of(const Publisher& sender) {
  Record* closed = nullptr;
  bool revoked = permission_.run != 0 && any_same_process(earlier_.present, sender);
  for (Record& record : records_) {
    if (same(record.connection, sender.connection)) return record;
    if (!record.connection.expired() || !same_process(record.sender, sender)) continue;
    revoked |= record.revoked;
    if (record.sender.topic == sender.topic && (closed == nullptr || record.revoked)) closed = &record;
  }
  if (closed != nullptr) {
    closed->connection = sender.connection;
    return *closed;
  }
  forget_the_oldest_closed();
  Record& record = records_.emplace_back();
  record.sender = {sender.name, nullptr, sender.uri, sender.topic};
  record.connection = sender.connection;
  record.revoked = revoked;
  if (revoked) record.requested_ns = started_ns_;
  return record;
}

void MotionRequests::forget_the_oldest_closed() {
  const auto closed = [](const Record& record) { return record.connection.expired(); };
  if (std::ranges::count_if(records_, closed) >= static_cast<std::ptrdiff_t>(kMaxClosed))
    records_.erase(std::ranges::find_if(records_, closed));
}

std::vector<std::string> MotionRequests::senders(std::int64_t now_ns, std::int64_t window_ns) const {
  std::set<std::string> names;
  for (const Record& record : records_) {
    const bool lately = record.sent_ns && std::abs(now_ns - *record.sent_ns) <= window_ns;
    if (lately && names.size() < kMaxNames) names.insert(record.sender.name);
  }
  return {names.begin(), names.end()};
}

void MotionRequests::request(const Publisher& sender, std::int64_t now_ns, std::int64_t age_ns) {
  Record& record = record_of(sender);
  record.requests = true;
  record.revoked |= permission_.granted && now_ns - age_ns < granted_ns_ - in_transit_ns(earlier_.period_ns);
  record.requested_ns = now_ns;
}

void MotionRequests::end(const Publisher& sender) {
  const Record& own = record_of(sender);
  for (Record& record : records_) {
    const bool continued =
        record.connection.expired() && same_process(record.sender, sender) && record.sender.topic == sender.topic;
    if (&record != &own && !continued) continue;
    record.requests = record.revoked = false;
    record.zero_sent = true;
  }
}

bool MotionRequests::follow(const MotionPermission& permission, std::int64_t now_ns) {
  const bool restarted = permission.stopped || permission.run == earlier_.run || earlier_.requested;
  if (permission_.run == 0) started_ns_ = now_ns;
  if (permission_.run == 0 && !restarted) earlier_.present.clear();
  const bool withdrawn = permission.run != permission_.run || permission.withdrawals != permission_.withdrawals;
  const bool granted = permission.granted && (withdrawn || !permission_.granted);
  permission_ = permission;
  if (granted) granted_ns_ = now_ns;
  bool ended = withdrawn;
  for (Record& record : records_) {
    if (withdrawn) {
      record.revoked |= record.requests || recent(record, now_ns);
      record.zero_sent = false;
    }
    const bool with_grant = record.zero_sent && recent(record, now_ns) &&
                            now_ns - *record.requested_ns <= in_transit_ns(earlier_.period_ns);
    if (granted && record.requests && !with_grant && !record.revoked) ended = record.revoked = true;
  }
  return ended;
}

bool MotionRequests::revoked(const Publisher& sender) const {
  return std::ranges::any_of(
      records_, [&](const Record& record) { return record.revoked && same(record.connection, sender.connection); });
}

bool MotionRequests::recent(const Record& record, std::int64_t now_ns) const {
  return record.requested_ns && std::abs(now_ns - *record.requested_ns) <= window_ns_;
}

bool MotionRequests::any(std::int64_t now_ns) const {
  return std::ranges::any_of(records_, [&](const Record& record) {
    return record.requests && recent(record, now_ns) && !record.connection.expired();
  });
}

std::vector<std::string> MotionRequests::revoked_names() const {
  std::set<std::string> names;
  for (const Record& record : records_) {
    if (record.revoked && !record.connection.expired()) names.insert(record.sender.name);
  }
  return {names.begin(), names.end()};
}

}  // namespace robot_control
