#pragma once

#include <optional>

namespace chiaro::cli {

double memory_bytes();  // of this machine

// What may still be taken up of `limit` bytes; absent: of three quarters of this machine's.
double memory_left(std::optional<double> limit);

}  // namespace chiaro::cli
