/// librobot_control_tripwire.so, preloaded into a node, records what its real-time thread must not do. It is a tool for
/// tests and diagnosis; no program links it.
///
///   LD_PRELOAD=…/librobot_control_tripwire.so ROBOT_CONTROL_TRIPWIRE=REPORT rosrun robot_control state_estimator
///
/// A thread is watched if it has one of the names below. The watch begins with its wait number kStartWaits. It ends
/// when the thread gives its signal stack back, which is the first thing after its loop. Recorded are
///   allocation   malloc, calloc, realloc, free and the aligned forms; new and delete call them
///   lock         mutexes, read-write locks and condition variables, also where they do not reach the kernel
///   exception    throw
///   system call  every one except the waits: futex by syscall(2), clock_nanosleep(2). Syscall User Dispatch (x86-64,
///                Linux ≥ 5.11) turns them into SIGSYS; the handler records the stack and then executes the call
///   page fault   a perf event of the thread sends it a signal at each
/// At its end the process writes REPORT.PID. It begins with what could not be watched. One block per different stack
/// follows: kind, thread, count, and for each frame the object and the offset in it, for addr2line(1).
///
/// SIGUSR2 lets each watched thread commit one violation of each kind, so that a test can prove that they are found.

#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <linux/perf_event.h>
#include <malloc.h>
#include <pthread.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <stdexcept>

#ifndef PR_SET_SYSCALL_USER_DISPATCH
#define PR_SET_SYSCALL_USER_DISPATCH 59
#define PR_SYS_DISPATCH_ON 1
#endif

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);
}

