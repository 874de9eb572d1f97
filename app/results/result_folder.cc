#include "app/results/result_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <set>
#include <string_view>
#include <system_error>
#include <thread>

#include "core/files.h"
#include "core/log.h"

namespace annulus::app {

namespace fs = std::filesystem;

namespace {

constexpr const char *list_name = "owner.txt",
                     *head =
                         "# The scene whose results these are, and the files that annulus wrote here. It removes and "
                         "replaces no others.\n";
constexpr const char* other_folder = "give another folder (-o)";
constexpr const char* files_of_every_run[] = {"report.html", "summary.json", "figures.csv", "run.json", "run.log"};

/// As it can stand in a line.
std::string on_one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }, '?');
  return text;
}

std::string line_of(std::string_view word, const std::string& text) {
  return fmt::format("{} {}\n", word, on_one_line(text));
}

fs::path canonical_place(const fs::path& path) {
  std::error_code error;
  auto result = fs::weakly_canonical(fs::absolute(path, error), error);
  if (error || result.empty()) result = fs::absolute(path, error).lexically_normal();
  return result.has_filename() ? result : result.parent_path();
}

/// What `file` is called in a list in `folder`: relative, so that both can be moved together. Pipes, which have no
/// lasting name, as given.
std::string recorded(const fs::path& file, const fs::path& folder) {
  std::error_code error;
  const auto kind = fs::status(file, error).type();
  const bool lasting = kind == fs::file_type::regular || kind == fs::file_type::not_found;
  return lasting ? canonical_place(file).lexically_relative(folder).generic_string() : file.lexically_normal().string();
}

bool insert(std::vector<std::string>& sorted, const std::string& name) {
  const auto at = std::lower_bound(sorted.begin(), sorted.end(), name);
  if (at != sorted.end() && *at == name) return false;
  sorted.insert(at, name);
  return true;
}

bool contains(const std::vector<std::string>& sorted, const std::string& name) {
  return std::binary_search(sorted.begin(), sorted.end(), name);
}

bool there(const fs::path& file) {
  std::error_code error;
  return fs::exists(fs::symlink_status(file, error));
}

}  // namespace

struct ResultFolder::Record {
  std::string scene, title, process;
  std::vector<std::string> earlier, written;  ///< sorted

  /// A last line without an end was cut off.
  explicit Record(std::string_view text) {
    for (auto end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
      const auto line = text.substr(0, end);
      text.remove_prefix(end + 1);
      const auto blank = line.find(' ');
      if (blank == std::string_view::npos) continue;
      const auto word = line.substr(0, blank);
      const std::string value(line.substr(blank + 1));
      if (word == "scene") scene = value;
      if (word == "title") title = value;
      if (word == "process") process = value;
      // Names that lead out of the folder are not ours.
      const fs::path path(value);
      if (path.is_absolute() || std::find(path.begin(), path.end(), "..") != path.end()) continue;
      if (word == "earlier") insert(earlier, value);
      if (word == "file") insert(written, value);
    }
  }

  [[nodiscard]] std::string text() const {
    std::string all = head + line_of("scene", scene) + line_of("title", title) + line_of("process", process);
    for (const auto& name : earlier) all += line_of("earlier", name);
    for (const auto& name : written) all += line_of("file", name);
    return all;
  }

  [[nodiscard]] std::vector<std::string> all() const {
    std::vector<std::string> names;
    std::set_union(earlier.begin(), earlier.end(), written.begin(), written.end(), std::back_inserter(names));
    return names;
  }
};

ResultFolder::ResultFolder(fs::path folder, const FolderOwner& owner, const std::vector<fs::path>& shared)
    : folder_(std::move(folder)),
      root_(canonical_place(folder_)),
      scene_(on_one_line(recorded(owner.file, root_))),
      title_(on_one_line(owner.title)) {
  for (const auto& path : shared) {
    if (path.empty()) continue;
    shared_.push_back(canonical_place(path));
    shared_.push_back(fs::absolute(path).lexically_normal());
  }
  if (there(list())) lock(0);
}

ResultFolder::~ResultFolder() {
  if (file_ >= 0) ::close(file_);
}

/// A scene of the list, for messages.
std::string ResultFolder::shown(const std::string& scene) const { return (root_ / scene).lexically_normal().string(); }

