#include "rt/realtime_thread.h"

#include <fcntl.h>
#include <link.h>
#include <linux/capability.h>
#include <malloc.h>
#include <pthread.h>
#include <pwd.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <future>
#include <system_error>
#include <utility>

#include "rt/crash_report.h"
#include "rt/wait_count.h"

namespace robot_control {
namespace {

constexpr std::size_t kOrdinaryStackBytes = 1024 * 1024;
constexpr std::size_t kGuardBytes = 64 * 1024;  // an overflow causes SIGSEGV instead of overwriting other memory

std::string user_name() {
  const passwd* entry = getpwuid(geteuid());
  if (entry != nullptr) return entry->pw_name;
  return std::string(":").append(std::to_string(geteuid()));  // limits.conf(5)
}

bool has_capability(int capability) {
  std::ifstream status("/proc/self/status");
  for (std::string key; status >> key;) {
    unsigned long long effective = 0;
    if (key == "CapEff:" && status >> std::hex >> effective) return ((effective >> capability) & 1) != 0;
  }
  return false;
}

/// Raises the soft limit as far as the hard limit permits, and returns it.
rlim_t raise_limit(__rlimit_resource resource, rlim_t wanted) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0) return 0;
  if (limit.rlim_cur >= wanted) return limit.rlim_cur;
  limit.rlim_cur = std::min(limit.rlim_max, wanted);
  return setrlimit(resource, &limit) == 0 ? limit.rlim_cur : 0;
}

std::string memory_refusal(const std::string& why) {
  return "memory is not locked (" + why + "; remedy: '" + user_name() + " - memlock unlimited' or CAP_IPC_LOCK)";
}

/// These libraries come with ROS and with the readers of meshes. No loop calls them.
constexpr auto kLibrariesOutsideTheLoop = std::to_array<std::string_view>(
    {"libassimp.", "libdraco.", "libicudata.", "libicui18n.", "libicuuc.", "libpython3."});

RealtimeReport lock_memory() {
  RealtimeReport report;
  const rlim_t limit = raise_limit(RLIMIT_MEMLOCK, RLIM_INFINITY);
  if (limit != RLIM_INFINITY && !has_capability(CAP_IPC_LOCK)) {
    report.memory_lock = Grant::kRefused;
    report.refusals.push_back(memory_refusal("limit " + std::to_string(limit / 1024) + " KiB"));
    return report;
  }
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
    report.memory_lock = Grant::kRefused;
    report.refusals.push_back(memory_refusal(std::strerror(errno)));
    return report;
  }
  report.memory_lock = Grant::kGranted;
  unlock_libraries(kLibrariesOutsideTheLoop);
  mallopt(M_ARENA_MAX, 2);
  mallopt(M_TRIM_THRESHOLD, -1);
  pthread_attr_t attributes;
  if (pthread_attr_init(&attributes) == 0) {
    pthread_attr_setstacksize(&attributes, kOrdinaryStackBytes);
    pthread_setattr_default_np(&attributes);
    pthread_attr_destroy(&attributes);
  }
  return report;
}

void take_core(int core, RealtimeReport& report) {
  if (core < 0) return;
  cpu_set_t cores;
  CPU_ZERO(&cores);
  int error = EINVAL;
  if (core < CPU_SETSIZE) {
    CPU_SET(static_cast<std::size_t>(core), &cores);
    error = pthread_setaffinity_np(pthread_self(), sizeof cores, &cores);
  }
  report.core = error == 0 ? Grant::kGranted : Grant::kRefused;
  if (error == 0) return;
  report.refusals.push_back("core " + std::to_string(core) + " is not granted (" + std::strerror(error) +
                            "; remedy: robot.core: one that 'taskset -cp " + std::to_string(getpid()) +
                            "' lists, or -1)");
}

void take_priority(int priority, RealtimeReport& report) {
  const rlim_t limit = raise_limit(RLIMIT_RTPRIO, static_cast<rlim_t>(priority));
  const sched_param parameter{.sched_priority = priority};
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);
  report.priority = error == 0 ? Grant::kGranted : Grant::kRefused;
  if (error == 0) return;
  report.refusals.push_back("SCHED_FIFO priority " + std::to_string(priority) + " is not granted (limit " +
                            std::to_string(limit) + "; remedy: '" + user_name() + " - rtprio 99' or CAP_SYS_NICE)");
}

