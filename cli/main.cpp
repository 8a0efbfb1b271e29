#include "cli/exhaustion.h"
#include "cli/interruption.h"
#include "cli/program.h"

namespace {

// The initialisers of some two hundred libraries take longer than many a command, start threads and take memory.
void before_libraries_start(int, char**, char**) {
  chiaro::cli::install_signal_handlers();
  chiaro::cli::prepare_for_exhaustion();
}

// The loader calls what stands in that section of a program before any of them.
[[gnu::section(".preinit_array"), gnu::used]] void (*first)(int, char**, char**) = before_libraries_start;

}  // namespace

int main(int argc, char** argv) { return chiaro::cli::run_program(argc, argv); }
