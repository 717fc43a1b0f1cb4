// SPDX-License-Identifier: Apache-2.0
#include "catoptric/core/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "catoptric/core/error.h"
#include "catoptric/core/log.h"

namespace catoptric::core {
namespace {

/// A POSIX file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] int get() const { return fd_; }
  [[nodiscard]] bool isOpen() const { return fd_ >= 0; }
  /// Network file systems report a full disk only here.
  [[nodiscard]] bool close() { return ::close(std::exchange(fd_, -1)) == 0; }

 private:
  int fd_;
};

/// Removes the temporary file unless it was renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::string path) : path_(std::move(path)) {}
  ~TemporaryFile() {
    if (!path_.empty()) ::unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  void release() { path_.clear(); }

 private:
  std::string path_;
};

std::string reason(int code) {
  return std::error_code(code, std::generic_category()).message();
}

std::string hintForWriting(int code) {
  switch (code) {
    case ENOSPC:
    case EDQUOT:
      return "free some space or write to another disk";
    case ENOENT:
      return "create the folder first";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a folder you may write to";
    case ENOTDIR:
      return "a part of the path is a file, not a folder";
    case EFBIG:
      return "the file size limit of this process or disk is too small";
    case ENAMETOOLONG:
      return "choose a shorter name";
    default:
      return {};
  }
}

[[noreturn]] void throwWriteError(const std::filesystem::path& path, int code) {
  throw Error("file.write", "cannot write '" + path.string() + "': " + reason(code), {},
              hintForWriting(code));
}

[[noreturn]] void throwTooLarge(const std::filesystem::path& path, std::size_t maxBytes) {
  throw Error("file.too_large",
              "'" + path.string() + "' is larger than " + std::to_string(maxBytes) + " bytes");
}

/// 0, or the errno of the write that failed.
int writeAll(int fd, std::span<const std::byte> bytes) {
  constexpr std::size_t kLargestWrite = std::size_t(1) << 30;  // Linux writes at most 2 GiB at once
  while (!bytes.empty()) {
    const ssize_t count = ::write(fd, bytes.data(), std::min(bytes.size(), kLargestWrite));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return count < 0 ? errno : EIO;
    bytes = bytes.subspan(std::size_t(count));
  }
  return 0;
}

/// Devices and pipes (/dev/stdout, /dev/full) cannot be replaced by a rename: they are written to.
void writeToDevice(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (!file.isOpen()) throwWriteError(path, errno);
  if (const int code = writeAll(file.get(), bytes)) throwWriteError(path, code);
  if (!file.close()) throwWriteError(path, errno);
}

/// ".NAME.PID-COUNT.tmp" beside the target: unique among all processes and threads of the machine that write
/// now. A file of that name left by a killed process, or by another machine that shares the folder, is passed
/// over.
std::pair<int, std::string> openTemporary(const std::filesystem::path& path) {
  static std::atomic<unsigned> counter{0};
  const std::filesystem::path folder = path.parent_path();
  const std::string name = path.filename().string().substr(0, 200);  // NAME_MAX is 255
  for (int attempt = 0; attempt < 1000; ++attempt) {
    const std::string unique =
        "." + name + "." + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".tmp";
    const std::string temporary = (folder / unique).string();
    const int fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd >= 0) return {fd, temporary};
    if (errno != EEXIST) throwWriteError(path, errno);
  }
  throwWriteError(path, EEXIST);
}

void replaceFile(const std::filesystem::path& path, std::optional<mode_t> oldMode,
                 std::span<const std::byte> bytes) {
  const auto [fd, temporaryPath] = openTemporary(path);
  TemporaryFile temporary(temporaryPath);
  Descriptor file(fd);
  // Best effort: some file systems (FAT) have no modes.
  if (oldMode && ::fchmod(fd, *oldMode) != 0)
    logInfo("cannot keep the permissions of '" + path.string() + "'");
  if (const int code = writeAll(fd, bytes)) throwWriteError(path, code);
  if (!file.close()) throwWriteError(path, errno);
  if (::rename(temporaryPath.c_str(), path.c_str()) != 0) throwWriteError(path, errno);
  temporary.release();
}

/// Follows links, so that a link to a picture stays a link. A dangling one is followed too.
std::filesystem::path resolveLinks(std::filesystem::path path) {
  constexpr int kMaxLinks = 40;  // as the kernel has it
  std::error_code ignored;
  for (int i = 0; i < kMaxLinks && std::filesystem::is_symlink(path, ignored); ++i) {
    const std::filesystem::path target = std::filesystem::read_symlink(path, ignored);
    if (target.empty()) break;
    path = target.is_absolute() ? target : path.parent_path() / target;
  }
  return path;
}

}  // namespace

std::vector<std::byte> readFile(const std::filesystem::path& path, std::size_t maxBytes) {
  // O_NONBLOCK: opening a pipe without a writer must fail the test below, not wait.
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!file.isOpen()) {
    const int code = errno;
    throw Error(code == ENOENT ? "file.not_found" : "file.not_readable",
                "cannot open '" + path.string() + "': " + reason(code), {},
                code == ENOENT ? "check the path" : "");
  }
  struct stat status {};
  if (::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode))
    throw Error("file.not_regular", "'" + path.string() + "' is not a regular file");
  if (std::size_t(status.st_size) > maxBytes) throwTooLarge(path, maxBytes);

  // The size is only a hint: the file may grow while it is read, and files of /proc say 0.
  std::vector<std::byte> bytes;
  try {
    bytes.resize(std::size_t(status.st_size) + 1);
    std::size_t used = 0;
    while (true) {
      if (used == bytes.size()) bytes.resize(2 * bytes.size());
      const ssize_t count = ::read(file.get(), bytes.data() + used, bytes.size() - used);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0)
        throw Error("file.not_readable", "cannot read '" + path.string() + "': " + reason(errno));
      if (count == 0) break;
      used += std::size_t(count);
      if (used > maxBytes) throwTooLarge(path, maxBytes);
    }
    bytes.resize(used);
  } catch (const std::bad_alloc&) {
    throw Error("file.too_large", "'" + path.string() + "' does not fit into memory");
  }
  return bytes;
}

void writeFileAtomically(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  if (path.empty() || !path.has_filename())
    throw Error("file.write", "cannot write '" + path.string() + "': not a file name");
  const std::filesystem::path target = resolveLinks(path);
  struct stat status {};
  const bool exists = ::stat(target.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) throwWriteError(path, EISDIR);
  if (exists && !S_ISREG(status.st_mode)) return writeToDevice(target, bytes);
  // A write-protected file is the user's "no", even where the folder would let us replace it.
  if (exists && ::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0) throwWriteError(path, errno);
  replaceFile(target, exists ? std::optional<mode_t>(status.st_mode & 0777) : std::nullopt, bytes);
}

void writeFileAtomically(const std::filesystem::path& path, std::string_view text) {
  writeFileAtomically(path, std::as_bytes(std::span(text.data(), text.size())));
}

}  // namespace catoptric::core