fs::path ResultFolder::list() const { return folder_ / list_name; }

/// The process that holds the lock, from the list; it writes its line as soon as it has the lock.
std::string ResultFolder::holder() const {
  constexpr int most = 100;
  for (int i = 0;; ++i) {
    const Record record(read_file(list()));
    if (!record.process.empty() || i == most)
      return fmt::format("process {} is writing the results of {} (\"{}\")", record.process, shown(record.scene),
                         record.title);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

/// `flags`: O_CREAT to make the list where there is none.
void ResultFolder::lock(int flags) {
  // Whoever held the lock may have put a new list in the place of the one that was opened.
  for (bool current = false; !current;) {
    if (file_ >= 0) ::close(file_);
    file_ = ::open(list().c_str(), O_RDWR | O_APPEND | O_NOFOLLOW | O_CLOEXEC | flags, 0666);
    if (file_ < 0) throw cannot_write(list(), errno);
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
      if (errno == EWOULDBLOCK)
        throw Error(fmt::format("{}: {} there; wait until it ends, or {}", folder_.string(), holder(), other_folder));
      log::warn(fmt::format("{}: cannot be locked ({}); do not let two runs write there at the same time",
                            folder_.string(), std::strerror(errno)));
    }
    struct stat opened {
    }, named{};
    if (::fstat(file_, &opened) == 0 && !S_ISREG(opened.st_mode))
      throw FileError(fmt::format("{}: is not a file; move it away, or {}", list().string(), other_folder));
    current = ::fstat(file_, &opened) == 0 && ::lstat(list().c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
              opened.st_dev == named.st_dev;
  }
  const auto text = read_file(list());
  if (!text.empty() && !text.starts_with(head)) return;  // somebody else's: check() refuses it
  if (text.empty()) append(head + line_of("scene", scene_) + line_of("title", title_));
  append(line_of("process", std::to_string(::getpid())));
}

void ResultFolder::append(const std::string& lines) {
  if (::write(file_, lines.data(), lines.size()) != static_cast<ssize_t>(lines.size()))
    throw cannot_write(list(), errno);
}

/// A new list in the place of the old one. The lock is never free in between.
void ResultFolder::replace(const Record& record) {
  UnfinishedFile unfinished(list());
  const int next = ::open(unfinished.temporary().c_str(), O_RDWR | O_APPEND | O_NOFOLLOW | O_CLOEXEC);
  const auto text = record.text();
  if (next < 0) throw cannot_write(list(), errno);
  ::flock(next, LOCK_EX | LOCK_NB);
  if (::write(next, text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
    const int error = errno;
    ::close(next);
    throw cannot_write(list(), error);
  }
  unfinished.finish();
  ::close(file_);
  file_ = next;
}

void ResultFolder::check() const {
  const auto text = file_ < 0 ? "" : read_file(list());
  const auto not_ours = [&](const fs::path& file) {
    return FileError(fmt::format("{}: exists already, and annulus did not write it; move it away, or {}", file.string(),
                                 other_folder));
  };
  if (text.empty()) {  // nobody's yet
    for (const auto* name : files_of_every_run)
      if (there(folder_ / name)) throw not_ours(folder_ / name);
    return;
  }
  if (!text.starts_with(head)) throw not_ours(list());
  const Record record(text);
  if (record.scene.empty())
    throw FileError(fmt::format(
        "{}: is damaged: it names no scene, so that it is not known whose results are in its folder; {}, or "
        "remove this one",
        list().string(), other_folder));
  if (record.scene == scene_) return;
  const bool renamed = record.title == title_ && !there(root_ / record.scene);
  if (renamed) return;
  throw FileError(fmt::format("{}: holds the results of {} (\"{}\"), not of {} (\"{}\"); {}, or remove this one",
                              folder_.string(), shown(record.scene), record.title, shown(scene_), title_,
                              other_folder));
}

void ResultFolder::begin() {
  check();
  fs::create_directories(folder_);
  root_ = canonical_place(folder_);
  if (file_ < 0) lock(O_CREAT);
  check();  // another process may have been faster
  Record record(read_file(list()));
  earlier_.clear();
  for (const auto& name : record.all())
    if (there(folder_ / name)) earlier_.push_back(name);
  record.scene = scene_;
  record.title = title_;
  record.process = std::to_string(::getpid());
  record.earlier = earlier_;
  record.written.clear();
  written_.clear();
  replace(record);
  begun_ = true;
}

std::string ResultFolder::name_of(const fs::path& file) const {
  const auto place = fs::absolute(file).lexically_normal();
  const auto name = place.lexically_relative(fs::absolute(folder_).lexically_normal());
  if (name.empty() || *name.begin() == ".." || name == list_name) return {};
  for (const auto& shared : shared_)
    for (const auto& at : {place, root_ / name})
      if (std::mismatch(shared.begin(), shared.end(), at.begin(), at.end()).first == shared.end()) return {};
  return name.generic_string();
}

fs::path ResultFolder::link_above(const std::string& name) const {
  auto place = folder_;
  const fs::path path(name);
  for (auto part = path.begin(); part != path.end() && std::next(part) != path.end(); ++part) {
    place /= *part;
    std::error_code none;
    if (fs::is_symlink(fs::symlink_status(place, none))) return place;
  }
  return {};
}

bool ResultFolder::listed(const std::string& name) const {
  if (contains(written_, name) || contains(earlier_, name)) return true;
  return contains(Record(read_file(list())).written, name);  // by a forked process
}

void ResultFolder::before_write(const fs::path& file) {
  if (!begun_) return;
  const auto name = name_of(file);
  if (name.empty() || contains(written_, name)) return;
  if (const auto link = link_above(name); !link.empty())
    throw FileError(
        fmt::format("cannot write {}: {} is a link to another folder, where annulus writes nothing; move it "
                    "away, or {}",
                    file.string(), link.string(), other_folder));
  if (there(file) && !listed(name))
    throw FileError(
        fmt::format("cannot write {}: a file of this name exists that annulus did not write; move it away, or {}",
                    file.string(), other_folder));
  append(line_of("file", name));
  insert(written_, name);
}

void ResultFolder::before_removal(const fs::path& file) {
  if (!begun_) return;
  const auto name = name_of(file);
  if (name.empty() || (listed(name) && link_above(name).empty())) return;
  throw FileError(
      fmt::format("cannot remove {}: annulus did not write it; move it away, or {}", file.string(), other_folder));
}

std::vector<std::string> ResultFolder::written(const Which& which) const {
  std::vector<std::string> names;
  for (const auto& name : Record(read_file(list())).written)
    if (which(name) && there(folder_ / name)) names.push_back(name);
  return names;
}

void ResultFolder::remove_earlier(const Which& which) {
  Record record(read_file(list()));
  std::vector<std::string> left;
  for (const auto& name : record.earlier) {
    if (contains(record.written, name)) continue;
    if (!which(name)) {
      left.push_back(name);
      continue;
    }
    if (!link_above(name).empty()) continue;  // what is behind it is not ours
    std::error_code ignored;
    fs::remove(folder_ / name, ignored);
    for (auto parent = fs::path(name).parent_path(); !parent.empty(); parent = parent.parent_path())
      if (!fs::remove(folder_ / parent, ignored)) break;  // it is not empty
  }
  record.earlier = left;
  replace(record);
  earlier_ = std::move(left);
}

bool is_name_of_run(const std::string& name) {
  static const std::set<std::string> folders = {
      "cache",    "computed",    "dynamics", "errors",           "grid",    "mesh",  "optimise",
      "pictures", "sensitivity", "statics",  "statics_pictures", "studies", "sweep", "tradeoff"};
  static const std::set<std::string> endings = {".csv", ".html", ".json", ".log", ".svg", ".txt"};
  return folders.contains(name) || endings.contains(fs::path(name).extension().string()) || is_unfinished(name);
}

bool is_of_tradeoff(const std::string& name) {
  return name.starts_with("tradeoff/") || (name.starts_with("tradeoff") && name.find('/') == std::string::npos);
}

bool is_of_statics(const std::string& name) {
  if (name.starts_with("statics/") || name.starts_with("statics_pictures/")) return true;
  return name.starts_with("statics.") && name.find('/') == std::string::npos;
}

bool is_of_run(const std::string& name) { return !is_of_tradeoff(name) && !is_of_statics(name); }

}  // namespace annulus::app
