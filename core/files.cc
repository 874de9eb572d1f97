#include "core/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/file_guard.h"

namespace annulus {

namespace {

constexpr const char* mark = ".unfinished";

/// The process in "<file>.<process>.<counter>.unfinished<ending>"; 0 for any other name.
int writer_of(const std::filesystem::path& path) {
  const auto name = path.filename().string();
  const auto end = name.rfind(mark);
  if (end == std::string::npos) return 0;
  const auto process = std::filesystem::path(name.substr(0, end)).stem().extension().string();
  int id = 0;
  if (process.size() > 1) std::from_chars(process.data() + 1, process.data() + process.size(), id);
  return id;
}

/// Devices, pipes and folders are not to be replaced by a file, nor are links to them.
void check_replaceable(const std::filesystem::path& file) {
  struct stat there {};
  if (::stat(file.c_str(), &there) != 0 || S_ISREG(there.st_mode)) return;
  throw FileError(fmt::format("cannot write {}: it is {}; give the name of a file", file.string(),
                              S_ISDIR(there.st_mode) ? "a folder" : "a device or a pipe"));
}

bool runs(int process) { return ::kill(process, 0) == 0 || errno != ESRCH; }

}  // namespace

FileError cannot_write(const std::filesystem::path& file, int error) {
  std::string reason = error == 0 ? "" : std::generic_category().message(error) + "; ";
  if (error == EFBIG) reason += "raise the limit of the file size (ulimit -f), and ";
  return FileError(
      fmt::format("cannot write {}: {}check that its folder exists, is writable and not full", file.string(), reason));
}

UnfinishedFile::UnfinishedFile(std::filesystem::path file, const std::string& ending) : file_(std::move(file)) {
  static std::atomic<unsigned> counter{0};
  check_replaceable(file_);
  ask_to_write(file_);
  for (int opened = -1; opened < 0;) {
    temporary_ = file_;
    temporary_ += fmt::format(".{}.{}{}{}", ::getpid(), counter++, mark, ending);
    // Exclusively: whatever lies there under this name, a link to another file too, stays.
    opened = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (opened >= 0)
      ::close(opened);
    else if (errno != EEXIST)
      throw cannot_write(file_, errno);
  }
}

UnfinishedFile::~UnfinishedFile() {
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void UnfinishedFile::finish() {
  std::error_code error;
  std::filesystem::rename(temporary_, file_, error);
  if (error) throw cannot_write(file_, error.value());
}

bool is_unfinished(const std::filesystem::path& file) { return writer_of(file) != 0; }

std::string read_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(fmt::format("cannot read {}", file.string()));
  try {
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  } catch (const std::ios_base::failure& error) {  // folders can be opened, but not read
    throw InputError(fmt::format("cannot read {}: {}", file.string(), error.what()));
  }
}

void write_file(const std::filesystem::path& file, const std::string& text) {
  UnfinishedFile unfinished(file);
  const int out = ::open(unfinished.temporary().c_str(), O_WRONLY | O_NOFOLLOW | O_CLOEXEC);
  if (out < 0) throw cannot_write(file, errno);
  int error = 0;
  for (std::string_view rest = text; error == 0 && !rest.empty();) {
    const auto count = ::write(out, rest.data(), rest.size());
    if (count >= 0)
      rest.remove_prefix(static_cast<std::size_t>(count));
    else if (errno != EINTR)
      error = errno;
  }
  if (::close(out) != 0 && error == 0) error = errno;
  if (error != 0) throw cannot_write(file, error);
  unfinished.finish();
}

std::optional<std::string> file_checksum(const std::filesystem::path& file) {
  constexpr std::streamsize block = 1 << 20;
  std::ifstream in(file, std::ios::binary);
  if (!in) return std::nullopt;
  std::vector<char> buffer(block);
  unsigned long sum = 0;
  std::uintmax_t bytes = 0;
  while (in.read(buffer.data(), block), in.gcount() > 0) {
    const auto count = static_cast<std::size_t>(in.gcount());
    sum = ::crc32_z(sum, reinterpret_cast<const Bytef*>(buffer.data()), count);
    bytes += count;
  }
  return fmt::format("{} bytes, {:08x}", bytes, sum);
}

std::string text_checksum(std::string_view text) {
  return fmt::format("{} bytes, {:08x}", text.size(),
                     ::crc32_z(0, reinterpret_cast<const Bytef*>(text.data()), text.size()));
}

void remove_unfinished_files(const std::filesystem::path& folder) {
  constexpr std::chrono::minutes untouched(10);
  const auto now = std::filesystem::file_time_type::clock::now();
  std::vector<std::filesystem::path> left;
  std::error_code ignored;
  for (std::filesystem::recursive_directory_iterator at(folder, ignored), end; at != end; at.increment(ignored)) {
    const int process = writer_of(at->path());
    if (process == 0 || runs(process)) continue;
    std::error_code gone;
    const auto written = at->last_write_time(gone);
    if (!gone && now - written > untouched) left.push_back(at->path());
  }
  for (const auto& file : left) std::filesystem::remove(file, ignored);
}

}  // namespace annulus
