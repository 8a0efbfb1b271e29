#include "cli/program.h"

int main(int argc, char** argv) { return chiaro::cli::run_program(argc, argv); }
