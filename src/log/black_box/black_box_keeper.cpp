#include "log/black_box/black_box_keeper.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "log/log_error.h"
#include "signals/formatted_text.h"
#include "signals/names.h"

namespace robot_control {
namespace {

constexpr const char* kCrashed = "telemetry had not ended orderly, or had no time to save a stop";

}  // namespace

BlackBoxKeeper::BlackBoxKeeper(const std::string& folder, std::size_t bytes, std::size_t keep, LogHeader header)
    : folder_(folder, keep), keep_(keep), bytes_(bytes), header_(std::move(header)) {
  folder_.put_ring_aside();
  if (keep_ != 0) unsaved_ = folder_.unsaved();
  try {
    make_box();
  } catch (const LogError&) {
    if (unsaved_.empty()) throw;
    // The ring of a killed telemetry may fill the disk; the saved bag is a third as large.
    for (const std::string& ring : std::exchange(unsaved_, {})) report(save(ring, IncidentKind::kCrash, kCrashed, {}));
    make_box();
  }
}

void BlackBoxKeeper::set_header(const LogHeader& header) {
  header_ = header;
  if (box_ != nullptr) box_->set_header(header);
}

void BlackBoxKeeper::check_ring(std::int64_t now_ns) {
  constexpr std::int64_t kCheckNs = 1'000'000'000;
  if (now_ns < check_ns_) return;
  check_ns_ = now_ns + kCheckNs;
  if (box_ != nullptr && box_->sound()) return;
  box_.reset();  // removed files keep their room on the disk while they are open
  try {
    folder_.put_ring_aside();
    make_box();
    absent_ = false;
    notes_.push_back(folder_.ring() + " was removed or cannot be written; another one was begun");
  } catch (const LogError& error) {
    check_ns_ = now_ns + kRetryNs;
    if (std::exchange(absent_, true)) return;
    notes_.push_back(
        folder_.ring() +
        " was removed or cannot be written, and no other can be made, which is tried every 10 s: " + error.what());
  }
}

void BlackBoxKeeper::check_size() {
  if (size_checked_ || box_ == nullptr || box_->seconds_added() < kRateKnown) return;
  size_checked_ = true;
  const double held = box_->seconds_held();
  if (held >= kMinHeldTime) return;
  const double gigabytes = static_cast<double>(bytes_) * 1e-9;
  notes_.push_back(formatted("telemetry.black_box of %.3g GB holds %.0f s of this robot; %.0f s need %.2g GB",
                             gigabytes, held, kMinHeldTime, gigabytes * 1.1 * kMinHeldTime / held));
}

BlackBoxKeeper::Outcome BlackBoxKeeper::save(const std::string& ring, IncidentKind kind, const std::string& why,
                                             const GiveUp& give_up) const {
  try {
    const SavedIncident saved = folder_.save(ring, kind, give_up);
    const std::string missing = saved.missing.empty() ? "" : "; " + saved.missing;
    return {.saved = true, .note = "saved " + saved.bag + ": " + why + missing};
  } catch (const EmptyBlackBox&) {
    std::error_code ignored;
    if (kind == IncidentKind::kCrash) std::filesystem::remove_all(ring, ignored);
    return {};
  } catch (const SavingGivenUp&) {
    return {.given_up = true, .note = {}};
  } catch (const std::exception& error) {
    return {.note = "not saved (" + why + "): " + error.what()};
  }
}

void BlackBoxKeeper::begin(const std::string& ring, IncidentKind kind, const std::string& why) {
  saving_ = kind == IncidentKind::kStop ? why : "";
  outcome_ = std::async(std::launch::async, [this, ring, kind, why] {
    constexpr int kLowestPriority = 19;
    setpriority(PRIO_PROCESS, 0, kLowestPriority);  // this applies to the calling thread alone
    return save(ring, kind, why, [this] { return ends_.load(); });
  });
}

/// Reports what the thread has saved; false: it gave up.
bool BlackBoxKeeper::finish_saving() {
  if (!outcome_.valid()) return true;
  Outcome outcome = outcome_.get();
  const bool given_up = outcome.given_up;
  report(std::move(outcome));
  return !given_up;
}

void BlackBoxKeeper::report(Outcome outcome) {
  if (outcome.saved) ++saved_;
  if (!outcome.note.empty()) notes_.push_back(std::move(outcome.note));
}

void BlackBoxKeeper::poll(std::int64_t now_ns) {
  check_ring(now_ns);
  check_size();
  if (outcome_.valid() && outcome_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  finish_saving();
  if (watch_.due(now_ns)) {
    const std::uint64_t causes = watch_.clear();
    if (keep_ != 0) begin(folder_.ring(), IncidentKind::kStop, names_of(kStopCauseNames, causes, ", "));
  } else if (!unsaved_.empty()) {
    begin(unsaved_.front(), IncidentKind::kCrash, kCrashed);
    unsaved_.erase(unsaved_.begin());
  }
}

/// The caller saves, because the thread may get little processor time, and roslaunch kills a node after 15 s.
void BlackBoxKeeper::finish(const GiveUp& late) {
  ends_.store(true);
  if (box_ != nullptr) box_->finish();
  std::string why = finish_saving() ? "" : saving_;
  if (watch_.pending()) why += (why.empty() ? "" : ", ") + names_of(kStopCauseNames, watch_.clear(), ", ");
  if (!why.empty() && keep_ != 0) {
    Outcome outcome = save(folder_.ring(), IncidentKind::kStop, why, late);
    if (outcome.given_up) {
      notes_.push_back("not saved (" + why + "): telemetry ends; the next one in this folder saves it as a crash");
      return;
    }
    report(std::move(outcome));
  }
  if (box_ != nullptr) box_->mark_ended();
}

bool IncidentWatch::update(std::uint64_t causes, std::int64_t now_ns) noexcept {
  const bool stop = std::exchange(seen_, true) && causes_ == 0 && causes != 0;
  causes_ = causes;
  if (stop) {
    if (!pending()) latest_ns_ = now_ns + kMaxDelay;
    due_ns_ = std::min(now_ns + kTimeAfterStop, latest_ns_);
  }
  if (stop || pending()) causes_to_save_ |= causes;
  return stop;
}

}  // namespace robot_control
