#include "core/file_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/files.h"
#include "core/log.h"

namespace annulus {

FileLock::FileLock(const std::filesystem::path& file)
    : file_(::open(file.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666)) {
  if (file_ < 0) throw cannot_write(file, errno);
  int status = 0;
  do status = ::flock(file_, LOCK_EX);
  while (status != 0 && errno == EINTR);
  if (status != 0) log::warn(fmt::format("{}: cannot be locked ({})", file.string(), std::strerror(errno)));
}

FileLock::~FileLock() { ::close(file_); }

}  // namespace annulus
