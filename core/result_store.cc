#include "core/result_store.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/uuid_io.hpp>
#include <charconv>
#include <system_error>
#include <tuple>
#include <utility>

#include "core/errors.h"
#include "core/files.h"
#include "core/log.h"

namespace annulus {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view magic = "annulus result 1";
constexpr const char* ending = ".result";

unsigned long checksum(std::string_view bytes) {
  return ::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
}

std::string compressed(std::string_view content) {
  std::string packed(::compressBound(content.size()), '\0');
  uLongf size = packed.size();
  const int status = ::compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                                 reinterpret_cast<const Bytef*>(content.data()), content.size(), Z_BEST_SPEED);
  require(status == Z_OK, "a buffer of the bound's size holds the compressed content");
  packed.resize(size);
  return packed;
}

std::string uncompressed(std::string_view packed, std::size_t size) {
  std::string content(size, '\0');
  uLongf length = size;
  const int status = ::uncompress(reinterpret_cast<Bytef*>(content.data()), &length,
                                  reinterpret_cast<const Bytef*>(packed.data()), packed.size());
  if (status != Z_OK || length != size) throw Error("its content cannot be unpacked");
  return content;
}

/// The first line of a file: what it is, its own name, how its content is packed, sizes and checksum of what follows.
std::string head(const std::string& name, bool plain, std::size_t size, std::string_view packed) {
  return fmt::format("{} {} {} {} {} {:08x}\n", magic, name, plain ? "plain" : "zlib", size, packed.size(),
                     checksum(packed));
}

std::size_t number_at(std::string_view& text) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{}) throw Error("its first line is damaged");
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  if (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  return value;
}

/// The content of a file. Throws Error telling what is wrong with it.
std::string content_of(const std::string& file, const std::string& name) {
  const auto line = file.find('\n');
  const auto own = fmt::format("{} {} ", magic, name);
  if (line == std::string::npos || file.compare(0, own.size(), own) != 0) throw Error("it is another file");
  const std::string_view all(file);
  auto rest = all.substr(own.size(), line - own.size());
  const bool plain = rest.substr(0, 6) == "plain ";
  rest.remove_prefix(std::min(rest.size(), plain ? std::size_t{6} : std::size_t{5}));
  const auto size = number_at(rest);
  const auto packed = all.substr(line + 1);
  // Comparing whole lines leaves no part of it unchecked.
  if (all.substr(0, line + 1) != head(name, plain, size, packed)) throw Error("its checksum is wrong");
  if (plain && size != packed.size()) throw Error("its size is wrong");
  if (plain) return std::string(packed);
  // The size itself has no checksum; zlib packs at most a thousand to one.
  constexpr std::size_t most = 1100;
  if (size > most * (packed.size() + 1)) throw Error("its size is wrong");
  return uncompressed(packed, size);
}

/// Calls visit(kind, path) for every result in a folder. Others may remove files meanwhile.
template <class Visit>
void for_each_result(const fs::path& folder, Visit visit) {
  std::error_code error;
  for (fs::directory_iterator kind(folder, error), end; !error && kind != end; kind.increment(error)) {
    std::error_code gone;
    for (fs::directory_iterator file(kind->path(), gone); !gone && file != end; file.increment(gone))
      if (file->path().extension() == ending) visit(kind->path().filename().string(), file->path());
  }
}

/// The content of the result of this name in a folder, if it is there; a damaged one is removed.
std::optional<std::string> content_in(const fs::path& folder, const std::string& name) {
  const auto path = folder / name;
  std::error_code none;
  if (!fs::is_regular_file(path, none)) return std::nullopt;
  try {
    auto content = content_of(read_file(path), name);
    fs::last_write_time(path, fs::file_time_type::clock::now(), none);
    return content;
  } catch (const Error& error) {
    log::warn(fmt::format("{} is damaged: {}; it is left out and computed again where it is needed", path.string(),
                          error.what()));
    fs::remove(path, none);
    return std::nullopt;
  }
}

}  // namespace

ResultStore::ResultStore(fs::path folder, std::string program, std::uintmax_t most_bytes, std::vector<fs::path> others)
    : folder_(std::move(folder)), program_(std::move(program)), most_bytes_(most_bytes), others_(std::move(others)) {}

