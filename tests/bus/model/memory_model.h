#pragma once
/// Runs two threads on atomic words, in every execution that the memory model of C++ allows them.
///
/// Each word keeps the history of its stores. Each thread has a *view*: per word the oldest store that it may still
/// read. A load reads any store from there on, and each is a branch of the exploration. So a thread may read an old
/// value for as long as nothing orders it otherwise. A release store carries the view of its thread; an acquire load
/// joins the view of the store that it read. Read-modify-writes read the last store and continue its release sequence.
/// This is the view semantics of release/acquire and relaxed accesses without its promises (J. Kang et al., "A
/// promising semantics for relaxed-memory concurrency", POPL 2017, sections 2 to 3). No store is read before it is
/// executed (no load buffering). Hence the model cannot show that an order is missing which only keeps a load in front
/// of a later store. Words have one writing thread; fences and seq_cst are refused.
///
/// With Schedules::kAll every access is a point at which the other thread may go on instead. Schedules::kDistinct
/// leaves out schedules that cannot be distinguished: only the store that a load reads matters, and a thread may read
/// old stores anyway. So thread 0 runs ahead until it loads a word that thread 1 writes. There it reads an existing
/// store, or lets thread 1 run up to its next store to that word. Thread 1 runs when thread 0 waits or has ended. If
/// thread 1 writes nothing that thread 0 reads, this needs no switch at all. memory_model_test.cpp compares the
/// outcomes of both.
///
/// Before `explore`, accesses are executed at once: both threads know their results.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <source_location>
#include <string>
#include <vector>

#include "bus/model/choices.h"
#include "bus/model/fiber.h"
#include "bus/model/site.h"

namespace robot_control::model {

enum class Schedules { kDistinct, kAll };

struct Report {
  std::uint64_t schedules = 0;  ///< visited, up to the first violation
  std::string violation;        ///< empty: none
};

class MemoryModel {
 public:
  using Value = std::uint64_t;
  using Body = std::function<void()>;

  MemoryModel();
  MemoryModel(const MemoryModel&) = delete;
  MemoryModel& operator=(const MemoryModel&) = delete;
  ~MemoryModel();

  /// The model to which new atomics belong.
  static MemoryModel& current();

  // ---- what a test does
  void name(std::size_t word, const std::string& text);

  /// Thread 1 alone writes this word; without this, thread 0 alone does.
  void second_writes(std::size_t word) { words_[word].writer = 1; }

  void set_mutant(const std::optional<Mutant>& mutant) { mutant_ = mutant; }

  /// Runs both bodies in every way. `after` runs behind them, knows all their stores, and may call `fail`.
  Report explore(const Body& first, const Body& second, const Body& after = {}, Schedules = Schedules::kDistinct);

  /// A body reports a violation, which ends the exploration.
  void fail(const std::string& violation);

  /// A body goes on in `options` ways.
  std::size_t choose(std::size_t options) { return choices_.choose(options); }

  /// The body may end before any of its stores from here on, as if its process were killed there: its later stores are
  /// lost. `revive` ends that: a successor starts, and knows the result.
  void mortal() noexcept { mortal_ = true; }
  void revive() noexcept { mortal_ = dead_ = false; }

  /// Every way to break one of the accesses so far in source files whose name ends with `file`.
  std::vector<Mutant> mutants(const std::string& file) const;

  /// "load-acquire newest #2 without order": the second such access in the source.
  std::string to_string(const Mutant& mutant) const;

  // ---- what ModelAtomic does
  std::size_t add_word(Value initial);
  Value load(std::size_t word, std::memory_order order, const std::source_location& where);
  void store(std::size_t word, Value value, std::memory_order order, const std::source_location& where);
  Value add(std::size_t word, Value value, std::memory_order order, const std::source_location& where);

 private:
  static constexpr std::size_t kWords = 24;
  static constexpr int kNobody = -1;
  using View = std::array<std::uint8_t, kWords>;

  struct Store {
    Value value = 0;
    View carries{};
  };
  struct Word {
    std::vector<Store> history;
    std::size_t name = 0;
    int writer = 0;
  };
  struct Thread {
    Fiber fiber;
    View view{};
    std::array<std::optional<Value>, kWords> last_read;
    std::size_t waits_for = kWords;
  };

  void run(const Body& first, const Body& second);
  void reset(const std::vector<Value>& initial);
  bool exploring() const noexcept { return running_ != kNobody; }
  Site visit(std::size_t word, Operation operation, std::memory_order order, const std::source_location& where);
  bool broken(const Site& site, Defect defect) const;
  bool dies();
  void append(std::size_t word, const Store& store);
  std::size_t oldest_readable(std::size_t word);
  View carried_by(std::size_t word, const Site& site) const;
  Thread& self() noexcept { return threads_[static_cast<std::size_t>(running_)]; }
  const Thread& self() const noexcept { return threads_[static_cast<std::size_t>(running_)]; }
  Thread& other() noexcept { return threads_[static_cast<std::size_t>(1 - running_)]; }

  static inline MemoryModel* current_ = nullptr;

  MemoryModel* before_;
  std::vector<Word> words_;
  std::vector<std::string> names_{"word"};
  std::array<Thread, 2> threads_;
  Choices choices_;
  std::set<Site> sites_;
  std::set<Site> repeating_;  // loads of what their thread had read before
  std::optional<Mutant> mutant_;
  std::string violation_;
  Schedules schedules_ = Schedules::kDistinct;
  int running_ = kNobody;
  bool mortal_ = false;
  bool dead_ = false;
};

/// Replaces std::atomic in the tested code.
template <class T>
class ModelAtomic {
 public:
  using Where = std::source_location;

  ModelAtomic(T initial = T{}) : word_(MemoryModel::current().add_word(initial)) {}  // NOLINT: as std::atomic
  ModelAtomic(const ModelAtomic&) = delete;
  ModelAtomic& operator=(const ModelAtomic&) = delete;

  T load(std::memory_order order, const Where& where = Where::current()) const {
    return static_cast<T>(MemoryModel::current().load(word_, order, where));
  }
  void store(T value, std::memory_order order, const Where& where = Where::current()) {
    MemoryModel::current().store(word_, value, order, where);
  }
  T fetch_add(T value, std::memory_order order, const Where& where = Where::current()) {
    return static_cast<T>(MemoryModel::current().add(word_, value, order, where));
  }

  std::size_t word() const noexcept { return word_; }

 private:
  std::size_t word_;
};

}  // namespace robot_control::model
