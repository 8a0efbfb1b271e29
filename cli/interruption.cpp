#include "cli/interruption.h"

#include <csignal>

#include <unistd.h>

#include "cli/program.h"
#include "renderer/core/atomic_file.h"

namespace chiaro::cli {
namespace {

// A signal handler can reach nothing but static storage.
std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

void handle_signal(int) {
  if (!interrupted.exchange(true)) return;
  renderer::remove_unfinished_files();
  _exit(kInterrupted);
}

}  // namespace

void install_signal_handlers() {
  struct sigaction action = {};
  action.sa_handler = handle_signal;
  action.sa_flags = 0;  // who waits for a pipe waits no longer
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // A terminal that closes, unless nohup made it nobody's concern.
  struct sigaction inherited = {};
  sigaction(SIGHUP, nullptr, &inherited);
  if (inherited.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
  // A file that may grow no further is as a full disk: writing it fails, and says so.
  action.sa_handler = SIG_IGN;
  sigaction(SIGXFSZ, &action, nullptr);
}

const std::atomic<bool>& interruption_flag() { return interrupted; }

}  // namespace chiaro::cli
