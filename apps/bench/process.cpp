#include "apps/bench/process.h"

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <ctime>
#include <fcntl.h>
#include <system_error>
#include <unistd.h>

namespace vox::bench {
namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {
    if (number < 0) fail("cannot open a descriptor");
  }
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

/// Blocks SIGCHLD and the signals that interrupt this process, so that it can wait for them.
class BlockedSignals {
 public:
  BlockedSignals() {
    ::sigemptyset(&blocked_);
    for (const int number : {SIGCHLD, SIGINT, SIGTERM}) ::sigaddset(&blocked_, number);
    ::sigprocmask(SIG_BLOCK, &blocked_, &before_);
  }
  ~BlockedSignals() { ::sigprocmask(SIG_SETMASK, &before_, nullptr); }
  BlockedSignals(const BlockedSignals&) = delete;
  BlockedSignals& operator=(const BlockedSignals&) = delete;

  const sigset_t& before() const { return before_; }

  /// Waits for the next of these signals; returns 0 if none arrives in the given time.
  int wait(double seconds) const {
    const double whole = std::floor(seconds);
    timespec time{};
    time.tv_sec = static_cast<std::time_t>(whole);
    time.tv_nsec = static_cast<long>((seconds - whole) * 1e9);
    return std::max(::sigtimedwait(&blocked_, nullptr, &time), 0);
  }

 private:
  sigset_t blocked_{};
  sigset_t before_{};
};

/// Runs in the child until the program starts; makes only calls that are safe after fork.
[[noreturn]] void becomeProgram(char* const* arguments, const Limits& limits, int input, int output,
                                int errorPipe, const sigset_t& signals) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (limits.memoryBytes > 0) {
    const rlimit most{limits.memoryBytes, limits.memoryBytes};
    ::setrlimit(RLIMIT_AS, &most);
  }
  ::sigprocmask(SIG_SETMASK, &signals, nullptr);
  ::dup2(input, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  ::execvp(arguments[0], arguments);
  const int error = errno;
  if (::write(errorPipe, &error, sizeof error) < 0) _exit(126);
  _exit(127);
}

/// Waits for the end of a process. At the timeout, kills it and the processes that it has started.
/// @return whether it ended in time
bool waitFor(pid_t process, const BlockedSignals& signals, double timeoutSeconds, int& status,
             rusage& usage) {
  constexpr double kForever = 1e8;
  const double timeout = timeoutSeconds > 0 ? timeoutSeconds : kForever;
  const auto start = Clock::now();
  while (::wait4(process, &status, WNOHANG, &usage) == 0) {
    const double left = timeout - std::chrono::duration<double>(Clock::now() - start).count();
    const int arrived = left > 0 ? signals.wait(left) : 0;
    if (arrived == SIGCHLD || (arrived == 0 && left > 0)) continue;
    ::kill(-process, SIGKILL);
    ::wait4(process, &status, 0, &usage);
    if (arrived != 0) throw Interrupted();
    return false;
  }
  return true;
}

double secondsOf(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

std::string contentOf(const Descriptor& file) {
  std::string content;
  std::array<char, 4096> part;
  ssize_t got = 0;
  while ((got = ::pread(file.number(), part.data(), part.size(),
                        static_cast<off_t>(content.size()))) > 0)
    content.append(part.data(), static_cast<std::size_t>(got));
  return content;
}

bool saysMemory(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text.find("memory") != std::string::npos || text.find("bad_alloc") != std::string::npos;
}

Outcome outcomeOf(const ProcessRun& run, const Limits& limits) {
  if (run.exitCode == 0) return Outcome::kOk;
  return limits.memoryBytes > 0 && saysMemory(run.output) ? Outcome::kOutOfMemory
                                                          : Outcome::kFailed;
}

std::string lastLine(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

}  // namespace

ProcessRun runProcess(const std::vector<std::string>& command, const Limits& limits) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);

  const Descriptor input(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  const Descriptor output(::memfd_create("output", MFD_CLOEXEC));
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail("cannot make a pipe");
  const Descriptor errorIn(ends[0]);
  Descriptor errorOut(ends[1]);
  const BlockedSignals signals;

  const auto start = Clock::now();
  const pid_t process = ::fork();
  if (process < 0) fail("cannot start a process");
  if (process == 0)
    becomeProgram(arguments.data(), limits, input.number(), output.number(), errorOut.number(),
                  signals.before());
  errorOut.close();
  int execError = 0;
  const bool started = ::read(errorIn.number(), &execError, sizeof execError) == 0;

  int status = 0;
  rusage usage{};
  const bool inTime = waitFor(process, signals, limits.timeoutSeconds, status, usage);
  ProcessRun run;
  run.wallSeconds = std::chrono::duration<double>(Clock::now() - start).count();
  run.cpuSeconds = secondsOf(usage.ru_utime) + secondsOf(usage.ru_stime);
  run.peakBytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
  run.exitCode = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  run.output = contentOf(output);
  if (!started) {
    run.output = std::generic_category().message(execError);
    run.outcome = execError == ENOENT ? Outcome::kAbsent : Outcome::kFailed;
  } else {
    run.outcome = inTime ? outcomeOf(run, limits) : Outcome::kTimedOut;
  }
  return run;
}

std::string describe(const ProcessRun& run) {
  const std::string reason = "exit code " + std::to_string(run.exitCode) +
                             (run.output.empty() ? "" : ": " + lastLine(run.output));
  switch (run.outcome) {
    case Outcome::kOk:
      return "ok";
    case Outcome::kAbsent:
      return "absent";
    case Outcome::kFailed:
      return "failed (" + reason + ")";
    case Outcome::kTimedOut:
      return "over the timeout";
    case Outcome::kOutOfMemory:
      return "over the limit of memory (" + reason + ")";
  }
  return "";
}

}  // namespace vox::bench
