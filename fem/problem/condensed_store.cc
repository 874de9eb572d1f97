#include "fem/problem/condensed_store.h"

#include <algorithm>
#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/uuid_io.hpp>
#include <fstream>
#include <system_error>
#include <tuple>
#include <vector>

#include "core/errors.h"
#include "core/files.h"
#include "core/log.h"
#include "fem/problem/byte_stream.h"

namespace annulus::fem {
namespace {

const std::string tooth_file_kind = "annulus condensed tooth";
/// To be raised with every change of what is written, or of how it is computed.
constexpr std::uint32_t tooth_file_format = 2;

}  // namespace

CondensedStore::CondensedStore(std::filesystem::path folder, std::string version, std::uintmax_t most_bytes)
    : folder_(std::move(folder)), version_(std::move(version)), most_bytes_(most_bytes) {}

std::string CondensedStore::key(const std::string& inputs) const {
  const boost::uuids::name_generator_sha1 generate(boost::uuids::ns::oid());
  const std::string all = version_ + "\n" + std::to_string(tooth_file_format) + "\n" + inputs;
  return boost::uuids::to_string(generate(all.data(), all.size()));
}

bool CondensedStore::read_or_make(const std::string& key, const std::function<void(ByteReader&)>& read_one,
                                  const std::function<void()>& make,
                                  const std::function<void(ByteWriter&)>& write_one) {
  std::mutex* mine = nullptr;
  {
    const std::lock_guard guard(lock_);
    mine = &of_key_[key];
  }
  const std::lock_guard guard(*mine);
  if (read(key, read_one)) return true;
  make();
  write(key, write_one);
  return false;
}

bool CondensedStore::read(const std::string& key, const std::function<void(ByteReader&)>& read_one) const {
  std::error_code none;
  const auto size = std::filesystem::file_size(file(key), none);
  std::ifstream in(file(key), std::ios::binary);
  if (none || !in) return false;
  try {
    ByteReader reader(in, size);
    std::string kind, of;
    reader.get(kind);
    const auto format = reader.get<std::uint32_t>();
    reader.get(of);
    if (kind != tooth_file_kind || format != tooth_file_format || of != key) throw Error("a file of another kind");
    read_one(reader);
    const auto sum = reader.checksum();
    if (reader.get<std::uint32_t>() != sum) throw Error("a wrong checksum");
  } catch (const std::exception& error) {
    log::info(file(key).string() + ": " + error.what() + "; condensed again");
    return false;
  }
  std::filesystem::last_write_time(file(key), std::filesystem::file_time_type::clock::now(), none);
  return true;
}

void CondensedStore::write(const std::string& key, const std::function<void(ByteWriter&)>& write_one) const {
  std::error_code ignored;
  std::filesystem::create_directories(folder_, ignored);
  try {
    UnfinishedFile unfinished(file(key));
    std::ofstream out(unfinished.temporary(), std::ios::binary);
    ByteWriter writer(out);
    writer.add(tooth_file_kind).add(tooth_file_format).add(key);
    write_one(writer);
    writer.add(writer.checksum());
    out.close();
    if (!out) throw InputError("cannot write " + file(key).string());
    unfinished.finish();
  } catch (const InputError& error) {
    log::warn(std::string(error.what()) + ": this tooth is not kept");
    return;
  }
  remove_oldest(file(key));
}

void CondensedStore::remove_oldest(const std::filesystem::path& newest) const {
  using Entry = std::tuple<std::filesystem::file_time_type, std::filesystem::path, std::uintmax_t>;
  std::vector<Entry> entries;
  std::uintmax_t total = 0;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, error)) {
    // Another thread or program may take one away meanwhile.
    std::error_code gone;
    const auto size = entry.file_size(gone);
    const auto used = entry.last_write_time(gone);
    if (gone || entry.path().extension() != ".tooth") continue;
    total += size;
    entries.emplace_back(used, entry.path(), size);
  }
  std::sort(entries.begin(), entries.end());
  for (const auto& [used, path, size] : entries) {
    if (total <= most_bytes_) return;
    if (path == newest && size <= most_bytes_) continue;
    std::filesystem::remove(path, error);
    total -= size;
  }
}

}  // namespace annulus::fem
