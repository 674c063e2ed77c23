// Signals: the first one cancels the run, the next one ends the process.

#include "apps/vox/interrupt.h"

#include "libvox/io/atomic_file.h"

#include <atomic>
#include <csignal>
#include <unistd.h>

namespace vox::app {
namespace {

std::atomic<Progress*> running{nullptr};
std::atomic<int> handlersAtWork{0};
static_assert(std::atomic<Progress*>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

void endProcess() {
  removePartialFiles();
  constexpr char kMessage[] = "\nvox: interrupted\n";
  const int code = Cancelled::kExitCode;
  if (::write(STDERR_FILENO, kMessage, sizeof kMessage - 1) < 0) _exit(code);
  _exit(code);
}

extern "C" void onSignal(int) {
  ++handlersAtWork;
  Progress* const run = running.exchange(nullptr);
  if (run == nullptr) endProcess();
  run->cancel();
  --handlersAtWork;
}

}  // namespace

void handleSignals() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP})
    if (std::signal(number, onSignal) == SIG_IGN) std::signal(number, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a file that becomes too large is an error of the write
}

CancelOnSignal::CancelOnSignal(Progress& run) {
  running = &run;
}

CancelOnSignal::~CancelOnSignal() {
  running = nullptr;
  while (handlersAtWork > 0) ::usleep(1);  // a handler on another thread may still use the run
}

}  // namespace vox::app