namespace {

constexpr std::array<const char*, 5> kNames{"driver", "estimator", "controller", "monitor", "devices"};
constexpr int kStartWaits = 2000;
constexpr int kFrames = 24;
constexpr std::size_t kRecords = 64;
constexpr char kAllow = 0;  // SYSCALL_DISPATCH_FILTER_ALLOW
constexpr char kBlock = 1;  // SYSCALL_DISPATCH_FILTER_BLOCK

struct Record {
  std::atomic<std::uint64_t> key{0};  // hash of kind, thread and stack; 0: free
  std::atomic<std::uint64_t> count{0};
  const char* kind = nullptr;
  long number = -1;  // of the system call
  std::array<char, 16> thread{};
  int depth = 0;
  std::array<void*, kFrames> stack{};
};
std::array<Record, kRecords> records;
std::atomic<bool> unwatched_calls{false};
std::atomic<bool> unwatched_faults{false};
std::atomic<int> watched{0};
std::atomic<int> plants{0};

struct ThreadState {
  bool named = false;
  bool armed = false;
  bool busy = false;  // inside this library
  volatile char selector = kAllow;
  int waits = 0;
  int planted = 0;
  int stage = 0;
  std::array<char, 16> name{};
};
thread_local ThreadState self __attribute__((tls_model("initial-exec")));

/// Counts a violation; keeps the first stack of each kind. Must not be inlined: the stack begins above it.
__attribute__((noinline)) void record(const char* kind, long number = -1) {
  if (!self.armed || self.busy) return;
  self.busy = true;
  const char before = self.selector;
  self.selector = kAllow;
  std::array<void*, kFrames> stack{};
  const int depth = backtrace(stack.data(), kFrames);
  std::uint64_t key = 0xCBF29CE484222325U ^ reinterpret_cast<std::uintptr_t>(kind) ^ static_cast<std::uint64_t>(number);
  for (const char letter : self.name) key = (key ^ static_cast<unsigned char>(letter)) * 0x100000001B3U;
  for (int i = 0; i < depth; ++i)
    key = (key ^ reinterpret_cast<std::uintptr_t>(stack[static_cast<std::size_t>(i)])) * 0x100000001B3U;
  key |= 1;
  for (Record& each : records) {
    std::uint64_t free = 0;
    if (each.key.compare_exchange_strong(free, key)) {
      each.kind = kind;
      each.number = number;
      each.thread = self.name;
      each.depth = depth;
      each.stack = stack;
      free = key;
    }
    if (free != key) continue;
    each.count.fetch_add(1);
    break;
  }
  self.selector = before;
  self.busy = false;
}

template <class Function>
Function* next(const char* name, const char* version = nullptr) {
  void* const found = version == nullptr ? dlsym(RTLD_NEXT, name) : dlvsym(RTLD_NEXT, name, version);
  if (found == nullptr) std::abort();
  return reinterpret_cast<Function*>(found);
}

#if defined(__x86_64__)

long execute(long number, long a, long b, long c, long d, long e, long f) {
  long result = number;
  register long r10 asm("r10") = d;
  register long r8 asm("r8") = e;
  register long r9 asm("r9") = f;
  asm volatile("syscall" : "+a"(result) : "D"(a), "S"(b), "d"(c), "r"(r10), "r"(r8), "r"(r9) : "rcx", "r11", "memory");
  return result;
}

// The return from a handler is a system call, too: it is allowed by its place.
asm(R"(
.text
.type robot_control_tripwire_return, @function
robot_control_tripwire_return:
  movq $15, %rax
  syscall
robot_control_tripwire_return_end:
)");
extern "C" char robot_control_tripwire_return[] __attribute__((visibility("hidden")));
extern "C" char robot_control_tripwire_return_end[] __attribute__((visibility("hidden")));

void on_system_call(int, siginfo_t* info, void* context) {
  auto* registers = static_cast<ucontext_t*>(context)->uc_mcontext.gregs;
  const int error = errno;
  self.selector = kAllow;
  record("system call", info->si_syscall);
  registers[REG_RAX] = execute(info->si_syscall, registers[REG_RDI], registers[REG_RSI], registers[REG_RDX],
                               registers[REG_R10], registers[REG_R8], registers[REG_R9]);
  self.selector = kBlock;
  errno = error;
}

void on_page_fault(int, siginfo_t*, void*) {
  const char before = self.selector;
  self.selector = kAllow;
  record("page fault");
  self.selector = before;
}

constexpr std::size_t kUntouched = 1 << 16;  // bytes
void* untouched = nullptr;                   // mapped, but not present once it was given back

void on_plant(int, siginfo_t*, void*) {
  munlock(untouched, kUntouched);
  madvise(untouched, kUntouched, MADV_DONTNEED);
  plants.fetch_add(1);
}

/// sigaction(2) without the C library, whose return from handlers is no allowed call.
void handle(int signal, void (*handler)(int, siginfo_t*, void*)) {
  struct {
    void (*handler)(int, siginfo_t*, void*);
    unsigned long flags;
    void* restorer;
    unsigned long mask;
  } action{handler, SA_SIGINFO | SA_RESTART | 0x04000000 /* SA_RESTORER */, robot_control_tripwire_return, 0};
  execute(SYS_rt_sigaction, signal, reinterpret_cast<long>(&action), 0, 8, 0, 0);
}

bool watch_system_calls() {
  const auto begin = reinterpret_cast<unsigned long>(robot_control_tripwire_return);
  const auto end = reinterpret_cast<unsigned long>(robot_control_tripwire_return_end);
  // The address after the instruction is compared.
  return prctl(PR_SET_SYSCALL_USER_DISPATCH, PR_SYS_DISPATCH_ON, begin, end - begin + 1, &self.selector) == 0;
}

#else
#error "the tripwire watches system calls on x86-64 alone"
#endif

const int kFaultSignal = SIGRTMAX - 3;

bool watch_page_faults() {
  perf_event_attr attributes{};
  attributes.size = sizeof attributes;
  attributes.type = PERF_TYPE_SOFTWARE;
  attributes.config = PERF_COUNT_SW_PAGE_FAULTS;
  attributes.sample_period = 1;
  attributes.exclude_kernel = 1;
  attributes.wakeup_events = 1;
  const auto fd = static_cast<int>(::syscall(SYS_perf_event_open, &attributes, 0, -1, -1, PERF_FLAG_FD_CLOEXEC));
  if (fd < 0) return false;
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  if (mmap(nullptr, 2 * page, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0) == MAP_FAILED) return false;
  const f_owner_ex owner{F_OWNER_TID, gettid()};
  return fcntl(fd, F_SETFL, O_ASYNC | O_NONBLOCK) == 0 && fcntl(fd, F_SETSIG, kFaultSignal) == 0 &&
         fcntl(fd, F_SETOWN_EX, &owner) == 0;
}

std::atomic<int> holder_ready{0};
pthread_mutex_t contended = PTHREAD_MUTEX_INITIALIZER;

void* hold(void*) {
  for (;;) {
    pthread_mutex_lock(&contended);
    holder_ready.store(1);
    usleep(2000);
    pthread_mutex_unlock(&contended);
    holder_ready.store(0);
    usleep(1000);
  }
  return nullptr;
}

}  // namespace

