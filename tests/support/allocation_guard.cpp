#include "support/allocation_guard.h"

#include <cerrno>
#include <cstdlib>

namespace {

// initial-exec: the first access must not itself allocate.
__attribute__((tls_model("initial-exec"))) thread_local std::uint64_t calls = 0;

}  // namespace

namespace robot_control {

AllocationGuard::AllocationGuard() noexcept : before_(calls) {}

std::uint64_t AllocationGuard::count() const noexcept {
  return calls - before_;
}

}  // namespace robot_control

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

extern "C" {

void* __libc_malloc(std::size_t size) noexcept;
void* __libc_calloc(std::size_t count, std::size_t size) noexcept;
void* __libc_realloc(void* memory, std::size_t size) noexcept;
void* __libc_memalign(std::size_t alignment, std::size_t size) noexcept;
void __libc_free(void* memory) noexcept;

void* malloc(std::size_t size) noexcept {
  ++calls;
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) noexcept {
  ++calls;
  return __libc_calloc(count, size);
}

void* realloc(void* memory, std::size_t size) noexcept {
  ++calls;
  return __libc_realloc(memory, size);
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  ++calls;
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  ++calls;
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  ++calls;
  void* made = __libc_memalign(alignment, size);
  if (made == nullptr) return ENOMEM;
  *memory = made;
  return 0;
}

void free(void* memory) noexcept {
  if (memory == nullptr) return;
  ++calls;
  __libc_free(memory);
}

}  // extern "C"

#endif
