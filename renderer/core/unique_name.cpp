#include "renderer/core/unique_name.h"

#include <random>

#include <fmt/format.h>

namespace chiaro::renderer {

std::string unique_name() {
  std::random_device device;
  return fmt::format("{:08x}{:08x}", device(), device());
}

}  // namespace chiaro::renderer
