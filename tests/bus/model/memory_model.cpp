#include "bus/model/memory_model.h"

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace robot_control::model {
namespace {

bool acquires(std::memory_order order) noexcept {
  return order == std::memory_order_acquire || order == std::memory_order_acq_rel;
}

bool releases(std::memory_order order) noexcept {
  return order == std::memory_order_release || order == std::memory_order_acq_rel;
}

constexpr std::uint64_t kMaxSchedules = 3'000'000;  // some 10 s

template <class View>
void join(View& into, const View& from) noexcept {
  for (std::size_t i = 0; i < into.size(); ++i) into[i] = std::max(into[i], from[i]);
}

}  // namespace

MemoryModel::MemoryModel() : before_(current_) {
  current_ = this;
}

MemoryModel::~MemoryModel() {
  current_ = before_;
}

MemoryModel& MemoryModel::current() {
  if (current_ == nullptr) throw std::logic_error("an atomic of the model without a model");
  return *current_;
}

std::size_t MemoryModel::add_word(Value initial) {
  if (words_.size() == kWords) throw std::logic_error("more words than the model has room for");
  words_.emplace_back().history = {{initial, {}}};
  return words_.size() - 1;
}

void MemoryModel::name(std::size_t word, const std::string& text) {
  const auto known = std::find(names_.begin(), names_.end(), text);
  words_[word].name = static_cast<std::size_t>(known - names_.begin());
  if (known == names_.end()) names_.push_back(text);
}

Report MemoryModel::explore(const Body& first, const Body& second, const Body& after, Schedules schedules) {
  std::vector<Value> initial;
  for (const Word& word : words_) initial.push_back(word.history.back().value);
  schedules_ = schedules;
  violation_.clear();
  choices_ = {};
  Report report;
  do {
    reset(initial);
    run(first, second);
    if (after) after();
    if (++report.schedules > kMaxSchedules) throw std::logic_error("more schedules than a test should visit");
  } while (violation_.empty() && choices_.next());
  reset(initial);
  report.violation = violation_;
  return report;
}

void MemoryModel::reset(const std::vector<Value>& initial) {
  for (std::size_t i = 0; i < words_.size(); ++i) words_[i].history.assign(1, {initial[i], {}});
  for (Thread& thread : threads_) {
    thread.view.fill(0);
    thread.last_read.fill(std::nullopt);
  }
  revive();
}

void MemoryModel::run(const Body& first, const Body& second) {
  threads_[0].fiber.start(first);
  threads_[1].fiber.start(second);
  running_ = 0;
  while (!self().fiber.ended() || !other().fiber.ended()) {
    self().fiber.resume();
    if (!other().fiber.ended()) running_ = 1 - running_;
  }
  running_ = kNobody;
}

void MemoryModel::fail(const std::string& violation) {
  if (violation_.empty()) violation_ = violation;
}

MemoryModel::Value MemoryModel::load(std::size_t word, std::memory_order order, const std::source_location& where) {
  if (!exploring()) return words_[word].history.back().value;
  const Site site = visit(word, Operation::kLoad, order, where);
  std::optional<Value>& last_read = self().last_read[word];
  if (last_read) repeating_.insert(site);
  if (broken(site, Defect::kStale) && last_read) return *last_read;
  const std::size_t oldest = oldest_readable(word);
  const std::size_t last = words_[word].history.size() - 1;
  const std::size_t read = last - choose(last - oldest + 1);
  const Store& store = words_[word].history[read];
  self().view[word] = static_cast<std::uint8_t>(read);
  if (acquires(order) && !broken(site, Defect::kRelaxed)) join(self().view, store.carries);
  last_read = store.value;
  return store.value;
}

void MemoryModel::store(std::size_t word, Value value, std::memory_order order, const std::source_location& where) {
  if (!exploring()) {
    words_[word].history.back().value = value;
    return;
  }
  const Site site = visit(word, Operation::kStore, order, where);
  if (dies() || broken(site, Defect::kSkipped)) return;
  append(word, {value, carried_by(word, site)});
}

MemoryModel::Value MemoryModel::add(std::size_t word, Value value, std::memory_order order,
                                    const std::source_location& where) {
  if (!exploring()) {
    Value& stored = words_[word].history.back().value;
    return std::exchange(stored, stored + value);
  }
  const Site site = visit(word, Operation::kAdd, order, where);
  const Store read = words_[word].history.back();
  if (dies() || broken(site, Defect::kSkipped)) return read.value;
  if (acquires(order) && !broken(site, Defect::kRelaxed)) join(self().view, read.carries);
  Store store{read.value + value, carried_by(word, site)};
  join(store.carries, read.carries);
  append(word, store);
  return read.value;
}

Site MemoryModel::visit(std::size_t word, Operation operation, std::memory_order order,
                        const std::source_location& where) {
  if (order == std::memory_order_seq_cst) throw std::logic_error("seq_cst is not modelled");
  const Site site{where.file_name(), where.line(), where.column(), words_[word].name, operation, order};
  sites_.insert(site);
  if (schedules_ == Schedules::kAll && !other().fiber.ended() && choose(2) == 1) self().fiber.pause();
  return site;
}

bool MemoryModel::broken(const Site& site, Defect defect) const {
  return mutant_ && mutant_->defect == defect && mutant_->site == site;
}

bool MemoryModel::dies() {
  if (mortal_ && !dead_) dead_ = choose(2) == 1;
  return dead_;
}

std::size_t MemoryModel::oldest_readable(std::size_t word) {
  std::size_t oldest = self().view[word];
  if (schedules_ == Schedules::kAll || running_ != 0 || words_[word].writer == 0) return oldest;
  while (!other().fiber.ended() && choose(2) == 1) {
    const std::size_t known = words_[word].history.size();
    self().waits_for = word;
    self().fiber.pause();
    self().waits_for = kWords;
    if (words_[word].history.size() > known) oldest = known;
  }
  return oldest;
}

MemoryModel::View MemoryModel::carried_by(std::size_t word, const Site& site) const {
  View carried{};
  if (releases(site.order) && !broken(site, Defect::kRelaxed)) carried = self().view;
  carried[word] = static_cast<std::uint8_t>(words_[word].history.size());
  return carried;
}

void MemoryModel::append(std::size_t word, const Store& store) {
  if (words_[word].writer != running_) fail("the other thread writes " + names_[words_[word].name]);
  words_[word].history.push_back(store);
  self().view[word] = static_cast<std::uint8_t>(words_[word].history.size() - 1);
  if (other().waits_for == word) self().fiber.pause();
}

std::vector<Mutant> MemoryModel::mutants(const std::string& file) const {
  std::vector<Mutant> all;
  for (const Site& site : sites_) {
    if (!std::string_view(site.file).ends_with(file)) continue;
    if (site.order != std::memory_order_relaxed) all.push_back({site, Defect::kRelaxed});
    if (site.operation != Operation::kLoad) all.push_back({site, Defect::kSkipped});
    if (repeating_.contains(site)) all.push_back({site, Defect::kStale});
  }
  return all;
}

std::string MemoryModel::to_string(const Mutant& mutant) const {
  const Site& site = mutant.site;
  const auto alike = [&](const Site& earlier) {
    return earlier.name == site.name && earlier.operation == site.operation && earlier.order == site.order &&
           earlier <= site;
  };
  const char* const operations[] = {"load", "store", "add"};
  const char* const defects[] = {"without order", "not done", "not recreated"};
  const std::string order = acquires(site.order) ? "-acquire " : releases(site.order) ? "-release " : "-relaxed ";
  return operations[static_cast<int>(site.operation)] + order + names_[site.name] + " #" +
         std::to_string(std::count_if(sites_.begin(), sites_.end(), alike)) + " " +
         defects[static_cast<int>(mutant.defect)];
}

}  // namespace robot_control::model
