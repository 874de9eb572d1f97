#include "app/results/program_identity.h"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <vector>

#include "app/results/content_id.h"
#include "core/errors.h"
#include "core/loaded_library.h"

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

/// Whether a file is one of the libraries that are loaded when they are needed.
bool is_loaded_library(std::string_view file) {
  const auto name = std::filesystem::path(file).filename();
  const auto all = loaded_libraries();
  return std::any_of(all.begin(), all.end(), [&](const LoadedLibrary& l) { return l.file().filename() == name; });
}

int add_build_id(dl_phdr_info* object, std::size_t /*size*/, void* identity) {
  const std::string_view name(object->dlpi_name);
  // Neither the program, which may be Python, nor libraries of others belong to the build.
  if (name.find("libannulus_") == std::string_view::npos || is_loaded_library(name)) return 0;
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

/// The build identity of a library that may not be loaded, from its file; empty when there is none.
std::string build_id_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const auto read = [&in](std::size_t place, char* bytes, std::size_t size) {
    in.seekg(static_cast<std::streamoff>(place));
    in.read(bytes, static_cast<std::streamsize>(size));
    return in.good();
  };
  ElfW(Ehdr) header{};
  if (!read(0, reinterpret_cast<char*>(&header), sizeof header)) return {};
  for (std::size_t i = 0; i < header.e_phnum; ++i) {
    ElfW(Phdr) segment{};
    if (!read(header.e_phoff + i * header.e_phentsize, reinterpret_cast<char*>(&segment), sizeof segment)) return {};
    if (segment.p_type != PT_NOTE) continue;
    std::vector<char> notes(segment.p_filesz);
    if (!read(segment.p_offset, notes.data(), notes.size())) return {};
    if (auto id = build_id_in(notes.data(), notes.size()); !id.empty()) return id;
  }
  return {};
}

}  // namespace

const std::string& program_identity() {
  static const std::string identity = [] {
    std::string ids;
    ::dl_iterate_phdr(add_build_id, &ids);
    require(!ids.empty(), "the linker gives the libraries of annulus a build identity");
    for (const auto& library : loaded_libraries()) {
      const auto id = build_id_of(library.file());
      require(!id.empty(), "the linker gives " + library.file().string() + " a build identity");
      ids += " " + id;
    }
    return std::string("annulus ") + version() + ids;
  }();
  return identity;
}

}  // namespace annulus::app