// One violation of each kind; a test looks for these names in the stacks.
extern "C" {
__attribute__((noinline)) void planted_allocation() {
  void* volatile memory = std::malloc(100);
  std::free(memory);
}
__attribute__((noinline)) void planted_contended_lock() {
  pthread_mutex_lock(&contended);
  pthread_mutex_unlock(&contended);
}
__attribute__((noinline)) void planted_log_line() {
  std::fprintf(stderr, "a planted log line\n");
  std::fflush(stderr);
}
__attribute__((noinline)) void planted_first_touch() {
  *static_cast<volatile char*>(untouched) = 1;
}
__attribute__((noinline)) void planted_file_read() {
  char text[16];
  const int file = open("/proc/self/stat", O_RDONLY);
  const ssize_t read_bytes = read(file, text, sizeof text);
  static_cast<void>(read_bytes);
  close(file);
}
__attribute__((noinline)) void planted_exception() {
  try {
    throw std::runtime_error("planted");
  } catch (const std::exception&) {
  }
}
__attribute__((noinline)) void planted_sleep() {
  for (int i = 0; i < 20; ++i) usleep(10);
}
}

namespace {

/// Commits one planted violation every ten waits.
void plant() {
  constexpr std::array kPlants{planted_allocation, planted_contended_lock, planted_log_line, planted_first_touch,
                               planted_file_read,  planted_exception,      planted_sleep};
  if (self.planted == plants.load()) return;
  if (++self.stage % 10 != 0) return;
  const auto which = static_cast<std::size_t>(self.stage / 10 - 1);
  if (which < kPlants.size()) {
    kPlants[which]();
  } else {
    self.planted = plants.load();
  }
}

/// Is called before each wait of the loop.
void before_wait() {
  if (!self.named || self.busy) return;
  if (++self.waits == kStartWaits) {
    self.busy = true;
    if (!watch_page_faults()) unwatched_faults.store(true);
    if (!watch_system_calls()) unwatched_calls.store(true);
    watched.fetch_add(1);
    self.busy = false;
    self.armed = true;
    self.selector = kBlock;
  }
  if (self.armed) plant();
}

struct Report {
  Report() {
    std::array<void*, 4> first{};
    backtrace(first.data(), 4);  // loads the unwinder
    untouched = mmap(nullptr, kUntouched, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    handle(SIGSYS, on_system_call);
    handle(kFaultSignal, on_page_fault);
    handle(SIGUSR2, on_plant);
    if (std::getenv("ROBOT_CONTROL_TRIPWIRE") == nullptr) return;
    pthread_t thread{};
    pthread_create(&thread, nullptr, hold, nullptr);
    pthread_detach(thread);
  }
  Report(const Report&) = delete;
  Report& operator=(const Report&) = delete;

  ~Report() {
    const char* const path = std::getenv("ROBOT_CONTROL_TRIPWIRE");
    if (path == nullptr) return;
    std::array<char, 512> name{};
    std::snprintf(name.data(), name.size(), "%s.%d", path, getpid());
    FILE* const file = std::fopen(name.data(), "w");
    if (file == nullptr) return;
    std::fprintf(file, "watched %d\n", watched.load());
    if (unwatched_calls.load()) std::fprintf(file, "unwatched system calls: no Syscall User Dispatch\n");
    if (unwatched_faults.load()) std::fprintf(file, "unwatched page faults: no perf_event_open(2)\n");
    for (const Record& each : records) {
      if (each.key.load() == 0) break;
      std::fprintf(file, "%s %ld in %s: %llu times\n", each.kind, each.number, each.thread.data(),
                   static_cast<unsigned long long>(each.count.load()));
      for (int i = 0; i < each.depth; ++i) {
        void* const place = each.stack[static_cast<std::size_t>(i)];
        Dl_info object{};
        if (dladdr(place, &object) == 0 || object.dli_fname == nullptr) continue;
        std::fprintf(file, "  %s %#lx %s\n", object.dli_fname,
                     static_cast<unsigned long>(static_cast<char*>(place) - static_cast<char*>(object.dli_fbase)),
                     object.dli_sname == nullptr ? "?" : object.dli_sname);
      }
    }
    std::fclose(file);
  }
};
const Report report;

}  // namespace

extern "C" {

void* malloc(std::size_t size) noexcept {
  record("allocation");
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  record("allocation");
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) noexcept {
  record("allocation");
  return __libc_realloc(memory, size);
}
void free(void* memory) noexcept {
  if (memory != nullptr) record("allocation");
  __libc_free(memory);
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  record("allocation");
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  *memory = memalign(alignment, size);
  return *memory == nullptr ? ENOMEM : 0;
}

int pthread_setname_np(pthread_t thread, const char* name) noexcept {
  static auto* const real = next<int(pthread_t, const char*)>("pthread_setname_np");
  if (pthread_equal(thread, pthread_self()) != 0) {
    self.named = std::ranges::any_of(kNames, [&](const char* each) { return std::strcmp(each, name) == 0; });
    std::strncpy(self.name.data(), name, self.name.size() - 1);
  }
  return real(thread, name);
}

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  static auto* const real = next<int(pthread_mutex_t*)>("pthread_mutex_lock");
  record("lock");
  return real(mutex);
}
int pthread_mutex_trylock(pthread_mutex_t* mutex) noexcept {
  static auto* const real = next<int(pthread_mutex_t*)>("pthread_mutex_trylock");
  record("lock");
  return real(mutex);
}
int pthread_mutex_timedlock(pthread_mutex_t* mutex, const timespec* until) noexcept {
  static auto* const real = next<int(pthread_mutex_t*, const timespec*)>("pthread_mutex_timedlock");
  record("lock");
  return real(mutex, until);
}
int pthread_mutex_clocklock(pthread_mutex_t* mutex, clockid_t clock, const timespec* until) noexcept {
  static auto* const real = next<int(pthread_mutex_t*, clockid_t, const timespec*)>("pthread_mutex_clocklock");
  record("lock");
  return real(mutex, clock, until);
}
int pthread_rwlock_rdlock(pthread_rwlock_t* lock) noexcept {
  static auto* const real = next<int(pthread_rwlock_t*)>("pthread_rwlock_rdlock");
  record("lock");
  return real(lock);
}
int pthread_rwlock_wrlock(pthread_rwlock_t* lock) noexcept {
  static auto* const real = next<int(pthread_rwlock_t*)>("pthread_rwlock_wrlock");
  record("lock");
  return real(lock);
}
int pthread_cond_wait(pthread_cond_t* condition, pthread_mutex_t* mutex) {
  static auto* const real = next<int(pthread_cond_t*, pthread_mutex_t*)>("pthread_cond_wait", "GLIBC_2.3.2");
  record("lock");
  return real(condition, mutex);
}
int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex, const timespec* until) {
  using Function = int(pthread_cond_t*, pthread_mutex_t*, const timespec*);
  static auto* const real = next<Function>("pthread_cond_timedwait", "GLIBC_2.3.2");
  record("lock");
  return real(condition, mutex, until);
}
int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock, const timespec* until) {
  using Function = int(pthread_cond_t*, pthread_mutex_t*, clockid_t, const timespec*);
  static auto* const real = next<Function>("pthread_cond_clockwait");
  record("lock");
  return real(condition, mutex, clock, until);
}
int pthread_cond_signal(pthread_cond_t* condition) noexcept {
  static auto* const real = next<int(pthread_cond_t*)>("pthread_cond_signal", "GLIBC_2.3.2");
  record("lock");
  return real(condition);
}
int pthread_cond_broadcast(pthread_cond_t* condition) noexcept {
  static auto* const real = next<int(pthread_cond_t*)>("pthread_cond_broadcast", "GLIBC_2.3.2");
  record("lock");
  return real(condition);
}

