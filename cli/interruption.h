#pragma once

#include <atomic>

namespace chiaro::cli {

// From here on SIGINT and SIGTERM set the flag; a second one ends the program at once.
void install_signal_handlers();

// What renderer::Control::interrupted points at.
const std::atomic<bool>& interruption_flag();

}  // namespace chiaro::cli