std::unique_ptr<LatencyRequest> limit_idle_states(const RealtimeParameters& parameters, RealtimeReport& report) {
  if (parameters.policy == RealtimePolicy::kOff || !parameters.cpu_latency_us) return nullptr;
  auto request = std::make_unique<LatencyRequest>(*parameters.cpu_latency_us);
  report.cpu_latency = request->refusal().empty() ? Grant::kGranted : Grant::kRefused;
  if (!request->refusal().empty()) report.refusals.push_back(request->refusal());
  return request;
}

bool refused(const RealtimeParameters& parameters, const RealtimeReport& report) {
  return parameters.policy == RealtimePolicy::kRequired && !report.refusals.empty();
}

}  // namespace

RealtimeReport prepare_process(RealtimePolicy policy) {
  if (policy == RealtimePolicy::kOff) return {};
  static const RealtimeReport first = lock_memory();
  return first;
}

struct RealtimeThread::Thread {
  /// The stack of the thread, with a guard below it and populated pages.
  class Stack {
   public:
    Stack() {
      const int flags = MAP_PRIVATE | MAP_ANONYMOUS | MAP_STACK | MAP_POPULATE;
      memory_ = mmap(nullptr, kGuardBytes + RealtimeThread::kStackBytes, PROT_READ | PROT_WRITE, flags, -1, 0);
      if (memory_ == MAP_FAILED) throw std::system_error(errno, std::generic_category(), "mmap of the loop's stack");
      mprotect(memory_, kGuardBytes, PROT_NONE);
      mlock(bottom(), RealtimeThread::kStackBytes);  // succeeds also if the limit is too small for the whole process
    }
    Stack(const Stack&) = delete;
    Stack& operator=(const Stack&) = delete;
    ~Stack() { munmap(memory_, kGuardBytes + RealtimeThread::kStackBytes); }

    void* bottom() const noexcept { return static_cast<char*>(memory_) + kGuardBytes; }

   private:
    void* memory_ = nullptr;
  };

  RealtimeParameters parameters;
  std::function<void()> body;
  RealtimeReport report;
  std::promise<void> ready;
  int id = 0;
  std::atomic<std::uint64_t> waits{0};
  Stack stack;
  pthread_t handle{};
  bool joined = false;

  static void* run(void* argument) {
    auto& self = *static_cast<Thread*>(argument);
    const RealtimeParameters& requested = self.parameters;
    const AlternateStack signal_stack;
    pthread_setname_np(pthread_self(), requested.name.substr(0, 15).c_str());
    take_core(requested.core, self.report);
    if (requested.policy != RealtimePolicy::kOff && requested.priority > 0)
      take_priority(requested.priority, self.report);
    self.id = gettid();
    count_waits_in(&self.waits);
    const bool go = !refused(requested, self.report);
    self.ready.set_value();
    if (go) self.body();
    return nullptr;
  }
};

RealtimeThread::RealtimeThread(const RealtimeParameters& parameters, std::function<void()> body)
    : report_(prepare_process(parameters.policy)),
      latency_(limit_idle_states(parameters, report_)),
      thread_(std::make_unique<Thread>()) {
  thread_->parameters = parameters;
  thread_->body = std::move(body);
  thread_->report = report_;
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstack(&attributes, thread_->stack.bottom(), kStackBytes);
  const int error = pthread_create(&thread_->handle, &attributes, &Thread::run, thread_.get());
  pthread_attr_destroy(&attributes);
  if (error != 0) throw std::system_error(error, std::generic_category(), "pthread_create of the loop's thread");
  thread_->ready.get_future().wait();
  report_ = thread_->report;
  if (!refused(parameters, report_)) return;
  join();
  std::string message = "realtime: required, but";
  for (const std::string& refusal : report_.refusals) message += "\n  " + refusal;
  throw RealtimeError(message + "\n  how to grant it: docs/realtime.md");
}

