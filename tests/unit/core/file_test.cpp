// SPDX-License-Identifier: Apache-2.0
#include "catoptric/core/file.h"

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>

#include "test_support.h"

namespace catoptric::core {
namespace {

std::string readText(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = readFile(path);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string errorText(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(ReadFile, GivesBackWhatWasWritten) {
  const TemporaryFolder folder;
  std::string text = "one\0two\r\n";
  text.resize(100000, 'x');
  writeFileAtomically(folder / "a.bin", text);
  EXPECT_EQ(readText(folder / "a.bin"), text);
  writeFileAtomically(folder / "empty", "");
  EXPECT_EQ(readText(folder / "empty"), "");
}

TEST(ReadFile, RefusesWhatIsNoFile) {
  const TemporaryFolder folder;
  EXPECT_EQ(errorCode([&] { (void)readFile(folder / "missing"); }), "file.not_found");
  EXPECT_EQ(errorCode([&] { (void)readFile(folder / "."); }), "file.not_regular");
  EXPECT_EQ(errorCode([&] { (void)readFile("/dev/zero"); }), "file.not_regular");
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(errorCode([&] { (void)readFile(folder / "pipe"); }), "file.not_regular");  // and does not wait
}

TEST(ReadFile, KeepsToTheCap) {
  const TemporaryFolder folder;
  writeFileAtomically(folder / "a", std::string(1000, 'x'));
  EXPECT_EQ(readFile(folder / "a", 1000).size(), 1000u);
  EXPECT_EQ(errorCode([&] { (void)readFile(folder / "a", 999); }), "file.too_large");
  // A sparse file of a terabyte is refused by its size, before memory is asked for.
  ASSERT_EQ(::truncate((folder / "a").c_str(), off_t(1) << 40), 0);
  EXPECT_EQ(errorCode([&] { (void)readFile(folder / "a"); }), "file.too_large");
}

TEST(ReadFile, ReadsFilesWhoseSizeIsUnknown) {
  if (!std::filesystem::exists("/proc/self/status")) GTEST_SKIP() << "no /proc here";
  EXPECT_NE(readText("/proc/self/status").find("Pid:"), std::string::npos);
}

TEST(WriteFile, ReplacesTheOldFileAndLeavesNothingElse) {
  const TemporaryFolder folder;
  writeFileAtomically(folder / "a", "old");
  ASSERT_EQ(::chmod((folder / "a").c_str(), 0640), 0);
  writeFileAtomically(folder / "a", "new");
  EXPECT_EQ(readText(folder / "a"), "new");
  EXPECT_EQ(folder.fileCount(), 1u);
  struct stat status {};
  ASSERT_EQ(::stat((folder / "a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0640u);
}

TEST(WriteFile, NewFilesObeyTheUmask) {
  const TemporaryFolder folder;
  const mode_t old = ::umask(027);
  writeFileAtomically(folder / "a", "x");
  ::umask(old);
  struct stat status {};
  ASSERT_EQ(::stat((folder / "a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0640u);
}

TEST(WriteFile, FollowsLinks) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("target", folder / "link");  // dangling at first
  writeFileAtomically(folder / "link", "one");
  writeFileAtomically(folder / "link", "two");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(readText(folder / "target"), "two");
}

TEST(WriteFile, WorksInTheCurrentFolderAndWithLongNames) {
  const TemporaryFolder folder;
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder / ".");
  writeFileAtomically("plain", "x");
  std::filesystem::current_path(before);
  EXPECT_EQ(readText(folder / "plain"), "x");
  writeFileAtomically(folder / std::string(255, 'n'), "long");
  EXPECT_EQ(readText(folder / std::string(255, 'n')), "long");
}

TEST(WriteFile, MissingFolderIsOneLineWithARemedy) {
  const TemporaryFolder folder;
  const std::string text = errorText([&] { writeFileAtomically(folder / "no/such/a.png", "x"); });
  EXPECT_NE(text.find("a.png"), std::string::npos) << text;
  EXPECT_NE(text.find("create the folder first"), std::string::npos) << text;
  EXPECT_EQ(errorCode([&] { writeFileAtomically(folder / "", "x"); }), "file.write");
  EXPECT_EQ(errorCode([&] { writeFileAtomically("", "x"); }), "file.write");
  std::filesystem::create_directory(folder / "sub");
  EXPECT_EQ(errorCode([&] { writeFileAtomically(folder / "sub", "x"); }), "file.write");
  writeFileAtomically(folder / "file", "x");
  EXPECT_EQ(errorCode([&] { writeFileAtomically(folder / "file/below", "x"); }), "file.write");
}

/// Root may write everywhere: becomes "nobody" for a while.
class Unprivileged {
 public:
  Unprivileged() : wasRoot_(::geteuid() == 0) {
    constexpr uid_t kNobody = 65534;
    if (wasRoot_ && ::seteuid(kNobody) != 0) throw std::runtime_error("cannot become nobody");
  }
  ~Unprivileged() {
    if (wasRoot_ && ::seteuid(0) != 0) std::abort();
  }

 private:
  bool wasRoot_;
};

TEST(WriteFile, UnwritableFolderIsRefused) {
  const Unprivileged user;
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "sub");
  writeFileAtomically(folder / "sub/a", "old");
  ASSERT_EQ(::chmod((folder / "sub").c_str(), 0555), 0);
  const std::string text = errorText([&] { writeFileAtomically(folder / "sub/a", "new"); });
  ::chmod((folder / "sub").c_str(), 0755);
  EXPECT_NE(text.find("choose a folder you may write to"), std::string::npos) << text;
  EXPECT_EQ(readText(folder / "sub/a"), "old");
}

TEST(WriteFile, WriteProtectedFileIsRefused) {
  const Unprivileged user;
  const TemporaryFolder folder;
  writeFileAtomically(folder / "a", "old");
  ASSERT_EQ(::chmod((folder / "a").c_str(), 0444), 0);
  EXPECT_EQ(errorCode([&] { writeFileAtomically(folder / "a", "new"); }), "file.write");
  EXPECT_EQ(readText(folder / "a"), "old");
  ASSERT_EQ(::chmod((folder / "a").c_str(), 0), 0);
  EXPECT_EQ(errorCode([&] { (void)readFile(folder / "a"); }), "file.not_readable");
}

TEST(WriteFile, DevicesAreWrittenToNotReplaced) {
  struct stat before {
  }, after{};
  ASSERT_EQ(::stat("/dev/full", &before), 0);
  const std::string text = errorText([] { writeFileAtomically("/dev/full", "x"); });
  EXPECT_NE(text.find("free some space"), std::string::npos) << text;
  writeFileAtomically("/dev/null", "x");
  ASSERT_EQ(::stat("/dev/full", &after), 0);
  EXPECT_TRUE(S_ISCHR(after.st_mode));
  EXPECT_EQ(before.st_ino, after.st_ino);
}

/// Lets a write fail half-way, as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &old_);
    rlimit limit = old_;
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit old_{};
  void (*handler_)(int);
};

TEST(WriteFile, FailureHalfWayKeepsTheOldFile) {
  const TemporaryFolder folder;
  writeFileAtomically(folder / "a", "old");
  std::string code;
  {
    const FileSizeLimit limit(4096);
    code = errorCode([&] { writeFileAtomically(folder / "a", std::string(100000, 'x')); });
  }
  EXPECT_EQ(code, "file.write");
  EXPECT_EQ(readText(folder / "a"), "old");
  EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(WriteFile, ProcessesAndThreadsDoNotMixTheirBytes) {
  const TemporaryFolder folder;
  constexpr std::size_t kSize = 300000;
  const auto writeMany = [&](char letter) {
    for (int i = 0; i < 15; ++i) writeFileAtomically(folder / "a", std::string(kSize, letter));
  };
  writeFileAtomically(folder / "a", std::string(kSize, '0'));
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    bool ok = true;
    try {
      writeMany('A');
    } catch (...) {
      ok = false;
    }
    ::_exit(ok ? 0 : 1);
  }
  std::thread other(writeMany, 'B');
  for (int i = 0; i < 30; ++i) {
    const std::string text = readText(folder / "a");
    EXPECT_EQ(text.size(), kSize);
    EXPECT_EQ(text.find_first_not_of(text.front()), std::string::npos);
  }
  other.join();
  int status = 1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_EQ(folder.fileCount(), 1u);
}

}  // namespace
}  // namespace catoptric::core
