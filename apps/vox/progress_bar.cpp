// A bar of text, or lines.

#include "apps/vox/progress_bar.h"

#include "apps/vox/options.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <unistd.h>

namespace vox::app {
namespace {

/// True if stderr is a terminal that can erase a line.
bool onTerminal() {
  const char* const kind = std::getenv("TERM");
  return ::isatty(STDERR_FILENO) == 1 && kind != nullptr && std::string_view(kind) != "dumb";
}

}  // namespace

ProgressBar::ProgressBar(const CommonOptions& options)
    : isBar_(!options.quiet && onTerminal()), isLines_(options.progressLines) {}

Progress::Callback ProgressBar::callback() {
  if (isLines_) return [this](double fraction, const char* stage) { print(fraction, stage); };
  if (!isBar_) return {};
  return [this](double fraction, const char* stage) { draw(fraction, stage); };
}

void ProgressBar::print(double fraction, const char* stage) {
  const int percent = static_cast<int>(std::floor(fraction * 100));
  if (percent == printedPercent_) return;
  printedPercent_ = percent;
  std::fprintf(stderr, "vox: %d%% %s\n", percent, stage);
}

void ProgressBar::draw(double fraction, const char* stage) {
  constexpr std::chrono::milliseconds kMoment(200);
  if (!drawn_ && std::chrono::steady_clock::now() - start_ < kMoment) return;
  drawn_ = true;
  constexpr int kWidth = 40;
  const int full = static_cast<int>(std::floor(fraction * kWidth));
  const int percent = static_cast<int>(std::floor(fraction * 100));
  const std::string bar = std::string(static_cast<std::size_t>(full), '#') +
                          std::string(static_cast<std::size_t>(kWidth - full), '.');
  std::fprintf(stderr, "\r[%s] %3d%% %s\033[K", bar.c_str(), percent, stage);
  std::fflush(stderr);
}

void ProgressBar::erase() {
  if (!drawn_) return;
  drawn_ = false;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
}

}  // namespace vox::app