RealtimeThread::~RealtimeThread() {
  join();
}

int RealtimeThread::id() const noexcept {
  return thread_->id;
}

std::uint64_t RealtimeThread::waits() const noexcept {
  return thread_->waits.load(std::memory_order_relaxed);
}

void RealtimeThread::join() {
  if (thread_->joined) return;
  pthread_join(thread_->handle, nullptr);
  thread_->joined = true;
}

namespace {

std::string remedy_of(int error) {
  if (error == EACCES || error == EPERM) return "scripts/privileges install, or in a container the device itself";
  return "remove robot.cpu_dma_latency, or use a kernel with CONFIG_CPU_IDLE and its device";
}

}  // namespace

LatencyRequest::LatencyRequest(std::int32_t latency_us, const char* device)
    : descriptor_(open(device, O_WRONLY | O_CLOEXEC)) {
  if (descriptor_ >= 0 && write(descriptor_, &latency_us, sizeof latency_us) == sizeof latency_us) return;
  const int error = errno;
  refusal_ = "cpu_dma_latency " + std::to_string(latency_us) + " us is not granted (" + device + ": " +
             std::strerror(error) + "; remedy: " + remedy_of(error) + ")";
}

LatencyRequest::~LatencyRequest() {
  if (descriptor_ >= 0) close(descriptor_);
}

bool precede_ordinary_threads() noexcept {
  constexpr int kLowestPriority = 1;
  if (rlimit limit{}; getrlimit(RLIMIT_RTPRIO, &limit) == 0 && limit.rlim_cur < kLowestPriority) {
    limit.rlim_cur = limit.rlim_max;
    setrlimit(RLIMIT_RTPRIO, &limit);
  }
  const sched_param parameter{.sched_priority = kLowestPriority};
  return sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameter) == 0;
}

namespace {

struct Search {
  std::span<const std::string_view> names;
  std::size_t bytes = 0;
};

bool wanted(const Search& search, std::string_view path) noexcept {
  const std::string_view file = path.substr(path.rfind('/') + 1);
  return std::ranges::any_of(search.names, [&](std::string_view name) { return file.starts_with(name); });
}

/// Returns whether code is changed when the library is loaded. Then its pages cannot be read from the file again.
bool relocates_code(const dl_phdr_info& library) noexcept {
  for (const ElfW(Phdr) & segment : std::span(library.dlpi_phdr, library.dlpi_phnum)) {
    if (segment.p_type != PT_DYNAMIC) continue;
    const auto* entry =
        reinterpret_cast<const ElfW(Dyn)*>(library.dlpi_addr + segment.p_vaddr);  // NOLINT(performance-no-int-to-ptr)
    for (; entry->d_tag != DT_NULL; ++entry) {
      if (entry->d_tag == DT_TEXTREL || (entry->d_tag == DT_FLAGS && (entry->d_un.d_val & DF_TEXTREL) != 0))
        return true;
    }
  }
  return false;
}

int unlock(dl_phdr_info* library, std::size_t /*size*/, void* argument) {
  auto& search = *static_cast<Search*>(argument);
  if (!wanted(search, library->dlpi_name) || relocates_code(*library)) return 0;
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  for (const ElfW(Phdr) & segment : std::span(library->dlpi_phdr, library->dlpi_phnum)) {
    if (segment.p_type != PT_LOAD || (segment.p_flags & PF_W) != 0) continue;
    const std::uintptr_t begin = (library->dlpi_addr + segment.p_vaddr) / page * page;
    const std::uintptr_t end = (library->dlpi_addr + segment.p_vaddr + segment.p_memsz + page - 1) / page * page;
    auto* const memory = reinterpret_cast<void*>(begin);  // NOLINT(performance-no-int-to-ptr)
    if (munlock(memory, end - begin) == 0 && madvise(memory, end - begin, MADV_DONTNEED) == 0)
      search.bytes += end - begin;
  }
  return 0;
}

}  // namespace

std::size_t unlock_libraries(std::span<const std::string_view> names) noexcept {
  Search search{.names = names};
  dl_iterate_phdr(&unlock, &search);
  return search.bytes;
}

}  // namespace robot_control
