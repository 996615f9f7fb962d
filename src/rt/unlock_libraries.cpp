#include "rt/unlock_libraries.h"

#include <link.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>

namespace robot_control {
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
