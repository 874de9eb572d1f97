#include "app/results/program_identity.h"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <cstring>
#include <string_view>

#include "app/results/content_id.h"
#include "core/errors.h"

namespace annulus::app {

namespace {

/// The build identity among the notes of a segment (a hash that the linker computes), in hexadecimal digits.
std::string build_id_in(const char* notes, std::size_t size) {
  constexpr std::size_t align = 4;
  const auto padded = [](std::size_t n) { return (n + align - 1) / align * align; };
  while (size >= sizeof(ElfW(Nhdr))) {
    ElfW(Nhdr) note{};
    std::memcpy(&note, notes, sizeof note);
    const std::size_t whole = sizeof note + padded(note.n_namesz) + padded(note.n_descsz);
    if (whole > size) break;
    const char* name = notes + sizeof note;
    if (note.n_type == NT_GNU_BUILD_ID && std::string_view(name, note.n_namesz) == std::string_view("GNU\0", 4)) {
      std::string id;
      const char* bytes = name + padded(note.n_namesz);
      for (std::size_t i = 0; i < note.n_descsz; ++i) id += fmt::format("{:02x}", static_cast<unsigned char>(bytes[i]));
      return id;
    }
    notes += whole;
    size -= whole;
  }
  return {};
}

int add_build_id(dl_phdr_info* object, std::size_t /*size*/, void* identity) {
  const std::string_view name(object->dlpi_name);
  // The program itself has no name; libraries of others do not belong to the build.
  if (!name.empty() && name.find("libannulus_") == std::string_view::npos) return 0;
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const auto& segment = object->dlpi_phdr[i];
    if (segment.p_type != PT_NOTE) continue;
    // The loader gives addresses as numbers. NOLINTNEXTLINE(performance-no-int-to-ptr)
    const auto* notes = reinterpret_cast<const char*>(object->dlpi_addr + segment.p_vaddr);
    if (const auto id = build_id_in(notes, segment.p_memsz); !id.empty())
      *static_cast<std::string*>(identity) += " " + id;
  }
  return 0;
}

}  // namespace

const std::string& program_identity() {
  static const std::string identity = [] {
    std::string ids;
    ::dl_iterate_phdr(add_build_id, &ids);
    require(!ids.empty(), "the linker gives the program a build identity");
    return std::string("annulus ") + version() + ids;
  }();
  return identity;
}

}  // namespace annulus::app
