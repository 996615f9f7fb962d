#include "ros/network/interposition.h"

#include <dlfcn.h>
#include <elf.h>
#include <link.h>

namespace robot_control {
namespace {

struct Search {
  const Interposed& function;
  bool imported = false;
};

/// The dynamic linker has added the load address to these pointers (glibc does on all machines but RISC-V and MIPS).
struct Tables {
  const ElfW(Sym) * symbols = nullptr;
  const char* names = nullptr;
  const ElfW(Rela) * calls = nullptr;
  std::size_t calls_bytes = 0;
  const ElfW(Rela) * others = nullptr;
  std::size_t others_bytes = 0;
};

template <class Pointee>
const Pointee* at(ElfW(Addr) address) {
  const Pointee* pointer = nullptr;
  static_assert(sizeof(const Pointee*) == sizeof address);
  std::memcpy(&pointer, &address, sizeof address);
  return pointer;
}

Tables tables_of(const ElfW(Dyn) * entry) {
  Tables tables;
  for (; entry->d_tag != DT_NULL; ++entry) {
    if (entry->d_tag == DT_SYMTAB) tables.symbols = at<ElfW(Sym)>(entry->d_un.d_ptr);
    if (entry->d_tag == DT_STRTAB) tables.names = at<char>(entry->d_un.d_ptr);
    if (entry->d_tag == DT_JMPREL) tables.calls = at<ElfW(Rela)>(entry->d_un.d_ptr);
    if (entry->d_tag == DT_PLTRELSZ) tables.calls_bytes = entry->d_un.d_val;
    if (entry->d_tag == DT_RELA) tables.others = at<ElfW(Rela)>(entry->d_un.d_ptr);
    if (entry->d_tag == DT_RELASZ) tables.others_bytes = entry->d_un.d_val;
  }
  return tables;
}

bool names(const Tables& tables, const ElfW(Rela) * relocations, std::size_t bytes, const std::string& symbol) {
  for (std::size_t i = 0; relocations != nullptr && i < bytes / sizeof *relocations; ++i) {
    const ElfW(Sym)& found = tables.symbols[ELF64_R_SYM(relocations[i].r_info)];
    if (symbol == tables.names + found.st_name) return true;
  }
  return false;
}

int find_import(dl_phdr_info* object, std::size_t /*size*/, void* data) {
  Search& search = *static_cast<Search*>(data);
  if (std::strstr(object->dlpi_name, search.function.library.c_str()) == nullptr) return 0;
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const ElfW(Phdr)& header = object->dlpi_phdr[i];
    if (header.p_type != PT_DYNAMIC) continue;
    const Tables tables = tables_of(at<ElfW(Dyn)>(object->dlpi_addr + header.p_vaddr));
    search.imported = names(tables, tables.calls, tables.calls_bytes, search.function.symbol) ||
                      names(tables, tables.others, tables.others_bytes, search.function.symbol);
  }
  return 1;
}

bool is_defined_here(const std::string& symbol) {
  const void* found = dlsym(RTLD_DEFAULT, symbol.c_str());
  Dl_info place{};
  Dl_info own{};
  const auto* const here = reinterpret_cast<const void*>(&is_defined_here);
  return found != nullptr && dladdr(found, &place) != 0 && dladdr(here, &own) != 0 && place.dli_fbase == own.dli_fbase;
}

}  // namespace

bool leads_here(const Interposed& function) {
  Search search{.function = function};
  dl_iterate_phdr(find_import, &search);
  return search.imported && is_defined_here(function.symbol);
}

std::vector<std::string> not_replaced(const std::vector<Interposed>& functions) {
  std::vector<std::string> missing;
  for (const Interposed& function : functions) {
    if (!leads_here(function)) missing.push_back(function.description);
  }
  return missing;
}

}  // namespace robot_control