void __cxa_throw(void* object, void* type, void (*destroy)(void*)) {
  static auto* const real = next<void(void*, void*, void (*)(void*))>("__cxa_throw");
  record("exception");
  real(object, type, destroy);
  __builtin_unreachable();
}

int sigaltstack(const stack_t* stack, stack_t* before) noexcept {
  if (self.armed) {
    self.armed = false;
    self.named = false;
    self.selector = kAllow;
  }
  return static_cast<int>(
      execute(SYS_sigaltstack, reinterpret_cast<long>(stack), reinterpret_cast<long>(before), 0, 0, 0, 0));
}

// The two waits of the loop (rt/clock.cpp, rt/futex.cpp).

int clock_nanosleep(clockid_t clock, int flags, const timespec* time, timespec* left) {
  static auto* const real = next<int(clockid_t, int, const timespec*, timespec*)>("clock_nanosleep");
  before_wait();
  const char before = self.selector;
  self.selector = kAllow;
  const int result = real(clock, flags, time, left);
  self.selector = before;
  return result;
}

long syscall(long number, ...) noexcept {
  std::va_list list;
  va_start(list, number);
  std::array<long, 6> words{};
  for (long& word : words) word = va_arg(list, long);
  va_end(list);
  constexpr long kWaitBitset = 9;
  const bool waits = number == SYS_futex && (words[1] & 0x7F) == kWaitBitset;
  if (waits) before_wait();
  if (number != SYS_futex) record("system call", number);
  const char before = self.selector;
  self.selector = kAllow;
  const long result = execute(number, words[0], words[1], words[2], words[3], words[4], words[5]);
  self.selector = before;
  if (result >= -4095 && result < 0) {
    errno = static_cast<int>(-result);
    return -1;
  }
  return result;
}
}