std::string ResultStore::name_of(const std::string& kind, std::string_view inputs) const {
  const boost::uuids::name_generator_sha1 generate(boost::uuids::ns::oid());
  std::string all = fmt::format("{}\n{}\n", program_, kind);
  all += inputs;
  return fmt::format("{}/{}{}", kind, boost::uuids::to_string(generate(all.data(), all.size())), ending);
}

std::optional<std::string> ResultStore::find(const std::string& kind, std::string_view inputs) const {
  const auto name = name_of(kind, inputs);
  auto content = content_in(folder_, name);
  for (auto other = others_.begin(); !content && other != others_.end(); ++other) content = content_in(*other, name);
  return content;
}

std::optional<std::string> ResultStore::find_own(const std::string& kind, std::string_view inputs) const {
  return content_in(folder_, name_of(kind, inputs));
}

std::vector<std::string> ResultStore::find_others(const std::string& kind, std::string_view inputs) const {
  const auto name = name_of(kind, inputs);
  std::vector<std::string> list;
  for (const auto& other : others_)
    if (auto content = content_in(other, name)) list.push_back(std::move(*content));
  return list;
}

void ResultStore::keep(const std::string& kind, std::string_view inputs, std::string_view content,
                       Packing packing) const {
  const auto name = name_of(kind, inputs);
  const auto path = folder_ / name;
  const bool plain = packing == Packing::plain;
  const std::string packed = plain ? std::string() : compressed(content);
  std::string file = head(name, plain, content.size(), plain ? content : std::string_view(packed));
  file += plain ? content : std::string_view(packed);
  std::error_code ignored;
  fs::create_directories(path.parent_path(), ignored);
  try {
    write_file(path, file);
  } catch (const FileError& error) {
    log::warn(fmt::format("{}: this result is not cached", error.what()));
    return;
  }
  note_size(file.size(), path);
}

bool ResultStore::find_or_make(const std::string& kind, std::string_view inputs, Packing packing,
                               const std::function<void(const std::string&)>& use,
                               const std::function<std::string()>& make) const {
  std::mutex* mine = nullptr;
  {
    const std::lock_guard guard(lock_);
    mine = &being_made_[name_of(kind, inputs)];
  }
  const std::lock_guard guard(*mine);
  if (const auto found = find(kind, inputs)) {
    use(*found);
    return true;
  }
  keep(kind, inputs, make(), packing);
  return false;
}

void ResultStore::note_size(std::uintmax_t bytes, const fs::path& newest) const {
  const std::lock_guard guard(lock_);
  if (bytes_ && *bytes_ + bytes <= most_bytes_) {
    *bytes_ += bytes;
    return;
  }
  using Entry = std::tuple<fs::file_time_type, fs::path, std::uintmax_t>;
  std::vector<Entry> entries;
  std::uintmax_t total = 0;
  for_each_result(folder_, [&](const std::string&, const fs::path& path) {
    std::error_code gone;
    const auto size = fs::file_size(path, gone);
    const auto used = fs::last_write_time(path, gone);
    if (gone) return;
    total += size;
    entries.emplace_back(used, path, size);
  });
  std::sort(entries.begin(), entries.end());
  for (const auto& [used, path, size] : entries) {
    if (total <= most_bytes_) break;
    if (path == newest && size <= most_bytes_) continue;
    std::error_code gone;
    fs::remove(path, gone);
    total -= size;
  }
  bytes_ = total;
}

std::vector<ResultStore::Contents> ResultStore::contents(const fs::path& folder) {
  std::map<std::string, Contents> by_kind;
  for_each_result(folder, [&](const std::string& kind, const fs::path& path) {
    auto& contents = by_kind[kind];
    std::error_code gone;
    const auto size = fs::file_size(path, gone);
    if (gone) return;
    contents.kind = kind;
    ++contents.results;
    contents.bytes += size;
  });
  std::vector<Contents> list;
  list.reserve(by_kind.size());
  for (auto& [kind, contents] : by_kind) list.push_back(std::move(contents));
  return list;
}

void ResultStore::clear(const fs::path& folder) {
  std::vector<fs::path> all;
  for_each_result(folder, [&](const std::string&, const fs::path& path) { all.push_back(path); });
  std::error_code ignored;
  for (const auto& path : all) {
    fs::remove(path, ignored);
    fs::remove(path.parent_path(), ignored);  // when it is empty
  }
}

}  // namespace annulus
