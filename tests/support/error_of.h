#pragma once

#include <string>

#include "renderer/core/error.h"

namespace chiaro::test {

// The message of the Error that `action` throws; empty where it throws none.
template <class Action>
std::string error_of(const Action& action) {
  try {
    action();
  } catch (const renderer::Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace chiaro::test
