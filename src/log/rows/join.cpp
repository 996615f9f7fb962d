#include "log/rows/join.h"

#include <algorithm>
#include <utility>

namespace robot_control {
namespace {

template <class Row>
const FrameHead* front_of(const std::deque<Row>& queue) {
  return queue.empty() ? nullptr : &head_of(queue.front());
}

template <class Row>
const Row* first_of(const std::deque<Row>& queue, bool has_row) {
  return has_row ? &queue.front() : nullptr;
}

}  // namespace

Join::Join(double period, std::function<void(const JoinedRow&)> sink, std::size_t window)
    : period_(period), sink_(std::move(sink)), window_(window) {}

template <std::size_t Node, class Row>
void Join::add_to(const Row& row) {
  auto& queue = std::get<Node>(queues_);
  const FrameHead& head = head_of(row);
  const bool run_over = std::find(finished_runs_.begin(), finished_runs_.end(), head.run) != finished_runs_.end();
  const bool emitted = run_ == head.run && last_cycle_ && head.cycle <= *last_cycle_;
  // A restarted node begins with the newest frame, which its predecessor may have answered.
  const bool again =
      !queue.empty() && head_of(queue.back()).run == head.run && head.cycle <= head_of(queue.back()).cycle;
  if (run_over || emitted || again) {
    if (!repeats<Node>(row)) ++counts_.late[Node];
    return;
  }
  newest_[Node] = {row.calls.law.process, row.calls.law.number, head.run, head.cycle};
  queue.push_back(row);
  drain(false);
}

template <std::size_t Node, class Row>
bool Join::repeats(const Row& row) {
  const FrameHead& head = head_of(row);
  Newest& newest = newest_[Node];
  const LawRow& law = row.calls.law;
  if (head.run != newest.run || head.cycle != newest.cycle) return false;
  if (law.process == newest.process && law.number <= newest.number) return false;
  newest.process = law.process;
  newest.number = law.number;
  std::get<Node>(repeated_).push_back(row);
  give_repeated();
  return true;
}

void Join::give_repeated() {
  const auto over = [this](const auto& row) { return std::ranges::count(finished_runs_, head_of(row).run) != 0; };
  const auto give = [&](auto& queue) {
    while (!queue.empty() && over(queue.front())) queue.pop_front();
    while (!queue.empty() && run_ == head_of(queue.front()).run && last_cycle_ >= head_of(queue.front()).cycle) {
      const std::uint64_t cycle = head_of(queue.front()).cycle;
      JoinedRow row{.run = run_index_, .cycle = cycle, .time = row_time(cycle, period_)};
      row.repeats = true;
      row.put(queue.front());
      sink_(row);
      queue.pop_front();
    }
  };
  give(std::get<1>(repeated_));
  give(std::get<2>(repeated_));
  give(std::get<3>(repeated_));
}

void Join::add(const DriverTrace& row) {
  add_to<0>(row);
}
void Join::add(const EstimatorTrace& row) {
  add_to<1>(row);
}
void Join::add(const ControllerTrace& row) {
  add_to<2>(row);
}
void Join::add(const MonitorTrace& row) {
  add_to<3>(row);
}

void Join::emit_beyond(std::size_t window) {
  const std::size_t before = std::exchange(window_, window);
  drain(false);
  window_ = before;
}

std::array<const FrameHead*, 4> Join::fronts() const {
  return std::apply([](const auto&... queue) { return std::array<const FrameHead*, 4>{front_of(queue)...}; }, queues_);
}

bool Join::may_proceed(const std::array<const FrameHead*, 4>& fronts) const {
  const bool complete = std::all_of(fronts.begin(), fronts.end(), [](const auto* head) { return head != nullptr; });
  const auto longest = std::apply([](const auto&... queue) { return std::max({queue.size()...}); }, queues_);
  return complete || longest > window_;
}

void Join::drain(bool force) {
  for (;;) {
    const auto heads = fronts();
    const bool nothing = std::none_of(heads.begin(), heads.end(), [](const auto* head) { return head != nullptr; });
    if (nothing || !(force || may_proceed(heads))) return;
    const FrameHead* next = nullptr;
    for (const FrameHead* head : heads) {
      if (head == nullptr || run_ != head->run) continue;
      if (next == nullptr || head->cycle < next->cycle) next = head;
    }
    if (next != nullptr) {
      emit(next->cycle);
      continue;
    }
    for (const FrameHead* head : heads) {
      if (head != nullptr && (next == nullptr || head->stamp_ns < next->stamp_ns)) next = head;
    }
    begin_run(next->run);
  }
}

void Join::begin_run(std::uint64_t run) {
  if (run_) finished_runs_.push_back(*run_);
  run_ = run;
  last_cycle_.reset();
  ++run_index_;
}

void Join::emit(std::uint64_t cycle) {
  const auto heads = fronts();
  std::array<bool, 4> has{};
  for (std::size_t node = 0; node < has.size(); ++node) {
    has[node] = heads[node] != nullptr && run_ == heads[node]->run && heads[node]->cycle == cycle;
    if (!has[node]) ++counts_.absent[node];
  }
  JoinedRow row;
  row.run = run_index_;
  row.cycle = cycle;
  row.time = row_time(cycle, period_);
  row.driver = first_of(std::get<0>(queues_), has[0]);
  row.set({first_of(std::get<1>(queues_), has[1]), first_of(std::get<2>(queues_), has[2]),
           first_of(std::get<3>(queues_), has[3])});
  sink_(row);
  ++counts_.emitted;
  last_cycle_ = cycle;
  std::size_t node = 0;
  std::apply([&](auto&... queue) { ((has[node++] ? queue.pop_front() : void()), ...); }, queues_);
  give_repeated();
}

}  // namespace robot_control
